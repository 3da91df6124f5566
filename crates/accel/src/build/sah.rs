//! Builds a tree top down by the surface area heuristic over bins (Wald 2007, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies").
//!
//! The cost of a split is `1 + (A_l n_l + A_r n_r) / A`, that of a leaf `n`. Where no plane splits (equal centres,
//! areas that overflow) or the tree gets deep, the items are halved by rank instead, so depth stays below 64.
use durer_core::math::{Bounds3, Point3};

use super::{BuildOptions, Engine};
use crate::tree::{DEPTH_MAX, Node, Pair, Tree};

/// Below this depth halves are taken by rank: 2^31 items need 31 more levels.
const DEPTH_SAH: u32 = DEPTH_MAX as u32 - 32;
const BINS_MAX: usize = 32;

/// An item to be sorted into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds3,
    center: Point3,
    index: u32,
}

/// A node whose children are still to be made: items `begin..end` belong to node `name`.
struct Task {
    name: u32,
    begin: usize,
    end: usize,
    depth: u32,
}

/// A plane between two bins.
struct Split {
    axis: usize,
    /// Bins below this one go left.
    bin: usize,
    cost: f32,
}

/// The tree over `boxes` and, leaf by leaf, the indices of the boxes. Those that are not finite come last, outside the
/// tree; by brute force all do.
pub(crate) fn grow(boxes: impl Iterator<Item = Bounds3>, options: &BuildOptions) -> (Tree, Vec<u32>) {
    let all = (0u32..).zip(boxes);
    if options.engine == Engine::BruteForce {
        let order: Vec<u32> = all.map(|(i, _)| i).collect();
        return (Tree::list(order.len()), order);
    }
    let (mut items, mut aside) = (Vec::new(), Vec::new());
    for (index, bounds) in all {
        if bounds.is_finite() {
            items.push(Item { bounds, center: bounds.center(), index });
        } else {
            aside.push(index);
        }
    }
    let mut tree = Tree::list(items.len() + aside.len());
    if !items.is_empty() {
        fill(&mut tree, &mut items, options);
    }
    let order = items.iter().map(|i| i.index).chain(aside).collect();
    (tree, order)
}

fn fill(tree: &mut Tree, items: &mut [Item], options: &BuildOptions) {
    tree.bounded = items.len();
    tree.root = leaf(items, 0);
    let mut tasks = vec![Task { name: 0, begin: 0, end: items.len(), depth: 0 }];
    while let Some(Task { name, begin, end, depth }) = tasks.pop() {
        tree.depth = tree.depth.max(depth);
        let Some(middle) = divide(&mut items[begin..end], depth, options) else {
            continue;
        };
        let middle = begin + middle;
        let link = tree.pairs.len() as u32;
        let children = [leaf(&items[begin..middle], begin), leaf(&items[middle..end], middle)];
        tree.pairs.push(Pair(children));
        let parent = match name.checked_sub(1) {
            None => &mut tree.root,
            Some(i) => &mut tree.pairs[i as usize / 2].0[i as usize % 2],
        };
        (parent.link, parent.count) = (link, 0);
        let below = |side: u32, begin, end| Task { name: 1 + 2 * link + side, begin, end, depth: depth + 1 };
        tasks.push(below(1, middle, end));
        tasks.push(below(0, begin, middle));
    }
}

/// `Bounds3::union` for boxes without NaN: one instruction per coordinate.
#[inline(always)]
fn joined(a: Bounds3, b: Bounds3) -> Bounds3 {
    let lesser = |a: f32, b: f32| if a < b { a } else { b };
    let greater = |a: f32, b: f32| if a > b { a } else { b };
    let (min, max) = (a.min, a.max);
    Bounds3 {
        min: Point3::new(lesser(min.x, b.min.x), lesser(min.y, b.min.y), lesser(min.z, b.min.z)),
        max: Point3::new(greater(max.x, b.max.x), greater(max.y, b.max.y), greater(max.z, b.max.z)),
    }
}

fn around(boxes: impl Iterator<Item = Bounds3>) -> Bounds3 {
    boxes.fold(Bounds3::EMPTY, joined)
}

