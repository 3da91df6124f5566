//! A ray in one space, with what box tests need of it.
use durer_core::math::{Bounds3, Ray};

use crate::slab::Slab;

/// A ray and its constants for boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    pub(crate) ray: Ray,
    pub(crate) slab: Slab,
}

impl Space {
    /// For things inside `region`. `None` if the ray can hit nothing.
    #[inline]
    pub(crate) fn new(ray: &Ray, region: &Bounds3) -> Option<Self> {
        Some(Self { ray: *ray, slab: Slab::new(ray, region)? })
    }
}
