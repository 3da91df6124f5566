//! What a picture costs, by the lecture's formula, factor by factor:
//!
//! `height x width x [primitives x intersection cost x ray tree size x shadow rays x supersamples x gloss x temporal x
//! focal]`.
//!
//! Each factor is defined so that the product is the number of ray-primitive tests, and with the intersection cost the
//! time: *ray tree size* counts eye rays and the sharp reflections and refractions that follow, *gloss* is what rays about
//! blurred directions multiply it with, *shadow rays* what shadow rays multiply that with, *primitives* the tests of a
//! ray. Where one sample set serves all effects, *temporal* and *focal* are 1.
mod advice;
mod alternative;
mod parameters;
mod probe;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use durer_render::{
    drive::PartCount,
    probe::{Counters, RayKind},
};

pub use advice::{Advice, advice};
pub use alternative::{Alternative, alternatives};
pub use parameters::FullTree;
pub use probe::{Method, Predicted, predict};

use crate::{Gather, Prepared, Progress, Rendered};

/// The factors of the formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// Rows.
    pub height: f64,
    /// Pixels per row.
    pub width: f64,
    /// Points of each pixel.
    pub supersamples: f64,
    /// Moments for each.
    pub temporal: f64,
    /// Points of the lens for each.
    pub focal: f64,
    /// Eye ray and sharp rays that follow it, parts of a ray on both sides of a surface that is not there one by one.
    pub tree: f64,
    /// Rays with those about blurred directions, by rays without.
    pub gloss: f64,
    /// Rays with those to lights, by rays without.
    pub shadow: f64,
    /// Primitives tested per ray.
    pub primitives: f64,
    /// Seconds per test, all that is done between tests included.
    pub intersection: f64,
}

impl Factors {
    /// Names and values in the order of the formula; all but the intersection cost.
    pub fn counts(&self) -> [(&'static str, f64); 9] {
        [
            ("height", self.height),
            ("width", self.width),
            ("primitives", self.primitives),
            ("ray tree size", self.tree),
            ("shadow rays", self.shadow),
            ("supersamples", self.supersamples),
            ("gloss", self.gloss),
            ("temporal", self.temporal),
            ("focal", self.focal),
        ]
    }
    /// Rays of the whole picture.
    pub fn rays(&self) -> f64 {
        let eye = self.height * self.width * self.supersamples * self.temporal * self.focal;
        eye * self.tree * self.gloss * self.shadow
    }
    /// Ray-primitive tests of the whole picture.
    pub fn primitive_tests(&self) -> f64 {
        self.rays() * self.primitives
    }
    /// Seconds of one thread.
    pub fn seconds(&self) -> f64 {
        self.primitive_tests() * self.intersection
    }

    /// The factors of a picture of which `counters` saw `pixels` pixels in `busy` time.
    fn of(prepared: &Prepared, counters: &Counters, pixels: u64, busy: Duration) -> Self {
        let window = prepared.window();
        let nesting = prepared.settings.nesting;
        let (temporal, focal) = (f64::from(nesting.time.max(1)), f64::from(nesting.lens.max(1)));
        let rays = |kinds: &[RayKind]| kinds.iter().map(|&k| counters.rays(k)).sum::<u64>() as f64;
        let per = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        // What continues a ray through a surface that is not there is no gloss.
        let sharp = rays(&[RayKind::Eye, RayKind::Reflection, RayKind::Refraction, RayKind::Passing]);
        let eye = rays(&[RayKind::Eye]);
        let all = counters.all_rays() as f64;
        let seen = all - rays(&[RayKind::Shadow, RayKind::Connection, RayKind::Photon]);
        Self {
            height: f64::from(window.y1 - window.y0),
            width: f64::from(window.x1 - window.x0),
            supersamples: per(eye, pixels as f64 * temporal * focal),
            temporal,
            focal,
            tree: per(sharp, eye),
            gloss: per(seen, sharp),
            shadow: per(all, seen),
            primitives: per(counters.primitive_tests as f64, all),
            intersection: per(busy.as_secs_f64(), counters.primitive_tests as f64),
        }
    }
}

/// What the picture did take.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The factors.
    pub factors: Factors,
    /// Ray-primitive tests.
    pub primitive_tests: u64,
    /// Boxes tested.
    pub box_tests: u64,
    /// Rays.
    pub rays: u64,
}

/// Renders the whole picture, counting; `None` if `cancel` was set meanwhile.
pub fn measure(prepared: &Prepared, progress: &dyn Progress, cancel: &AtomicBool) -> Option<Measured> {
    let start = std::time::Instant::now();
    let Rendered { counters, cancelled, .. } = prepared.job().render(Gather::Counters, progress, cancel);
    let busy = start.elapsed() * u32::try_from(prepared.settings.threads).unwrap_or(1);
    let counters = counters.filter(|_| !cancelled)?;
    let pixels = prepared.window().area();
    Some(Measured {
        factors: Factors::of(prepared, &counters, pixels, busy),
        primitive_tests: counters.primitive_tests,
        box_tests: counters.node_tests,
        rays: counters.all_rays(),
    })
}

impl From<(&Prepared, &PartCount)> for Factors {
    fn from((prepared, part): (&Prepared, &PartCount)) -> Self {
        Self::of(prepared, &part.counters, part.pixels, part.busy)
    }
}
