//! A matte body under a clear coat: varnished wood, plastic, glazed pottery.
//!
//! pbrt-v4's model of two layers, by the closed form that it has over Lambert's body: see `bsdf/coat.rs`.
use durer_core::{math::Vector3, spectrum::Color};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, conductor::reflecting, detail::Detail, roughness::Roughness, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Coat, Lobe, Matte, Reflectance},
};

/// The coat's parameters that both coated materials have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layers {
    pub(super) eta: f32,
    pub(super) thickness: f32,
    /// How often a walk meets what is below the coat.
    pub(super) bounces: u32,
    pub(super) walks: u32,
}

impl Layers {
    pub(super) const fn eta(name: &'static str) -> ParamSpec {
        let doc = "Index of refraction of the coat, relative to the outside.";
        ParamSpec::new(name, ParamType::Index, ParamDefault::Float(1.5), doc).range(1.0, 10.0)
    }
    pub(super) const THICKNESS: ParamSpec = ParamSpec::float(
        "thickness",
        0.01,
        "Of the coat, in mean free paths: along the cosine c the share exp(-thickness / c) is left on each way.",
    )
    .range(0.0, 1e6);
    pub(super) const ALBEDO: ParamSpec = ParamSpec::color(
        "albedo",
        [0.0; 3],
        "Of what is in the coat; other values than 0 are not supported yet: it absorbs only.",
    )
    .range(0.0, f32::INFINITY);
    pub(super) const G: ParamSpec =
        ParamSpec::float("g", 0.0, "Asymmetry of what is in the coat; without effect while albedo is 0.")
            .range(-1.0, 1.0);
    pub(super) const MAX_DEPTH: ParamSpec = ParamSpec::new(
        "maxdepth",
        ParamType::Int,
        ParamDefault::Int(10),
        "Surfaces at most that light meets between its ways in and out.",
    )
    .range(1.0, 1000.0);
    pub(super) const SAMPLES: ParamSpec = ParamSpec::new(
        "nsamples",
        ParamType::Int,
        ParamDefault::Int(1),
        "Random walks for a value; without effect where there is a closed form.",
    )
    .range(1.0, 1000.0);

    pub(super) fn read(args: &mut Args<'_>, eta: &str) -> Self {
        if args.color("albedo") != Color::BLACK {
            args.warning("albedo", "light that scatters within a coat is not supported yet; it only absorbs");
        }
        Self {
            eta: args.index(eta),
            thickness: args.float("thickness"),
            bounces: (args.int("maxdepth") as u32).div_ceil(2),
            walks: args.int("nsamples") as u32,
        }
    }
}

/// A body under a coat.
#[derive(Debug)]
pub struct CoatedDiffuse {
    reflectance: ColorInput,
    roughness: Roughness,
    layers: Layers,
    coat: Coat,
    detail: Detail,
}

impl Kind for CoatedDiffuse {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "coateddiffuse",
        aliases: &["plastic"],
        doc: "A matte body under a clear coat, smooth or rough; the same from both sides.",
        params: &[
            ParamSpec::color_texture("reflectance", [0.5; 3], "Share of light that the body reflects.")
                .range(0.0, f32::INFINITY),
            Layers::eta("eta"),
            Roughness::BOTH,
            Roughness::U,
            Roughness::V,
            Roughness::REMAP,
            Layers::THICKNESS,
            Layers::ALBEDO,
            Layers::G,
            Layers::MAX_DEPTH,
            Layers::SAMPLES,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (layers, roughness) = (Layers::read(args, "eta"), Roughness::read(args));
        Some(Box::new(Self {
            reflectance: share_input(args, "reflectance"),
            coat: Coat::new(layers.eta, layers.thickness, roughness.constant()),
            roughness,
            layers,
            detail: Detail::read(args),
        }))
    }
}

impl Material for CoatedDiffuse {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf {
        self.detail.tilt(cx, surface, wo);
        let albedo = share(cx, self.reflectance, &surface.texture_at());
        let facets = self.roughness.facets(cx, surface);
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        Bsdf::default()
            .with(Lobe::Matte(Matte::Coated(self.coat.body(albedo, &facets, self.layers.bounces, cos))))
            .with(reflecting(Reflectance::dielectric(self.layers.eta), facets, cos))
    }
}
