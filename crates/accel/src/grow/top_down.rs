//! From references to a binary tree, top down: one thread.
//!
//! Where no plane splits (equal centres, no areas), or the tree would get deeper than allowed, items are halved by rank.
use std::ops::Range;

use rayon::prelude::*;

use super::{
    DEPTH_MAX, Primitives,
    binary::{Binary, Item},
    bins::{Bins, Plane, Slices},
    hull::{AreaUnit, Hull},
    partition::{self, Around},
    shared::{self, CHUNK, Top},
};
use crate::simd::{Work, roomy};

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

/// A range that is to be grown.
struct Pending {
    plot: Plot,
    items: Range<usize>,
    /// The node whose right child it is.
    parent: Option<usize>,
}

/// The subtree over some items, by one thread.
pub(super) struct Subtree<'a, 'b, P> {
    pub(super) grower: &'a Grower<'b, P>,
    pub(super) plot: Plot,
    pub(super) items: &'a mut [Item],
}

impl<P: Primitives> Work for Subtree<'_, '_, P> {
    /// The nodes, which point to their children by the distance.
    type Output = Vec<Item>;

    #[inline(always)]
    fn run(self) -> Vec<Item> {
        let Self { grower, plot, items } = self;
        let mut nodes: Vec<Item> = Vec::with_capacity(2 * items.len().div_ceil(grower.leaf_max));
        let mut bins = [Bins::EMPTY; 2];
        let mut pending = vec![Pending { plot, items: 0..items.len(), parent: None }];
        while let Some(Pending { mut plot, items: mut range, parent }) = pending.pop() {
            if let Some(parent) = parent {
                nodes[parent] = Item::inner(&nodes[parent].0, [1, (nodes.len() - parent) as u32]);
            }
            // Down to the left, right siblings are left for later.
            loop {
                let items = &mut items[range.clone()];
                if grower.is_leaf(items) {
                    nodes.push(Item::leaf(&plot.around.hull, plot.first, items.len()));
                    break;
                }
                let (middle, around) =
                    grower.divide(&plot, items, &mut bins).unwrap_or_else(|| plot.halve(items));
                let [left, right] = plot.split(middle, around);
                let middle = range.start + middle;
                pending.push(Pending { plot: right, items: middle..range.end, parent: Some(nodes.len()) });
                nodes.push(Item(plot.around.hull));
                (plot, range) = (left, range.start..middle);
            }
        }
        nodes
    }
}

impl<P: Primitives> Grower<'_, P> {
    #[inline(always)]
    fn is_leaf(&self, items: &[Item]) -> bool {
        let packs = |item: &Item| self.prims.packs(item.prim());
        items.len() == 1 || items.len() <= self.leaf_max && items.iter().all(packs)
    }

    /// Splits two or more items by the surface area heuristic, if that can.
    #[inline(always)]
    fn divide(&self, plot: &Plot, items: &mut [Item], bins: &mut [Bins; 2]) -> Option<(usize, [Around; 2])> {
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
    fn plane(&self, around: &Around, items: &[Item], bins: &mut [Bins; 2]) -> Option<Plane> {
        let slices = Slices::new(&around.centers, items.len());
        Bins::fill(bins, &slices, items);
        bins[0].best(&slices, items.len(), &self.unit)
    }
}
