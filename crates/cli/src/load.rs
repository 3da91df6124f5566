//! From the name of a scene to something that renders, with a clock beside it.
use std::time::{Duration, Instant};

use durer::{Imported, Options, Prepared};

/// A scene, and how long it took to get it.
pub(crate) struct Loaded {
    pub(crate) imported: Imported,
    /// `None` if the diagnostics hold an error.
    pub(crate) prepared: Option<Prepared>,
    /// Reading and parsing.
    pub(crate) load: Duration,
    /// Compiling, with the hierarchy of boxes.
    pub(crate) build: Duration,
}

pub(crate) fn load(scene: &str, wishes: &Options) -> Loaded {
    let start = Instant::now();
    let mut imported = durer::open(scene);
    let load = start.elapsed();
    let start = Instant::now();
    let prepared = durer::prepare(&mut imported, wishes);
    Loaded { imported, prepared, load, build: start.elapsed() }
}
