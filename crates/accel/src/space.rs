//! A ray in one space, with what tests of boxes and triangles need of it.
use durer_core::math::Ray;

use crate::{slab::Slab, triangle::Shear};

/// A ray and its constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space<'r> {
    /// Borrowed. PERF: a ray just written in parts and copied as a whole stalls (bench render).
    pub(crate) ray: &'r Ray,
    pub(crate) slab: Slab,
    pub(crate) shear: Shear,
}

impl<'r> Space<'r> {
    /// For things whose coordinates are at most `region`. `None` if the ray can hit nothing.
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &'r Ray, region: f32) -> Option<Self> {
        Some(Self { ray, slab: Slab::new::<ROBUST>(ray, region)?, shear: Shear::new(ray)? })
    }
}
