//! A binary tree of boxes over a list of items, and how a ray walks it.
//!
//! Two children share one cache line. Items `0..bounded` lie in the tree; the rest have no finite box (infinite
//! planes) and are tested one after another. A tree with nothing bounded is a plain list: brute force.
use std::ops::Range;

use durer_core::math::Bounds3;

use crate::{
    hit::Hit,
    slab::{Slab, Window},
};

/// Longest way from the root to a leaf the builder makes, in edges.
pub(crate) const DEPTH_MAX: usize = 64;

/// A box and what it holds.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Node {
    pub(crate) min: [f32; 3],
    /// Inner node: which pair holds the children. Leaf: first item.
    pub(crate) link: u32,
    pub(crate) max: [f32; 3],
    /// Items of a leaf; 0 for an inner node.
    pub(crate) count: u32,
}

impl Node {
    pub(crate) fn new(bounds: &Bounds3, link: u32, count: u32) -> Self {
        Self { min: bounds.min.to_array(), link, max: bounds.max.to_array(), count }
    }
    pub(crate) fn bounds(&self) -> Bounds3 {
        Bounds3 { min: self.min.into(), max: self.max.into() }
    }
    fn items(&self) -> Range<usize> {
        let first = self.link as usize;
        first..first + self.count as usize
    }
}

/// Sibling nodes.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Pair(pub(crate) [Node; 2]);

/// The tree. A node is named by 0 (root) or `1 + 2 * pair + side`, plus `base` outside.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) root: Node,
    pub(crate) pairs: Vec<Pair>,
    /// Items in the tree.
    pub(crate) bounded: usize,
    /// All items.
    pub(crate) total: usize,
    /// Longest way from the root to a leaf, in edges.
    pub(crate) depth: u32,
    /// Nodes of all trees before this one in the `Accel`.
    pub(crate) base: u32,
}

/// What a walk meets.
pub(crate) trait Leaves {
    /// A node was entered.
    fn node(&mut self, node: u32);
    /// Offers every hit on these items to `best`.
    fn nearest(&mut self, items: Range<usize>, best: &mut Hit);
    /// Whether any of these items is hit.
    fn blocks(&mut self, items: Range<usize>) -> bool;
}

/// The part of a ray a walk may use.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
}

impl Tree {
    /// All `total` items in a plain list.
    pub(crate) fn list(total: usize) -> Self {
        let root = Node::new(&Bounds3::EMPTY, 0, 0);
        Self { root, pairs: Vec::new(), bounded: 0, total, depth: 0, base: 0 }
    }
    /// Number of nodes.
    pub(crate) fn len(&self) -> usize {
        if self.bounded == 0 { 0 } else { 1 + 2 * self.pairs.len() }
    }
    /// The node with this name, without `base`.
    pub(crate) fn node(&self, name: u32) -> &Node {
        match name.checked_sub(1) {
            None => &self.root,
            Some(i) => &self.pairs[i as usize / 2].0[i as usize % 2],
        }
    }

    /// Offers the hits on all items to `best`, whose `t` ends the ray.
    #[inline]
    pub(crate) fn nearest<L: Leaves>(&self, slab: &Slab, t_min: f32, best: &mut Hit, leaves: &mut L) {
        if self.bounded < self.total {
            leaves.nearest(self.bounded..self.total, best);
        }
        if self.bounded == 0 || !slab.window(&self.root.min, &self.root.max).admits(t_min, best.t) {
            return;
        }
        if self.pairs.is_empty() {
            leaves.node(self.base);
            leaves.nearest(self.root.items(), best);
            return;
        }
        self.nearest_below(slab, t_min, best, leaves);
    }

    fn nearest_below<L: Leaves>(&self, slab: &Slab, t_min: f32, best: &mut Hit, leaves: &mut L) {
        let mut stack = [(0u32, 0f32); DEPTH_MAX];
        let mut held = 0;
        let (mut name, mut node) = (0, &self.root);
        loop {
            leaves.node(self.base + name);
            if node.count > 0 {
                leaves.nearest(node.items(), best);
            } else {
                let (first, [a, b]) = (1 + 2 * node.link, &self.pairs[node.link as usize].0);
                let (wa, wb) = (slab.window(&a.min, &a.max), slab.window(&b.min, &b.max));
                match (wa.admits(t_min, best.t), wb.admits(t_min, best.t)) {
                    (true, true) => {
                        let swap = wb.near < wa.near;
                        let far = if swap { (first, wa.near) } else { (first + 1, wb.near) };
                        stack[held] = far;
                        held += 1;
                        (name, node) = if swap { (first + 1, b) } else { (first, a) };
                        continue;
                    }
                    (true, false) => {
                        (name, node) = (first, a);
                        continue;
                    }
                    (false, true) => {
                        (name, node) = (first + 1, b);
                        continue;
                    }
                    (false, false) => {}
                }
            }
            loop {
                if held == 0 {
                    return;
                }
                held -= 1;
                let (candidate, near) = stack[held];
                // A nearer hit may have been found since this was put aside.
                if near <= best.t {
                    name = candidate;
                    break;
                }
            }
            node = self.node(name);
        }
    }

    /// Whether any item is hit; returns at the first.
    #[inline]
    pub(crate) fn blocks<L: Leaves>(&self, slab: &Slab, span: Span, leaves: &mut L) -> bool {
        if self.bounded < self.total && leaves.blocks(self.bounded..self.total) {
            return true;
        }
        let admits = |w: Window| w.admits(span.t_min, span.t_max);
        if self.bounded == 0 || !admits(slab.window(&self.root.min, &self.root.max)) {
            return false;
        }
        if self.pairs.is_empty() {
            leaves.node(self.base);
            return leaves.blocks(self.root.items());
        }
        self.blocks_below(slab, span, leaves)
    }

    fn blocks_below<L: Leaves>(&self, slab: &Slab, span: Span, leaves: &mut L) -> bool {
        let admits = |w: Window| w.admits(span.t_min, span.t_max);
        let mut stack = [0u32; DEPTH_MAX];
        let mut held = 0;
        let (mut name, mut node) = (0, &self.root);
        loop {
            leaves.node(self.base + name);
            if node.count > 0 {
                if leaves.blocks(node.items()) {
                    return true;
                }
            } else {
                let (first, [a, b]) = (1 + 2 * node.link, &self.pairs[node.link as usize].0);
                let (in_a, in_b) = (admits(slab.window(&a.min, &a.max)), admits(slab.window(&b.min, &b.max)));
                if in_a && in_b {
                    stack[held] = first + 1;
                    held += 1;
                }
                if in_a || in_b {
                    (name, node) = if in_a { (first, a) } else { (first + 1, b) };
                    continue;
                }
            }
            if held == 0 {
                return false;
            }
            held -= 1;
            name = stack[held];
            node = self.node(name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_have_the_size_they_were_designed_for() {
        assert_eq!((size_of::<Node>(), size_of::<Pair>()), (32, 64));
    }
}
