//! Metal under a clear coat: lacquered brass, car paint without its flakes. pbrt-v4's model of two layers.
use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, Kind, Schema};

use super::{
    Material,
    coateddiffuse::Layers,
    conductor::{self, Metal, reflecting},
    detail::Detail,
    roughness::{self, Roughness},
};
use crate::{
    ShadeCx, Surface,
    bsdf::{Below, Bsdf, Lobe, Reflectance, mirrored_by_layers},
};

/// A metal under a coat.
#[derive(Debug)]
pub struct CoatedConductor {
    metal: Metal,
    metal_roughness: Roughness,
    coat_roughness: Roughness,
    layers: Layers,
    detail: Detail,
}

const METAL: conductor::Words = conductor::Words { eta: "conductor.eta", k: "conductor.k" };
const METAL_ROUGHNESS: roughness::Words =
    roughness::Words { both: "conductor.roughness", u: "conductor.uroughness", v: "conductor.vroughness" };
const COAT_ROUGHNESS: roughness::Words =
    roughness::Words { both: "interface.roughness", u: "interface.uroughness", v: "interface.vroughness" };

impl Kind for CoatedConductor {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "coatedconductor",
        aliases: &[],
        doc: "Metal under a clear coat, each smooth or rough; the same from both sides.",
        params: &[
            METAL.eta(),
            METAL.k(),
            Metal::REFLECTANCE,
            METAL_ROUGHNESS.both(),
            METAL_ROUGHNESS.u(),
            METAL_ROUGHNESS.v(),
            Layers::eta("interface.eta"),
            COAT_ROUGHNESS.both(),
            COAT_ROUGHNESS.u(),
            COAT_ROUGHNESS.v(),
            Roughness::REMAP,
            Roughness::DISTRIBUTION,
            Roughness::SHADOWING,
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
        let layers = Layers::read(args, "interface.eta");
        Some(Box::new(Self {
            metal: Metal::read(args, METAL, layers.eta_d),
            metal_roughness: Roughness::read_as(args, METAL_ROUGHNESS),
            coat_roughness: Roughness::read_as(args, COAT_ROUGHNESS),
            layers,
            detail: Detail::read(args),
        }))
    }
}

impl Material for CoatedConductor {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let metal = self.metal.at(cx, &surface.texture_at());
        let (coat, below) =
            (self.coat_roughness.facets(cx, surface), self.metal_roughness.facets(cx, surface));
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        let Layers { eta_d, thickness, bounces, .. } = self.layers;
        let eta = self.layers.index(&cx.basis);
        let is_sharp = coat.is_smooth() && below.is_smooth();
        // Read as relative to the coat at 587.6 nm.
        let (metal_eta, k) = match metal {
            Reflectance::Index { eta: metal, k } => (metal * (eta_d / eta), k * (eta_d / eta)),
            Reflectance::Schlick { .. } | Reflectance::Tinted { .. } | Reflectance::Passed { .. } => {
                (Spectrum::ONE, Spectrum::BLACK)
            }
        };
        let layered = self.layers.walked(cx, coat, Below::Metal { eta: metal_eta, k, facets: below });
        if is_sharp {
            let metal = Reflectance::Index { eta: metal_eta, k };
            let weight = mirrored_by_layers(cos, eta, thickness, metal, bounces);
            let mirror = Bsdf::default().with(Lobe::Mirror { weight });
            let is_clear = self.layers.cloud.is_none();
            return self.layers.led(cx, if is_clear { mirror } else { mirror.with(Lobe::Layered(layered)) });
        }
        let outside = reflecting(Reflectance::dielectric(eta), coat, cos);
        self.layers.led(cx, Bsdf::default().with(Lobe::Layered(layered)).with(outside))
    }
}
