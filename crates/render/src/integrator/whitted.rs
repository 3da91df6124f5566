//! Recursive ray tracing (Whitted 1980, "An improved illumination model for shaded display"):
//!
//! `L = L_e + ambient term + sum over lights of (f cos * light, if its shadow ray arrives) + sum over sharp directions
//! of weight * L(child)`.
//!
//! Diffuse interreflection is left to the ambient term. Unlike in 1980 the ambient term knows the normal (a sky's
//! unoccluded irradiance), and glossy lobes see the sky's blurred mirror image.
use durer_model::material::GlossRays;
use durer_scene::{Args, Kind, Schema};

use super::{
    Integrator, Start, Transport,
    walk::{Rules, Walk},
};
use crate::{Contribution, SampleCx, probe::Probe};

/// Whitted's integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    rules: Rules,
}

impl Kind for Whitted {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "whitted",
        aliases: &[],
        doc: "Recursive ray tracing: ambient term, shadow rays, mirror reflection and refraction (Whitted 1980).",
        params: &[Rules::MAX_DEPTH, Rules::MIN_CONTRIBUTION, Rules::SHADOWS, Rules::ATTENUATION_DISTANCE],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self { rules: Rules::from_args(args) }))
    }
}

impl Transport for Whitted {
    fn bounded(&self) -> Option<GlossRays> {
        Some(GlossRays::Main)
    }
    fn depth_limit(&self) -> Option<u32> {
        Some(self.rules.max_depth)
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        Walk::new(&self.rules, cx, probe).start(start, parent, out);
    }
}
