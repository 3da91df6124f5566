//! A ray in one space, with everything about it that is computed once.
use durer_core::math::{Bounds3, Ray};

use crate::{slab::Slab, triangle::Shear};

/// A ray and its constants for boxes and triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    pub(crate) ray: Ray,
    pub(crate) slab: Slab,
    pub(crate) shear: Shear,
}

impl Space {
    /// For things inside `region`. `None` if the ray can hit nothing.
    pub(crate) fn new(ray: &Ray, region: &Bounds3) -> Option<Self> {
        let slab = Slab::new(ray, region)?;
        Some(Self { ray: *ray, slab, shear: Shear::new(ray)? })
    }
}
