//! Why a pixel has its colour: sentences with numbers, from the rays of its samples.
//!
//! [`explain`] records the samples of a pixel, divides their light into parts, follows the ray that brings most through
//! one of them with the formulas that made its light, says what was cut off, and checks every ray against the laws of
//! ray tracing ([`check`]).
mod bodies;
mod check;
mod explanation;
mod part;
mod story;
mod survey;
mod words;

pub use check::{Finding, Law, check};
pub use explanation::{Explanation, Paragraph, SampleFinding, Spread, VERSION};
pub use part::{Part, PartKind};

use crate::{Gather, drive::Taken, probe::RayTree, tree::Subject};

use part::Parts;

/// Samples of a pixel that are recorded at most.
const MOST_SAMPLES: usize = 256;
/// Rays of all recorded samples together, about at most.
const MOST_RAYS: usize = 200_000;

/// A recorded sample.
struct Sample {
    number: u32,
    /// What it counts in the pixel.
    weight: f64,
    rgb: [f64; 3],
    /// `None` of data pictures where nothing was hit.
    has_value: bool,
    tree: RayTree,
}

impl Sample {
    /// What arrives along the eye ray, before camera and film make something of it.
    fn arriving(&self) -> [f64; 3] {
        self.tree.nodes.first().map_or(self.rgb, |eye| words::rgb(&self.tree.basis, eye.result))
    }
    fn is_finite(&self) -> bool {
        self.rgb.iter().all(|v| v.is_finite())
    }
}

/// Explains the mean of a pixel, or one of its `samples`, all of which are `taken`.
pub fn explain(subject: &Subject<'_>, pixel: [u32; 2], taken: &[Taken], sample: Option<u32>) -> Explanation {
    let chosen: Vec<&Taken> = match sample {
        Some(sample) => taken.get(sample as usize).into_iter().collect(),
        None => taken.iter().collect(),
    };
    let samples = record(subject, pixel, &chosen);
    let rgb = match (sample, samples.first()) {
        (Some(_), Some(one)) => one.rgb,
        _ => subject.mean(pixel, taken).map(f64::from),
    };
    explained(subject, pixel, taken.len() as u32, (&samples, rgb))
}

/// Explains one sample of a pixel, and takes no other.
pub fn explain_one(subject: &Subject<'_>, pixel: [u32; 2], sample: u32) -> Explanation {
    let job = subject.prepared.job();
    let taken = job.sample_of(pixel, sample, Gather::Rays);
    let samples = record(subject, pixel, &taken.iter().collect::<Vec<_>>());
    let rgb = samples.first().map_or([0.0; 3], |one| one.rgb);
    explained(subject, pixel, job.sample_count(pixel), (&samples, rgb))
}

/// Explains recorded samples of a pixel that has so many.
fn explained(
    subject: &Subject<'_>,
    pixel: [u32; 2],
    count: u32,
    (samples, rgb): (&[Sample], [f64; 3]),
) -> Explanation {
    let numbers: Vec<u32> = samples.iter().map(|s| s.number).collect();
    let detailed = representative(samples);
    let total: f64 = samples.iter().filter(|s| s.is_finite()).map(|s| s.weight).sum();
    let (mut ways, mut sources) = (Parts::default(), Parts::default());
    if matches!(subject.prepared.integrator.facts().output, crate::Output::Radiance) && total != 0.0 {
        for one in samples.iter().filter(|s| s.is_finite()) {
            ways.merge(&part::by_way(subject.prepared, &one.tree), one.weight / total);
            sources.merge(&part::by_source(subject.prepared, &one.tree), one.weight / total);
        }
    }
    let missing = survey::missing(subject.prepared, samples);
    let mut explanation = Explanation {
        version: VERSION,
        scene: subject.name.to_owned(),
        integrator: subject.prepared.integrator_name.clone(),
        pixel,
        samples: count,
        explained: numbers,
        sample: detailed.map_or(0, |s| s.number),
        rgb,
        parts: ways.sorted(),
        sources: sources.sorted(),
        spread: (samples.len() > 1).then(|| survey::spread(samples)),
        missing: missing.as_ref().ok().copied(),
        no_bound: missing.err(),
        paragraphs: Vec::new(),
        findings: findings(subject, samples),
    };
    if let Some(detailed) = detailed {
        explanation.paragraphs = story::tell(subject, samples, detailed, &explanation);
    }
    explanation
}

/// Records the samples, or so many of them, evenly chosen, as the budget allows.
fn record(subject: &Subject<'_>, pixel: [u32; 2], taken: &[&Taken]) -> Vec<Sample> {
    let job = subject.prepared.job();
    let one = |taken: &Taken| {
        let (tree, rgb) = job.record(pixel, taken.sample);
        Sample {
            number: taken.sample,
            weight: f64::from(taken.weight.unwrap_or(1.0)),
            rgb: rgb.map(f64::from),
            has_value: taken.rgb.is_some(),
            tree,
        }
    };
    let Some(first) = taken.first().copied().map(one) else { return Vec::new() };
    let most = (MOST_RAYS / first.tree.nodes.len().max(1)).clamp(1, MOST_SAMPLES).min(taken.len());
    let others = (1..most).map(|i| one(taken[i * taken.len() / most]));
    std::iter::once(first).chain(others.collect::<Vec<_>>()).collect()
}

/// The finite sample nearest to the mean of all; the first if none is finite.
fn representative(samples: &[Sample]) -> Option<&Sample> {
    let finite = || samples.iter().filter(|s| s.is_finite());
    let count = finite().count().max(1) as f64;
    let mean: [f64; 3] = std::array::from_fn(|i| finite().map(|s| s.rgb[i]).sum::<f64>() / count);
    let distance = |s: &Sample| (0..3).map(|i| (s.rgb[i] - mean[i]).powi(2)).sum::<f64>();
    finite().min_by(|a, b| distance(a).total_cmp(&distance(b))).or(samples.first())
}

/// What is wrong in any sample, each thing once.
fn findings(subject: &Subject<'_>, samples: &[Sample]) -> Vec<SampleFinding> {
    let mut all: Vec<SampleFinding> = Vec::new();
    for sample in samples {
        for finding in check(subject.prepared, &sample.tree) {
            match all.iter_mut().find(|known| known.finding.is_like(&finding)) {
                Some(known) => known.samples += 1,
                None => all.push(SampleFinding { sample: sample.number, finding, samples: 1 }),
            }
        }
    }
    all
}
