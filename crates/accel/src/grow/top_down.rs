//! From references to a binary tree, top down: one thread.
//!
//! Where no plane splits (equal centres, no areas), or the tree would get deeper than allowed, items are halved by rank.
use rayon::prelude::*;

use super::{
    DEPTH_MAX, Primitives,
    binary::{Binary, Item},
    bins::{Bins, Plane, Slices},
    hull::{AreaUnit, Hull},
    partition::{self, Around},
    shared::{self, CHUNK, Top},
};
use crate::simd::roomy;

/// What is known of a range of items.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plot {
    /// Where it begins among all items.
    pub(super) first: u32,
    /// Levels above.
    pub(super) depth: u32,
    pub(super) around: Around,
}

/// What all ranges have in common.
pub(super) struct Grower<'a, P> {
    pub(super) prims: &'a P,
    pub(super) unit: AreaUnit,
    /// Most primitives in a leaf of the binary tree.
    pub(super) leaf_max: usize,
}

/// References to all primitives, of which there is at least one, and the unit for areas of boxes around them.
pub(super) fn references(prims: &impl Primitives) -> (Vec<Item>, AreaUnit) {
    let reference = |prim: u32| Item::reference(&Hull::new(&prims.bounds(prim)), prim);
    let mut items: Vec<Item> = roomy(prims.len());
    items.par_extend((0..prims.len() as u32).into_par_iter().with_min_len(CHUNK).map(reference));
    let unit = AreaUnit::new(&shared::around(&items).hull);
    (items, unit)
}

/// The tree over one item or more, with up to `leaf_max` of those that pack in a leaf; its top may exist already.
pub(super) fn build(
    prims: &impl Primitives,
    mut items: Vec<Item>,
    top: Option<Top<Plot>>,
    unit: AreaUnit,
    leaf_max: usize,
) -> Binary {
    let grower = Grower { prims, unit, leaf_max };
    let subtrees = match top {
        Some(top) => shared::run(&grower, top, &mut items, 0),
        None => {
            let around = shared::around(&items);
            shared::grow(&grower, Plot { first: 0, depth: 0, around }, &mut items)
        }
    };
    let order = items.par_iter().with_min_len(CHUNK).map(Item::prim).collect();
    Binary { nodes: subtrees.assembled(items), order, unit }
}

impl Plot {
    /// Whether a tree over `n` items that begins here may be split any way: halving just reaches single items at the
    /// last level.
    pub(super) fn has_levels_for(&self, n: usize) -> bool {
        self.depth + n.next_power_of_two().trailing_zeros() + 1 < DEPTH_MAX
    }

    /// The two parts of a split range.
    pub(super) fn split(&self, middle: usize, around: [Around; 2]) -> [Self; 2] {
        let (first, depth) = (self.first, self.depth + 1);
        [
            Self { first, depth, around: around[0] },
            Self { first: first + middle as u32, depth, around: around[1] },
        ]
    }

    /// Halves a range.
    pub(super) fn halve(&self, items: &mut [Item]) -> (usize, [Around; 2]) {
        let middle = partition::halve(items, &self.around.centers);
        let (left, right) = items.split_at(middle);
        (middle, [Around::new(left), Around::new(right)])
    }
}

impl<P: Primitives> Grower<'_, P> {
    /// Appends the nodes over a range. They point to their children by the distance. What `bins` hold does not matter.
    pub(super) fn grow(&self, plot: Plot, items: &mut [Item], nodes: &mut Vec<Item>, bins: &mut Bins) {
        let (hull, n) = (plot.around.hull, items.len());
        let packs = |item: &Item| self.prims.packs(item.prim());
        if n == 1 || n <= self.leaf_max && items.iter().all(packs) {
            nodes.push(Item::leaf(&hull, plot.first, n));
            return;
        }
        let node = nodes.len();
        nodes.push(Item::ZERO);
        let (middle, around) = self.divide(&plot, items, bins).unwrap_or_else(|| plot.halve(items));
        let [left, right] = plot.split(middle, around);
        let (items_left, items_right) = items.split_at_mut(middle);
        self.grow(left, items_left, nodes, bins);
        let right_place = (nodes.len() - node) as u32;
        self.grow(right, items_right, nodes, bins);
        nodes[node] = Item::inner(&hull, [1, right_place]);
    }

    /// Splits two or more items by the surface area heuristic, if that can.
    #[inline(never)]
    fn divide(&self, plot: &Plot, items: &mut [Item], bins: &mut Bins) -> Option<(usize, [Around; 2])> {
        if !plot.has_levels_for(items.len()) {
            return None;
        }
        let mut around = plot.around;
        let plane = self.plane(&around, items, bins).or_else(|| {
            // What was known of the centres may have been too wide.
            around = Around::new(items);
            self.plane(&around, items, bins)
        })?;
        Some((partition::by_plane(items, &plane), around.sides(&plane)))
    }

    #[inline(always)]
    fn plane(&self, around: &Around, items: &[Item], bins: &mut Bins) -> Option<Plane> {
        let slices = Slices::new(&around.centers, items.len());
        bins.fill(&slices, items);
        bins.best(&slices, items.len(), &self.unit)
    }
}
