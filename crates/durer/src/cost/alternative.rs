//! The same picture by other means: with and without hierarchy, nested and shared sampling.
use std::sync::atomic::AtomicBool;

use durer_accel::Engine;
use durer_io::import::Imported;
use durer_render::integrator::{Distributed, Sampling};
use durer_scene::Kind;

use super::{Factors, predict, probe::timed_tests};
use crate::{Options, prepare};

/// One way to make the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// With a hierarchy, or without.
    pub engine: Engine,
    /// How the rays of several effects are combined; `None` for integrators without such.
    pub sampling: Option<Sampling>,
    /// What it is expected to take.
    pub factors: Factors,
    /// Boxes that will be tested.
    pub box_tests: f64,
}

/// Predicts all ways; those that cannot be prepared are left out. What is known of the scene's own `integrator` decides
/// whether sampling is one of the choices.
pub fn alternatives(
    imported: &mut Imported,
    options: &Options,
    integrator: &str,
    cancel: &AtomicBool,
) -> Vec<Alternative> {
    let samplings: &[Option<Sampling>] = match integrator == Distributed::SCHEMA.name {
        true => &[Some(Sampling::Shared), Some(Sampling::Nested)],
        false => &[None],
    };
    let mut all = Vec::new();
    for &sampling in samplings {
        let mut wishes = Options { engine: Engine::Bvh, ..options.clone() };
        wishes.distribution.sampling = sampling.or(wishes.distribution.sampling);
        let Some(predicted) = prepare(imported, &wishes).and_then(|scene| predict(&scene, cancel)) else {
            continue;
        };
        all.push(Alternative {
            engine: Engine::Bvh,
            sampling,
            factors: predicted.factors,
            box_tests: predicted.box_tests,
        });
        // The rays are the same.
        let wishes = Options { engine: Engine::BruteForce, ..wishes };
        if let Some(scene) = prepare(imported, &wishes) {
            let timed = timed_tests(&scene, predicted.primitives, cancel);
            let factors =
                Factors { primitives: timed.per_ray, intersection: timed.seconds, ..predicted.factors };
            all.push(Alternative { engine: Engine::BruteForce, sampling, factors, box_tests: 0.0 });
        }
    }
    all
}
