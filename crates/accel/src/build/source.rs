//! Geometries as they are handed in.
use std::{borrow::Cow, sync::Arc};

use durer_core::math::{Bounds3, Point3};
use rayon::prelude::*;

use crate::{
    BuildError,
    curve::Curves,
    geometry::{Items, own_boxes},
    point::Points,
};

/// Vertices or triangles that one thread looks at at a time.
const CHUNK: usize = 1 << 14;

/// A triangle mesh in object space. It may be empty; triangles without area are never hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Three vertices each. Either winding: both sides are hit.
    pub indices: Vec<[u32; 3]>,
}

/// A mesh of quads in object space: each is the triangles `0 1 3` and `2 3 1`, so that it need not be flat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quads {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Four vertices each, around the quad.
    pub indices: Vec<[u32; 4]>,
}

/// A moment in seconds and where the vertices are.
pub(crate) type Key<'a> = (f32, Cow<'a, [Point3]>);

/// A geometry waiting to be built.
#[derive(Clone, Debug)]
pub(crate) enum Source<'a> {
    Triangles {
        positions: Cow<'a, [Point3]>,
        indices: Cow<'a, [[u32; 3]]>,
    },
    Quads(Quads),
    /// At least two keys.
    Keyed {
        indices: Cow<'a, [[u32; 3]]>,
        keys: Vec<Key<'a>>,
    },
    Boxes(Vec<Bounds3>),
    /// With a box around each segment.
    Curves(Arc<Curves>, Vec<Bounds3>),
    /// With a box around each point.
    Points(Arc<Points>, Vec<Bounds3>),
}

impl<'a> Source<'a> {
    pub(crate) fn triangles(
        positions: Cow<'a, [Point3]>,
        indices: Cow<'a, [[u32; 3]]>,
    ) -> Result<Self, BuildError> {
        check(&positions, &indices, "triangles")?;
        Ok(Self::Triangles { positions, indices })
    }

    pub(crate) fn quads(mesh: Quads) -> Result<Self, BuildError> {
        check(&mesh.positions, &mesh.indices, "quads")?;
        Ok(Self::Quads(mesh))
    }

    pub(crate) fn keyed(indices: Cow<'a, [[u32; 3]]>, mut keys: Vec<Key<'a>>) -> Result<Self, BuildError> {
        for (key, pair) in (1..).zip(keys.windows(2)) {
            let ([(before, first), (after, later)], finite) = ([&pair[0], &pair[1]], f32::is_finite);
            if !(before < after && finite(*before) && finite(*after) && first.len() == later.len()) {
                return Err(BuildError::VertexKeyInvalid { key });
            }
        }
        for (_, positions) in &keys {
            check(positions, &indices, "triangles")?;
        }
        if keys.len() > 1 {
            return Ok(Self::Keyed { indices, keys });
        }
        let positions = keys.pop().map_or(Cow::Borrowed(&[][..]), |(_, positions)| positions);
        Self::triangles(positions, indices)
    }

    pub(crate) fn boxes(given: Vec<Bounds3>) -> Result<Self, BuildError> {
        BuildError::check_count(given.len(), "boxes")?;
        match given.iter().position(Bounds3::is_empty) {
            Some(prim) => Err(BuildError::BoxInvalid { prim }),
            None => Ok(Self::Boxes(given)),
        }
    }

    pub(crate) fn curves(curves: Curves) -> Result<Self, BuildError> {
        let count = BuildError::check_count(curves.segments.len(), "curve segments")?;
        curves.check()?;
        let bounds = (0..count).into_par_iter().map(|segment| curves.bounds(segment)).collect();
        Ok(Self::Curves(Arc::new(curves), bounds))
    }

    pub(crate) fn points(points: Points) -> Result<Self, BuildError> {
        let count = BuildError::check_count(points.centers.len(), "points")?;
        points.check()?;
        let bounds = (0..count).into_par_iter().map(|prim| points.bounds(prim)).collect();
        Ok(Self::Points(Arc::new(points), bounds))
    }

    /// What stays of it beside the leaves.
    pub(crate) fn items(&self) -> Items {
        match self {
            Self::Triangles { indices, .. } | Self::Keyed { indices, .. } => {
                Items::Triangles(indices.len() as u32)
            }
            Self::Quads(mesh) => Items::Quads(mesh.indices.len() as u32),
            Self::Boxes(boxes) => Items::Boxes(own_boxes(boxes)),
            Self::Curves(curves, bounds) => Items::Curves(curves.clone(), own_boxes(bounds)),
            Self::Points(points, bounds) => Items::Points(points.clone(), own_boxes(bounds)),
        }
    }

    /// Whether its shape depends on time.
    pub(crate) fn moves(&self) -> bool {
        matches!(self, Self::Keyed { .. })
    }

    /// Moments for which vertices are given.
    pub(crate) fn keys(&self) -> usize {
        if let Self::Keyed { keys, .. } = self { keys.len() } else { 1 }
    }

    /// Boxes around everything, and around what is finite.
    pub(crate) fn bounds(&self) -> [Bounds3; 2] {
        let of_chunk = |chunk: &[Point3]| Bounds3::around(chunk.iter().copied());
        let around = |positions: &[Point3]| {
            positions.par_chunks(CHUNK).map(of_chunk).reduce(|| Bounds3::EMPTY, Bounds3::union)
        };
        let all = match self {
            Self::Triangles { indices, .. } | Self::Keyed { indices, .. } if indices.is_empty() => {
                Bounds3::EMPTY
            }
            Self::Triangles { positions, .. } => around(positions),
            Self::Quads(mesh) => around(&mesh.positions),
            Self::Keyed { keys, .. } => {
                keys.iter().fold(Bounds3::EMPTY, |all, (_, positions)| all.union(around(positions)))
            }
            Self::Boxes(boxes) | Self::Curves(_, boxes) | Self::Points(_, boxes) => {
                let union = |all: Bounds3, b: &Bounds3| all.union(*b);
                let finite = boxes.iter().filter(|b| b.is_finite()).fold(Bounds3::EMPTY, union);
                return [boxes.iter().fold(Bounds3::EMPTY, union), finite];
            }
        };
        [all; 2]
    }
}

fn check<const N: usize>(
    positions: &[Point3],
    indices: &[[u32; N]],
    what: &'static str,
) -> Result<(), BuildError> {
    BuildError::check_count(indices.len(), what)?;
    let lies_nowhere = |p: &Point3| !p.is_finite();
    if let Some(vertex) = positions.par_iter().with_min_len(CHUNK).position_first(lies_nowhere) {
        return Err(BuildError::VertexNotFinite { vertex });
    }
    let vertices = positions.len();
    // PERF: one maximum of all, then the search only if it is too large (bench kernel, build).
    let largest_of = |chunk: &[[u32; N]]| chunk.iter().flatten().fold(0, |most, &i| most.max(i));
    let largest = indices.par_chunks(CHUNK).map(largest_of).max().unwrap_or(0);
    if indices.is_empty() || (largest as usize) < vertices {
        return Ok(());
    }
    for (triangle, indices) in indices.iter().enumerate() {
        if let Some(&vertex) = indices.iter().find(|&&i| i as usize >= vertices) {
            return Err(BuildError::VertexOutOfRange { triangle, vertex, vertices });
        }
    }
    Ok(())
}
