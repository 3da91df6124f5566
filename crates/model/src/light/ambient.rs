//! The constant `I_a` of the classic formula: light from nowhere that only the ambient term sees.
use durer_core::{
    math::Normal3,
    spectrum::{Basis, LightColor, Spectrum},
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Light, LightBound, Track, largest};

/// An ambient light.
#[derive(Debug)]
pub struct Ambient {
    radiance: LightColor,
}

impl Kind for Ambient {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "ambient",
        aliases: &[],
        doc: "The classic ambient term: lights diffuse surfaces from all sides, is never seen or mirrored.",
        params: &[
            ParamSpec::color(
                "L",
                [0.1; 3],
                "Radiance; a surface reflects its ambient coefficient times this.",
            )
            .unit("W/(m² sr)")
            .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self { radiance: args.light_color("L") * args.float("scale") }))
    }
}

impl Light for Ambient {
    fn place(&mut self, _track: &Track) {}
    fn power(&self, _radius: f32) -> f32 {
        0.0
    }
    fn surrounds(&self) -> bool {
        true
    }
    fn is_sampled(&self) -> bool {
        false
    }
    fn bound(&self) -> LightBound {
        LightBound { ambient: largest(self.radiance.color), ..LightBound::default() }
    }
    fn ambient(&self, basis: Basis, _n: Normal3) -> Spectrum {
        basis.light(&self.radiance)
    }
}
