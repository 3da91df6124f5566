//! A mirror of constant reflectance, perfect (`R = V - 2 (V . N) N`) or rough.
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, Kind, ParamSpec, Schema};

use super::{Arriving, Material, Sent, largest_share, roughness::Roughness, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Glossy, Lobe, Reflectance, SMOOTH},
};

/// A mirror, the same from both sides and under all angles.
#[derive(Debug)]
pub struct Mirror {
    reflectance: ColorInput,
    roughness: Roughness,
}

impl Kind for Mirror {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "mirror",
        aliases: &[],
        doc: "Mirror, perfect or rough: reflects the same share of light under all angles.",
        params: &[
            ParamSpec::color_texture("reflectance", [0.9; 3], "Share of light reflected.")
                .range(0.0, f32::INFINITY),
            Roughness::BOTH,
            Roughness::U,
            Roughness::V,
            Roughness::REMAP,
            Roughness::DISTRIBUTION,
            Roughness::SHADOWING,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            reflectance: share_input(args, "reflectance"),
            roughness: Roughness::read(args),
        }))
    }
}

impl Material for Mirror {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, _wo: Vector3) -> Bsdf<'_> {
        let at = surface.texture_at();
        let weight = share(cx, &self.reflectance, &at);
        let facets = self.roughness.facets(cx, surface);
        let reflectance = Reflectance::Schlick { f0: weight, f90: weight };
        Bsdf::default().with(match facets.is_smooth() {
            true => Lobe::Mirror { weight },
            false => Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 }),
        })
    }
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        let followed = largest_share(cx, &self.reflectance);
        match self.roughness.constant() {
            Some(alpha) if alpha < SMOOTH => Sent { followed, ..Sent::default() },
            _ => Sent {
                own: arriving.highlight(followed * self.roughness.gain()),
                scattered: arriving.sky + arriving.lamps,
                followed,
            },
        }
    }
}