fn leaf(items: &[Item], first: usize) -> Node {
    let bounds = around(items.iter().map(|i| i.bounds));
    Node::new(&bounds, first as u32, items.len() as u32)
}

/// Orders `items` so that the first so many make the left child; `None` to leave them in one leaf.
fn divide(items: &mut [Item], depth: u32, options: &BuildOptions) -> Option<usize> {
    if items.len() <= 1 {
        return None;
    }
    let must = items.len() > options.leaf_max as usize;
    if depth >= DEPTH_SAH {
        return must.then(|| halve(items));
    }
    let bins = Bins::new(items, options);
    match bins.best(items) {
        Some(split) if must || split.cost < items.len() as f32 => {
            Some(partition(items, |i| bins.of(i.center, split.axis) < split.bin))
        }
        _ => must.then(|| halve(items)),
    }
}

/// Half the items by rank of their centres along the widest axis; ties by index, so the result is determined.
fn halve(items: &mut [Item]) -> usize {
    let axis = Bounds3::around(items.iter().map(|i| i.center)).diagonal().max_axis();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        a.center[axis].total_cmp(&b.center[axis]).then(a.index.cmp(&b.index))
    });
    middle
}

/// Moves the items that go left to the front; returns how many.
fn partition(items: &mut [Item], left: impl Fn(&Item) -> bool) -> usize {
    let mut n = 0;
    for i in 0..items.len() {
        if left(&items[i]) {
            items.swap(n, i);
            n += 1;
        }
    }
    n
}

/// Equal slices of the box around the centres.
struct Bins {
    count: usize,
    origin: Point3,
    /// Bins per unit of length; 0 where all centres agree.
    scale: [f32; 3],
}

impl Bins {
    fn new(items: &[Item], options: &BuildOptions) -> Self {
        // More bins than twice the items find no better plane.
        let count = (options.bins as usize).min(2 * items.len()).clamp(2, BINS_MAX);
        let centers = around(items.iter().map(|i| Bounds3 { min: i.center, max: i.center }));
        let scale = centers.diagonal().to_array().map(|extent| {
            let scale = count as f32 / extent;
            if scale.is_finite() { scale } else { 0.0 }
        });
        Self { count, origin: centers.min, scale }
    }
    fn of(&self, center: Point3, axis: usize) -> usize {
        // `as` saturates and turns NaN into 0.
        (((center[axis] - self.origin[axis]) * self.scale[axis]) as usize).min(self.count - 1)
    }

    /// The cheapest plane, if any leaves items on both sides.
    fn best(&self, items: &[Item]) -> Option<Split> {
        let whole = around(items.iter().map(|i| i.bounds)).half_area();
        (0..3)
            .filter(|&axis| self.scale[axis] > 0.0)
            .filter_map(|axis| self.best_on(axis, items))
            .map(|s| Split { cost: 1.0 + s.cost / whole, ..s })
            .filter(|s| s.cost.is_finite())
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// The cheapest plane on one axis, cost in units of area.
    fn best_on(&self, axis: usize, items: &[Item]) -> Option<Split> {
        let mut bins = [(Bounds3::EMPTY, 0u32); BINS_MAX];
        for item in items {
            let (bounds, count) = &mut bins[self.of(item.center, axis)];
            *bounds = joined(*bounds, item.bounds);
            *count += 1;
        }
        // right[i]: everything from bin i on.
        let mut right = [(0f32, 0u32); BINS_MAX];
        let (mut bounds, mut count) = (Bounds3::EMPTY, 0);
        for i in (1..self.count).rev() {
            bounds = bounds.union(bins[i].0);
            count += bins[i].1;
            right[i] = (bounds.half_area(), count);
        }
        let (mut bounds, mut count) = (Bounds3::EMPTY, 0);
        let mut best: Option<Split> = None;
        for bin in 1..self.count {
            bounds = bounds.union(bins[bin - 1].0);
            count += bins[bin - 1].1;
            let (right_area, right_count) = right[bin];
            if count == 0 || right_count == 0 {
                continue;
            }
            let cost = bounds.half_area() * count as f32 + right_area * right_count as f32;
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(Split { axis, bin, cost });
            }
        }
        best
    }
}
