//! What a scene is made of once it is built: geometries, each with its trees unless the scene's own tree holds it.
use durer_core::math::Bounds3;

use crate::{slab::grown, tree::Forest};

/// Names a geometry of one builder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GeometryId(pub(crate) u32);

impl GeometryId {
    /// Position in the order geometries were added.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What primitives of a geometry are, beyond what its leaves hold.
#[derive(Clone, Debug)]
pub(crate) enum Items {
    /// So many triangles.
    Triangles(u32),
    /// So many quads, two triangles each.
    Quads(u32),
    /// Shapes of the caller.
    Boxes(Vec<OwnBox>),
}

/// A shape's box, grown once by the slack of box tests; `None` if it is infinite and excludes nothing.
pub(crate) type OwnBox = Option<Bounds3>;

impl Items {
    /// Boxes as the caller gives them.
    pub(crate) fn boxes(given: &[Bounds3]) -> Self {
        let own = |b: &Bounds3| b.is_finite().then(|| grown(b, crate::slab::extent(b)));
        Self::Boxes(given.iter().map(own).collect())
    }

    /// How many a tree counts: a quad is two.
    pub(crate) fn len(&self) -> u32 {
        match self {
            Self::Triangles(count) => *count,
            Self::Quads(count) => 2 * count,
            Self::Boxes(boxes) => boxes.len() as u32,
        }
    }

    /// The box of a shape.
    pub(crate) fn own_box(&self, prim: u32) -> OwnBox {
        match self {
            Self::Boxes(boxes) => boxes[prim as usize],
            Self::Triangles(_) | Self::Quads(_) => None,
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Boxes(boxes) => size_of_val(boxes.as_slice()),
            Self::Triangles(_) | Self::Quads(_) => 0,
        }
    }
}

/// A geometry.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    pub(crate) items: Items,
    /// Its own trees; `None` if its one instance lies in the scene's tree, or it is never placed.
    pub(crate) forest: Option<Forest>,
}

impl Geometry {
    /// Triangles and shapes held.
    pub(crate) fn counts(&self) -> (u64, u64) {
        match &self.items {
            Items::Triangles(count) | Items::Quads(count) => (u64::from(*count), 0),
            Items::Boxes(boxes) => (0, boxes.len() as u64),
        }
    }
    /// Box around everything in its own trees, over all time.
    pub(crate) fn bounds(&self) -> Bounds3 {
        self.forest.as_ref().map_or(Bounds3::EMPTY, |forest| forest.bounds)
    }
    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        self.items.bytes() + self.forest.as_ref().map_or(0, Forest::bytes)
    }
}
