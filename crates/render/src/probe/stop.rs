//! Why rays end.
use serde::Serialize;

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
    /// Nothing is left to go on with: what the ray went through, or the surface it met, keeps all light.
    Absorbed,
    /// Not traced: the light lies behind the surface, as both the true and the shading normal say.
    LightBehindSurface,
    /// Not traced: the direction lies on the wrong side of the true surface although the shading normal, or the normal of
    /// a microfacet, leads there.
    BelowHorizon,
    /// The sample is infinite or not a number: the film leaves it out. Told of the eye ray.
    NanRejected,
    /// Not traced: the record was given up, as the tree has as many rays as were allowed.
    Cancelled,
    /// Not traced: ended by chance, the others standing for it.
    Roulette,
    /// The value was cut. Of integrators to come.
    Clamped,
}

impl StopReason {
    /// All reasons, in the order of their numbers.
    pub const ALL: [Self; 14] = [
        Self::MissedScene,
        Self::HitLight,
        Self::LightOccluded,
        Self::OpaqueNoChildren,
        Self::DepthLimit,
        Self::ContributionBelowCutoff,
        Self::TirNoRefraction,
        Self::Absorbed,
        Self::LightBehindSurface,
        Self::BelowHorizon,
        Self::NanRejected,
        Self::Cancelled,
        Self::Roulette,
        Self::Clamped,
    ];
    /// Those that no integrator gives yet.
    pub const RESERVED: [Self; 1] = [Self::Clamped];

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
            Self::Absorbed => "absorbed",
            Self::LightBehindSurface => "light-behind-surface",
            Self::BelowHorizon => "below-horizon",
            Self::NanRejected => "nan-rejected",
            Self::Cancelled => "cancelled",
            Self::Roulette => "roulette",
            Self::Clamped => "clamped",
        }
    }
    /// True if the ray was given up before it was traced.
    pub fn is_untraced(self) -> bool {
        match self {
            Self::DepthLimit
            | Self::ContributionBelowCutoff
            | Self::TirNoRefraction
            | Self::LightBehindSurface
            | Self::BelowHorizon
            | Self::Cancelled
            | Self::Roulette => true,
            Self::MissedScene
            | Self::HitLight
            | Self::LightOccluded
            | Self::OpaqueNoChildren
            | Self::Absorbed
            | Self::NanRejected
            | Self::Clamped => false,
        }
    }
}

/// A number and the bound that ended a ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Of the ray: bounces at [`StopReason::DepthLimit`] (surfaces passed in a row if there are too many of those), the
    /// largest lane of its share in the pixel at [`StopReason::ContributionBelowCutoff`], the number drawn at
    /// [`StopReason::Roulette`].
    pub value: f32,
    /// What was allowed: bounces at most, the share at and below which rays are not traced, or the number from which on
    /// they are not.
    pub threshold: f32,
}
