//! Observers of light transport: they see every ray and change nothing.
//!
//! Integrators are generic over [`Probe`]; with [`NoProbe`] every call and even the bookkeeping of parents vanishes.
//! Ids are explicit instead of push and pop, so that early returns cannot unbalance the tree and recursive and iterative
//! integrators look alike.

mod counters;
mod tree;

pub use counters::Counters;
pub use tree::{NodeId, RayTree, TreeHit, TreeNode};

pub use durer_accel::NoTraversalProbe as NoProbe;

use durer_accel::{Hit, TraversalProbe};
use durer_core::{Id, math::Point3, spectrum::Spectrum};
use durer_model::{Surface, bsdf::BranchKind};
use serde::Serialize;

use crate::{Object, PathRay};

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RayKind {
    /// From the camera.
    Eye,
    /// Towards a light.
    Shadow,
    /// Mirrored.
    Reflection,
    /// Refracted, or going straight on through something thin.
    Refraction,
    /// Drawn about a mirrored direction.
    GlossyReflection,
    /// Drawn about a refracted direction: translucency.
    GlossyRefraction,
    /// Continued, without a bounce, through a surface that is not there: that of a body which gives way to another.
    Passing,
}

impl RayKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::Eye,
        Self::Shadow,
        Self::Reflection,
        Self::Refraction,
        Self::GlossyReflection,
        Self::GlossyRefraction,
        Self::Passing,
    ];

    /// The kind of ray that follows a perfectly sharp direction.
    pub fn sharp(branch: BranchKind) -> Self {
        match branch {
            BranchKind::Reflection => Self::Reflection,
            BranchKind::Transmission => Self::Refraction,
        }
    }
    /// The kind of ray that follows a direction drawn from a lobe.
    pub fn drawn(branch: BranchKind) -> Self {
        match branch {
            BranchKind::Reflection => Self::GlossyReflection,
            BranchKind::Transmission => Self::GlossyRefraction,
        }
    }

    /// The word in exports and statistics.
    pub fn word(self) -> &'static str {
        match self {
            Self::Eye => "eye",
            Self::Shadow => "shadow",
            Self::Reflection => "reflection",
            Self::Refraction => "refraction",
            Self::GlossyReflection => "glossy-reflection",
            Self::GlossyRefraction => "glossy-refraction",
            Self::Passing => "passing",
        }
    }
}

/// Why nothing follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopReason {
    /// The ray left the scene.
    MissedScene,
    /// A shadow ray arrived.
    HitLight,
    /// A shadow ray met something else first.
    LightOccluded,
    /// The surface has no sharp direction to continue in.
    OpaqueNoChildren,
    /// Not traced: too many bounces.
    DepthLimit,
    /// Not traced: its share in the pixel is too small.
    ContributionBelowCutoff,
    /// Not traced: all light is reflected inside.
    TirNoRefraction,
}

impl StopReason {
    /// All reasons, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::MissedScene,
        Self::HitLight,
        Self::LightOccluded,
        Self::OpaqueNoChildren,
        Self::DepthLimit,
        Self::ContributionBelowCutoff,
        Self::TirNoRefraction,
    ];

    /// The word in exports and statistics.
    pub fn word(self) -> &'static str {
        match self {
            Self::MissedScene => "missed-scene",
            Self::HitLight => "hit-light",
            Self::LightOccluded => "light-occluded",
            Self::OpaqueNoChildren => "opaque-no-children",
            Self::DepthLimit => "depth-limit",
            Self::ContributionBelowCutoff => "contribution-below-cutoff",
            Self::TirNoRefraction => "tir-no-refraction",
        }
    }
    /// True if the ray was given up before it was traced.
    pub fn is_untraced(self) -> bool {
        matches!(self, Self::DepthLimit | Self::ContributionBelowCutoff | Self::TirNoRefraction)
    }
}

/// What a shadow ray found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightEvent {
    /// Index of the light in the scene.
    pub light: u32,
    /// The point on the light; `None` if it is infinitely far away.
    pub point: Option<Point3>,
    /// What arrives if nothing is in between.
    pub unoccluded: Spectrum,
    /// The share of it that passes what is in between: 1 where nothing is.
    pub passed: Spectrum,
    /// Something of it arrives.
    pub visible: bool,
    /// What keeps all of it, if something does; only looked for if the probe [`Probe::RECORDS`].
    pub blocker: Option<Id<Object>>,
}

/// An observer. Every method does nothing unless overridden.
pub trait Probe: TraversalProbe {
    /// True if the probe wants details that cost extra rays.
    const RECORDS: bool = false;

    /// A ray is about to be traced, or given up.
    fn ray(&mut self, parent: Self::Id, ray: &PathRay, kind: RayKind) -> Self::Id {
        let _ = (parent, ray, kind);
        Self::Id::default()
    }
    /// The ray met a surface.
    fn surface(&mut self, id: Self::Id, object: Id<Object>, hit: &Hit, surface: &Surface) {
        let _ = (id, object, hit, surface);
    }
    /// A shadow ray was answered.
    fn light(&mut self, id: Self::Id, event: &LightEvent) {
        let _ = (id, event);
    }
    /// Radiance that comes from no other ray: ambient term, emission, sky, a light's arriving light.
    fn local(&mut self, id: Self::Id, radiance: Spectrum) {
        let _ = (id, radiance);
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
