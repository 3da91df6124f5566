//! Recursive ray tracing (Whitted 1980, "An improved illumination model for shaded display"):
//!
//! `L = L_e + ambient term + sum over lights of (f cos * light, if its shadow ray arrives) + sum over sharp directions
//! of weight * L(child)`.
//!
//! Diffuse interreflection is left to the ambient term. Unlike in 1980 the ambient term knows the normal (a sky's
//! unoccluded irradiance), and glossy lobes see the sky's blurred mirror image.
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Integrator, Transport,
    walk::{Rules, Walk},
};
use crate::{Contribution, PathRay, SampleCx, probe::Probe};

/// Whitted's integrator with its two stop rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Bounces traced at most.
    pub max_depth: u32,
    /// A branch whose share in the pixel is at or below this is not traced.
    pub min_contribution: f32,
}

impl Kind for Whitted {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "whitted",
        aliases: &[],
        doc: "Recursive ray tracing: ambient term, shadow rays, mirror reflection and refraction (Whitted 1980).",
        params: &[
            ParamSpec::new("maxdepth", ParamType::Int, ParamDefault::Int(10), "Bounces traced at most.")
                .unit("bounces")
                .range(0.0, 1000.0),
            ParamSpec::float(
                "mincontribution",
                1.0 / 512.0,
                "A branch whose share in the pixel is at or below this is not traced.",
            )
            .range(0.0, 1.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let max_depth = args.int("maxdepth") as u32;
        Some(Box::new(Self { max_depth, min_contribution: args.float("mincontribution") }))
    }
}

impl Transport for Whitted {
    fn sample<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: PathRay,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let rules = Rules { max_depth: self.max_depth, min_contribution: self.min_contribution };
        Walk::new(&rules, cx, probe).sample(&ray, parent, out);
    }
}
