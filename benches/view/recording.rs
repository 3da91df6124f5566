//! The trees of one pixel, timed.
use std::time::{Duration, Instant};

use durer::{
    probe::Detail,
    tree::{Subject, Surroundings},
};
use serde_json::{Value, json};

/// How long one pixel took.
pub(crate) struct Recording {
    /// The tree of its first sample.
    pub(crate) one: Duration,
    pub(crate) one_nodes: usize,
    /// The trees of all samples.
    pub(crate) all: Duration,
    pub(crate) all_nodes: usize,
    /// The document of all samples, with what else `durer trace --sample all` tells of the pixel.
    pub(crate) document: Duration,
}

impl Recording {
    /// Records the pixel in each way.
    pub(crate) fn of(subject: &Subject<'_>, pixel: [u32; 2]) -> Self {
        let (job, samples) = (subject.prepared.job(), subject.prepared.settings.samples);
        let (one, (tree, _)) = timed(|| job.record(pixel, 0));
        let (all, trees) =
            timed(|| (0..samples).map(|sample| job.record(pixel, sample).0).collect::<Vec<_>>());
        let indices: Vec<u32> = (0..samples).collect();
        let (document, _) = timed(|| subject.page(pixel, &indices, Surroundings::None, Detail::default()));
        Self {
            one,
            one_nodes: tree.nodes.len(),
            all,
            all_nodes: trees.iter().map(|tree| tree.nodes.len()).sum(),
            document,
        }
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed(), result)
}

/// Median and worst, each on its own, of a time in seconds and a number of nodes.
pub(crate) fn summary(recordings: &[Recording], figure: impl Fn(&Recording) -> (Duration, usize)) -> Value {
    let (mut times, mut nodes): (Vec<Duration>, Vec<usize>) = recordings.iter().map(figure).unzip();
    times.sort();
    nodes.sort();
    let seconds = |time: Option<&Duration>| time.map(Duration::as_secs_f64);
    json!({
        "median": seconds(times.get(times.len() / 2)), "worst": seconds(times.last()),
        "nodes_median": nodes.get(nodes.len() / 2), "nodes_most": nodes.last(),
    })
}
