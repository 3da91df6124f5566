//! The prediction: parameters where they are enough, else a hundredth of the pixels.
use std::sync::atomic::AtomicBool;

use durer_accel::Engine;
use durer_render::drive::{Antialias, PartCount, scattered};

use super::{Factors, FullTree};
use crate::Prepared;

/// Every how many pixels along an edge one is probed: a hundredth of them.
const PROBE_EDGE: u32 = 10;
/// At least so many pixels are probed, if there are.
const LEAST_PIXELS: u64 = 1000;
/// Of so many pixels the trees are looked at for being full.
const TREES: usize = 32;

/// Where a prediction comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Size of the picture, samples, depth, branches, lights and primitives.
    Parameters(FullTree),
    /// Some of the pixels.
    Probe {
        /// How many.
        pixels: u64,
    },
}

/// What a picture is expected to cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Predicted {
    /// Where it comes from.
    pub method: Method,
    /// The factors.
    pub factors: Factors,
    /// Boxes that will be tested.
    pub box_tests: f64,
    /// Primitives of the scene, as often as they are placed: what every ray is tested against without a hierarchy.
    pub primitives: u64,
}

/// Predicts what rendering takes; `None` if `cancel` was set meanwhile.
pub fn predict(prepared: &Prepared, cancel: &AtomicBool) -> Option<Predicted> {
    let window = prepared.window();
    let least = ((window.area() as f64 / LEAST_PIXELS as f64).sqrt() as u32).clamp(1, PROBE_EDGE);
    let pixels = scattered(window, least);
    let part: PartCount = prepared.job().count(&pixels, cancel);
    if cancel.load(std::sync::atomic::Ordering::Relaxed) {
        return None;
    }
    let probed = Factors::from((prepared, &part));
    let counts = prepared.scene.report.geometry;
    let primitives = counts.triangles_placed + counts.other_shapes;
    let step = (pixels.len() / TREES).max(1);
    let some: Vec<[u32; 2]> = pixels.iter().copied().step_by(step).collect();
    let tests_all = prepared.scene.accel.engine() == Engine::BruteForce;
    // Adaptive antialiasing takes as many samples as it finds that it needs.
    let is_even = prepared.settings.antialias == Antialias::Supersample;
    let full = if tests_all && is_even { FullTree::of(prepared, &some) } else { None };
    let exact = |tree: FullTree| Factors {
        supersamples: f64::from(prepared.settings.samples) / (probed.temporal * probed.focal),
        tree: tree.rays(),
        gloss: 1.0,
        shadow: 1.0 + tree.rays_to_lights() / tree.rays(),
        primitives: primitives as f64,
        ..probed
    };
    // The few trees that were looked at may be full while others are not, and a shadow ray may be tested in pieces where
    // it passes through things: the parameters are enough only if nothing that was counted disagrees.
    let full = full.filter(|&tree| exact(tree).counts() == probed.counts());
    let (method, factors) = match full {
        Some(tree) => (Method::Parameters(tree), exact(tree)),
        None => (Method::Probe { pixels: part.pixels }, probed),
    };
    let boxes_per_ray = part.counters.node_tests as f64 / part.counters.all_rays().max(1) as f64;
    Some(Predicted { method, factors, box_tests: factors.rays() * boxes_per_ray, primitives })
}

/// Tests without a hierarchy that are timed.
const TIMED_TESTS: u64 = 20_000_000;

/// Tests without a hierarchy, timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Timed {
    /// Seconds of a ray-primitive test; 0 where there is nothing to test.
    pub(super) seconds: f64,
    /// Tests of a ray: all primitives, and all again for each piece of a shadow ray that passes through things.
    pub(super) per_ray: f64,
}

/// Times tests without a hierarchy on a few pixels.
pub(super) fn timed_tests(prepared: &Prepared, primitives: u64, cancel: &AtomicBool) -> Timed {
    let window = prepared.window();
    // Every sample takes at least its eye ray.
    let pixels =
        (TIMED_TESTS / (primitives.max(1) * u64::from(prepared.settings.samples))).clamp(1, LEAST_PIXELS);
    let edge = (window.area() as f64 / pixels as f64).sqrt().ceil() as u32;
    let mut some = scattered(window, edge);
    some.truncate(pixels as usize);
    let PartCount { counters, busy, .. } = prepared.job().count(&some, cancel);
    let (tests, rays) = (counters.primitive_tests, counters.all_rays());
    if tests == 0 || rays == 0 {
        return Timed::default();
    }
    Timed { seconds: busy.as_secs_f64() / tests as f64, per_ray: tests as f64 / rays as f64 }
}
