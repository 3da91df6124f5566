//! The metallic-roughness material of glTF 2.0 (appendix B) and its extensions.
//!
//! A GGX lobe (alpha = roughness²) whose `f0` runs from `((eta - 1) / (eta + 1))²` (dielectric) to the base colour
//! (metal); below the dielectric's part of it a diffuse body of the base colour. The appendix dims the body by `1 - F` of
//! each pair of directions; here it is by `1 - E` along both, `E` the directional albedo of the dielectric's lobe and of what
//! lies on top (`bsdf/under.rs`): reciprocal, and the whole never reflects more than arrives. Facets below a coat or fibres are
//! dimmed by `1 - E(wo)` alone, which depends on the view; so does the colour of a film.
//!
//! `transmission` replaces that share of the body by a thin coloured sheet that light passes straight, or spread if it is
//! rough (KHR_materials_transmission); with a `thickness` by a real body that refracts (KHR_materials_volume), rough if the surface
//! is. `subsurface` replaces a share by one in which light walks at random below the surface (`below.rs`). Coverage (`alphamode blend`) scales everything and lets the rest pass; where it is 0 there is a hole. `unlit`
//! (KHR_materials_unlit) leaves nothing but the base colour, which the surface then emits.
mod below;
mod film;
mod layers;

use durer_core::{
    math::{Frame, Normal3, Vector3, float::sqr},
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, FloatInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Arriving, GlossRays, Material, Sent, normal_map, sent::facet_gain, share, share_input};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{
        Bounced, Bsdf, Distribution, Glossy, Interface, Lobe, Matte, SMOOTH, Sheet, Under, normal_reflectance,
    },
    medium::Inside,
    texture::TextureAt,
};

use below::Below;
use layers::Layers;

/// What the alpha channel means.
#[derive(Clone, Copy, Debug, PartialEq)]
enum AlphaMode {
    Opaque,
    /// Below the cut-off there is a hole.
    Mask(f32),
    /// It is the share of the surface that is there.
    Blend,
}

/// Whether light is followed below the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depth {
    Flat,
    Open,
}

/// The glTF material; what is seen of it looks the same from both sides.
#[derive(Debug)]
pub struct Principled {
    base: ColorInput,
    alpha: FloatInput,
    mode: AlphaMode,
    metallic: FloatInput,
    roughness: FloatInput,
    eta: f32,
    transmission: FloatInput,
    emission: ColorInput,
    strength: f32,
    normal: Option<ColorInput>,
    normal_scale: f32,
    /// What the texture transform of the normal map does to surface coordinates, inverted: du/du', du/dv', dv/du', dv/dv'.
    normal_frame: [f32; 4],
    unlit: bool,
    one_sided: bool,
    layers: Layers,
    below: Option<Below>,
}

/// Parameters of the core and of the extensions.
const PARAMS: [ParamSpec; CORE.len() + Layers::PARAMS.len() + Below::PARAMS.len()] = {
    let mut all = [CORE[0]; CORE.len() + Layers::PARAMS.len() + Below::PARAMS.len()];
    let mut i = 0;
    while i < all.len() {
        all[i] = match i {
            _ if i < CORE.len() => CORE[i],
            _ if i < CORE.len() + Layers::PARAMS.len() => Layers::PARAMS[i - CORE.len()],
            _ => Below::PARAMS[i - CORE.len() - Layers::PARAMS.len()],
        };
        i += 1;
    }
    all
};

