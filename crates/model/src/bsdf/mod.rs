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

/// The sharp directions of a [`Bsdf`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Branches {
    list: [Option<Branch>; Bsdf::MOST_LOBES * 2],
    /// Set if a lobe would have transmitted but reflects totally, with the weight that the transmitted ray would have had.
    pub total_internal_reflection: Option<Spectrum>,
}

impl Branches {
    /// The branches, reflections before transmissions of the same lobe.
    pub fn iter(&self) -> impl Iterator<Item = &Branch> {
        self.list.iter().flatten()
    }
}

/// A glossy lobe as seen by an integrator that does not sample it: its main direction and how much it reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlossyView {
    /// Mirror direction.
    pub wi: Vector3,
    /// Directional albedo.
    pub weight: Spectrum,
    /// GGX roughness.
    pub alpha: f32,
}

/// The lobes at one point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bsdf {}

impl Bsdf {
    /// Most lobes a material can return.
    pub const MOST_LOBES: usize = 4;

    /// Value of all lobes that are not perfectly sharp, without the cosine. 1/sr.
    pub fn eval(&self, _wo: Vector3, _wi: Vector3) -> Spectrum {
        Spectrum::BLACK
    }
    /// Coefficient of the ambient term: diffuse albedo, or the ambient coefficient of a classic material.
    pub fn ambient(&self) -> Spectrum {
        Spectrum::BLACK
    }
    /// The glossy lobe, if there is one.
    pub fn glossy(&self, _wo: Vector3) -> Option<GlossyView> {
        None
    }
    /// The perfectly sharp directions.
    pub fn branches(&self, _wo: Vector3) -> Branches {
        Branches::default()
    }
    /// The surface's own colour as people would name it: diffuse albedo, or the tint of what it reflects or transmits.
    pub fn albedo(&self) -> Spectrum {
        Spectrum::BLACK
    }
}
