//! The cheapest plane between bins (Wald 2007, section 3): items fall into slices by their centres, and the cost
//! `A_l n_l + A_r n_r` of each plane between slices follows from two sweeps, all three axes at once.
use wide::f32x4;

use super::{
    binary::Item,
    hull::{AreaUnit, Hull},
};

/// Slices an axis at most.
pub(super) const BINS: usize = 16;

/// Which slice a centre falls into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slices {
    count: usize,
    origin: f32x4,
    /// Slices per unit of length; 0 where all centres agree.
    scale: f32x4,
    last: f32x4,
}

/// A plane between slices: those below `bin` go left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) axis: usize,
    pub(super) bin: usize,
    pub(super) cost: f32,
}

impl Slices {
    /// For `n` items whose centres are in `centers`.
    pub(super) fn new(centers: &Hull, n: usize) -> Self {
        let count = (4 + n / 2).min(BINS);
        let scale = centers.extent().map(|extent| {
            let scale = count as f32 / extent;
            if scale.is_finite() { scale } else { 0.0 }
        });
        let last = f32x4::splat((count - 1) as f32);
        let [x, y, z] = scale;
        Self { count, origin: centers.lo, scale: f32x4::new([x, y, z, 0.0]), last }
    }

    /// Slices of a centre on the three axes; NaN counts as 0.
    #[inline(always)]
    fn of(&self, center: f32x4) -> [i32; 4] {
        let place = (center - self.origin) * self.scale;
        place.fast_max(f32x4::ZERO).fast_min(self.last).fast_trunc_int().to_array()
    }

    /// Whether an item goes left of a plane.
    #[inline(always)]
    pub(super) fn is_left(&self, item: &Item, plane: &Plane) -> bool {
        let at = |v: &f32x4| v.as_array()[plane.axis];
        let place = (at(&item.center()) - at(&self.origin)) * at(&self.scale);
        // The same decision as `of`.
        place < plane.bin as f32 || place.is_nan()
    }
}

/// What has fallen into slices.
#[derive(Clone)]
pub(super) struct Bins {
    hulls: [[Hull; 3]; BINS],
    counts: [[i32; 4]; BINS],
}

impl Bins {
    pub(super) const EMPTY: Self = Self { hulls: [[Hull::EMPTY; 3]; BINS], counts: [[0; 4]; BINS] };

    #[inline(always)]
    pub(super) fn fill(&mut self, slices: &Slices, items: &[Item]) {
        for item in items {
            let places = slices.of(item.center());
            for (axis, place) in places.into_iter().enumerate().take(3) {
                let bin = place as usize % BINS;
                let hull = &mut self.hulls[bin][axis];
                *hull = hull.joined(item.0);
                self.counts[bin][axis] += 1;
            }
        }
    }

    /// Both together.
    pub(super) fn merged(mut self, o: &Self) -> Self {
        for bin in 0..BINS {
            for axis in 0..3 {
                self.hulls[bin][axis] = self.hulls[bin][axis].joined(o.hulls[bin][axis]);
                self.counts[bin][axis] += o.counts[bin][axis];
            }
        }
        self
    }

    /// The cheapest plane that has some of the `n` items on both sides; of equals the first. `None` if there is none, or
    /// if all sides are without area so that costs say nothing.
    pub(super) fn best(&self, slices: &Slices, n: usize, unit: &AreaUnit) -> Option<Plane> {
        let number = |bin: usize| f32x4::from(self.counts[bin].map(|c| c as f32));
        let mut right = [f32x4::ZERO; BINS];
        let (mut hulls, mut count) = ([Hull::EMPTY; 3], f32x4::ZERO);
        for bin in (1..slices.count).rev() {
            join(&mut hulls, &self.hulls[bin]);
            count += number(bin);
            right[bin] = unit.areas(&hulls) * count;
        }
        let all = f32x4::splat(n as f32);
        let worst = f32x4::splat(f32::INFINITY);
        let (mut least, mut place) = (worst, f32x4::ZERO);
        (hulls, count) = ([Hull::EMPTY; 3], f32x4::ZERO);
        for (bin, right) in right.into_iter().enumerate().take(slices.count).skip(1) {
            join(&mut hulls, &self.hulls[bin - 1]);
            count += number(bin - 1);
            let cost = unit.areas(&hulls) * count + right;
            let better = cost.simd_lt(least) & count.simd_gt(f32x4::ZERO) & count.simd_lt(all);
            least = better.bitselect(cost, least);
            place = better.bitselect(f32x4::splat(bin as f32), place);
        }
        let (least, place) = (least.to_array(), place.to_array());
        let axis = (1..3).fold(0, |best, axis| if least[axis] < least[best] { axis } else { best });
        let plane = Plane { axis, bin: place[axis] as usize, cost: least[axis] };
        (plane.cost > 0.0 && plane.cost < f32::INFINITY).then_some(plane)
    }
}

#[inline(always)]
fn join(hulls: &mut [Hull; 3], more: &[Hull; 3]) {
    for axis in 0..3 {
        hulls[axis] = hulls[axis].joined(more[axis]);
    }
}
