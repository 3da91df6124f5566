//! Light transport: from a ray to radiance.
//!
//! An author writes one generic [`Transport::trace`]; what the driver holds is the object-safe [`Integrator`], which
//! comes from a blanket impl. A new integrator is one file here and one line in [`INTEGRATORS`].

mod ambient_occlusion;
mod bdpt;
mod below;
mod cast;
mod distributed;
mod first;
mod function;
mod light_tracing;
mod path;
mod photons;
mod shading;
mod survey;
mod vertices;
mod walk;
mod whitted;

use std::sync::Arc;

use durer_model::material::GlossRays;
use durer_scene::{Entry, ParamDefault, ParamSpec, ParamType};

use crate::{
    Contribution, LightSampler, PathRay, SampleCx,
    probe::{Counters, NoProbe, Probe, Recorder, TreeNode},
};

pub use ambient_occlusion::AmbientOcclusion;
pub use bdpt::Bidirectional;
pub use cast::{Cast, Show};
pub use distributed::{Distributed, Sampling};
pub use first::{Met, first_met};
pub use function::Function;
pub use light_tracing::LightTracing;
pub use path::{Direct, Path, Sppm, VolPath};
pub use photons::{Gathering, Photon, Photons, Sent, send};
pub use survey::{Survey, Surveyed};
pub use walk::{Lights, Shadows};
pub use whitted::Whitted;

/// What the film holds once it is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Light; antialiased by averaging.
    Radiance,
    /// Numbers for the eye: see [`Show`].
    Data(Show),
    /// What samples of light are like: see [`Survey`].
    Survey(Survey),
}

/// The eye rays of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EyeSamples {
    /// How many.
    pub total: u32,
    /// Moments for each point of the pixel; 0: the middle of the shutter time always.
    pub time: u32,
    /// Points of the lens for each moment; 0: its centre always.
    pub lens: u32,
}

/// What particles from the lights are to an integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Particles {
    /// It sends none.
    #[default]
    None,
    /// One way to find light among others.
    Some,
    /// They leave photons behind that samples gather.
    Gathered,
    /// All light comes by them.
    All,
}

/// What is known of an integrator before it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// What the samples mean.
    pub output: Output,
    /// [`Transport::depth_limit`].
    pub depth_limit: Option<u32>,
    /// [`Transport::bounded`].
    pub bounded: Option<GlossRays>,
    /// [`Transport::particles`].
    pub particles: Particles,
    /// [`Transport::walks`].
    pub walks: bool,
    /// [`Transport::looks`].
    pub looks: bool,
    /// [`Transport::gathering`].
    pub gathering: Option<Gathering>,
}

/// What is traced.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "made once for each sample, and never kept")]
pub enum Start<'a> {
    /// An eye ray.
    Eye(&'a PathRay),
    /// A recorded ray, once more.
    Again(&'a TreeNode),
}

/// Light transport as its author writes it, once for all probes.
pub trait Transport: Send + Sync {
    /// What the samples mean.
    fn output(&self) -> Output {
        Output::Radiance
    }
    /// The eye rays of a pixel if `asked` samples are wished for.
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        EyeSamples { total: asked, time: 1, lens: 1 }
    }
    /// Bounces traced at most, if it follows rays at all.
    fn depth_limit(&self) -> Option<u32> {
        None
    }
    /// How it sees gloss, if what it follows is bounded by [`crate::Scene::brightest`].
    fn bounded(&self) -> Option<GlossRays> {
        None
    }
    /// What particles are to it.
    fn particles(&self) -> Particles {
        Particles::None
    }
    /// Whether it looks at the scene at all.
    fn looks(&self) -> bool {
        true
    }
    /// Whether it follows light below surfaces. If not it sees matte bodies there.
    fn walks(&self) -> bool {
        false
    }
    /// What photons the samples of each index share, if they do.
    fn gathering(&self) -> Option<Gathering> {
        None
    }
    /// The same with the photons that its samples share.
    fn with(&self, photons: &Arc<Photons>) -> Option<Box<dyn Integrator>> {
        let _ = photons;
        None
    }
    /// Traces a ray and all it spawns; leaves what arrives in `out`.
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    );
}

