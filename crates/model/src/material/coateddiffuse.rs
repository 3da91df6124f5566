//! A matte body under a clear coat: varnished wood, plastic, glazed pottery.
//!
//! pbrt-v4's model of two layers, by the closed form that it has over Lambert's body: see `bsdf/coat.rs`; by a random walk where
//! light scatters in the coat (`bsdf/layered.rs`).
use durer_core::{
    math::Vector3,
    spectrum::{Basis, Color, Curve},
};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Material, REFLECTION, conductor::reflecting, detail::Detail, read_factor, roughness::Roughness, share,
    share_input,
};
use crate::{
    ShadeCx, Surface,
    bsdf::{Again, Below, Bsdf, Cloud, Coat, Facets, Layered, Lobe, Matte, Reflectance},
};

/// The coat's parameters that both coated materials have.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    /// At 587.6 nm.
    pub(super) eta_d: f32,
    /// How the index changes with wavelength, if it does: as directions below the coat depend on it, only the leading one goes
    /// on, as in pbrt-v4.
    dispersion: Option<Curve>,
    pub(super) thickness: f32,
    /// How often a walk meets what is below the coat.
    pub(super) bounces: u32,
    walks: u32,
    /// Albedo and asymmetry of what scatters in the coat, if anything does.
    pub(super) cloud: Option<(Color, f32)>,
}

impl Layers {
    pub(super) const fn eta(name: &'static str) -> ParamSpec {
        let doc = "Index of refraction of the coat, relative to the outside; one that changes with wavelength counts for each \
                   where rays carry wavelengths.";
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
        "Share of light that what is in the coat scatters; at 0 it only absorbs.",
    )
    .range(0.0, f32::INFINITY);
    pub(super) const G: ParamSpec =
        ParamSpec::float("g", 0.0, "Mean cosine of the deflection where light is scattered in the coat.")
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
        let albedo = args.color("albedo");
        let (eta_d, dispersion) = args.refraction(eta);
        Self {
            eta_d,
            dispersion,
            thickness: args.float("thickness"),
            bounces: (args.int("maxdepth") as u32).div_ceil(2),
            walks: args.int("nsamples") as u32,
            cloud: (albedo != Color::BLACK).then(|| (albedo, args.float("g"))),
        }
    }

    /// The index that a sample's light meets.
    pub(super) fn index(&self, basis: &Basis) -> f32 {
        self.dispersion.as_ref().map_or(self.eta_d, |curve| basis.leading(curve, self.eta_d))
    }
    /// The lobes, of the leading wavelength if the index depends on it.
    pub(super) fn led(&self, cx: &ShadeCx<'_>, bsdf: Bsdf<'static>) -> Bsdf<'static> {
        if self.dispersion.is_some() && cx.basis != Basis::Rgb { bsdf.led() } else { bsdf }
    }

    /// The walk below a coat of these facets.
    pub(super) fn walked(&self, cx: &ShadeCx<'_>, coat: Facets, below: Below) -> Layered {
        let cloud = self.cloud.map_or(Cloud::NONE, |(albedo, g)| Cloud::new(cx.basis.reflectance(albedo), g));
        Layered {
            eta: self.index(&cx.basis),
            coat,
            thickness: self.thickness,
            cloud,
            below,
            bounces: self.bounces as u16,
            walks: self.walks as u16,
            scale: 1.0,
        }
    }
}

const NONLINEAR: ParamSpec = ParamSpec::new(
    "nonlinear",
    ParamType::Bool,
    ParamDefault::Bool(true),
    "Light that the coat sends back to the body takes its colour each time, as in nature; if not the body counts as white \
     there, and keeps the colour that it was given. Without effect where light scatters in the coat.",
);

/// A body under a coat.
#[derive(Debug)]
pub struct CoatedDiffuse {
    reflectance: ColorInput,
    roughness: Roughness,
    layers: Layers,
    coat: Coat,
    /// Whether light that the coat sends back to the body takes its colour once more.
    again: Again,
    /// On what the coat reflects.
    factor: Option<ColorInput>,
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
            Roughness::DISTRIBUTION,
            Roughness::SHADOWING,
            Layers::THICKNESS,
            Layers::ALBEDO,
            Layers::G,
            Layers::MAX_DEPTH,
            Layers::SAMPLES,
            NONLINEAR,
            REFLECTION,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (layers, roughness) = (Layers::read(args, "eta"), Roughness::read(args));
        Some(Box::new(Self {
            reflectance: share_input(args, "reflectance"),
            coat: Coat::new(
                (layers.eta_d, layers.dispersion.as_ref()),
                layers.thickness,
                (roughness.constant(), roughness.like()),
            ),
            roughness,
            layers,
            again: if args.bool(NONLINEAR.name) { Again::Colored } else { Again::White },
            factor: read_factor(args, &REFLECTION),
            detail: Detail::read(args),
        }))
    }
}

impl Material for CoatedDiffuse {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let albedo = share(cx, &self.reflectance, &surface.texture_at());
        let facets = self.roughness.facets(cx, surface);
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        let eta = self.layers.index(&cx.basis);
        let body = match self.layers.cloud {
            Some(_) => Lobe::Layered(self.layers.walked(cx, facets, Below::Matte { albedo })),
            None => Lobe::Matte(Matte::Coated(self.coat.body(
                (albedo, self.again),
                (eta, &facets),
                self.layers.bounces,
                cos,
            ))),
        };
        let outside = match &self.factor {
            None => Reflectance::dielectric(eta),
            Some(factor) => Reflectance::Tinted { eta, tint: share(cx, factor, &surface.texture_at()) },
        };
        let outside = reflecting(outside, facets, cos);
        self.layers.led(cx, Bsdf::default().with(body).with(outside))
    }
}
