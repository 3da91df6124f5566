//! Sorts items to the two sides of a split.
use rayon::prelude::*;

use super::{binary::Item, bins::Plane, hull::Hull, shared::CHUNK};
use crate::simd::{Work, widest};

/// The box around the items of a range and one around their centres (doubled).
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub(super) hull: Hull,
    pub(super) centers: Hull,
}

impl Around {
    pub(super) fn new(items: &[Item]) -> Self {
        let empty = Self { hull: Hull::EMPTY, centers: Hull::EMPTY };
        items.iter().fold(empty, |a, item| Self {
            hull: a.hull.joined(item.0),
            centers: a.centers.with(item.center()),
        })
    }
    pub(super) fn joined(self, o: Self) -> Self {
        Self { hull: self.hull.joined(o.hull), centers: self.centers.joined(o.centers) }
    }

    /// The two sides of a plane, the boxes around centres from what is known without looking: they lie between the
    /// plane and the old box, and within the box around the items.
    #[inline(always)]
    pub(super) fn sides(&self, plane: &Plane) -> [Self; 2] {
        let side = |hull: Hull| {
            let lo = self.centers.lo.fast_max(hull.lo + hull.lo);
            let hi = self.centers.hi.fast_min(hull.hi + hull.hi);
            Self { hull, centers: Hull { lo, hi } }
        };
        let (mut left, mut right) = (side(plane.hulls[0]), side(plane.hulls[1]));
        let end = &mut left.centers.hi.as_mut_array()[plane.axis];
        *end = end.min(plane.at);
        let begin = &mut right.centers.lo.as_mut_array()[plane.axis];
        *begin = begin.max(plane.at);
        [left, right]
    }
}

/// Moves the items left of `plane` to the front; returns how many.
#[inline(always)]
#[expect(clippy::manual_swap, reason = "swapped items pass through memory")]
pub(super) fn by_plane(items: &mut [Item], plane: &Plane) -> usize {
    let mut left = 0;
    // No branch to predict: an item on the right changes places with another on the right.
    for i in 0..items.len() {
        // PERF: asked where it lies: for one of its lanes it would pass through memory (bench kernel, build).
        let is_left = plane.is_left(&items[i]);
        let item = items[i];
        items[i] = items[left];
        items[left] = item;
        left += usize::from(is_left);
    }
    left
}

/// Copies the items left of `plane` to the front of `to`, the others behind them, by chunks in parallel. `counts` says
/// how many of each chunk go left. Returns how many do; both sides keep their order.
pub(super) fn to_sides(items: &[Item], to: &mut [Item], plane: &Plane, counts: Vec<usize>) -> usize {
    let middle = counts.iter().sum();
    let (mut left, mut right) = to.split_at_mut(middle);
    let mut places = Vec::with_capacity(counts.len());
    for (chunk, count) in items.chunks(CHUNK).zip(counts) {
        let (to_left, rest_left) = left.split_at_mut(count);
        let (to_right, rest_right) = right.split_at_mut(chunk.len() - count);
        (left, right) = (rest_left, rest_right);
        places.push((chunk, [to_left, to_right]));
    }
    places.into_par_iter().for_each(|(items, to)| widest(Deal { items, to, plane }));
    middle
}

/// Copies items, in their order, to the two sides of a plane.
struct Deal<'a> {
    items: &'a [Item],
    to: [&'a mut [Item]; 2],
    plane: &'a Plane,
}

impl Work for Deal<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let mut next = [0; 2];
        for item in self.items {
            let side = usize::from(!self.plane.is_left(item));
            self.to[side][next[side]] = *item;
            next[side] += 1;
        }
    }
}

/// Half the items by rank of their centres along the widest axis, equals by primitive; as they lie where centres say
/// nothing.
pub(super) fn halve(items: &mut [Item], centers: &Hull) -> usize {
    let middle = items.len() / 2;
    let extent = centers.extent();
    let axis = (1..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
    if extent[axis] > 0.0 {
        let at = |item: &Item| item.center_on(axis);
        items.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)).then(a.prim().cmp(&b.prim())));
    }
    middle
}
