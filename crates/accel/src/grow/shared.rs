//! The top of the tree: long ranges are split one after the other, each by all threads together; then every thread
//! takes subtrees.
use rayon::prelude::*;

use super::{
    Primitives,
    binary::{Item, Node},
    bins::{Bins, Plane, Slices},
    hull::Hull,
    partition::{self, Around},
    top_down::{Grower, Plot, Subtree},
};
use crate::simd::{roomy, widest};

/// Ranges longer than this are split by all threads together.
const SHARED: usize = 1 << 14;
/// Items that one thread looks at at a time.
pub(super) const CHUNK: usize = 1 << 12;

/// The top of a tree with something in place of what is below: `Plot`s at first, then nodes.
pub(super) enum Top<T> {
    Split { hull: Hull, middle: usize, below: Box<[Top<T>; 2]> },
    Task(T),
}

/// The box around items, of which there is at least one, and that around their centres.
pub(super) fn around(items: &[Item]) -> Around {
    let chunks = items.par_chunks(CHUNK).map(Around::new);
    chunks.reduce_with(Around::joined).expect("at least one item")
}

/// This many items, which all threads touch first, on big pages.
fn blank(count: usize) -> Vec<Item> {
    let mut items = roomy(count);
    items.par_extend(rayon::iter::repeat_n(Item::ZERO, count).with_min_len(CHUNK));
    items
}

/// Grows the subtrees over all items.
pub(super) fn grow<P: Primitives>(grower: &Grower<P>, plot: Plot, items: &mut [Item]) -> Top<Vec<Item>> {
    let mut spare = if items.len() > SHARED { blank(items.len()) } else { Vec::new() };
    let top = split(grower, plot, items, &mut spare, false);
    drop(spare);
    run(grower, top, items, 0)
}

/// Splits while ranges are long. At each level items move from one of two places to the other; they end in that which
/// they are `away` from, if they are.
fn split<P: Primitives>(
    grower: &Grower<P>,
    plot: Plot,
    items: &mut [Item],
    other: &mut [Item],
    away: bool,
) -> Top<Plot> {
    if items.len() <= SHARED {
        if away {
            other.copy_from_slice(items);
        }
        return Top::Task(plot);
    }
    let (middle, around, moved) = match divide(grower, &plot, items, other) {
        Some((middle, around)) => (middle, around, true),
        None => {
            let (middle, around) = plot.halve(items);
            (middle, around, false)
        }
    };
    let (items, other) = if moved { (other, items) } else { (items, other) };
    let (items, others) = (items.split_at_mut(middle), other.split_at_mut(middle));
    let [left, right] = plot.split(middle, around);
    let left = split(grower, left, items.0, others.0, away != moved);
    let right = split(grower, right, items.1, others.1, away != moved);
    Top::Split { hull: plot.around.hull, middle, below: Box::new([left, right]) }
}

/// Moves a range, split by the surface area heuristic, to another place, if there is such a split.
fn divide<P: Primitives>(
    grower: &Grower<P>,
    plot: &Plot,
    items: &[Item],
    other: &mut [Item],
) -> Option<(usize, [Around; 2])> {
    if !plot.has_levels_for(items.len()) {
        return None;
    }
    let mut known = plot.around;
    let (plane, counts) = plane(grower, &known, items).or_else(|| {
        known = around(items);
        plane(grower, &known, items)
    })?;
    Some((partition::to_sides(items, other, &plane, counts), known.sides(&plane)))
}

/// The cheapest plane, and how many items of each chunk are left of it.
fn plane<P: Primitives>(grower: &Grower<P>, around: &Around, items: &[Item]) -> Option<(Plane, Vec<usize>)> {
    let slices = Slices::new(&around.centers, items.len());
    let parts: Vec<Bins> = items.par_chunks(CHUNK).map(|chunk| Bins::new(&slices, chunk)).collect();
    let plane = Bins::sum(&parts).best(&slices, items.len(), &grower.unit)?;
    let counts = parts.iter().map(|part| part.count_left(&plane)).collect();
    Some((plane, counts))
}

/// Grows what is below the top of a tree over items, of which the first is number `first` of all.
pub(super) fn run<P: Primitives>(
    grower: &Grower<P>,
    top: Top<Plot>,
    items: &mut [Item],
    first: u32,
) -> Top<Vec<Item>> {
    match top {
        Top::Split { hull, middle, below } => {
            let [left, right] = *below;
            let (items_left, items_right) = items.split_at_mut(middle);
            let (left, right) = rayon::join(
                || run(grower, left, items_left, first),
                || run(grower, right, items_right, first + middle as u32),
            );
            Top::Split { hull, middle, below: Box::new([left, right]) }
        }
        Top::Task(plot) => Top::Task(widest(Subtree { grower, plot: Plot { first, ..plot }, items })),
    }
}

impl Top<Vec<Item>> {
    /// All nodes, which then point to places, in memory that `room` has held.
    pub(super) fn assembled(self, room: Vec<Item>) -> Vec<Item> {
        let mut nodes = room;
        nodes.resize(self.len(), Item::ZERO);
        nodes.shrink_to_fit();
        self.place(&mut nodes, 0);
        nodes
    }

    fn len(&self) -> usize {
        match self {
            Self::Split { below, .. } => 1 + below[0].len() + below[1].len(),
            Self::Task(nodes) => nodes.len(),
        }
    }

    /// Writes all nodes, the first of which is number `base` of all.
    fn place(self, nodes: &mut [Item], base: u32) {
        match self {
            Self::Split { hull, below, .. } => {
                let [left, right] = *below;
                let (left_place, right_place) = (base + 1, base + 1 + left.len() as u32);
                let Some((node, rest)) = nodes.split_first_mut() else { return };
                *node = Item::inner(&hull, [left_place, right_place]);
                let (first, second) = rest.split_at_mut(left.len());
                rayon::join(|| left.place(first, left_place), || right.place(second, right_place));
            }
            Self::Task(subtree) => {
                for ((node, to), place) in subtree.into_iter().zip(nodes).zip(base..) {
                    *to = match node.node() {
                        Node::Inner([left, right]) => Item::inner(&node.0, [place + left, place + right]),
                        Node::Leaf { .. } => node,
                    };
                }
            }
        }
    }
}