const CORE: [ParamSpec; 15] = [
    ParamSpec::color_texture("basecolor", [1.0; 3], "Colour of the body, or of a metal's reflection.")
        .range(0.0, f32::INFINITY),
    ParamSpec::float_texture("alpha", 1.0, "Coverage; see alphamode.").range(0.0, 1.0),
    ParamSpec::new(
        "alphamode",
        ParamType::Choice(&["opaque", "mask", "blend"]),
        ParamDefault::Text("opaque"),
        "Whether alpha is ignored, cuts holes, or blends with what lies behind.",
    ),
    ParamSpec::float("alphacutoff", 0.5, "With mask: holes are where alpha is below this.").range(0.0, 1e6),
    ParamSpec::float_texture("metallic", 0.0, "0 dielectric, 1 metal.").range(0.0, 1.0),
    ParamSpec::float_texture("roughness", 0.5, "0 mirror, 1 dull; GGX alpha is its square.").range(0.0, 1.0),
    ParamSpec::float("eta", 1.5, "Index of refraction of the dielectric part.").range(0.0, 10.0),
    ParamSpec::float_texture("transmission", 0.0, "Share of the body that is a thin clear sheet.")
        .range(0.0, 1.0),
    ParamSpec::color_texture("emission", [0.0; 3], "Radiance emitted.").range(0.0, f32::INFINITY),
    ParamSpec::float("emissionstrength", 1.0, "Factor on emission.").range(0.0, f32::INFINITY),
    ParamSpec::new(
        "normal",
        ParamType::ColorTexture,
        ParamDefault::Unset,
        "Normal map: a linear colour texture, n = 2 c - 1.",
    ),
    ParamSpec::float("normalscale", 1.0, "Factor on the slope of the normal map."),
    ParamSpec::new(
        "normaluv",
        ParamType::Floats,
        ParamDefault::Unset,
        "m0 m1 m3 m4 of the normal map's uvmatrix, where its tangents are to turn with it.",
    ),
    ParamSpec::new(
        "unlit",
        ParamType::Bool,
        ParamDefault::Bool(false),
        "Emit the base colour and scatter nothing: what is seen is the colour itself.",
    ),
    ParamSpec::new(
        "onesided",
        ParamType::Bool,
        ParamDefault::Bool(false),
        "Not seen from behind (glTF without doubleSided); it casts its shadow all the same.",
    ),
];

impl Kind for Principled {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "principled",
        aliases: &[],
        doc: "The metallic-roughness material of glTF 2.0.",
        params: &PARAMS,
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let mode = match args.text("alphamode") {
            "mask" => AlphaMode::Mask(args.float("alphacutoff")),
            "blend" => AlphaMode::Blend,
            _ => AlphaMode::Opaque,
        };
        let normal = args.is_set("normal").then(|| args.color_input("normal"));
        let layers = Layers::read(args);
        Some(Box::new(Self {
            base: share_input(args, "basecolor"),
            alpha: args.float_input("alpha"),
            mode,
            metallic: args.float_input("metallic"),
            roughness: args.float_input("roughness"),
            eta: args.float("eta"),
            transmission: args.float_input("transmission"),
            emission: args.color_input("emission"),
            strength: args.float("emissionstrength"),
            normal,
            normal_scale: args.float("normalscale"),
            normal_frame: normal_frame(args),
            below: Below::read(args, layers.body.is_some()),
            layers,
            unlit: args.bool("unlit"),
            one_sided: args.bool("onesided"),
        }))
    }
}

/// The inverse of the parameter `normaluv`; complains if there is none.
fn normal_frame(args: &mut Args<'_>) -> [f32; 4] {
    match *args.floats("normaluv") {
        [] => {}
        [a, b, c, d] if a * d - b * c != 0.0 => {
            let determinant = a * d - b * c;
            return [d, -b, -c, a].map(|v| v / determinant);
        }
        // A map that is stretched to a line has no tangents to speak of.
        [_, _, _, _] => {}
        ref other => {
            args.error("normaluv", format!("\"normaluv\" has {} values, expected 4", other.len()));
        }
    }
    [1.0, 0.0, 0.0, 1.0]
}

impl Principled {
    /// The shading normal under the normal map.
    fn tilted(&self, cx: &ShadeCx<'_>, map: &ColorInput, surface: &Surface, wo: Vector3) -> Normal3 {
        let [a, b, c, d] = self.normal_frame;
        let (dpdu, dpdv) = (surface.dpdu, surface.dpdv);
        let turned = Surface { dpdu: dpdu * a + dpdv * c, dpdv: dpdu * b + dpdv * d, ..*surface };
        normal_map::tilted(&turned, cx.color(map, &surface.texture_at()), self.normal_scale, wo)
    }
    /// Looked up as for holes: in a point, as an average would count the holes in it twice.
    fn alpha(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.float(self.alpha, &at.as_point()) * at.vertex_color[3]
    }
    /// Share of the surface that is there.
    fn share_there(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        match self.mode {
            AlphaMode::Blend => self.alpha(cx, at).clamp(0.0, 1.0),
            AlphaMode::Opaque | AlphaMode::Mask(_) => 1.0,
        }
    }
    fn base(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let [r, g, b, _] = at.vertex_color;
        let vertex = cx.basis.reflectance(Color::new(r, g, b));
        (share(cx, &self.base, at) * vertex).map(|v| v.clamp(0.0, 1.0))
    }
}

