//! Sorts items to the two sides of a split, in place.
use super::{
    binary::Item,
    bins::{Plane, Slices},
    hull::Hull,
};

/// The box around the items of a range and that around their centres (doubled).
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
}

/// Moves the items left of `plane` to the front; returns how many.
pub(super) fn by_plane(items: &mut [Item], slices: &Slices, plane: &Plane) -> usize {
    let (mut begin, mut end) = (0, items.len());
    loop {
        while begin < end && slices.is_left(&items[begin], plane) {
            begin += 1;
        }
        while begin < end && !slices.is_left(&items[end - 1], plane) {
            end -= 1;
        }
        if begin == end {
            return begin;
        }
        items.swap(begin, end - 1);
    }
}

/// Half the items by rank of their centres along the widest axis, equals by primitive; as they lie where centres say
/// nothing.
pub(super) fn halve(items: &mut [Item], centers: &Hull) -> usize {
    let middle = items.len() / 2;
    let extent = centers.extent();
    let axis = (1..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
    if extent[axis] > 0.0 {
        let at = |item: &Item| item.center().as_array()[axis];
        items.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)).then(a.prim().cmp(&b.prim())));
    }
    middle
}
