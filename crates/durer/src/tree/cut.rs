//! A tree with fewer rays, or two that are compared: those stay that add most to the pixel, with all above them.
//!
//! Rays are taken best first from the eye down, by what they and all below them add, |contribution| summed over channels.
//! Two trees are cut as one, in which partners are one ray: else what was cut would look like a difference.
use std::{cmp::Reverse, collections::BinaryHeap};

use serde::{Deserialize, Serialize};

use super::{
    compare::{Change, Comparison},
    document::{Node, Tree},
    number::{Rgb, plain, rgb},
};

/// Rays that a page had no room for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct LeftOut {
    /// How many.
    pub rays: u32,
    /// What they add to the pixel: the sum of their `contribution`.
    pub contribution: Rgb,
    /// What they bring to the ray that they are left out below: the sum of `weight` times `result` of those that follow it.
    pub result: Rgb,
}

/// A tree and the one that it is compared with.
pub(super) type Pair<'a> = (&'a Tree, Option<&'a Tree>);

/// Rays of both.
pub(super) fn rays((tree, other): Pair<'_>) -> usize {
    tree.nodes.len() + other.map_or(0, |t| t.nodes.len())
}

/// Both with at most `most` rays together, but never without their eye rays. What is small enough stays as it is.
pub(super) fn cut(pair: Pair<'_>, most: usize) -> (Tree, Option<Tree>) {
    let (tree, other) = pair;
    if rays(pair) <= most {
        return (tree.clone(), other.cloned());
    }
    let mut kept = keep(pair, most).into_iter();
    let (mine, theirs) = (New::of(kept.next().unwrap_or_default()), New::of(kept.next().unwrap_or_default()));
    let mut small = mine.tree(tree);
    small.diff = tree.diff.as_ref().map(|diff| renumbered(diff, &mine, &theirs));
    (small, other.map(|t| theirs.tree(t)))
}

/// A ray of one tree, or the same of both.
struct Place {
    ids: [Option<usize>; 2],
    children: Vec<usize>,
    rank: [u64; 2],
}

/// For each tree, which of its rays stay.
fn keep((tree, other): Pair<'_>, most: usize) -> [Vec<bool>; 2] {
    let mut kept = [tree.nodes.len(), other.map_or(0, |t| t.nodes.len())].map(|n| vec![false; n]);
    let (places, roots) = places((tree, other));
    let mut open: BinaryHeap<([u64; 2], Reverse<usize>)> = BinaryHeap::new();
    // The eye rays stay in any case.
    open.extend(roots.iter().map(|&root| ([u64::MAX; 2], Reverse(root))));
    let mut left = most;
    while let Some((rank, Reverse(at))) = open.pop() {
        let place = &places[at];
        let cost = place.ids.iter().flatten().count();
        if cost > left && rank != [u64::MAX; 2] {
            break;
        }
        left = left.saturating_sub(cost);
        for (side, id) in place.ids.iter().enumerate() {
            if let Some(id) = id {
                kept[side][*id] = true;
            }
        }
        open.extend(place.children.iter().map(|&child| (places[child].rank, Reverse(child))));
    }
    kept
}

/// The rays of both trees as one tree, and the eye rays in it.
fn places((tree, other): Pair<'_>) -> (Vec<Place>, Vec<usize>) {
    let pairs = tree.diff.as_ref().map_or(&[][..], |diff| &diff.pairs);
    let theirs = other.map_or(&[][..], |t| &t.nodes);
    let mut places: Vec<Place> = (0..tree.nodes.len()).map(|id| Place::new([Some(id), None])).collect();
    let mut of_theirs = vec![None; theirs.len()];
    for &[a, b] in pairs {
        let (a, b) = (a as usize, b as usize);
        if let (Some(place), Some(of)) = (places.get_mut(a), of_theirs.get_mut(b)) {
            place.ids[1] = Some(b);
            *of = Some(a);
        }
    }
    for (b, of) in of_theirs.iter_mut().enumerate() {
        if of.is_none() {
            *of = Some(places.len());
            places.push(Place::new([None, Some(b)]));
        }
    }
    let ranks = [ranks(tree), other.map(ranks).unwrap_or_default()];
    let mut roots = Vec::new();
    for at in 0..places.len() {
        let ids = places[at].ids;
        let rank_of = |side: usize| ids[side].and_then(|id| ranks[side].get(id).copied());
        places[at].rank = rank_of(0).max(rank_of(1)).unwrap_or_default();
        let parent = match ids {
            [Some(a), _] => tree.nodes[a].parent.map(|p| p as usize),
            [None, Some(b)] => theirs[b].parent.and_then(|p| of_theirs.get(p as usize).copied().flatten()),
            [None, None] => None,
        };
        match parent {
            Some(parent) if parent < places.len() => places[parent].children.push(at),
            _ => roots.push(at),
        }
    }
    (places, roots)
}

impl Place {
    fn new(ids: [Option<usize>; 2]) -> Self {
        Self { ids, children: Vec::new(), rank: [0; 2] }
    }
}

