//! Which factor to cut first ("can we reduce this?").
use durer_accel::Engine;
use durer_render::drive::Antialias;

use super::Factors;
use crate::Prepared;

/// A factor that can be made smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advice {
    /// Its name in the formula.
    pub factor: &'static str,
    /// Share of the time that is saved if it becomes 1, in `[0, 1)`; of primitives, if the hierarchy's take their place.
    pub saves: f64,
    /// By what means.
    pub how: &'static str,
}

/// The factors that can be cut, the one that saves most first. `bvh` are the factors with a hierarchy.
pub fn advice(prepared: &Prepared, factors: &Factors, bvh: Option<&Factors>) -> Vec<Advice> {
    let saves = |factor: f64| if factor > 1.0 { 1.0 - 1.0 / factor } else { 0.0 };
    let of =
        |factor: &'static str, value: f64, how: &'static str| Advice { factor, saves: saves(value), how };
    let nested = prepared.settings.nesting.time > 1 || prepared.settings.nesting.lens > 1;
    let shared = "--sampling shared: the samples that antialiasing needs anyway serve double duty";
    let fewer_samples = match prepared.settings.antialias {
        Antialias::Supersample => "--spp with fewer samples, or --antialias adaptive",
        Antialias::Adaptive(_) => "a larger --aa-threshold or a smaller --aa-depth",
    };
    let mut all = vec![
        of("supersamples", factors.supersamples, fewer_samples),
        of("ray tree size", factors.tree, "a larger --min-contribution or a smaller --max-depth"),
        of("shadow rays", factors.shadow, "fewer lights, fewer --shadow-rays"),
        of("gloss", factors.gloss, "fewer --gloss-rays"),
        of("temporal", factors.temporal, if nested { shared } else { "fewer --time-samples" }),
        of("focal", factors.focal, if nested { shared } else { "fewer --lens-samples" }),
    ];
    if let Some(bvh) = bvh.filter(|_| prepared.scene.accel.engine() == Engine::BruteForce) {
        let ratio = factors.primitives * factors.intersection / (bvh.primitives * bvh.intersection);
        all.push(of("primitives", ratio, "--accel balanced: a hierarchy of boxes"));
    }
    all.retain(|a| a.saves > 0.0 && a.saves.is_finite());
    all.sort_by(|a, b| b.saves.total_cmp(&a.saves));
    all
}
