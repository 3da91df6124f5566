//! What an instance places: a mesh or a list of boxes, with its own tree.
use durer_core::math::{Bounds3, Point3, Segment};

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
    /// The same, at several moments.
    Moving(Moving),
    Boxes(Vec<LeafBox>),
}

/// Triangles whose vertices move on straight lines between keys.
#[derive(Clone, Debug)]
pub(crate) struct Moving {
    /// Moments and leaves of each key, in the same order.
    keys: Vec<(f32, Vec<LeafTriangle>)>,
    place: Vec<u32>,
}

impl Moving {
    /// The triangle of leaf `index` at `time`. It lies in the box around its keys.
    pub(crate) fn at(&self, index: usize, time: f32) -> LeafTriangle {
        let segment = Segment::at(time, self.keys.len(), |key| self.keys[key].0);
        let (a, b) = (&self.keys[segment.key].1[index], &self.keys[segment.key + 1].1[index]);
        let vertices = std::array::from_fn(|i| segment.point(a.vertices[i], b.vertices[i]));
        LeafTriangle { vertices, prim: a.prim }
    }
    fn len(&self) -> usize {
        self.place.len()
    }
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
    pub(crate) fn triangles(
        positions: &[Point3],
        indices: &[[u32; 3]],
        options: &BuildOptions,
    ) -> Result<Self, BuildError> {
        let given = corners(positions, indices)?;
        let (tree, order) = grow(given.iter().map(LeafTriangle::bounds), options);
        let leaves: Vec<_> = order.iter().map(|&i| given[i as usize]).collect();
        let bounds = leaves.iter().fold(Bounds3::EMPTY, |all, l| all.union(l.bounds()));
        Ok(Self { tree, items: Items::Triangles { leaves, place: places(&order) }, finite: bounds, bounds })
    }

    /// Triangles at two or more moments.
    pub(crate) fn moving(
        indices: &[[u32; 3]],
        keys: &[(f32, &[Point3])],
        options: &BuildOptions,
    ) -> Result<Self, BuildError> {
        for (key, pair) in (1..).zip(keys.windows(2)) {
            let ([(before, first), (after, later)], finite) = ([pair[0], pair[1]], f32::is_finite);
            if !(before < after && finite(before) && finite(after) && first.len() == later.len()) {
                return Err(BuildError::VertexKeyInvalid { key });
            }
        }
        let mut given = Vec::with_capacity(keys.len());
        for (time, positions) in keys {
            given.push((*time, corners(positions, indices)?));
        }
        let swept = |i: usize| given.iter().fold(Bounds3::EMPTY, |all, (_, key)| all.union(key[i].bounds()));
        let (tree, order) = grow((0..indices.len()).map(swept), options);
        let bounds = (0..indices.len()).fold(Bounds3::EMPTY, |all, i| all.union(swept(i)));
        let in_order = |(time, key): &(f32, Vec<LeafTriangle>)| {
            (*time, order.iter().map(|&i| key[i as usize]).collect())
        };
        let keys = given.iter().map(in_order).collect();
        Ok(Self {
            tree,
            items: Items::Moving(Moving { keys, place: places(&order) }),
            finite: bounds,
            bounds,
        })
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
        matches!(self.items, Items::Triangles { .. } | Items::Moving(_))
    }

    /// Triangles and boxes held.
    pub(crate) fn counts(&self) -> (u64, u64) {
        match &self.items {
            Items::Triangles { leaves, .. } => (leaves.len() as u64, 0),
            Items::Moving(moving) => (moving.len() as u64, 0),
            Items::Boxes(leaves) => (0, leaves.len() as u64),
        }
    }

    /// The vertices of triangle `prim` at `time`; `None` for boxes.
    pub(crate) fn vertices(&self, prim: u32, time: f32) -> Option<[Point3; 3]> {
        match &self.items {
            Items::Triangles { leaves, place } => Some(leaves[place[prim as usize] as usize].vertices),
            Items::Moving(moving) => Some(moving.at(moving.place[prim as usize] as usize, time).vertices),
            Items::Boxes(_) => None,
        }
    }

    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        let items = match &self.items {
            Items::Triangles { leaves, place } => {
                size_of_val(leaves.as_slice()) + size_of_val(place.as_slice())
            }
            Items::Moving(moving) => {
                let keys = moving.keys.iter().map(|(_, leaves)| size_of_val(leaves.as_slice()));
                keys.sum::<usize>() + size_of_val(moving.place.as_slice())
            }
            Items::Boxes(leaves) => size_of_val(leaves.as_slice()),
        };
        items + size_of_val(self.tree.pairs.as_slice())
    }
}

/// The corners of each triangle, checked.
fn corners(positions: &[Point3], indices: &[[u32; 3]]) -> Result<Vec<LeafTriangle>, BuildError> {
    let count = BuildError::check_count(indices.len(), "triangles")?;
    if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
        return Err(BuildError::VertexNotFinite { vertex });
    }
    let vertices = positions.len();
    let mut given = Vec::with_capacity(indices.len());
    for (prim, indices) in (0..count).zip(indices) {
        if let Some(&vertex) = indices.iter().find(|&&i| i as usize >= vertices) {
            return Err(BuildError::VertexOutOfRange { triangle: prim as usize, vertex, vertices });
        }
        given.push(LeafTriangle { vertices: indices.map(|i| positions[i as usize]), prim });
    }
    Ok(given)
}

/// Where each item went.
fn places(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    for (at, &item) in (0..).zip(order) {
        place[item as usize] = at;
    }
    place
}
