//! What the extensions of glTF's material add: how its reflection is tinted and brushed, coats and fibres on top of it, what
//! shines through it, and what fills its body.
use durer_core::{
    math::{
        Frame, Normal3, Vector3,
        float::{cos, ln, sin, sqr},
    },
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, FloatInput, ParamDefault, ParamSpec, ParamType};

use super::{
    super::{normal_map, roughness::tangent},
    film,
};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Facets, Interface, Lobe, Matte, Reflectance, Sheen, Split, Tilted, Veil},
    texture::TextureAt,
};

/// Least cosine between the normals of coat and surface for the coat to count as tilted.
const LEAST_COSINE: f32 = 0.05;

/// Parameters of the extensions.
#[derive(Debug)]
pub(super) struct Layers {
    specular: FloatInput,
    specular_color: ColorInput,
    coat: FloatInput,
    coat_roughness: FloatInput,
    coat_normal: Option<ColorInput>,
    coat_normal_scale: f32,
    sheen: ColorInput,
    sheen_roughness: FloatInput,
    anisotropy: FloatInput,
    direction: Option<ColorInput>,
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
    pub(super) const PARAMS: [ParamSpec; 21] = [
        ParamSpec::float_texture("specular", 1.0, "Strength of the dielectric part's reflection.")
            .range(0.0, 1.0),
        ParamSpec::color_texture("specularcolor", [1.0; 3], "Its colour at normal incidence.")
            .range(0.0, f32::INFINITY),
        ParamSpec::float_texture("clearcoat", 0.0, "Share of the surface below a clear coat.")
            .range(0.0, 1.0),
        ParamSpec::float_texture("clearcoatroughness", 0.0, "Roughness of the coat.").range(0.0, 1.0),
        ParamSpec::new(
            "clearcoatnormal",
            ParamType::ColorTexture,
            ParamDefault::Unset,
            "Normal map of the coat, as normal; without it the coat is as smooth as the shape.",
        ),
        ParamSpec::float("clearcoatnormalscale", 1.0, "Factor on the slope of the coat's normal map."),
        ParamSpec::color_texture("sheencolor", [0.0; 3], "Colour of fibres on the surface; black: none.")
            .range(0.0, 1.0),
        ParamSpec::float_texture("sheenroughness", 0.0, "How far the fibres lean apart.").range(0.0, 1.0),
        ParamSpec::float_texture("anisotropy", 0.0, "Brushed: the roughness along the brush rises to 1.")
            .range(0.0, 1.0),
        ParamSpec::new(
            "anisotropydirection",
            ParamType::ColorTexture,
            ParamDefault::Unset,
            "Direction of the brush along growing u and v, as 2 c - 1 of red and green; without it along u.",
        ),
        ParamSpec::float("anisotropyrotation", 0.0, "Turns the direction of the brush, from u towards v.")
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
        Medium::DISPERSION,
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
            coat_normal: args.is_set("clearcoatnormal").then(|| args.color_input("clearcoatnormal")),
            coat_normal_scale: args.float("clearcoatnormalscale"),
            sheen: args.color_input("sheencolor"),
            sheen_roughness: args.float_input("sheenroughness"),
            anisotropy: args.float_input("anisotropy"),
            direction: args.is_set("anisotropydirection").then(|| args.color_input("anisotropydirection")),
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
        let tint = cx.weight(&self.specular_color, at, |v| v.max(0.0));
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
            let film = film::reflected(&cx.basis, cos, (self.film_eta, thickness), own.ends().0);
            let seen = own.at(cos) * (1.0 - share) + film * share;
            Reflectance::Schlick { f0: seen, f90: seen }
        };
        (under_film(of_dielectric), under_film(whole))
    }

    /// The facets of a surface of width `alpha`.
    pub(super) fn facets(&self, cx: &ShadeCx<'_>, surface: &Surface, alpha: f32) -> Facets {
        let at = surface.texture_at();
        let strength = cx.float(self.anisotropy, &at).clamp(0.0, 1.0);
        if strength == 0.0 {
            return Facets::round(alpha);
        }
        let [x, y] = self.direction.as_ref().map_or([1.0, 0.0], |map| {
            let [r, g, _] = cx.color(map, &at).rgb;
            [2.0 * r - 1.0, 2.0 * g - 1.0]
        });
        let (s, c) = (sin(self.rotation), cos(self.rotation));
        let (x, y) = (c * x - s * y, c * y + s * x);
        let t = tangent(surface);
        let t = Vector3::new(t.x, t.y, 0.0).normalize();
        let across = Vector3::new(-t.y, t.x, 0.0);
        // Mirrored texture coordinates turn the other direction round.
        let is_mirrored = surface.frame().to_local(surface.dpdv).dot(across) < 0.0;
        let along = t * x + across * if is_mirrored { -y } else { y };
        Facets::along(along, alpha + (1.0 - alpha) * sqr(strength), alpha)
    }

    /// The normal of the coat in the frame of the surface, whose normal without normal map is `smooth`.
    fn coat_normal(&self, cx: &ShadeCx<'_>, (surface, smooth): (&Surface, Normal3), wo: Vector3) -> Vector3 {
        let shape = Surface { n_s: smooth, ..*surface };
        let normal = match &self.coat_normal {
            Some(map) => {
                normal_map::tilted(&shape, cx.color(map, &surface.texture_at()), self.coat_normal_scale, wo)
            }
            None => smooth,
        };
        let up = Vector3::new(0.0, 0.0, 1.0);
        if normal == surface.n_s {
            return up;
        }
        let local = Frame::from_z(surface.n_s).to_local(normal.into());
        if local.z >= LEAST_COSINE { local } else { up }
    }

    /// Coat and fibres on a surface; `smooth` is its normal without normal map.
    pub(super) fn veil(&self, cx: &ShadeCx<'_>, (surface, smooth): (&Surface, Normal3), wo: Vector3) -> Veil {
        let at = surface.texture_at();
        let unit = |input: FloatInput| cx.float(input, &at).clamp(0.0, 1.0);
        let coat = unit(self.coat);
        let sheen = self.fibres(cx, &at).rgb.into_iter().fold(0.0, f32::max);
        Veil {
            coat,
            coat_alpha: if coat > 0.0 { sqr(unit(self.coat_roughness)) } else { 0.0 },
            coat_normal: match coat > 0.0 {
                true => self.coat_normal(cx, (surface, smooth), wo),
                false => Veil::NONE.coat_normal,
            },
            sheen,
            sheen_alpha: if sheen > 0.0 { sqr(unit(self.sheen_roughness)) } else { 0.0 },
        }
    }
    fn fibres(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        cx.color(&self.sheen, at).map(|v| v.clamp(0.0, 1.0))
    }

    /// Adds coat and fibres to `bsdf`, of a surface of which the share `coverage` is there.
    pub(super) fn on_top(
        &self,
        (cx, at): (&ShadeCx<'_>, &TextureAt),
        veil: &Veil,
        (wo, coverage): (Vector3, f32),
        bsdf: &mut Bsdf,
    ) {
        if veil.coat > 0.0 {
            let coat = veil.coat();
            bsdf.add(
                match veil.coat_normal == Veil::NONE.coat_normal {
                    true => Lobe::Glossy(coat),
                    false => Lobe::Tilted(Tilted { glossy: coat, normal: veil.coat_normal }),
                }
                .scaled(coverage),
            );
        }
        if veil.sheen > 0.0 {
            let color = cx.basis.reflectance(self.fibres(cx, at));
            let below_coat = Veil { sheen: 0.0, ..*veil }.left(wo);
            let sheen = Sheen::new(color * (below_coat * coverage), veil.sheen_alpha, wo);
            bsdf.add(Lobe::Matte(Matte::Sheen(sheen)));
        }
    }

    /// Share of the body's light that leaves behind it, and its colour.
    pub(super) fn shine(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> (f32, Spectrum) {
        let share = cx.float(self.shine, at).clamp(0.0, 1.0);
        match share > 0.0 {
            true => (share, cx.weight(&self.shine_color, at, |v| v.clamp(0.0, 1.0))),
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
    let eta = args.float("eta");
    let dispersion = Medium::dispersing(eta, args.float(Medium::DISPERSION.name));
    Some(Medium { absorption, dispersion, ..Medium::clear(eta) })
}
