//! A ray in one space, with everything about it that is computed once.
use durer_core::math::{Bounds3, Ray};

use crate::{slab::Slab, triangle::Shear};

/// A ray and its constants for boxes and triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    pub(crate) ray: Ray,
    pub(crate) slab: Slab,
    /// `None` where there are no triangles to test.
    pub(crate) shear: Option<Shear>,
}

impl Space {
    /// For things inside `region`, triangles among them or not. `None` if the ray can hit nothing.
    pub(crate) fn new(ray: &Ray, region: &Bounds3, triangles: bool) -> Option<Self> {
        let slab = Slab::new(ray, region)?;
        let shear = if triangles { Some(Shear::new(ray)?) } else { None };
        Some(Self { ray: *ray, slab, shear })
    }
}
