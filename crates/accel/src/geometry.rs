//! What a scene is made of once it is built: geometries, each with its trees unless the scene's own tree holds it.
use std::sync::Arc;

use durer_core::math::Bounds3;
use rayon::prelude::*;

use crate::{
    curve::{Curves, parts},
    point::Points,
    slab::{extent, grown},
    tree::Forest,
};

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
    /// Segments of curves, with their boxes.
    Curves(Arc<Curves>, Vec<OwnBox>),
    /// Points, with their boxes.
    Points(Arc<Points>, Vec<OwnBox>),
}

/// A shape's box, grown once by the slack of box tests; `None` if it is infinite and excludes nothing.
pub(crate) type OwnBox = Option<Bounds3>;

/// Boxes as they are given, made ready for tests.
pub(crate) fn own_boxes(given: &[Bounds3]) -> Vec<OwnBox> {
    given.par_iter().map(|b| b.is_finite().then(|| grown(b, extent(b)))).collect()
}

impl Items {
    /// How many a tree counts: a quad is two.
    pub(crate) fn len(&self) -> u32 {
        match self {
            Self::Triangles(count) => *count,
            Self::Quads(count) => 2 * count,
            Self::Boxes(_) | Self::Curves(..) | Self::Points(..) => self.boxes().len() as u32,
        }
    }

    /// The boxes of shapes; none of triangles.
    pub(crate) fn boxes(&self) -> &[OwnBox] {
        match self {
            Self::Boxes(boxes) | Self::Curves(_, boxes) | Self::Points(_, boxes) => boxes,
            Self::Triangles(_) | Self::Quads(_) => &[],
        }
    }

    /// The box of a shape.
    pub(crate) fn own_box(&self, prim: u32) -> OwnBox {
        self.boxes().get(prim as usize).copied().flatten()
    }

    /// Numbers and boxes of finite shapes as trees hold them, in order: a long curve several times, by its parts.
    pub(crate) fn leaf_boxes(&self) -> Vec<(u32, Bounds3)> {
        let finite = |(prim, own): (usize, &OwnBox)| Some((prim as u32, (*own)?));
        let shapes = self.boxes().par_iter().enumerate().filter_map(finite);
        match self {
            Self::Curves(curves, _) => shapes
                .flat_map_iter(|(prim, own)| parts(curves, prim, &own).into_iter().map(move |b| (prim, b)))
                .collect(),
            _ => shapes.collect(),
        }
    }

    fn bytes(&self) -> usize {
        let shapes = match self {
            Self::Triangles(_) | Self::Quads(_) | Self::Boxes(_) => 0,
            Self::Curves(c, _) => {
                size_of_val(c.points.as_slice())
                    + size_of_val(c.radii.as_slice())
                    + size_of_val(c.normals.as_slice())
                    + size_of_val(c.segments.as_slice())
            }
            Self::Points(p, _) => {
                size_of_val(p.centers.as_slice())
                    + size_of_val(p.radii.as_slice())
                    + size_of_val(p.normals.as_slice())
            }
        };
        shapes + size_of_val(self.boxes())
    }
}

/// A geometry.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    pub(crate) items: Items,
    /// Boxes in object space around everything, and around what is finite, over all time.
    pub(crate) bounds: [Bounds3; 2],
    /// Moments for which its vertices are given; 1 for what keeps its shape.
    pub(crate) keys: usize,
    /// Its own trees; `None` if its one instance lies in the scene's tree, or it is never placed.
    pub(crate) forest: Option<Forest>,
}

impl Geometry {
    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        self.items.bytes() + self.forest.as_ref().map_or(0, Forest::bytes)
    }
}
