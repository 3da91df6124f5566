//! From references to a binary tree, top down.
//!
//! A subtree over n items has 2n - 1 nodes, so its nodes lie in preorder in a range that is known beforehand, and
//! threads fill disjoint slices. Where no plane splits (equal centres, no areas), or the tree would get deeper than
//! allowed, items are halved by rank.
use rayon::prelude::*;

use super::{
    DEPTH_MAX, Primitives,
    binary::{Binary, Item},
    bins::{Bins, Slices},
    hull::{AreaUnit, Hull},
    partition::{self, Around},
};

/// Ranges longer than this are left to another thread if one is idle.
const GRAIN: usize = 4096;
/// Items that one thread looks at together at the top of the tree.
const CHUNK: usize = 1 << 14;

/// A range of items and the slots for the nodes over them.
struct Range<'a> {
    items: &'a mut [Item],
    nodes: &'a mut [Item],
    first_item: u32,
    first_node: u32,
    /// Levels above.
    depth: u32,
    around: Around,
}

/// The tree over `prims`, of which there is at least one, down to single primitives.
pub(super) fn build(prims: &impl Primitives) -> Binary {
    let n = prims.len();
    let reference = |prim: usize| {
        let prim = prim as u32;
        Item::reference(&Hull::new(&prims.bounds(prim)), prim)
    };
    let mut items: Vec<Item> = (0..n).into_par_iter().with_min_len(GRAIN).map(reference).collect();
    let slots = 2 * n - 1;
    let mut nodes: Vec<Item> = (0..slots).into_par_iter().with_min_len(GRAIN).map(|_| Item::ZERO).collect();
    let around = items.par_chunks(CHUNK).map(Around::new).reduce_with(Around::joined);
    let around = around.expect("at least one item");
    let unit = AreaUnit::new(&around.hull);
    split(
        &unit,
        Range { items: &mut items, nodes: &mut nodes, first_item: 0, first_node: 0, depth: 0, around },
    );
    let order = items.par_iter().with_min_len(GRAIN).map(Item::prim).collect();
    Binary { nodes, order, unit }
}

fn split(unit: &AreaUnit, range: Range) {
    let Range { items, nodes, first_item, first_node, depth, around } = range;
    let n = items.len();
    let (node, below) = nodes.split_first_mut().expect("a slot for each node");
    if n == 1 {
        *node = Item::leaf(&around.hull, first_item, 1);
        return;
    }
    let middle = divide(unit, items, depth, &around);
    let (left, right) = items.split_at_mut(middle);
    let slots = 2 * middle - 1;
    let (nodes_left, nodes_right) = below.split_at_mut(slots);
    let (name_left, name_right) = (first_node + 1, first_node + 1 + slots as u32);
    *node = Item::inner(&around.hull, [name_left, name_right]);
    let depth = depth + 1;
    let (around_left, around_right) = (Around::new(left), Around::new(right));
    let left = Range {
        items: left,
        nodes: nodes_left,
        first_item,
        first_node: name_left,
        depth,
        around: around_left,
    };
    let first_item = first_item + middle as u32;
    let right = Range {
        items: right,
        nodes: nodes_right,
        first_item,
        first_node: name_right,
        depth,
        around: around_right,
    };
    if n > GRAIN {
        rayon::join(|| split(unit, left), || split(unit, right));
    } else {
        split(unit, left);
        split(unit, right);
    }
}

/// Orders two or more items so that the first so many make the left child.
#[inline(never)]
fn divide(unit: &AreaUnit, items: &mut [Item], depth: u32, around: &Around) -> usize {
    let n = items.len();
    if n == 2 {
        return 1;
    }
    // Halving from here on just reaches single items at the last level.
    let levels = n.next_power_of_two().trailing_zeros() + 1;
    if depth + levels < DEPTH_MAX {
        let slices = Slices::new(&around.centers, n);
        let mut bins = Bins::EMPTY;
        bins.fill(&slices, items);
        if let Some(plane) = bins.best(&slices, n, unit) {
            return partition::by_plane(items, &slices, &plane);
        }
    }
    partition::halve(items, &around.centers)
}
