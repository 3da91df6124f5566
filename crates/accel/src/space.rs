//! A ray in one space, with what box tests need of it.
use durer_core::math::{Bounds3, Ray};

use crate::slab::Slab;

/// A ray and its constants for boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space<'r> {
    /// Borrowed. PERF: a ray just written in parts and copied as a whole stalls (bench render).
    pub(crate) ray: &'r Ray,
    pub(crate) slab: Slab,
}

impl<'r> Space<'r> {
    /// For things inside `region`. `None` if the ray can hit nothing.
    #[inline]
    pub(crate) fn new(ray: &'r Ray, region: &Bounds3) -> Option<Self> {
        Some(Self { ray, slab: Slab::new(ray, region)? })
    }
}
