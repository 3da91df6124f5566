//! Moves subtrees to where they cost less (Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding
//! Volume Hierarchies"; Meister, Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization").
//!
//! The cost of a binary tree is the sum of its nodes' areas. For some of the largest nodes the best new place is looked
//! for, all in the unchanged tree and in parallel; then the moves are made one after the other, the most promising
//! first. A move that does not pay any more after those before it is taken back, so the cost never rises.
use rayon::prelude::*;

use super::{
    binary::{Binary, Item, Node},
    hull::{AreaUnit, Hull},
};
use crate::simd::{Work, widest};

/// The root's parent.
const NONE: u32 = u32::MAX;
/// Nodes that one thread looks at at a time.
const CHUNK: usize = 256;

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Rounds.
    pub(super) rounds: usize,
    /// What fraction of all nodes is tried in the first round; in round i the i-th part of that.
    pub(super) fraction: f32,
}

impl Effort {
    pub(super) const NONE: Self = Self { rounds: 0, fraction: 0.0 };
    pub(super) const MOST: Self = Self { rounds: 8, fraction: 0.5 };
}

/// The part of the first round's nodes that are tried before it, to see whether the tree is any good already.
const PROBE: f32 = 0.1;
/// A round that saves less than this part of the areas it looks at is the last.
const WORTH: f64 = 1e-3;

/// A node that would better be the sibling of another.
#[derive(Clone, Copy, Debug)]
struct Move {
    gain: f32,
    node: u32,
    target: u32,
}

/// A tree that knows parents.
struct Tree<'a> {
    nodes: &'a mut [Item],
    parents: Vec<u32>,
    unit: AreaUnit,
}

/// Makes a tree cheaper.
pub(super) fn reinsert(tree: &mut Binary, effort: Effort) {
    let mut parents = vec![NONE; tree.nodes.len()];
    for (name, node) in (0u32..).zip(&tree.nodes) {
        if let Node::Inner(below) = node.node() {
            below.into_iter().for_each(|child| parents[child as usize] = name);
        }
    }
    let mut tree = Tree { nodes: &mut tree.nodes, parents, unit: tree.unit };
    let all = effort.fraction * tree.nodes.len() as f32;
    let counts = (1..=effort.rounds).map(|round| all / round as f32);
    for count in std::iter::once(PROBE * all).chain(counts) {
        if !tree.improve(count as usize) {
            break;
        }
    }
}

/// Looks for better places of some nodes.
struct Search<'a> {
    tree: &'a Tree<'a>,
    names: &'a [u32],
}

impl Work for Search<'_> {
    type Output = Vec<Move>;
    #[inline(always)]
    fn run(self) -> Vec<Move> {
        let mut stack = Vec::new();
        self.names.iter().filter_map(|&name| self.tree.search(name, &mut stack)).collect()
    }
}

