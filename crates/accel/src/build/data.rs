//! New data for a geometry that was built: [`GeometryData`].
use std::borrow::Cow;

use durer_core::math::{Bounds3, Point3};

use super::source::{Quads, Source};
use crate::{
    BuildError, GeometryId,
    curve::Curves,
    geometry::{Geometry, Items},
    point::Points,
};

/// What a geometry is now: of the kind it was built as, with as many primitives.
#[derive(Clone, Debug)]
pub enum GeometryData<'a> {
    /// For what `AccelBuilder::triangles` or `borrowed_triangles` added.
    Triangles {
        /// Vertices, in object space; any number of them.
        positions: &'a [Point3],
        /// Three vertices each; as many as before.
        indices: &'a [[u32; 3]],
    },
    /// For `AccelBuilder::quads`.
    Quads(Quads),
    /// For `AccelBuilder::keyed_triangles`.
    KeyedTriangles {
        /// Three vertices each; as many as before.
        indices: &'a [[u32; 3]],
        /// `(seconds, positions)` with rising times; as many as before.
        keys: Vec<(f32, &'a [Point3])>,
    },
    /// For `AccelBuilder::user`.
    User(Vec<Bounds3>),
    /// For `AccelBuilder::curves`.
    Curves(Curves),
    /// For `AccelBuilder::points`.
    Points(Points),
}

impl<'a> GeometryData<'a> {
    /// The same, checked.
    pub(super) fn source(self) -> Result<Source<'a>, BuildError> {
        match self {
            Self::Triangles { positions, indices } => {
                Source::triangles(Cow::Borrowed(positions), Cow::Borrowed(indices))
            }
            Self::Quads(mesh) => Source::quads(mesh),
            Self::KeyedTriangles { indices, keys } => {
                let keys = keys.into_iter().map(|(time, positions)| (time, Cow::Borrowed(positions)));
                Source::keyed(Cow::Borrowed(indices), keys.collect())
            }
            Self::User(boxes) => Source::boxes(boxes),
            Self::Curves(curves) => Source::curves(curves),
            Self::Points(points) => Source::points(points),
        }
    }
}

fn kind(items: &Items, keys: usize) -> &'static str {
    match items {
        Items::Triangles(_) if keys > 1 => "keyed triangles",
        Items::Triangles(_) => "triangles",
        Items::Quads(_) => "quads",
        Items::Boxes(_) => "boxes",
        Items::Curves(..) => "curve segments",
        Items::Points(..) => "points",
    }
}

/// Whether `new` can take the place of `old`, which is the geometry `id`.
pub(super) fn check_alike(id: GeometryId, old: &Geometry, new: &Geometry) -> Result<(), BuildError> {
    let geometry = id.0;
    let (built, given) = (kind(&old.items, old.keys), kind(&new.items, new.keys));
    if built != given {
        return Err(BuildError::KindChanged { geometry, built, given });
    }
    let count = |items: &Items| match items {
        Items::Quads(count) => *count as usize,
        _ => items.len() as usize,
    };
    for (what, built, given) in
        [(given, count(&old.items), count(&new.items)), ("vertex keys", old.keys, new.keys)]
    {
        if built != given {
            return Err(BuildError::CountChanged { geometry, what, built, given });
        }
    }
    Ok(())
}
