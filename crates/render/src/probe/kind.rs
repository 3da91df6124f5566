//! What rays are for.
use durer_model::bsdf::BranchKind;
use serde::Serialize;

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
    /// Between a vertex of a walk from one end of a path and one from the other, or the camera.
    Connection,
    /// The way of a particle from a light.
    Photon,
}

impl RayKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::Eye,
        Self::Shadow,
        Self::Reflection,
        Self::Refraction,
        Self::GlossyReflection,
        Self::GlossyRefraction,
        Self::Passing,
        Self::Connection,
        Self::Photon,
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

    /// Whether it brings what a surface sends from further on: no question whether something is seen, no way of a particle.
    pub fn is_followed(self) -> bool {
        !matches!(self, Self::Shadow | Self::Connection | Self::Photon)
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
            Self::Connection => "connection",
            Self::Photon => "photon",
        }
    }
}
