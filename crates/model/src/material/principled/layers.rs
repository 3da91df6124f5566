//! What the extensions of glTF's material add: how its reflection is tinted and brushed, coats and fibres on top of it, what
//! shines through it, and what fills its body.
use durer_core::{
    math::{
        Vector3,
        float::{cos, ln, sin, sqr},
    },
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, FloatInput, ParamDefault, ParamSpec, ParamType};

use super::{super::roughness::tangent, film};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Facets, Glossy, Interface, Lobe, Matte, Reflectance, Sheen, Split},
    texture::TextureAt,
};

/// Reflectance of the clear coat at normal incidence: an index of 1.5.
const COAT: f32 = 0.04;

/// Parameters of the extensions.
#[derive(Debug)]
pub(super) struct Layers {
    specular: FloatInput,
    specular_color: ColorInput,
    coat: FloatInput,
    coat_roughness: FloatInput,
    sheen: ColorInput,
    sheen_roughness: FloatInput,
    anisotropy: FloatInput,
    rotation: f32,
    film: FloatInput,
    film_eta: f32,
    film_thickness: FloatInput,
    shine: FloatInput,
    shine_color: ColorInput,
    pub(super) body: Option<Medium>,
    pub(super) compensates: bool,
}

impl Layers {
    /// Whether nothing is there beside the core of the material.
    pub(super) fn are_plain(&self) -> bool {
        let none = |input: FloatInput| input == FloatInput::Constant(0.0);
        let as_usual = self.specular == FloatInput::Constant(1.0)
            && self.specular_color == ColorInput::Constant(Color::new(1.0, 1.0, 1.0));
        let extras = [self.coat, self.anisotropy, self.film, self.shine];
        as_usual
            && extras.into_iter().all(none)
            && self.sheen == ColorInput::Constant(Color::BLACK)
            && self.body.is_none()
            && !self.compensates
    }
    pub(super) const PARAMS: [ParamSpec; 17] = [
        ParamSpec::float_texture("specular", 1.0, "Strength of the dielectric part's reflection.")
            .range(0.0, 1.0),
        ParamSpec::color_texture("specularcolor", [1.0; 3], "Its colour at normal incidence.")
            .range(0.0, f32::INFINITY),
        ParamSpec::float_texture("clearcoat", 0.0, "Share of the surface below a clear coat.")
            .range(0.0, 1.0),
        ParamSpec::float_texture("clearcoatroughness", 0.0, "Roughness of the coat.").range(0.0, 1.0),
        ParamSpec::color_texture("sheencolor", [0.0; 3], "Colour of fibres on the surface; black: none.")
            .range(0.0, 1.0),
        ParamSpec::float_texture("sheenroughness", 0.0, "How far the fibres lean apart.").range(0.0, 1.0),
        ParamSpec::float_texture("anisotropy", 0.0, "Brushed: the roughness along the brush rises to 1.")
            .range(0.0, 1.0),
        ParamSpec::float("anisotropyrotation", 0.0, "Direction of the brush, from that of growing u.")
            .unit("rad"),
        ParamSpec::float_texture("iridescence", 0.0, "Share of the surface below a thin film.")
            .range(0.0, 1.0),
        ParamSpec::float("iridescenceeta", 1.3, "Index of refraction of the film.").range(1.0, 10.0),
        ParamSpec::float_texture("iridescencethickness", 400.0, "Thickness of the film.")
            .unit("nm")
            .range(0.0, 1e6),
        ParamSpec::float_texture(
            "diffusetransmission",
            0.0,
            "Share of the body's light that leaves behind it.",
        )
        .range(0.0, 1.0),
        ParamSpec::color_texture("diffusetransmissioncolor", [1.0; 3], "Its colour.")
            .range(0.0, f32::INFINITY),
        ParamSpec::float(
            "thickness",
            0.0,
            "Above 0 what is transmitted enters a real body and is refracted.",
        )
        .unit("m")
        .range(0.0, f32::INFINITY),
        ParamSpec::color(
            "attenuationcolor",
            [1.0; 3],
            "What is left of white light after the distance below.",
        )
        .range(0.0, 1.0),
        ParamSpec::new(
            "attenuationdistance",
            ParamType::Float,
            ParamDefault::Unset,
            "Way through the body after which light has that colour; without it nothing is absorbed.",
        )
        .unit("m")
        .range(0.0, f32::INFINITY),
        ParamSpec::new(
            "energycompensation",
            ParamType::Bool,
            ParamDefault::Bool(false),
            "Adds the light that bounces several times between microfacets: rough metal is brighter.",
        ),
    ];

    pub(super) fn read(args: &mut Args<'_>) -> Self {
        Self {
            specular: args.float_input("specular"),
            specular_color: args.color_input("specularcolor"),
            coat: args.float_input("clearcoat"),
            coat_roughness: args.float_input("clearcoatroughness"),
            sheen: args.color_input("sheencolor"),
            sheen_roughness: args.float_input("sheenroughness"),
            anisotropy: args.float_input("anisotropy"),
            rotation: args.float("anisotropyrotation"),
            film: args.float_input("iridescence"),
            film_eta: args.float("iridescenceeta"),
            film_thickness: args.float_input("iridescencethickness"),
            shine: args.float_input("diffusetransmission"),
            shine_color: args.color_input("diffusetransmissioncolor"),
            body: body(args),
            compensates: args.bool("energycompensation"),
        }
    }