impl Tree<'_> {
    #[inline(always)]
    fn hull(&self, name: u32) -> Hull {
        self.nodes[name as usize].0
    }
    #[inline(always)]
    fn area(&self, name: u32) -> f32 {
        self.unit.area(&self.hull(name))
    }
    #[inline(always)]
    fn parent(&self, name: u32) -> u32 {
        self.parents[name as usize]
    }
    #[inline(always)]
    fn sibling(&self, name: u32) -> u32 {
        match self.nodes[self.parent(name) as usize].node() {
            Node::Inner([left, right]) if left == name => right,
            Node::Inner([left, _]) => left,
            Node::Leaf { .. } => unreachable!("a parent has children"),
        }
    }

    /// One round over the `count` largest nodes; whether another is worth while.
    fn improve(&mut self, count: usize) -> bool {
        let names = self.largest(count);
        let area: f64 = names.iter().map(|&name| f64::from(self.area(name))).sum();
        let search = |names| widest(Search { tree: self, names });
        let mut moves: Vec<Move> = names.par_chunks(CHUNK).flat_map_iter(search).collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.node.cmp(&b.node)));
        let gain: f64 = moves.iter().map(|m| self.try_move(m)).sum();
        gain > WORTH * area
    }

    /// The names of the nodes with the largest areas, in their order, without the root and its children.
    fn largest(&self, count: usize) -> Vec<u32> {
        let name = |name: u32| (self.area(name).to_bits(), name);
        let mut all: Vec<(u32, u32)> = (1..self.nodes.len() as u32)
            .into_par_iter()
            .filter(|&name| self.parent(name) != 0)
            .map(name)
            .collect();
        if count < all.len() {
            // Of floats that are not negative, bits order like values.
            all.select_nth_unstable_by(count, |a, b| b.cmp(a));
            all.truncate(count);
        }
        let mut names: Vec<u32> = all.into_iter().map(|(_, name)| name).collect();
        names.par_sort_unstable();
        names
    }

    /// The best new sibling for a node. Branch and bound: subtrees beside the path to the root are searched with what
    /// the removal has gained up to there, less the growth of the boxes on the way down.
    #[inline(always)]
    fn search(&self, node: u32, stack: &mut Vec<(f32, u32)>) -> Option<Move> {
        let hull = self.hull(node);
        let area = self.unit.area(&hull);
        let parent = self.parent(node);
        let mut best = Move { gain: 0.0, node, target: NONE };
        // Without the node its parent goes; what is around the rest of its ancestors shrinks.
        let mut gained = self.area(parent);
        let (mut pivot, mut below) = (parent, node);
        let mut rest = Hull::EMPTY;
        while pivot != NONE {
            let sibling = self.sibling(below);
            stack.push((gained, sibling));
            while let Some((gained, target)) = stack.pop() {
                if gained - area <= best.gain {
                    continue;
                }
                let beside = self.hull(target);
                let joined = self.unit.area(&beside.joined(hull));
                let gain = gained - joined;
                if gain > best.gain && !(pivot == parent && target == sibling) {
                    (best.gain, best.target) = (gain, target);
                }
                let further = gain + self.unit.area(&beside);
                if let (Node::Inner([left, right]), true) =
                    (self.nodes[target as usize].node(), further - area > best.gain)
                {
                    stack.push((further, left));
                    stack.push((further, right));
                }
            }
            rest = rest.joined(self.hull(sibling));
            if pivot != parent {
                gained += self.area(pivot) - self.unit.area(&rest);
            }
            (below, pivot) = (pivot, self.parent(pivot));
        }
        (best.target != NONE).then_some(best)
    }

    /// Makes a move if it is still possible and still pays; returns by how much areas shrink.
    fn try_move(&mut self, m: &Move) -> f64 {
        let parent = self.parent(m.node);
        if parent == 0 || parent == NONE || m.target == parent || self.is_below(m.target, m.node) {
            return 0.0;
        }
        let sibling = self.sibling(m.node);
        if m.target == sibling {
            return 0.0;
        }
        let gain = self.put(m.node, m.target);
        if gain <= 0.0 {
            self.put(m.node, sibling);
        }
        gain.max(0.0)
    }

    fn is_below(&self, mut name: u32, root: u32) -> bool {
        while name != NONE && name != root {
            name = self.parent(name);
        }
        name == root
    }

    /// Makes `node` the sibling of `target`, its old parent their parent; returns by how much areas shrink.
    fn put(&mut self, node: u32, target: u32) -> f64 {
        let (parent, sibling) = (self.parent(node), self.sibling(node));
        let mut gain = f64::from(self.area(parent));
        let above = self.parent(parent);
        self.replace(above, parent, sibling);
        gain += self.refit(above);
        let place = self.parent(target);
        self.replace(place, target, parent);
        let hull = self.hull(node).joined(self.hull(target));
        self.nodes[parent as usize] = Item::inner(&hull, [node, target]);
        self.parents[target as usize] = parent;
        gain -= f64::from(self.area(parent));
        gain + self.refit(place)
    }

    /// Puts `new` in the place of a child of `parent`.
    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        if let Node::Inner(below) = self.nodes[parent as usize].node() {
            let below = below.map(|child| if child == old { new } else { child });
            self.nodes[parent as usize] = Item::inner(&self.hull(parent), below);
        }
        self.parents[new as usize] = parent;
    }

    /// Fits boxes from a node upwards to what is below them; returns by how much their areas shrink.
    fn refit(&mut self, mut name: u32) -> f64 {
        let mut gain = 0.0;
        while name != NONE {
            let Node::Inner([left, right]) = self.nodes[name as usize].node() else { break };
            let (old, new) = (self.hull(name), self.hull(left).joined(self.hull(right)));
            if old.bounds() == new.bounds() {
                break;
            }
            gain += f64::from(self.unit.area(&old)) - f64::from(self.unit.area(&new));
            self.nodes[name as usize] = Item::inner(&new, [left, right]);
            name = self.parent(name);
        }
        gain
    }
}
