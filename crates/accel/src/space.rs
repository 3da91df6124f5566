//! A ray in one space, with what tests of boxes and triangles need of it.
use durer_core::math::Ray;

use crate::{slab::Slab, triangle::Shear};

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
    /// For things whose coordinates are at most `region`, and a ray with this [`crate::slab::largest_component`].
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &'r Ray, largest: f32, region: f32) -> Self {
        Self { ray, slab: Slab::new::<ROBUST>(ray, largest, region), shear: Shear::of_valid(ray) }
    }
}

/// Declares `$space` for a ray and a region, or leaves the function if the ray can hit nothing.
macro_rules! enter_space {
    ($space:ident, $robust:expr, $ray:expr, $region:expr) => {
        let Some(largest) = $crate::slab::largest_component($ray) else { return Default::default() };
        let mut $space = $crate::space::Space::new::<$robust>($ray, largest, $region);
        if $crate::slab::Slab::is_odd($ray, largest, $region) {
            $space.slab.widen($ray, largest, $region);
        }
    };
}
pub(crate) use enter_space;