/// Light transport as the driver holds it; nobody implements it by hand, but for [`Surveyed`].
pub trait Integrator: Send + Sync {
    /// What is known of it before it runs.
    fn facts(&self) -> Facts;
    /// [`Transport::eye_samples`].
    fn eye_samples(&self, asked: u32) -> EyeSamples;
    /// [`Transport::with`].
    fn with(&self, photons: &Arc<Photons>) -> Option<Box<dyn Integrator>> {
        let _ = photons;
        None
    }
    /// [`Transport::trace`] of an eye ray, unwatched.
    fn sample(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution);
    /// [`Transport::trace`] of an eye ray, recorded.
    fn record(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>);
    /// [`Transport::trace`] of a recorded ray, recorded.
    fn replay(&self, cx: &SampleCx<'_>, node: &TreeNode, out: &mut Contribution, recorder: &mut Recorder<'_>);
    /// [`Transport::trace`] of an eye ray, counted.
    fn count(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, counters: &mut Counters);
}

impl<T: Transport> Integrator for T {
    fn facts(&self) -> Facts {
        Facts {
            output: self.output(),
            depth_limit: self.depth_limit(),
            bounded: self.bounded(),
            particles: self.particles(),
            walks: self.walks(),
            looks: self.looks(),
            gathering: self.gathering(),
        }
    }
    fn with(&self, photons: &Arc<Photons>) -> Option<Box<dyn Integrator>> {
        Transport::with(self, photons)
    }
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        Transport::eye_samples(self, asked)
    }
    fn sample(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution) {
        self.trace(cx, Start::Eye(ray), (), &mut NoProbe, out);
    }
    fn record(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>) {
        self.trace(cx, Start::Eye(ray), Default::default(), recorder, out);
    }
    fn replay(
        &self,
        cx: &SampleCx<'_>,
        node: &TreeNode,
        out: &mut Contribution,
        recorder: &mut Recorder<'_>,
    ) {
        self.trace(cx, Start::Again(node), Default::default(), recorder, out);
    }
    fn count(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, counters: &mut Counters) {
        self.trace(cx, Start::Eye(ray), Default::default(), counters, out);
    }
}

/// All integrators.
pub const INTEGRATORS: &[Entry<Box<dyn Integrator>>] = &[
    Entry::of::<Whitted>(),
    Entry::of::<Distributed>(),
    Entry::of::<Path>(),
    Entry::of::<VolPath>(),
    Entry::of::<Direct>(),
    Entry::of::<LightTracing>(),
    Entry::of::<Bidirectional>(),
    Entry::of::<Sppm>(),
    Entry::of::<AmbientOcclusion>(),
    Entry::of::<Cast>(),
    Entry::of::<Function>(),
];

/// Those that follow one direction per hit: scene languages agree with us on what their depth means.
pub const PATHS: &[&str] = &["path", "volpath", "direct", "light", "bdpt", "sppm"];

/// Those that heed media.
pub const HEED_MEDIA: &[&str] = &["volpath", "light", "bdpt"];

/// Bounces of paths.
const PATH_DEPTH: ParamSpec = ParamSpec::new(
    "maxdepth",
    ParamType::Int,
    ParamDefault::Int(8),
    "Bounces at most; 1 is direct light. 5 where a pbrt file is silent, as in pbrt-v4.",
)
.range(0.0, 10_000.0);

/// How they choose a light.
const LIGHT_SAMPLER: ParamSpec = ParamSpec::new(
    "lightsampler",
    ParamType::Choice(&LightSampler::WORDS),
    ParamDefault::Text("tree"),
    "How the light is chosen that a hit asks: each as often, by power, or by what it may send there.",
);

/// When their walks may end by chance.
const ROULETTE_DEPTH: ParamSpec = ParamSpec::new(
    "roulettedepth",
    ParamType::Int,
    ParamDefault::Int(3),
    "Bounces after which chance may end a path.",
)
.range(0.0, 10_000.0);
