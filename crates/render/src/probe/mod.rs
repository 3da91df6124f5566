//! Observers of light transport: they see every ray and change nothing.
//!
//! Integrators are generic over [`Probe`]; with [`NoProbe`] every call and even the bookkeeping of parents vanishes.
//! Ids are explicit instead of push and pop, so that early returns cannot unbalance the tree and recursive and iterative
//! integrators look alike.

mod bound;
mod counters;
mod event;
mod kind;
mod node;
mod recorder;
mod stop;
mod tree;
mod walk;

pub use counters::Counters;
pub use event::{Choice, ChosenBy, Floating, Gathered, LightEvent, Particle, RandomNumbers, Shaded};
pub use kind::RayKind;
pub use node::{BoxTest, TreeHit, TreeMedia, TreeNode, TreeShading};
pub use recorder::Recorder;
pub use stop::{Limit, StopReason};
pub use tree::{Clock, Detail, NodeId, RayTree, TreeEye};

pub use durer_accel::NoTraversalProbe as NoProbe;

use durer_accel::{Hit, TraversalProbe};
use durer_core::{Id, spectrum::Spectrum};
use durer_model::Surface;

use crate::{Object, PathRay};

/// An observer. Every method does nothing unless overridden.
pub trait Probe: TraversalProbe {
    /// True if the probe wants details that cost extra work. Without it nothing is told by [`Probe::chosen`],
    /// [`Probe::shaded`], [`Probe::floating`], [`Probe::gathered`] and [`Probe::limit`].
    const RECORDS: bool = false;

    /// True if no more rays are wanted: those that follow are given up. Only asked if the probe [`Probe::RECORDS`].
    fn is_full(&self) -> bool {
        false
    }
    /// How the ray came about that is announced next.
    fn chosen(&mut self, choice: &Choice) {
        let _ = choice;
    }
    /// A ray is about to be traced, or given up.
    fn ray(&mut self, parent: Self::Id, ray: &PathRay, kind: RayKind) -> Self::Id {
        let _ = (parent, ray, kind);
        Self::Id::default()
    }
    /// The ray met a surface.
    fn surface(&mut self, id: Self::Id, object: Id<Object>, hit: &Hit, surface: &Surface) {
        let _ = (id, object, hit, surface);
    }
    /// How that surface scatters, and what it sends out by itself.
    fn shaded(&mut self, id: Self::Id, event: &Shaded<'_>) {
        let _ = (id, event);
    }
    /// What floats was on its way.
    fn floating(&mut self, id: Self::Id, event: &Floating) {
        let _ = (id, event);
    }
    /// Photons lay where the ray met a surface.
    fn gathered(&mut self, id: Self::Id, event: &Gathered) {
        let _ = (id, event);
    }
    /// The light that the ray met could have been sampled too: the density of that, 1/sr, and the share that is left to
    /// the ray.
    fn met_light(&mut self, id: Self::Id, other_pdf: f32, mis: f32) {
        let _ = (id, other_pdf, mis);
    }
    /// A shadow ray was answered.
    fn light(&mut self, id: Self::Id, event: &LightEvent) {
        let _ = (id, event);
    }
    /// Radiance that comes from no other ray: ambient term, emission, sky, a light's arriving light.
    fn local(&mut self, id: Self::Id, radiance: Spectrum) {
        let _ = (id, radiance);
    }
    /// The number that ends the ray, before [`Probe::stop`].
    fn limit(&mut self, id: Self::Id, limit: Limit) {
        let _ = (id, limit);
    }
    /// Nothing follows. `lost` is the share in the pixel that a ray not traced would have had.
    fn stop(&mut self, id: Self::Id, reason: StopReason, lost: Spectrum) {
        let _ = (id, reason, lost);
    }
    /// The ray's radiance: `local` plus weight times result of every child, summed in the order they were announced.
    fn result(&mut self, id: Self::Id, radiance: Spectrum) {
        let _ = (id, radiance);
    }
}

impl Probe for NoProbe {}
