//! A ray in one space, with what tests of boxes and triangles need of it.
use durer_core::math::Ray;

use crate::{
    slab::{Measured, Slab},
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
    /// For a valid ray.
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &'r Ray, measured: &Measured) -> Self {
        Self { ray, slab: Slab::new::<ROBUST>(measured), shear: Shear::of_valid(measured) }
    }

    /// For rays that are odd.
    #[cold]
    #[inline(never)]
    pub(crate) fn mend<const ROBUST: bool>(&mut self, region: f32) {
        let measured = Measured::of(self.ray);
        self.slab = Slab::odd::<ROBUST>(&measured, region);
        if ROBUST && measured.is_far(region) {
            self.shear.distrust();
        }
    }
}

/// Declares `$space` for a ray and a region, or leaves the function if the ray can hit nothing.
macro_rules! enter_space {
    ($space:ident, $robust:expr, $ray:expr, $region:expr) => {
        let measured = $crate::slab::Measured::of($ray);
        if !measured.is_valid() {
            return Default::default();
        }
        let mut $space = $crate::space::Space::new::<$robust>($ray, &measured);
        if measured.is_odd($region) {
            $space.mend::<$robust>($region);
        }
    };
}
pub(crate) use enter_space;
