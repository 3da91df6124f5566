//! Stochastic progressive photon mapping (Hachisuka and Jensen 2009): direct light as paths find it, all other light
//! gathered from photons in a disc that shrinks from pass to pass.
//!
//! Paths go on from what is sharp or nearly so (`alpha` below [`durer_model::bsdf::Glossy::BLURRED`]) and end where
//! something matte or rough is met: there a light is asked, one scattered ray may meet one, and photons stand for the rest.
//! In the form of Knaus and Zwicker a pass knows nothing of those before it: see [`super::super::photons`].
use std::sync::Arc;

use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    super::{
        Gathering, Integrator, LIGHT_SAMPLER, PATH_DEPTH, Particles, ROULETTE_DEPTH, Start, Transport,
        photons::{MOST_BYTES, Photons},
    },
    Course,
    follow::Follow,
};
use crate::{Contribution, SampleCx, probe::Probe};

/// The photon mapper.
#[derive(Clone, Debug)]
pub struct Sppm {
    course: Course,
    gathering: Gathering,
    /// Those of the pass; without them it finds direct light.
    photons: Option<Arc<Photons>>,
}

impl Kind for Sppm {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "sppm",
        aliases: &[],
        doc: "Stochastic progressive photon mapping: finds caustics that are seen in mirrors and through glass. A little \
              blurred at first, sharper with every sample of the pixels, each of which is a pass with photons of its own.",
        params: &[
            PATH_DEPTH,
            LIGHT_SAMPLER,
            ROULETTE_DEPTH,
            ParamSpec::new(
                "photonsperiteration",
                ParamType::Int,
                ParamDefault::Int(-1),
                "Particles that each pass sends; -1 for as many as the picture has pixels.",
            )
            .range(-1.0, 1e9),
            ParamSpec::new(
                "radius",
                ParamType::Float,
                ParamDefault::Unset,
                "Radius of the discs in which the first pass gathers photons; if left out that of 3 pixels, as most of the \
                 scene is seen. 1 in pbrt-v4.",
            )
            .unit("m")
            .range(1e-9, 1e9),
            ParamSpec::new("seed", ParamType::Int, ParamDefault::Int(0), "Changes the numbers of the photons."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let course = Course::from_args(args)?;
        let roulette_depth = args.int("roulettedepth") as u32;
        let asked = args.int("photonsperiteration");
        if asked == 0 {
            let message =
                "\"photonsperiteration\" is 0, expected 1 or more, or -1 for as many as there are pixels";
            args.error("photonsperiteration", message);
            return None;
        }
        let gathering = Gathering {
            particles: u32::try_from(asked).ok(),
            radius: args.optional_float("radius"),
            max_depth: course.rules.max_depth,
            roulette_depth,
            seed: args.int("seed") as u32,
        };
        let bytes = gathering.bytes(gathering.particles.unwrap_or(1));
        if bytes > MOST_BYTES {
            let message = format!(
                "{asked} photons of up to {} bounces may take {} GiB for each pass, and {} are allowed",
                course.rules.max_depth,
                bytes >> 30,
                MOST_BYTES >> 30
            );
            args.error("photonsperiteration", message);
            return None;
        }
        let course = Course { roulette_depth, ..course };
        Some(Box::new(Self { course, gathering, photons: None }))
    }
}

impl Transport for Sppm {
    fn depth_limit(&self) -> Option<u32> {
        Some(self.course.rules.max_depth)
    }
    fn particles(&self) -> Particles {
        Particles::Gathered
    }
    fn gathering(&self) -> Option<Gathering> {
        Some(self.gathering)
    }
    fn with(&self, photons: &Arc<Photons>) -> Option<Box<dyn Integrator>> {
        Some(Box::new(Self { photons: Some(Arc::clone(photons)), ..self.clone() }))
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        // Photons do not walk below surfaces: both see matte bodies there.
        let of_path = Follow::new(&self.course, cx, probe);
        let follow = Follow { photons: self.photons.as_deref(), walks: false, ..of_path };
        match start {
            Start::Eye(ray) => follow.sample(ray, parent, out),
            Start::Again(node) => follow.again(node, parent, out),
        }
    }
}
