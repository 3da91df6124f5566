//! The cheapest wide tree that a binary tree contains, by dynamic programming (Ylitie, Karras, Laine 2017, section 3.3).
//!
//! A wide node's children are a forest of at most `width` subtrees. `C(v, i)`, the cost of what is below `v` as a
//! forest of at most `i` trees, is
//! - `C(v, 1) = A(v)` if `v` may be a leaf, else `A(v) + S(v, width)`,
//! - `C(v, i) = min(C(v, i - 1), S(v, i))`, where `S(v, i) = min over k of C(left, k) + C(right, i - k)`.
//!
//! Costs live on the path of the recursion only; what remains of each node are 16 choices of 4 bits.
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::{
    PACKET, Primitives, WIDEST, WideTree,
    binary::{Binary, Node},
    emit,
};

/// Above this level subtrees are left to other threads if those are idle.
const LEVELS_SHARED: u32 = 14;

/// Levels of a binary tree that recursion goes down; a tree that deep is degenerate.
const LEVELS_MAX: u32 = 1000;

/// What is best for each binary node.
pub(super) struct Choices {
    pub(super) width: usize,
    of_node: Vec<AtomicU64>,
}

/// The choices for one binary node.
#[derive(Clone, Copy)]
pub(super) struct Choice(u64);

impl Choices {
    pub(super) fn of(&self, node: u32) -> Choice {
        Choice(self.of_node[node as usize].load(Relaxed))
    }
}

impl Choice {
    /// Whether as a single tree it is a leaf.
    pub(super) fn is_leaf(self) -> bool {
        self.0 & 15 == 0
    }
    /// How many trees the left child contributes to a forest of `roots > 1`; 0 to take a smaller forest.
    pub(super) fn left_of(self, roots: usize) -> usize {
        (self.0 >> (4 * (roots - 1)) & 15) as usize
    }
}

/// Costs of forests below a node.
struct Forest {
    /// `C(v, i)` at `i - 1`, for `i` up to `roots`; more trees are no cheaper.
    costs: [f32; WIDEST],
    roots: usize,
    /// Primitives below.
    count: usize,
    /// Whether all may share a leaf.
    packs: bool,
}

/// Collapses a binary tree, which is not empty, to nodes of `width`; `None` if the result would be too deep.
pub(super) fn collapse(tree: &Binary, prims: &impl Primitives, width: usize) -> Option<WideTree> {
    let width = width.clamp(2, WIDEST);
    let of_node = (0..tree.nodes.len()).into_par_iter().map(|_| AtomicU64::new(0)).collect();
    let choices = Choices { width, of_node };
    solve(&Problem { tree, prims, choices: &choices }, 0, 0)?;
    emit::emit(tree, &choices)
}

struct Problem<'a, P> {
    tree: &'a Binary,
    prims: &'a P,
    choices: &'a Choices,
}

/// The forests below a node; `None` if the tree is too deep.
fn solve<P: Primitives>(problem: &Problem<P>, name: u32, level: u32) -> Option<Forest> {
    let item = &problem.tree.nodes[name as usize];
    let area = problem.tree.unit.area(&item.0);
    match item.node() {
        Node::Leaf { first, count } => {
            let mut costs = [0.0; WIDEST];
            costs[0] = area;
            let prim = problem.tree.order[first as usize];
            let packs = count > 1 || problem.prims.packs(prim);
            Some(Forest { costs, roots: 1, count: count as usize, packs })
        }
        Node::Inner(_) if level == LEVELS_MAX => None,
        Node::Inner([left, right]) => {
            let below = |name| solve(problem, name, level + 1);
            let (left, right) = if level < LEVELS_SHARED {
                rayon::join(|| below(left), || below(right))
            } else {
                (below(left), below(right))
            };
            let (forest, choice) = join(&left?, &right?, area, problem.choices.width);
            problem.choices.of_node[name as usize].store(choice, Relaxed);
            Some(forest)
        }
    }
}

/// The best forests below a node from those below its children, and the choices that lead to them.
fn join(left: &Forest, right: &Forest, area: f32, width: usize) -> (Forest, u64) {
    let count = left.count + right.count;
    let packs = left.packs && right.packs;
    let roots = (left.roots + right.roots).min(width);
    // Two trees at least: the children themselves.
    let mut splits = [0.0; WIDEST];
    let mut takes = [0u64; WIDEST];
    for i in 2..=roots {
        let (mut least, mut take) = (f32::INFINITY, 0);
        for k in i.saturating_sub(right.roots).max(1)..=left.roots.min(i - 1) {
            let cost = left.costs[k - 1] + right.costs[i - k - 1];
            if cost < least {
                (least, take) = (cost, k as u64);
            }
        }
        (splits[i - 1], takes[i - 1]) = (least, take);
    }
    let is_leaf = packs && count <= PACKET;
    let mut costs = [0.0; WIDEST];
    costs[0] = if is_leaf { area } else { area + splits[roots - 1] };
    let mut choice = u64::from(!is_leaf);
    for i in 2..=roots {
        costs[i - 1] = costs[i - 2];
        if splits[i - 1] < costs[i - 2] {
            costs[i - 1] = splits[i - 1];
            // As a forest of `width` it is only ever asked for by itself as a node.
            choice |= takes[i - 1] << (4 * (i - 1));
        }
    }
    let shift = 4 * (width - 1);
    choice = choice & !(15 << shift) | takes[roots - 1] << shift;
    (Forest { costs, roots: roots.min(width - 1), count, packs }, choice)
}
