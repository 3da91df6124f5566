//! Trees: nodes first, packets after them, in one stretch of memory.
use durer_core::math::{Bounds3, Segment};

use crate::{
    layout::{Link, NodeWriter, Target},
    simd::{Pages, ROW},
};

/// A tree of boxes over one list of primitives.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) pages: Pages,
    /// Where walks begin; `None` if nothing has a finite box.
    pub(crate) root: Option<Link>,
    /// The number of the only thing with a finite box, if that is a shape.
    pub(crate) sole: Option<u32>,
    /// Nodes, which fill the first rows.
    pub(crate) nodes: u32,
    /// Rows of each.
    pub(crate) node_rows: u32,
    /// Leaves without a finite box (infinite planes): every ray is tested against them.
    pub(crate) unbounded: Vec<Link>,
    /// All leaves, for brute force only.
    pub(crate) leaves: Vec<Link>,
    /// Some triangles lie in several leaves, each in a box around a part only.
    pub(crate) is_cut: bool,
    /// Box around what has a finite one.
    pub(crate) bounds: Bounds3,
    /// Longest way from the root to a leaf, in edges.
    pub(crate) depth: u32,
    /// Nodes of all trees before this one in the `Accel`.
    pub(crate) base: u32,
}

impl Tree {
    /// Nothing at all.
    pub(crate) fn empty() -> Self {
        Self {
            pages: Pages::zeroed(0),
            root: None,
            sole: None,
            nodes: 0,
            node_rows: 1,
            unbounded: Vec::new(),
            leaves: Vec::new(),
            is_cut: false,
            bounds: Bounds3::EMPTY,
            depth: 0,
            base: 0,
        }
    }

    /// Rows of nodes and packets.
    pub(crate) fn rows(&self) -> usize {
        self.pages.bytes() / ROW
    }

    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        let links = size_of_val(self.unbounded.as_slice()) + size_of_val(self.leaves.as_slice());
        self.pages.bytes() + links
    }

    /// The name of the node at `row`, unique in the `Accel`.
    pub(crate) fn name(&self, row: u32) -> u32 {
        self.base + row / self.node_rows
    }

    /// The box around the lanes of a node, and how many of them are leaves. `index` counts the tree's nodes.
    pub(crate) fn node_bounds<N: NodeWriter>(&self, index: u32) -> (Bounds3, u32) {
        let node: &N = self.pages.get(index * self.node_rows);
        let lanes = (0..N::WIDTH).filter_map(|lane| node.lane(lane, 0.0));
        lanes.fold((Bounds3::EMPTY, 0), |(all, leaves), ([min, max], link)| {
            let leaf = !matches!(Link(link).target(), Target::Node(_));
            (all.union(Bounds3 { min: min.into(), max: max.into() }), leaves + u32::from(leaf))
        })
    }
}

/// One tree, or one for each stretch of time.
#[derive(Clone, Debug)]
pub(crate) enum Trees {
    Still(Tree),
    /// Tree `i` holds from `times[i]` to `times[i + 1]`.
    Moving {
        times: Vec<f32>,
        trees: Vec<Tree>,
    },
}

/// The trees over one list of primitives.
#[derive(Clone, Debug)]
pub(crate) struct Forest {
    pub(crate) trees: Trees,
    /// Box around everything finite, over all time.
    pub(crate) bounds: Bounds3,
    /// The largest coordinate of any box, in magnitude.
    pub(crate) region: f32,
}

impl Forest {
    pub(crate) fn new(trees: Trees) -> Self {
        let mut forest = Self { trees, bounds: Bounds3::EMPTY, region: 0.0 };
        forest.measure();
        forest
    }
    /// Sets bounds and region from the trees.
    pub(crate) fn measure(&mut self) {
        self.bounds = self.trees().iter().fold(Bounds3::EMPTY, |all, tree| all.union(tree.bounds));
        let corners = [self.bounds.min, self.bounds.max].map(|p| p.to_array());
        let coordinates = corners.into_iter().flatten().map(f32::abs).filter(|x| x.is_finite());
        self.region = coordinates.fold(0.0, f32::max);
    }
    /// The tree that holds at `time`, and how far its stretch has gone.
    #[inline(always)]
    pub(crate) fn tree(&self, time: f32) -> (&Tree, f32) {
        match &self.trees {
            Trees::Still(tree) => (tree, 0.0),
            Trees::Moving { times, trees } => {
                let at = Segment::at(time, times.len(), |i| times[i]);
                (&trees[at.key], at.u)
            }
        }
    }
    pub(crate) fn trees(&self) -> &[Tree] {
        match &self.trees {
            Trees::Still(tree) => std::slice::from_ref(tree),
            Trees::Moving { trees, .. } => trees,
        }
    }
    pub(crate) fn trees_mut(&mut self) -> &mut [Tree] {
        match &mut self.trees {
            Trees::Still(tree) => std::slice::from_mut(tree),
            Trees::Moving { trees, .. } => trees,
        }
    }
    /// The number of the only thing in it, if that is a shape and stands still.
    #[inline]
    pub(crate) fn sole(&self) -> Option<u32> {
        match &self.trees {
            Trees::Still(tree) if tree.unbounded.is_empty() => tree.sole,
            _ => None,
        }
    }
    pub(crate) fn bytes(&self) -> usize {
        self.trees().iter().map(Tree::bytes).sum()
    }
    pub(crate) fn depth(&self) -> u32 {
        self.trees().iter().map(|tree| tree.depth).max().unwrap_or(0)
    }
}

/// Rows that a record takes.
pub(crate) const fn rows_of<R>() -> u32 {
    (size_of::<R>() / ROW) as u32
}
