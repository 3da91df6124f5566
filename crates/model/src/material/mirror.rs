//! A perfect mirror of constant reflectance: `R = V - 2 (V . N) N`.
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, Kind, ParamSpec, Schema};

use super::{Material, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe},
};

/// A mirror, the same from both sides and under all angles.
#[derive(Debug)]
pub struct Mirror {
    reflectance: ColorInput,
}

impl Kind for Mirror {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "mirror",
        aliases: &[],
        doc: "Perfect mirror: reflects the same share of light under all angles.",
        params: &[ParamSpec::color_texture("reflectance", [0.9; 3], "Share of light reflected.")
            .range(0.0, f32::INFINITY)],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self { reflectance: share_input(args, "reflectance") }))
    }
}

impl Material for Mirror {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, _wo: Vector3) -> Bsdf {
        let weight = share(cx, self.reflectance, &surface.texture_at());
        Bsdf::default().with(Lobe::Mirror { weight })
    }
}
