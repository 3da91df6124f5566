//! How light scatters at a point: a closed set of lobes, returned by value.
//!
//! Directions `wo` (back along the ray) and `wi` (towards the light) point away from the surface and are of unit
//! length, in a frame whose z axis is the shading normal; z > 0 is the outside.

use durer_core::{math::Vector3, spectrum::Spectrum};

/// Kinds of scattering that rays are spawned for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchKind {
    /// Mirror reflection.
    Reflection,
    /// Refraction, or passing straight on.
    Transmission,
}

/// A direction of a perfectly sharp lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Which way.
    pub kind: BranchKind,
    /// Unit direction.
    pub wi: Vector3,
    /// What the radiance arriving from `wi` is multiplied with.
    pub weight: Spectrum,
}

/// What happened to a lobe that yields no branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocked {
    /// Total internal reflection: nothing is transmitted.
    TotalInternalReflection,
}
