//! Watching a traversal: heat maps and cost counts. Vanishes when unused.

/// Observer of one or many traversals.
pub trait TraversalProbe {
    /// Says which ray an event belongs to; `()` for observers that do not ask.
    type Id: Copy + Default;
    /// False for observers that look away: then rays take the path without any events.
    const ACTIVE: bool = true;
    /// The ray entered a node of a tree, or began there. `bvh_node` is unique in its `Accel`: see `Accel::node_bounds`.
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
    const ACTIVE: bool = false;
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

/// What traversal tells: a probe behind a pointer, or nobody.
pub(crate) trait Watch {
    const ACTIVE: bool;
    fn node(&mut self, bvh_node: u32);
    fn primitive(&mut self, instance: u32, prim: u32);
}

/// Nobody watches.
pub(crate) struct Unwatched;

impl Watch for Unwatched {
    const ACTIVE: bool = false;
    #[inline(always)]
    fn node(&mut self, _: u32) {}
    #[inline(always)]
    fn primitive(&mut self, _: u32, _: u32) {}
}

/// A probe and the ray it is told about, without their types.
pub(crate) trait Sink {
    fn node(&mut self, bvh_node: u32);
    fn primitive(&mut self, instance: u32, prim: u32);
}

/// A probe and the ray it is told about.
pub(crate) struct Told<'a, P: TraversalProbe> {
    pub(crate) probe: &'a mut P,
    pub(crate) id: P::Id,
}

impl<P: TraversalProbe> Sink for Told<'_, P> {
    fn node(&mut self, bvh_node: u32) {
        self.probe.node(self.id, bvh_node);
    }
    fn primitive(&mut self, instance: u32, prim: u32) {
        self.probe.primitive(self.id, instance, prim);
    }
}

impl Watch for &mut dyn Sink {
    const ACTIVE: bool = true;
    fn node(&mut self, bvh_node: u32) {
        Sink::node(&mut **self, bvh_node);
    }
    fn primitive(&mut self, instance: u32, prim: u32) {
        Sink::primitive(&mut **self, instance, prim);
    }
}
