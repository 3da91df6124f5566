//! Light transport: from a ray to radiance.
//!
//! An author writes one generic [`Transport::trace`]; what the driver holds is the object-safe [`Integrator`], which
//! comes from a blanket impl. A new integrator is one file here and one line in [`INTEGRATORS`].

mod ambient_occlusion;
mod cast;
mod distributed;
mod path;
mod shading;
mod walk;
mod whitted;

use durer_model::material::GlossRays;
use durer_scene::Entry;

use crate::{
    Contribution, PathRay, SampleCx,
    probe::{Counters, NoProbe, Probe, Recorder, TreeNode},
};

pub use ambient_occlusion::AmbientOcclusion;
pub use cast::{Cast, Show};
pub use distributed::{Distributed, Sampling};
pub use path::{Direct, Path, VolPath};
pub use walk::{Lights, Shadows};
pub use whitted::Whitted;

/// What the film holds once it is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Light; antialiased by averaging.
    Radiance,
    /// Numbers for the eye: see [`Show`].
    Data(Show),
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

/// What is traced.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "made once for each sample, and never kept")]
pub enum Start<'a> {
    /// An eye ray.
    Eye(PathRay),
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

/// Light transport as the driver holds it; nobody implements it by hand.
pub trait Integrator: Send + Sync {
    /// What the samples mean.
    fn output(&self) -> Output;
    /// [`Transport::eye_samples`].
    fn eye_samples(&self, asked: u32) -> EyeSamples;
    /// [`Transport::depth_limit`].
    fn depth_limit(&self) -> Option<u32>;
    /// [`Transport::bounded`].
    fn bounded(&self) -> Option<GlossRays>;
    /// [`Transport::trace`] of an eye ray, unwatched.
    fn sample(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution);
    /// [`Transport::trace`] of an eye ray, recorded.
    fn record(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>);
    /// [`Transport::trace`] of a recorded ray, recorded.
    fn replay(&self, cx: &SampleCx<'_>, node: &TreeNode, out: &mut Contribution, recorder: &mut Recorder<'_>);
    /// [`Transport::trace`] of an eye ray, counted.
    fn count(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution, counters: &mut Counters);
}

impl<T: Transport> Integrator for T {
    fn output(&self) -> Output {
        Transport::output(self)
    }
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        Transport::eye_samples(self, asked)
    }
    fn depth_limit(&self) -> Option<u32> {
        Transport::depth_limit(self)
    }
    fn bounded(&self) -> Option<GlossRays> {
        Transport::bounded(self)
    }
    fn sample(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution) {
        self.trace(cx, Start::Eye(ray), (), &mut NoProbe, out);
    }
    fn record(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>) {
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
    fn count(&self, cx: &SampleCx<'_>, ray: PathRay, out: &mut Contribution, counters: &mut Counters) {
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
    Entry::of::<AmbientOcclusion>(),
    Entry::of::<Cast>(),
];

/// Those that follow one direction per hit: scene languages agree with us on what their depth means.
pub const PATHS: &[&str] = &["path", "volpath", "direct"];

/// pbrt-v4's integrators that we do not have yet; [`Path`] stands in for them, with a warning.
pub const NOT_YET: &[&str] =
    &["bdpt", "function", "lightpath", "mlt", "randomwalk", "simplepath", "simplevolpath", "sppm"];
