//! Counts of rays, stops and tests: `--stats`.
use durer_accel::{Hit, TraversalProbe};
use durer_core::{Id, spectrum::Spectrum};
use durer_model::Surface;

use super::{Probe, RayKind, StopReason};
use crate::{Object, PathRay};

/// Totals over any number of samples.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    announced: [u64; RayKind::ALL.len()],
    untraced: [u64; RayKind::ALL.len()],
    stops: [u64; StopReason::ALL.len()],
    /// Boxes tested.
    pub node_tests: u64,
    /// Primitives tested.
    pub primitive_tests: u64,
    /// Largest number of bounces of a traced ray.
    pub max_depth: u32,
}

impl Counters {
    /// Rays of a kind that were traced.
    pub fn rays(&self, kind: RayKind) -> u64 {
        self.announced[kind as usize] - self.untraced[kind as usize]
    }
    /// Traced rays of all kinds.
    pub fn all_rays(&self) -> u64 {
        RayKind::ALL.into_iter().map(|k| self.rays(k)).sum()
    }
    /// How often rays ended for this reason.
    pub fn stops(&self, reason: StopReason) -> u64 {
        self.stops[reason as usize]
    }
    /// Adds the totals of another worker.
    pub fn merge(&mut self, o: &Self) {
        let add = |a: &mut [u64], b: &[u64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        add(&mut self.announced, &o.announced);
        add(&mut self.untraced, &o.untraced);
        add(&mut self.stops, &o.stops);
        self.node_tests += o.node_tests;
        self.primitive_tests += o.primitive_tests;
        self.max_depth = self.max_depth.max(o.max_depth);
    }
}

impl TraversalProbe for Counters {
    type Id = RayId;
    fn node(&mut self, _: RayId, _: u32) {
        self.node_tests += 1;
    }
    fn primitive(&mut self, _: RayId, _: u32, _: u32) {
        self.primitive_tests += 1;
    }
}

/// The counters' note on a ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayId {
    kind: u8,
    /// 0 for shadow rays: they are part of a hit, no bounce of their own.
    depth: u32,
}

impl Probe for Counters {
    fn ray(&mut self, _: RayId, ray: &PathRay, kind: RayKind) -> RayId {
        self.announced[kind as usize] += 1;
        RayId { kind: kind as u8, depth: if kind == RayKind::Shadow { 0 } else { ray.depth } }
    }
    fn surface(&mut self, id: RayId, _: Id<Object>, _: &Hit, _: &Surface) {
        self.max_depth = self.max_depth.max(id.depth);
    }
    fn stop(&mut self, id: RayId, reason: StopReason, _: Spectrum) {
        self.stops[reason as usize] += 1;
        if reason.is_untraced() {
            self.untraced[id.kind as usize] += 1;
        } else {
            self.max_depth = self.max_depth.max(id.depth);
        }
    }
}
