//! A ray in one space, with what tests of boxes and triangles need of it.
use durer_core::math::Ray;

use crate::{
    slab::{Slab, farthest, floor, is_far, is_odd},
    triangle::Shear,
};

/// A ray and its constants.
///
/// PERF: never in an `Option` and never handed over by value: what is written in parts and copied as a whole stalls, for
/// 10 to 20 ns a ray (bench kernel).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space<'r> {
    pub(crate) ray: &'r Ray,
    pub(crate) slab: Slab,
    pub(crate) shear: Shear,
}

impl<'r> Space<'r> {
    /// For a ray of this [`crate::slab::length`].
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &'r Ray, length: f32) -> Self {
        let slab = Slab::new::<ROBUST>(ray, length, floor(length));
        Self { ray, slab, shear: Shear::of_valid(ray) }
    }

    /// Whether [`Space::mend`] is needed among things whose coordinates are at most `region`.
    #[inline(always)]
    pub(crate) fn is_odd(ray: &Ray, length: f32, region: f32) -> bool {
        is_odd(ray, length, farthest(ray, region))
    }

    #[cold]
    #[inline(never)]
    pub(crate) fn mend<const ROBUST: bool>(&mut self, length: f32, region: f32) {
        let farthest = farthest(self.ray, region);
        self.slab = Slab::odd::<ROBUST>(self.ray, length, farthest);
        if is_far(length, farthest) {
            self.shear.distrust();
        }
    }
}

/// Declares `$space` for a ray and a region, or leaves the function if the ray can hit nothing.
macro_rules! enter_space {
    ($space:ident, $robust:expr, $ray:expr, $region:expr) => {
        let Some(length) = $crate::slab::length($ray) else { return Default::default() };
        let mut $space = $crate::space::Space::new::<$robust>($ray, length);
        if $crate::space::Space::is_odd($ray, length, $region) {
            $space.mend::<$robust>(length, $region);
        }
    };
}
pub(crate) use enter_space;
