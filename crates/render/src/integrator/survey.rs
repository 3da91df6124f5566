//! What the samples of another integrator cost and how much they differ: heat maps beside its picture.
//!
//! A sample's value becomes (rays, Y, Y²) with Y its luminance. The film's means of these give the rays of a sample and,
//! as E[Y²] - E[Y]², the variance of one.
use std::sync::Arc;

use durer_core::spectrum::luminance;

use super::{EyeSamples, Facts, Integrator, Output, Photons};
use crate::{
    Contribution, PathRay, SampleCx, Value,
    probe::{Counters, Recorder, TreeNode},
};

/// What is shown of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Survey {
    /// Rays that one takes, in the mean.
    Rays,
    /// Standard deviation of the luminance of one.
    Noise,
}

impl Survey {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Rays, Self::Noise];

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Rays => "rays",
            Self::Noise => "noise",
        }
    }

    /// The number of a pixel from the film's means.
    pub fn number(self, [rays, light, square]: [f32; 3]) -> f32 {
        match self {
            Self::Rays => rays,
            Self::Noise => (square - light * light).max(0.0).sqrt(),
        }
    }
}

/// An integrator whose samples are surveyed; it traces the same rays.
pub struct Surveyed {
    /// Light transport.
    pub integrator: Box<dyn Integrator>,
    /// What is shown of it.
    pub survey: Survey,
}

impl Surveyed {
    fn look(cx: &SampleCx<'_>, out: &mut Contribution) {
        let light = match out.value {
            Value::Radiance(radiance) => luminance(cx.basis.to_rgb(radiance).map(f64::from)) as f32,
            Value::Data(_) => 0.0,
        };
        out.value = Value::Data(Some([out.rays as f32, light, light * light]));
        // What a sample has for other pixels is no number of its own.
        out.splats.clear();
    }
}

impl Integrator for Surveyed {
    fn facts(&self) -> Facts {
        Facts { output: Output::Survey(self.survey), ..self.integrator.facts() }
    }
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        self.integrator.eye_samples(asked)
    }
    fn with(&self, photons: &Arc<Photons>) -> Option<Box<dyn Integrator>> {
        let integrator = self.integrator.with(photons)?;
        Some(Box::new(Self { integrator, survey: self.survey }))
    }
    fn sample(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution) {
        self.integrator.sample(cx, ray, out);
        Self::look(cx, out);
    }
    fn record(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>) {
        self.integrator.record(cx, ray, out, recorder);
        Self::look(cx, out);
    }
    fn replay(
        &self,
        cx: &SampleCx<'_>,
        node: &TreeNode,
        out: &mut Contribution,
        recorder: &mut Recorder<'_>,
    ) {
        self.integrator.replay(cx, node, out, recorder);
        Self::look(cx, out);
    }
    fn count(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, counters: &mut Counters) {
        self.integrator.count(cx, ray, out, counters);
        Self::look(cx, out);
    }
}
