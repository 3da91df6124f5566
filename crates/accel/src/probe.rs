//! Watching a traversal: heat maps and cost counts. Vanishes when unused.

/// Observer of one or many traversals.
pub trait TraversalProbe {
    /// Says which ray an event belongs to; `()` for observers that do not ask.
    type Id: Copy + Default;
    /// The ray entered a node of a tree. `bvh_node` is unique in its `Accel`: see `Accel::node_bounds`.
    #[inline]
    fn node(&mut self, _id: Self::Id, _bvh_node: u32) {}
    /// The ray is tested against a primitive.
    #[inline]
    fn primitive(&mut self, _id: Self::Id, _instance: u32, _prim: u32) {}
}

/// Sees nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoTraversalProbe;

impl TraversalProbe for NoTraversalProbe {
    type Id = ();
}

/// Sums over all rays observed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalCounts {
    /// Nodes entered, in the trees of instances and of primitives alike.
    pub nodes: u64,
    /// Ray-primitive tests.
    pub primitives: u64,
}

impl TraversalProbe for TraversalCounts {
    type Id = ();
    fn node(&mut self, _: (), _: u32) {
        self.nodes += 1;
    }
    fn primitive(&mut self, _: (), _: u32, _: u32) {
        self.primitives += 1;
    }
}
