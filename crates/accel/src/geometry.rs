//! What an instance places: a mesh or a list of boxes, with its own tree.
use durer_core::math::{Bounds3, Point3};

use crate::{
    BuildError,
    build::{BuildOptions, grow},
    tree::Tree,
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

/// A triangle mesh in object space. It may be empty; triangles without area are never hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Three vertices each. Either winding: both sides are hit.
    pub indices: Vec<[u32; 3]>,
}

/// A triangle as leaves store it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafTriangle {
    pub(crate) vertices: [Point3; 3],
    /// Index in the mesh as given.
    pub(crate) prim: u32,
}

impl LeafTriangle {
    pub(crate) fn bounds(&self) -> Bounds3 {
        let [a, b, c] = self.vertices;
        Bounds3 { min: a.min(b).min(c), max: a.max(b).max(c) }
    }
}

/// A box as leaves store it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafBox {
    pub(crate) bounds: Bounds3,
    /// False for an infinite box, which excludes nothing.
    pub(crate) finite: bool,
    /// Index in the list as given.
    pub(crate) prim: u32,
}

/// Items in the order of the tree's leaves.
#[derive(Clone, Debug)]
pub(crate) enum Items {
    /// `place[prim]` is where triangle `prim` went.
    Triangles {
        leaves: Vec<LeafTriangle>,
        place: Vec<u32>,
    },
    Boxes(Vec<LeafBox>),
}

#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    pub(crate) tree: Tree,
    pub(crate) items: Items,
    /// Box around the items that have finite ones.
    pub(crate) finite: Bounds3,
    /// Box around everything.
    pub(crate) bounds: Bounds3,
}

impl Geometry {
    pub(crate) fn triangles(mesh: &Triangles, options: &BuildOptions) -> Result<Self, BuildError> {
        let count = BuildError::check_count(mesh.indices.len(), "triangles")?;
        if let Some(vertex) = mesh.positions.iter().position(|p| !p.is_finite()) {
            return Err(BuildError::VertexNotFinite { vertex });
        }
        let vertices = mesh.positions.len();
        let mut given = Vec::with_capacity(mesh.indices.len());
        for (prim, indices) in (0..count).zip(&mesh.indices) {
            if let Some(&vertex) = indices.iter().find(|&&i| i as usize >= vertices) {
                return Err(BuildError::VertexOutOfRange { triangle: prim as usize, vertex, vertices });
            }
            given.push(LeafTriangle { vertices: indices.map(|i| mesh.positions[i as usize]), prim });
        }
        let (tree, order) = grow(given.iter().map(LeafTriangle::bounds), options);
        let leaves: Vec<_> = order.iter().map(|&i| given[i as usize]).collect();
        let bounds = leaves.iter().fold(Bounds3::EMPTY, |all, l| all.union(l.bounds()));
        let mut place = vec![0; order.len()];
        for (at, leaf) in (0..count).zip(&leaves) {
            place[leaf.prim as usize] = at;
        }
        Ok(Self { tree, items: Items::Triangles { leaves, place }, finite: bounds, bounds })
    }

    pub(crate) fn boxes(given: &[Bounds3], options: &BuildOptions) -> Result<Self, BuildError> {
        BuildError::check_count(given.len(), "boxes")?;
        if let Some(prim) = given.iter().position(Bounds3::is_empty) {
            return Err(BuildError::BoxInvalid { prim });
        }
        let (tree, order) = grow(given.iter().copied(), options);
        let around = |all: Bounds3, b: &Bounds3| all.union(*b);
        let finite = given.iter().filter(|b| b.is_finite()).fold(Bounds3::EMPTY, around);
        let bounds = given.iter().fold(Bounds3::EMPTY, around);
        let leaf = |prim: u32| {
            let bounds = given[prim as usize];
            LeafBox { bounds, finite: bounds.is_finite(), prim }
        };
        let leaves = order.into_iter().map(leaf).collect();
        Ok(Self { tree, items: Items::Boxes(leaves), finite, bounds })
    }

    /// Whether rays need what triangle tests need.
    pub(crate) fn has_triangles(&self) -> bool {
        matches!(self.items, Items::Triangles { .. })
    }

    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        let items = match &self.items {
            Items::Triangles { leaves, place } => {
                size_of_val(leaves.as_slice()) + size_of_val(place.as_slice())
            }
            Items::Boxes(leaves) => size_of_val(leaves.as_slice()),
        };
        items + size_of_val(self.tree.pairs.as_slice())
    }
}