impl Principled {
    /// The lobes of a surface whose normal is settled; `smooth` is the one without normal map.
    fn lit(
        &self,
        cx: &ShadeCx<'_>,
        (surface, smooth): (&Surface, Normal3),
        wo: Vector3,
        depth: Depth,
    ) -> Bsdf<'_> {
        let at = surface.texture_at();
        let unit = |input: FloatInput| cx.float(input, &at).clamp(0.0, 1.0);
        let (base, coverage) = (self.base(cx, &at), self.share_there(cx, &at));
        let (metallic, transmission) = (unit(self.metallic), unit(self.transmission));
        let facets = self.layers.facets(cx, surface, sqr(unit(self.roughness)));

        let local_wo = Frame::from_z(surface.n_s).to_local(wo);
        let veil = self.layers.veil(cx, (surface, smooth), wo);
        let below_top = veil.left(local_wo);
        let walked = self.below.as_ref().map_or(0.0, |below| below.share(cx, &at));
        if let (Some(below), Depth::Open, false) = (&self.below, depth, surface.is_outside(wo)) {
            return Bsdf::default().with(Lobe::boundary(Interface::clear(below.eta()), facets));
        }
        // What enters a real body does so through an interface of its own, beside the opaque rest.
        let (entering, tint) = match (&self.layers.body, depth) {
            (Some(_), _) => (transmission * (1.0 - metallic), base),
            (None, Depth::Open) => (walked * (1.0 - transmission) * (1.0 - metallic), Spectrum::ONE),
            (None, Depth::Flat) => (0.0, Spectrum::ONE),
        };
        let sheet = if self.layers.body.is_some() { 0.0 } else { transmission };
        let there = coverage * (1.0 - entering);
        let dielectric_f0 = Spectrum::splat(normal_reflectance(self.eta));
        let (of_dielectric, reflectance) =
            self.layers.reflectance((cx, &at), (dielectric_f0, base, metallic), local_wo.z.abs().min(1.0));
        let dielectric = Glossy { reflectance: of_dielectric, facets, scale: there * below_top };
        let body = |color: Spectrum, share: f32| {
            Under::new(color * ((1.0 - metallic) * there * share), &dielectric, veil, local_wo)
        };
        let (shine, shine_color) = self.layers.shine(cx, &at);
        let mut bsdf = Bsdf::default();
        if metallic < 1.0 {
            let color = match &self.below {
                Some(below) if depth == Depth::Flat => {
                    base * (1.0 - walked) + below.color(cx, &at, base) * walked
                }
                _ => base,
            };
            bsdf.add(Lobe::Matte(Matte::Under(body(color, (1.0 - sheet) * (1.0 - shine)))));
        }
        bsdf.add(Lobe::Glossy(Glossy { reflectance, ..dielectric }));
        if shine > 0.0 && sheet < 1.0 {
            let behind = body(shine_color, (1.0 - sheet) * shine).seen_through();
            bsdf.add(Lobe::Matte(Matte::Under(behind)));
        }
        let mut passing = Spectrum::splat(1.0 - coverage);
        if sheet > 0.0 {
            let share = (1.0 - metallic) * sheet;
            match facets.is_smooth() {
                true => passing += body(base, sheet).albedo(),
                false => bsdf.add(Lobe::Sheet(Sheet::below(&dielectric, base)).scaled(share)),
            }
        }
        if !passing.is_black() {
            bsdf.add(Lobe::PassThrough { weight: passing });
        }
        if entering > 0.0 {
            let eta = self.layers.body.as_ref().map_or(self.eta, |body| body.eta(&cx.basis));
            let interface = Layers::boundary(eta, tint, entering * coverage * below_top);
            bsdf.add(Lobe::boundary(interface, facets));
        }
        if self.layers.compensates
            && let Some(lost) = Bounced::of(&reflectance, &facets)
        {
            bsdf.add(Lobe::Matte(Matte::Bounced(lost)).scaled(there * below_top));
        }
        self.layers.on_top((cx, &at), &veil, (local_wo, coverage), &mut bsdf);
        bsdf
    }
}