/// How much each ray counts: what it and those below add to the pixel, then its share of the pixel. Numbers that are at
/// least 0 are in the order of their bits.
fn ranks(tree: &Tree) -> Vec<[u64; 2]> {
    let size = |v: [f32; 3]| -> f64 {
        let sum: f64 = v.iter().map(|v| f64::from(v.abs())).sum();
        // What is no number is what somebody looks for.
        if sum.is_nan() { f64::INFINITY } else { sum }
    };
    let mut sums: Vec<f64> = tree.nodes.iter().map(|n| size(plain(n.contribution))).collect();
    if let Some(bad) = tree.bad.and_then(|id| sums.get_mut(id as usize)) {
        *bad = f64::INFINITY;
    }
    for id in (1..sums.len()).rev() {
        if let Some(parent) = tree.nodes[id].parent {
            sums[parent as usize] += sums[id];
        }
    }
    let own = tree.nodes.iter().map(|n| size(plain(n.throughput)).to_bits());
    sums.iter().map(|sum| sum.to_bits()).zip(own).map(|(sum, own)| [sum, own]).collect()
}

/// Ids in a cut tree.
struct New {
    /// By those in the whole tree.
    ids: Vec<Option<u32>>,
}

impl New {
    fn of(kept: Vec<bool>) -> Self {
        let mut next = 0..;
        Self { ids: kept.into_iter().map(|stays| stays.then(|| next.next()).flatten()).collect() }
    }

    fn id(&self, old: u32) -> Option<u32> {
        self.ids.get(old as usize).copied().flatten()
    }

    /// The rays that stay. Each says what is left out directly below it.
    fn tree(&self, whole: &Tree) -> Tree {
        let mut gone = Missing::below(whole);
        let mut left_out = vec![None; whole.nodes.len()];
        let mut all = LeftOut::default();
        for (id, node) in whole.nodes.iter().enumerate() {
            let Some(parent) = node.parent.filter(|&p| self.ids[id].is_none() && self.id(p).is_some()) else {
                continue;
            };
            let missing = std::mem::take(&mut gone[id]);
            missing.add_to(left_out[parent as usize].get_or_insert_default(), node);
            missing.add_to(&mut all, node);
        }
        // Without meaning for a whole tree.
        all.result = rgb([0.0; 3]);
        let stays = |id: usize| self.ids[id];
        let nodes = whole.nodes.iter().enumerate().filter_map(|(id, node)| {
            Some(Node {
                id: stays(id)? as usize,
                whole_id: Some(id as u32),
                parent: node.parent.and_then(|p| self.id(p)),
                left_out: left_out[id].take(),
                ..node.clone()
            })
        });
        Tree {
            nodes: nodes.collect(),
            left_out: Some(all),
            bad: whole.bad.and_then(|id| self.id(id)),
            ..head(whole)
        }
    }
}

/// What goes with a ray.
#[derive(Clone, Default)]
struct Missing {
    rays: u32,
    contribution: [f64; 3],
}

impl Missing {
    /// For every ray, itself and all below it.
    fn below(tree: &Tree) -> Vec<Self> {
        let own = |n: &Node| Self { rays: 1, contribution: plain(n.contribution).map(f64::from) };
        let mut sums: Vec<Self> = tree.nodes.iter().map(own).collect();
        for id in (1..sums.len()).rev() {
            let Missing { rays, contribution } = sums[id].clone();
            if let Some(parent) = tree.nodes[id].parent.and_then(|p| sums.get_mut(p as usize)) {
                parent.rays += rays;
                (0..3).for_each(|i| parent.contribution[i] += contribution[i]);
            }
        }
        sums
    }

    /// Counts it, and what its first ray brings to the one above.
    fn add_to(&self, sum: &mut LeftOut, node: &Node) {
        sum.rays += self.rays;
        for i in 0..3 {
            sum.contribution[i].0 += self.contribution[i] as f32;
            sum.result[i].0 += node.weight[i].0 * node.result[i].0;
        }
    }
}

/// All but the rays and the comparison.
fn head(tree: &Tree) -> Tree {
    Tree {
        durer: tree.durer.clone(),
        scene: tree.scene.clone(),
        integrator: tree.integrator.clone(),
        antialias: tree.antialias.clone(),
        rules: tree.rules.clone(),
        data: tree.data.clone(),
        no_bound: tree.no_bound.clone(),
        nodes: Vec::new(),
        diff: None,
        ..*tree
    }
}

/// The comparison of the rays that stay.
fn renumbered(diff: &Comparison, mine: &New, theirs: &New) -> Comparison {
    let change = |c: &Change| {
        Some(Change { before: mine.id(c.before)?, after: theirs.id(c.after)?, keys: c.keys.clone() })
    };
    Comparison {
        removed: diff.removed.iter().filter_map(|&id| mine.id(id)).collect(),
        added: diff.added.iter().filter_map(|&id| theirs.id(id)).collect(),
        changed: diff.changed.iter().filter_map(change).collect(),
        pairs: diff.pairs.iter().filter_map(|&[a, b]| Some([mine.id(a)?, theirs.id(b)?])).collect(),
        ..diff.without_lists()
    }
}
