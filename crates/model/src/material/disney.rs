//! Disney's material (Burley 2012, "Physically Based Shading at Disney"; 2015, "Extending the Disney BRDF to a BSDF with
//! Integrated Subsurface Scattering") with the formulas that Mitsuba 3 has in `principled` and `principledthin`.
//!
//! Facets of widths `r² / s` and `r² s`, `s = sqrt(1 - 0.9 anisotropic)`, reflect as glass (Fresnel's equations), as metal and
//! with a tint (Schlick's approximation from the colour on). Below them is a body ([`Burley`]), or glass that is tinted by the root of
//! the colour; on top a coat ([`Varnish`]). The formulas do not share light among each other: together they may send more than
//! arrives at grazing angles.
//!
//! A sheet (`thin`) has no inside: it reflects and passes the same from both sides, through facets that are
//! `0.65 eta - 0.35` as rough.
use durer_core::{
    math::{
        Vector3,
        float::{lerp, sqr},
    },
    spectrum::Spectrum,
};
use durer_scene::{Args, ColorInput, FloatInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, detail::Detail, roughness::tangent, share, share_input};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{
        Bsdf, Burley, Facets, Glossy, Interface, Lobe, Matte, Reflectance, Sheet, Split, Varnish,
        normal_reflectance,
    },
};

/// Disney's material.
#[derive(Debug)]
pub struct Disney {
    base: ColorInput,
    numbers: [FloatInput; UNITS.len()],
    diffuse_transmission: FloatInput,
    eta: f32,
    thin: bool,
    detail: Detail,
}

/// The numbers from 0 to 1.
const UNITS: [ParamSpec; 10] = [
    unit("roughness", 0.5, "0 mirror, 1 dull; the width of facets is its square."),
    unit("anisotropic", 0.0, "How much longer highlights are along u."),
    unit("metallic", 0.0, "0 dielectric, 1 metal. Not of a thin sheet."),
    unit("spectrans", 0.0, "Share of the body that is clear."),
    unit("speculartint", 0.0, "How much what a dielectric reflects has the hue of the base colour."),
    unit("sheen", 0.0, "Light along cloth."),
    unit("sheentint", 0.0, "How much the sheen has the hue of the base colour."),
    unit("flatness", 0.0, "How much the body looks as if light went below it."),
    unit("clearcoat", 0.0, "A second highlight. Not of a thin sheet."),
    unit("clearcoatgloss", 0.0, "How narrow that is: from width 0.1 to 0.001."),
];

const fn unit(name: &'static str, default: f32, doc: &'static str) -> ParamSpec {
    ParamSpec::float_texture(name, default, doc).range(0.0, 1.0)
}

/// [`UNITS`] at a point, and the base colour.
struct At {
    base: Spectrum,
    /// The base colour at luminance 1.
    hue: Spectrum,
    roughness: f32,
    anisotropic: f32,
    metallic: f32,
    clear: f32,
    tint: f32,
    sheen: f32,
    sheen_tint: f32,
    flatness: f32,
    coat: f32,
    coat_gloss: f32,
    behind: f32,
}

impl Kind for Disney {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "disney",
        aliases: &[],
        doc: "Disney's material as Mitsuba has it: metal, glass, cloth or plastic, or a thin sheet.",
        params: &[
            ParamSpec::color_texture("color", [0.5; 3], "Colour of the body, of metal, and of hues.")
                .range(0.0, f32::INFINITY),
            UNITS[0],
            UNITS[1],
            UNITS[2],
            UNITS[3],
            UNITS[4],
            UNITS[5],
            UNITS[6],
            UNITS[7],
            UNITS[8],
            UNITS[9],
            ParamSpec::float("eta", 1.5, "Index of refraction of what is no metal.").range(0.1, 10.0),
            ParamSpec::new("thin", ParamType::Bool, ParamDefault::Bool(false), "A sheet without inside."),
            ParamSpec::float_texture(
                "difftrans",
                0.0,
                "Of a thin sheet: twice the share of the body's light that leaves on the other side.",
            )
            .range(0.0, 2.0),
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let thin = args.bool("thin");
        let without = if thin { &["metallic", "clearcoat", "clearcoatgloss"][..] } else { &["difftrans"] };
        for name in without.iter().filter(|name| args.is_set(name)).collect::<Vec<_>>() {
            let other = if thin { "beside" } else { "without" };
            args.warning(name, format!("\"{name}\" has no effect {other} \"thin\""));
        }
        Some(Box::new(Self {
            base: share_input(args, "color"),
            numbers: UNITS.map(|spec| args.float_input(spec.name)),
            diffuse_transmission: args.float_input("difftrans"),
            eta: args.float("eta"),
            thin,
            detail: Detail::read(args),
        }))
    }
}

/// Facets as rough as this.
fn facets(roughness: f32, anisotropic: f32, along: Vector3) -> Facets {
    const LEAST: f32 = 0.001;
    let (width, stretch) = (sqr(roughness), (1.0 - 0.9 * anisotropic).sqrt());
    Facets::along(along, (width / stretch).max(LEAST), (width * stretch).max(LEAST))
}