    /// How a surface of this reflectance of its dielectric part and base colour reflects, of which the share `metallic` is
    /// a metal, seen under a cosine.
    pub(super) fn reflectance(
        &self,
        (cx, at): (&ShadeCx<'_>, &TextureAt),
        (dielectric, base, metallic): (Spectrum, Spectrum, f32),
        cos: f32,
    ) -> (Reflectance, Reflectance) {
        let specular = cx.float(self.specular, at).clamp(0.0, 1.0);
        let tint = cx.basis.reflectance(cx.color(self.specular_color, at).map(|v| v.max(0.0)));
        let dielectric = (dielectric * tint).map(|v| v.min(1.0)) * specular;
        let f0 = dielectric * (1.0 - metallic) + base * metallic;
        let f90 = Spectrum::splat(1.0 - (1.0 - specular) * (1.0 - metallic));
        let of_dielectric = Reflectance::Schlick { f0: dielectric, f90: Spectrum::splat(specular) };
        let whole = Reflectance::Schlick { f0, f90 };
        let share = cx.float(self.film, at).clamp(0.0, 1.0);
        let thickness = cx.float(self.film_thickness, at);
        if share == 0.0 || thickness <= 0.0 {
            return (of_dielectric, whole);
        }
        // The film's colour is that of the viewer's angle, for all facets.
        let under_film = |own: Reflectance| {
            let [r, g, b] = cx.basis.to_rgb(own.ends().0);
            let film =
                cx.basis.reflectance(film::reflected(cos, self.film_eta, thickness, Color::new(r, g, b)));
            let seen = own.at(cos) * (1.0 - share) + film * share;
            Reflectance::Schlick { f0: seen, f90: seen }
        };
        (under_film(of_dielectric), under_film(whole))
    }

    /// The facets of a surface of width `alpha`.
    pub(super) fn facets(&self, cx: &ShadeCx<'_>, surface: &Surface, alpha: f32) -> Facets {
        let strength = cx.float(self.anisotropy, &surface.texture_at()).clamp(0.0, 1.0);
        if strength == 0.0 {
            return Facets::round(alpha);
        }
        let t = tangent(surface);
        let (s, c) = (sin(self.rotation), cos(self.rotation));
        let turned = Vector3::new(c * t.x - s * t.y, c * t.y + s * t.x, 0.0);
        Facets::along(turned, alpha + (1.0 - alpha) * sqr(strength), alpha)
    }

    /// Adds coat and fibres to `bsdf`, of a surface of which the share `coverage` is there; the share of light that is left
    /// for what lies below them.
    pub(super) fn on_top(
        &self,
        (cx, at): (&ShadeCx<'_>, &TextureAt),
        (wo, coverage): (Vector3, f32),
        bsdf: &mut Bsdf,
    ) -> f32 {
        let mut left = 1.0;
        let coat = cx.float(self.coat, at).clamp(0.0, 1.0);
        if coat > 0.0 {
            let alpha = sqr(cx.float(self.coat_roughness, at).clamp(0.0, 1.0));
            let reflectance = Reflectance::Schlick { f0: Spectrum::splat(COAT), f90: Spectrum::ONE };
            let facets = Facets::round(alpha);
            let glossy = Glossy { reflectance, facets, scale: coat * coverage };
            left -= coat * glossy.directional_albedo(wo).max();
            bsdf.add(Lobe::Glossy(glossy));
        }
        let color = cx.basis.reflectance(cx.color(self.sheen, at).map(|v| v.clamp(0.0, 1.0)));
        if !color.is_black() {
            let alpha = sqr(cx.float(self.sheen_roughness, at).clamp(0.0, 1.0));
            let sheen = Sheen::new(color * (left * coverage), alpha, wo);
            left *= 1.0 - color.max() * sheen.hidden;
            bsdf.add(Lobe::Matte(Matte::Sheen(sheen)));
        }
        left.max(0.0)
    }

    /// Share of the body's light that leaves behind it, and its colour.
    pub(super) fn shine(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> (f32, Spectrum) {
        let share = cx.float(self.shine, at).clamp(0.0, 1.0);
        match share > 0.0 {
            true => (share, cx.basis.reflectance(cx.color(self.shine_color, at).map(|v| v.clamp(0.0, 1.0)))),
            false => (0.0, Spectrum::BLACK),
        }
    }

    /// The boundary of a real body, of which what enters is tinted and the share `weight` is there.
    pub(super) fn boundary(eta: f32, tint: Spectrum, weight: f32) -> Interface {
        let split = Split::Fresnel { reflection: Spectrum::splat(weight), transmission: tint * weight };
        Interface { eta, split }
    }
}

/// What fills the body, if it has a thickness.
fn body(args: &mut Args<'_>) -> Option<Medium> {
    let color = args.color("attenuationcolor");
    let distance = args.optional_float("attenuationdistance").filter(|d| *d > 0.0);
    if args.float("thickness") <= 0.0 {
        return None;
    }
    let absorption = distance.map_or(Color::BLACK, |d| color.map(|c| -ln(c.clamp(1e-6, 1.0)) / d));
    Some(Medium { eta: args.float("eta"), absorption, priority: None })
}
