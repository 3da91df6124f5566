//! Growing a tree of lights: from the top, by the split of least cost among buckets along an axis.
use durer_core::math::{Point3, Vector3};

use super::{LightBounds, NONE, Node};

/// Buckets along an axis.
const BUCKETS: usize = 12;
/// From this depth on halves are equal, so that no tree is deeper than [`super::DEEPEST`].
const EQUAL: usize = 24;
/// Up to so many lights all three axes are tried, beyond it the longest.
const MANY: usize = 4096;

/// A light to be put into a tree.
pub(super) struct Item {
    index: u32,
    center: Point3,
    known: LightBounds,
}

impl Item {
    pub(super) fn new(index: u32, known: LightBounds) -> Self {
        Self { index, center: known.bounds.center(), known }
    }
}

/// A tree that grows.
pub(super) struct Growing {
    pub(super) nodes: Vec<Node>,
    /// The leaf of each light.
    pub(super) leaves: Vec<u32>,
}

impl Growing {
    /// Fills node `at` with these lights, of which there is at least one.
    pub(super) fn fill(&mut self, at: u32, items: &mut [Item], depth: usize) -> LightBounds {
        if let [only] = items {
            self.nodes[at as usize].set(&only.known, only.index, true);
            self.leaves[only.index as usize] = at;
            return only.known;
        }
        let middle = split(items, depth);
        let first = self.nodes.len() as u32;
        let child = Node { parent: at, ..Node::default() };
        self.nodes.extend([child, child]);
        let (low, high) = items.split_at_mut(middle);
        let known = self.fill(first, low, depth + 1).union(self.fill(first + 1, high, depth + 1));
        self.nodes[at as usize].set(&known, first, false);
        known
    }

    /// Room for `count` lights, with an empty root.
    pub(super) fn new(count: usize) -> Self {
        Self { nodes: vec![Node { parent: NONE, ..Node::default() }], leaves: vec![NONE; count] }
    }
}

fn along(v: Vector3, axis: usize) -> f32 {
    [v.x, v.y, v.z][axis]
}

/// Puts the items into the order of a split; how many belong to its first part.
fn split(items: &mut [Item], depth: usize) -> usize {
    let low = items.iter().fold(Point3::splat(f32::INFINITY), |low, i| low.min(i.center));
    let high = items.iter().fold(Point3::splat(f32::NEG_INFINITY), |high, i| high.max(i.center));
    let extent = high - low;
    let longest = (0..3).max_by(|&a, &b| along(extent, a).total_cmp(&along(extent, b))).unwrap_or(0);
    let half = items.len() / 2;
    if along(extent, longest) <= 0.0 {
        return half;
    }
    if depth < EQUAL {
        let place = |item: &Item, axis: usize| {
            let t = along(item.center - low, axis) / along(extent, axis);
            ((t * BUCKETS as f32) as usize).min(BUCKETS - 1)
        };
        let axes = if items.len() > MANY { longest..longest + 1 } else { 0..3 };
        let candidates = axes.filter(|&axis| along(extent, axis) > 0.0).filter_map(|axis| {
            let (bucket, cost) = cheapest(items, |item| place(item, axis))?;
            // Thin nodes are seen under more angles than their measure says (section 4.4).
            Some((cost * along(extent, longest) / along(extent, axis), axis, bucket))
        });
        if let Some((_, axis, bucket)) = candidates.min_by(|a, b| a.0.total_cmp(&b.0)) {
            items.sort_by_key(|item| place(item, axis) >= bucket);
            return items.partition_point(|item| place(item, axis) < bucket);
        }
    }
    items.select_nth_unstable_by(half, |a, b| {
        along(a.center - low, longest).total_cmp(&along(b.center - low, longest)).then(a.index.cmp(&b.index))
    });
    half
}

/// The bucket before which a split is cheapest, and its cost; `None` if all items lie in the same bucket.
fn cheapest(items: &[Item], place: impl Fn(&Item) -> usize) -> Option<(usize, f32)> {
    let mut buckets = [(LightBounds::NOTHING, 0usize); BUCKETS];
    for item in items {
        let (known, count) = &mut buckets[place(item)];
        *known = known.union(item.known);
        *count += 1;
    }
    let mut above = [(0.0, 0); BUCKETS];
    let (mut known, mut count) = (LightBounds::NOTHING, 0);
    for i in (1..BUCKETS).rev() {
        known = known.union(buckets[i].0);
        count += buckets[i].1;
        above[i] = (known.cost(), count);
    }
    let (mut known, mut count) = (LightBounds::NOTHING, 0);
    let mut best = None;
    for i in 1..BUCKETS {
        known = known.union(buckets[i - 1].0);
        count += buckets[i - 1].1;
        let cost = known.cost() + above[i].0;
        if count > 0 && above[i].1 > 0 && best.is_none_or(|(_, least)| cost < least) {
            best = Some((i, cost));
        }
    }
    best
}
