//! Writes down the wide tree that was chosen, depth first.
use rayon::prelude::*;

use super::{
    Child, DEPTH_MAX, WIDEST, WideTree,
    binary::{Binary, Node},
    collapse::Choices,
};

/// Above this level of wide nodes subtrees are written apart, by all threads, and put together afterwards.
const LEVELS_APART: u32 = 1;

/// The wide tree of `choices`, if it is not too deep.
pub(super) fn emit(tree: &Binary, choices: &Choices) -> Option<WideTree> {
    let mut emission = Emission { tree, choices, wide: WideTree::default(), levels: 1 };
    if emission.is_leaf(0) {
        emission.wide.nodes.push(0);
        emission.child(0);
    } else {
        emission.node(0, 1);
    }
    if emission.levels > DEPTH_MAX {
        return None;
    }
    let mut wide = emission.wide;
    wide.nodes.push(wide.children.len() as u32);
    wide.nodes.shrink_to_fit();
    wide.children.shrink_to_fit();
    wide.order.shrink_to_fit();
    Some(wide)
}

struct Emission<'a> {
    tree: &'a Binary,
    choices: &'a Choices,
    wide: WideTree,
    /// Of nodes so far.
    levels: u32,
}

/// The children of a wide node: binary nodes.
#[derive(Default)]
struct Roots {
    names: [u32; WIDEST],
    count: usize,
}

impl Emission<'_> {
    fn is_leaf(&self, name: u32) -> bool {
        matches!(self.tree.nodes[name as usize].node(), Node::Leaf { .. }) || self.choices.of(name).is_leaf()
    }

    /// Writes a wide node and all below it.
    fn node(&mut self, name: u32, level: u32) {
        self.levels = self.levels.max(level);
        let mut roots = Roots::default();
        if let Node::Inner([left, right]) = self.tree.nodes[name as usize].node() {
            let k = self.choices.of(name).left_of(self.choices.width);
            self.gather(left, k, &mut roots);
            self.gather(right, self.choices.width - k, &mut roots);
        }
        let first = self.wide.children.len();
        self.wide.nodes.push(first as u32);
        for &root in &roots.names[..roots.count] {
            self.child(root);
        }
        let inner = |(_, root): &(usize, &u32)| !self.is_leaf(**root);
        if level <= LEVELS_APART {
            let below: Vec<_> = roots.names[..roots.count].iter().enumerate().filter(inner).collect();
            let below = below.into_par_iter().map(|(place, &root)| (place, self.apart(root, level + 1)));
            for (place, piece) in below.collect::<Vec<_>>() {
                self.wide.children[first + place].first = self.wide.nodes.len() as u32;
                self.append(piece);
            }
            return;
        }
        for (place, &root) in roots.names[..roots.count].iter().enumerate() {
            if !self.is_leaf(root) {
                self.wide.children[first + place].first = self.wide.nodes.len() as u32;
                self.node(root, level + 1);
            }
        }
    }

    /// A subtree by itself.
    fn apart(&self, name: u32, level: u32) -> Self {
        let mut piece =
            Self { tree: self.tree, choices: self.choices, wide: WideTree::default(), levels: level };
        piece.node(name, level);
        piece
    }

    /// Adds a subtree that was written by itself.
    fn append(&mut self, piece: Self) {
        self.levels = self.levels.max(piece.levels);
        let (wide, piece) = (&mut self.wide, piece.wide);
        let before = [wide.nodes.len(), wide.children.len(), wide.order.len()].map(|n| n as u32);
        wide.nodes.extend(piece.nodes.iter().map(|first| first + before[1]));
        wide.children.extend(piece.children.iter().map(|child| {
            let numbered_from = if child.count == 0 { before[0] } else { before[2] };
            Child { first: child.first + numbered_from, ..*child }
        }));
        wide.order.extend_from_slice(&piece.order);
    }

    /// Finds the cheapest forest of at most `most` trees below a binary node.
    fn gather(&self, name: u32, most: usize, roots: &mut Roots) {
        if let Node::Inner([left, right]) = self.tree.nodes[name as usize].node() {
            let choice = self.choices.of(name);
            for i in (2..=most).rev() {
                let k = choice.left_of(i);
                if k > 0 {
                    self.gather(left, k, roots);
                    return self.gather(right, i - k, roots);
                }
            }
        }
        roots.names[roots.count] = name;
        roots.count += 1;
    }

    /// Writes a child of a wide node; an inner one learns its number later.
    fn child(&mut self, name: u32) {
        let bounds = self.tree.nodes[name as usize].0.bounds();
        let first = self.wide.order.len();
        if self.is_leaf(name) {
            self.primitives(name, first);
        }
        let count = self.wide.order.len() - first;
        self.wide.children.push(Child { bounds, first: first as u32, count: count as u32 });
    }

    /// Writes the primitives below a binary node; those that the leaf, which begins at `begin`, has already (in pieces)
    /// only once.
    fn primitives(&mut self, name: u32, begin: usize) {
        match self.tree.nodes[name as usize].node() {
            Node::Inner(below) => below.into_iter().for_each(|name| self.primitives(name, begin)),
            Node::Leaf { first, count } => {
                for prim in &self.tree.order[first as usize..(first + count) as usize] {
                    if !self.wide.order[begin..].contains(prim) {
                        self.wide.order.push(*prim);
                    }
                }
            }
        }
    }
}
