//! Grows the tree of boxes that rays walk: top down by the surface area heuristic, then collapsed to wide nodes.
//!
//! 1. `spatial`: primitives are cut where that keeps boxes from overlapping (Stich, Friedrich, Dietrich 2009, "Spatial
//!    Splits in Bounding Volume Hierarchies").
//! 2. `top_down`: a binary tree by binned SAH (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//!    Hierarchies").
//! 3. `reinsert`: subtrees move to where they cost less (Meister, Bittner 2018, "Parallel Reinsertion for Bounding Volume
//!    Hierarchy Optimization").
//! 4. `collapse`: the cheapest tree of wide nodes and leaf packets that the binary tree contains, by dynamic
//!    programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//!    BVHs").
//!
//! Visiting a node and visiting a packet of primitives cost 1 each. The result does not depend on the number of
//! threads: chunks are of fixed size, and what is merged across threads are minima, maxima and whole numbers.
mod binary;
mod bins;
pub(crate) mod clip;
mod collapse;
mod emit;
mod hull;
mod partition;
mod reinsert;
mod shared;
mod spatial;
#[cfg(test)]
mod tests;
mod top_down;

use binary::{Binary, Item};
use durer_core::math::Bounds3;
use hull::{AreaUnit, Hull};
use reinsert::Effort;

/// How much work goes into a tree. Times are for one busy core of a 2023 server; threads share the work. The hits are the
/// same whatever it is.
///
/// ```
/// use durer_accel::{AccelBuilder, BuildOptions, Preset};
///
/// let builder = AccelBuilder::new(BuildOptions { preset: Preset::High, ..BuildOptions::default() });
/// # drop(builder);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// For geometry that changes from frame to frame: full leaves, nothing improved afterwards. 2.5 to 4 million triangles
    /// a second; 84 bytes for each at the peak, the tree included.
    Fast,
    /// For most pictures: subtrees move to where they cost less. About 2 million triangles a second where there is
    /// little to improve, fewer where large triangles lie among small ones; 97 bytes for each at the peak.
    #[default]
    Balanced,
    /// For pictures that take minutes: more of that, down to single triangles, and once more with triangles in pieces if
    /// boxes overlap much; the cheaper tree is kept. 3 to 12 times what `Balanced` takes, and more memory.
    High,
}

/// Children of a node at most, whatever the width asked for.
pub(crate) const WIDEST: usize = 16;
/// Most primitives that share a leaf.
pub(crate) const PACKET: usize = 8;
/// Levels of the tree at most, the root being one.
pub(crate) const DEPTH_MAX: u32 = 64;

/// What a tree is grown over.
pub(crate) trait Primitives: Sync {
    /// How many; at most `Link::LIMIT`.
    fn len(&self) -> usize;
    /// A box around one of them: finite and not empty, though it may be flat or a point.
    fn bounds(&self, prim: u32) -> Bounds3;
    /// Whether up to [`PACKET`] such share a leaf (triangles); otherwise it is alone in its leaf.
    fn packs(&self, prim: u32) -> bool;
    /// Boxes of the parts of `prim` inside `within` on the lower and upper side of the plane `axis = at`; a side
    /// without any part is empty. `None`: it cannot be cut.
    fn clip(&self, prim: u32, within: &Bounds3, axis: usize, at: f32) -> Option<[Bounds3; 2]>;
}

/// One child of a wide node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Child {
    /// Contains all below.
    pub(crate) bounds: Bounds3,
    /// The number of an inner node, or of the first entry of `order` in a leaf.
    pub(crate) first: u32,
    /// Entries of `order`; 0 for an inner node.
    pub(crate) count: u32,
}

/// A tree of wide nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct WideTree {
    /// The first child of each node, then an end mark. Depth first, a parent before its children; no nodes, and no end
    /// mark, if there are no primitives.
    pub(crate) nodes: Vec<u32>,
    /// The children of all nodes, those of a node side by side.
    pub(crate) children: Vec<Child>,
    /// Primitives, leaf by leaf.
    pub(crate) order: Vec<u32>,
}

/// The tree over `prims` with at most `width` (8 or 16) children a node and at most 64 levels.
pub(crate) fn grow(prims: &impl Primitives, width: usize, preset: Preset) -> WideTree {
    if prims.len() == 0 {
        return WideTree::default();
    }
    let (items, unit) = top_down::references(prims);
    let plan = Plan::of(preset);
    let whole = plan.whole(prims, items, unit, width);
    match plan.cuts.then(|| plan.in_pieces(prims, unit, width)).flatten() {
        // Cuts do not pay for themselves everywhere, least of all where reinsertion has done the same.
        Some(pieces) if pieces.area(&unit) < whole.area(&unit) => pieces,
        _ => whole,
    }
}

impl WideTree {
    /// The areas of all children, to which the cost of a tree is proportional.
    fn area(&self, unit: &AreaUnit) -> f64 {
        self.children.iter().map(|child| f64::from(unit.area(&Hull::new(&child.bounds)))).sum()
    }
}

/// What a preset does.
struct Plan {
    /// Most primitives in a leaf of the binary tree.
    leaf_max: usize,
    effort: Effort,
    /// Whether to try with primitives in pieces too.
    cuts: bool,
}

impl Plan {
    fn of(preset: Preset) -> Self {
        match preset {
            Preset::Fast => Self { leaf_max: PACKET, effort: Effort::NONE, cuts: false },
            Preset::Balanced => {
                Self { leaf_max: PACKET / 2, effort: Effort { rounds: 3, fraction: 0.1 }, cuts: false }
            }
            // Single primitives even where leaves of four would make the sum of areas a percent smaller: rays inside of
            // rooms take up to a fifth longer with those (bench kernel, sponza).
            Preset::High => Self { leaf_max: 1, effort: Effort::MOST, cuts: true },
        }
    }

    /// The tree over uncut primitives.
    fn whole(&self, prims: &impl Primitives, items: Vec<Item>, unit: AreaUnit, width: usize) -> WideTree {
        let tree = top_down::build(prims, items, None, unit, self.leaf_max);
        self.wide(prims, tree, width).unwrap_or_else(|| {
            // Reinsertion has made a tree that is too deep; without it that cannot be.
            let (items, unit) = top_down::references(prims);
            let tree = top_down::build(prims, items, None, unit, self.leaf_max);
            collapse::collapse(&tree, prims, width).expect("a binary tree that is not too deep")
        })
    }

    /// The tree over primitives some of which are cut, if any are.
    fn in_pieces(&self, prims: &impl Primitives, unit: AreaUnit, width: usize) -> Option<WideTree> {
        let (items, _) = top_down::references(prims);
        let pieces = spatial::cut(prims, items, unit)?;
        let tree = top_down::build(prims, pieces.items, Some(pieces.top), unit, self.leaf_max);
        self.wide(prims, tree, width)
    }

    /// Reinserts and collapses.
    fn wide(&self, prims: &impl Primitives, mut tree: Binary, width: usize) -> Option<WideTree> {
        if self.effort.rounds > 0 {
            reinsert::reinsert(&mut tree, self.effort);
        }
        collapse::collapse(&tree, prims, width)
    }
}