/// Schlick's approximation from a colour on, this much of it.
fn rising(f0: Spectrum, share: f32) -> Reflectance {
    Reflectance::Schlick { f0, f90: Spectrum::splat(share) }
}

impl Disney {
    fn at(&self, cx: &ShadeCx<'_>, surface: &Surface) -> At {
        let at = surface.texture_at();
        let unit = |input: FloatInput| cx.float(input, &at).clamp(0.0, 1.0);
        let [roughness, anisotropic, metallic, clear, tint, sheen, sheen_tint, flatness, coat, coat_gloss] =
            self.numbers.map(unit);
        let base = share(cx, &self.base, &at);
        let luminance = cx.color(&self.base, &at).luminance();
        let hue = if luminance > 0.0 { base / luminance } else { Spectrum::ONE };
        let behind = 0.5 * cx.float(self.diffuse_transmission, &at).clamp(0.0, 2.0);
        At {
            base,
            hue,
            roughness,
            anisotropic,
            metallic,
            clear,
            tint,
            sheen,
            sheen_tint,
            flatness,
            coat,
            coat_gloss,
            behind,
        }
    }
    /// Whether light gets through anywhere: then the outside is another one than the inside.
    fn is_clear(&self) -> bool {
        self.numbers[3] != FloatInput::Constant(0.0)
    }
    /// The body and its sheen, and how much of each is there.
    fn body(at: &At, (body, sheen): (f32, f32)) -> Lobe<'static> {
        let sheen = at.hue.map(|hue| lerp(at.sheen_tint, 1.0, hue)) * (at.sheen * sheen);
        let (roughness, flatness) = (at.roughness, at.flatness);
        Lobe::Matte(Matte::Burley(Burley { color: at.base * body, sheen, roughness, flatness }))
    }
    /// What facets reflect: `share` of it as glass or with a tint.
    fn reflected(&self, at: &At, facets: Facets, (share, metallic): (f32, f32), bsdf: &mut Bsdf) {
        let as_glass = Reflectance::dielectric(self.eta);
        let (plain, tinted) = (share * (1.0 - at.tint), share * at.tint);
        if plain > 0.0 {
            bsdf.add(Lobe::Glossy(Glossy { reflectance: as_glass, facets, scale: plain }));
        }
        if tinted + metallic > 0.0 {
            let f0 = at.base * metallic + at.hue * (tinted * normal_reflectance(self.eta));
            let reflectance = rising(f0, metallic + tinted);
            bsdf.add(Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 }));
        }
    }
    fn sheet(&self, at: &At, along: Vector3) -> Bsdf<'_> {
        let mut bsdf = Bsdf::default();
        let body = 1.0 - at.clear;
        if body > 0.0 {
            let reflected = body * (1.0 - at.behind);
            bsdf.add(Self::body(at, (reflected, reflected)));
            if at.behind > 0.0 {
                bsdf.add(Lobe::Behind { albedo: at.base * (body * at.behind) });
            }
        }
        if at.clear > 0.0 {
            let outside = facets(at.roughness, at.anisotropic, along);
            self.reflected(at, outside, (at.clear, 0.0), &mut bsdf);
            let roughness = ((0.65 * self.eta - 0.35) * at.roughness).max(0.0);
            let passing = facets(roughness, at.anisotropic, along);
            bsdf.add(Lobe::Sheet(Sheet::through(self.eta, passing, at.base * at.clear)));
        }
        bsdf
    }
    fn solid(&self, at: &At, along: Vector3, is_outside: bool) -> Bsdf<'_> {
        let facets = facets(at.roughness, at.anisotropic, along);
        let dielectric = 1.0 - at.metallic;
        let clear = dielectric * at.clear;
        let mut bsdf = Bsdf::default();
        if is_outside {
            let body = dielectric - clear;
            // The sheen is there where the body is.
            if body > 0.0 {
                bsdf.add(Self::body(at, (body, dielectric)));
            }
            self.reflected(at, facets, (dielectric, at.metallic), &mut bsdf);
            if at.coat > 0.0 {
                let alpha = lerp(at.coat_gloss, 0.1, 0.001);
                bsdf.add(Lobe::Varnish(Varnish { share: at.coat, alpha }));
            }
        }
        if clear > 0.0 {
            // From outside the facets above reflect all that is not let in.
            let reflection = if is_outside { Spectrum::BLACK } else { Spectrum::splat(clear) };
            let transmission = at.base.map(f32::sqrt) * clear;
            let split = Split::Fresnel { reflection, transmission };
            bsdf.add(Lobe::boundary(Interface { eta: self.eta, split }, facets));
        }
        bsdf
    }
}

impl Material for Disney {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let (at, along) = (self.at(cx, surface), tangent(surface));
        if self.thin {
            self.sheet(&at, along)
        } else {
            self.solid(&at, along, surface.is_outside(wo) || !self.is_clear())
        }
    }
    fn medium(&self) -> Option<Medium> {
        (self.is_clear() && !self.thin).then(|| Medium::clear(self.eta))
    }
}