impl Principled {
    /// The lobes for those who follow light as deep.
    fn lobes(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3, depth: Depth) -> Bsdf<'_> {
        let (at, smooth) = (surface.texture_at(), surface.n_s);
        if let Some(map) = &self.normal {
            surface.n_s = self.tilted(cx, map, surface, wo);
        }
        if self.unlit {
            let passing = Spectrum::splat(1.0 - self.share_there(cx, &at));
            return Bsdf::default().with(Lobe::PassThrough { weight: passing });
        }
        self.lit(cx, (surface, smooth), wo, depth)
    }
}

impl Material for Principled {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.lobes(cx, surface, wo, Depth::Flat)
    }
    fn open_bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.lobes(cx, surface, wo, Depth::Open)
    }
    fn is_walked(&self) -> bool {
        self.below.is_some() && !self.unlit
    }
    fn inside(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Option<Inside> {
        self.below.as_ref().map(|below| below.inside(cx, at, self.base(cx, at)))
    }
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let coverage = self.share_there(cx, at);
        if self.unlit {
            let [r, g, b, _] = at.vertex_color;
            return cx.basis.emission(cx.color(&self.base, at) * Color::new(r, g, b)) * coverage;
        }
        cx.basis.emission(cx.color(&self.emission, at)) * (self.strength * coverage)
    }
    /// Colours of vertices are taken to be at most 1. What passes, or is mirrored, is followed; at grazing angles that is
    /// everything.
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        if !self.layers.are_plain() {
            return Sent::UNBOUNDED;
        }
        let alpha = match self.roughness {
            FloatInput::Constant(roughness) => Some(sqr(roughness.clamp(0.0, 1.0))),
            FloatInput::Texture(_) => None,
        };
        let passes = self.mode == AlphaMode::Blend || self.transmission != FloatInput::Constant(0.0);
        if self.unlit {
            let followed = if passes { 1.0 } else { 0.0 };
            return Sent { own: 0.0, scattered: cx.largest_color(&self.base), followed };
        }
        let is_dull =
            arriving.gloss == GlossRays::Main && alpha.is_some_and(|alpha| alpha >= Glossy::BLURRED);
        let gain = match alpha {
            Some(alpha) if alpha < SMOOTH => 0.0,
            alpha => alpha.map_or(f32::INFINITY, |alpha| facet_gain(alpha, Distribution::Ggx)),
        };
        Sent {
            own: cx.largest_color(&self.emission) * self.strength + arriving.highlight(gain),
            scattered: arriving.all(),
            followed: if is_dull && !passes { 0.0 } else { 1.0 },
        }
    }
    fn has_holes(&self) -> bool {
        self.mode != AlphaMode::Opaque
    }
    fn coverage(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        if self.is_hole(cx, at) { 0.0 } else { self.share_there(cx, at) }
    }
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        match self.mode {
            AlphaMode::Opaque => false,
            AlphaMode::Mask(cutoff) => self.alpha(cx, at) < cutoff,
            AlphaMode::Blend => self.alpha(cx, at) <= 0.0,
        }
    }
    fn is_passed(&self) -> bool {
        let is_sheet = self.layers.body.is_none() && self.transmission != FloatInput::Constant(0.0);
        self.mode == AlphaMode::Blend || is_sheet
    }
    fn is_one_sided(&self) -> bool {
        // Walks meet it from behind.
        self.one_sided && !self.is_walked()
    }
    fn medium(&self) -> Option<Medium> {
        let clear = self.layers.body.clone().filter(|_| self.transmission != FloatInput::Constant(0.0));
        clear.or_else(|| self.below.as_ref().filter(|_| self.is_walked()).map(Below::medium))
    }
}
