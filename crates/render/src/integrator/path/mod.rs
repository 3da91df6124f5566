//! Path tracing: one direction per hit instead of all, at random, so that every way that light can take is found.
//!
//! `L = L_e + light of one lamp, chosen and sampled + weight * L(next ray)` (Kajiya 1986, "The Rendering Equation"). What
//! both a sampled light and a sampled direction can find counts in proportion to their densities (balance heuristic, Veach
//! and Guibas 1995). Paths that carry little end by chance and the others stand for them (Arvo and Kirk 1990).
mod below;
mod direct;
mod follow;
mod gather;
mod particle;
mod report;
mod sppm;

use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Integrator, LIGHT_SAMPLER, PATH_DEPTH, ROULETTE_DEPTH, Start, Transport, walk::Rules};
use crate::{Contribution, LightSampler, PathRay, SampleCx, probe::Probe};
use follow::Follow;

pub use sppm::Sppm;

/// What a path integrator asks of the recursion.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Course {
    rules: Rules,
    /// How lights are chosen.
    light_sampler: LightSampler,
    /// Sharp lobes seen after a blurred bounce are blurred as well.
    regularize: bool,
    /// Bounces after which chance may end a path.
    roulette_depth: u32,
    /// What spread directions meet is asked for its own light only.
    direct_only: bool,
    /// What floats in the air and in bodies counts.
    heeds_media: bool,
    /// Lamps and the sky are not seen but by what they light.
    hides_emitters: bool,
}

impl Course {
    const OF_PATHS: &[ParamSpec] = &[
        PATH_DEPTH,
        LIGHT_SAMPLER,
        ParamSpec::new(
            "regularize",
            ParamType::Bool,
            ParamDefault::Bool(false),
            "Blurs nearly sharp reflections of what is seen after a blurred bounce: less noise, a little wrong.",
        ),
        ROULETTE_DEPTH,
        Self::HIDE_EMITTERS,
    ];
    const HIDE_EMITTERS: ParamSpec = ParamSpec::new(
        "hideemitters",
        ParamType::Bool,
        ParamDefault::Bool(false),
        "Lamps and the sky are not seen directly: eye rays go through lamps as if they were not there, and the sky is black \
         to them. They light everything, and are seen in mirrors and through glass.",
    );

    /// With the parameters of path tracers.
    fn of_paths(args: &mut Args<'_>) -> Option<Self> {
        let (regularize, roulette_depth) = (args.bool("regularize"), args.int("roulettedepth") as u32);
        let hides_emitters = args.bool(Self::HIDE_EMITTERS.name);
        Some(Self { regularize, roulette_depth, hides_emitters, ..Self::from_args(args)? })
    }
    /// Whether lamps and the sky are nothing to a ray: those that the eye would see directly.
    fn hides(&self, ray: &PathRay) -> bool {
        self.hides_emitters && ray.depth == 0
    }
    fn from_args(args: &mut Args<'_>) -> Option<Self> {
        let rules = Rules { max_depth: args.int("maxdepth") as u32, ..Rules::PATH };
        let light_sampler = LightSampler::from_word(args.text("lightsampler"))?;
        Some(Self {
            rules,
            light_sampler,
            regularize: false,
            roulette_depth: u32::MAX,
            direct_only: false,
            heeds_media: false,
            hides_emitters: false,
        })
    }
}

/// The path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    course: Course,
}

impl Kind for Path {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "path",
        aliases: &[],
        doc: "Path tracing with multiple importance sampling and Russian roulette: all light that surfaces scatter.",
        params: Course::OF_PATHS,
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self { course: Course::of_paths(args)? }))
    }
}

/// The path tracer that heeds media; where there are none it does what [`Path`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolPath;

impl Kind for VolPath {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "volpath",
        aliases: &[],
        doc: "Path tracing through fog, smoke and milk as well: all light that surfaces and media scatter or send out.",
        params: Course::OF_PATHS,
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Path { course: Course { heeds_media: true, ..Course::of_paths(args)? } }))
    }
}

/// Direct light only, seen in mirrors and through glass as well: a path tracer that stops early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direct;

impl Kind for Direct {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "direct",
        aliases: &["directlighting"],
        doc: "Direct light with multiple importance sampling; mirrors and glass are followed, nothing else is.",
        params: &[PATH_DEPTH, LIGHT_SAMPLER, Course::HIDE_EMITTERS],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let hides_emitters = args.bool(Course::HIDE_EMITTERS.name);
        let course = Course { direct_only: true, hides_emitters, ..Course::from_args(args)? };
        Some(Box::new(Path { course }))
    }
}

impl Transport for Path {
    fn depth_limit(&self) -> Option<u32> {
        Some(self.course.rules.max_depth)
    }
    fn walks(&self) -> bool {
        !self.course.direct_only
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let follow = Follow::new(&self.course, cx, probe);
        match start {
            Start::Eye(ray) => follow.sample(ray, parent, out),
            Start::Again(node) => follow.again(node, parent, out),
        }
    }
}
