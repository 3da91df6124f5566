//! Why a scene cannot be built.
use thiserror::Error;

use crate::{curve::CurveError, layout::Link, point::PointError};

/// A mistake in what was handed to the builder, or to an `Accel` that is changed; it is left as it was before the call.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// A vertex has an infinite or NaN coordinate.
    #[error(
        "vertex {vertex} has a coordinate that is infinite or NaN; remove it or give it a finite position"
    )]
    VertexNotFinite {
        /// Index into `positions`.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle} names vertex {vertex}, but the mesh has {vertices} vertices (counted from 0); correct the index or add the vertex"
    )]
    VertexOutOfRange {
        /// Index into `indices`.
        triangle: usize,
        /// The index it holds.
        vertex: u32,
        /// Number of positions.
        vertices: usize,
    },
    /// A box of user geometry has a NaN corner or a minimum above its maximum.
    #[error(
        "box {prim} of user geometry is NaN or has min > max on some axis; give a box that contains the shape"
    )]
    BoxInvalid {
        /// Index into the list of boxes.
        prim: usize,
    },
    /// Curves are not sound.
    #[error(transparent)]
    Curves(#[from] CurveError),
    /// Points are not sound.
    #[error(transparent)]
    Points(#[from] PointError),
    /// A placement squashes space flat or holds a number that is not finite.
    #[error(
        "transform {key} of instance {instance} cannot be inverted; use finite coefficients and no zero scale"
    )]
    TransformSingular {
        /// Index the instance would have had.
        instance: usize,
        /// Which motion key; 0 for a still instance.
        key: usize,
    },
    /// A moving placement has no keys or its times do not rise.
    #[error(
        "motion key {key} of instance {instance} is missing or its time does not rise; give finite, strictly rising times"
    )]
    MotionKeyInvalid {
        /// Index the instance would have had.
        instance: usize,
        /// Which motion key.
        key: usize,
    },
    /// The vertex keys of a moving mesh are not alike or their times do not rise.
    #[error(
        "vertex key {key} has another number of vertices than the one before it, or is not later; give finite, strictly rising times"
    )]
    VertexKeyInvalid {
        /// Which key, counted from 0.
        key: usize,
    },
    /// The geometry was made by another builder.
    #[error("geometry {geometry} does not exist in this builder; add the geometry before placing it")]
    GeometryUnknown {
        /// The number inside the id.
        geometry: u32,
    },
    /// No such instance.
    #[error("instance {instance} does not exist; give an index that placing a geometry returned")]
    InstanceUnknown {
        /// The index given.
        instance: u32,
    },
    /// The instance has no tree of its own.
    #[error(
        "instance {instance} is part of the scene's own tree and cannot be placed anew; keep its geometry apart when building"
    )]
    InstanceMerged {
        /// The index given.
        instance: u32,
    },
    /// New data of a geometry are of another kind.
    #[error(
        "geometry {geometry} was built of {built}, but the new data are {given}; give data of the same kind"
    )]
    KindChanged {
        /// The number inside the id.
        geometry: u32,
        /// What it is made of.
        built: &'static str,
        /// What it was to be made of.
        given: &'static str,
    },
    /// New data of a geometry have another number of primitives or keys.
    #[error(
        "geometry {geometry} was built of {built} {what}, but the new data have {given}; give as many or build anew"
    )]
    CountChanged {
        /// The number inside the id.
        geometry: u32,
        /// Of what.
        what: &'static str,
        /// How many it has.
        built: usize,
        /// How many it was to have.
        given: usize,
    },
    /// The processor lacks what was asked for.
    #[error("this processor has no {isa} instructions; choose others, or none to take the best there are")]
    IsaMissing {
        /// As `Isa::name` says it.
        isa: &'static str,
    },
    /// A tree has more than the 2^28 rows of 32 bytes that links can name, which are 8 GiB. Triangles take 57 to 100 bytes
    /// each with the boxes above them, so that 85 to 150 million fit into one tree. Each geometry that is placed several
    /// times, moves or is kept apart has a tree of its own; all others share the scene's.
    #[error(
        "the tree over {primitives} primitives takes more than {gigabytes} GiB; leave out geometry, or trace the scene in parts"
    )]
    TreeTooLarge {
        /// Primitives of the tree.
        primitives: usize,
        /// The limit.
        gigabytes: usize,
    },
    /// Ids would not fit.
    #[error("{count} {what} are more than the {limit} that ids can count; split the scene", limit = Link::LIMIT)]
    TooMany {
        /// How many there are.
        count: usize,
        /// Of what.
        what: &'static str,
    },
}

impl BuildError {
    /// `count` as an id.
    pub(crate) fn check_count(count: usize, what: &'static str) -> Result<u32, Self> {
        u32::try_from(count).ok().filter(|n| *n <= Link::LIMIT).ok_or(Self::TooMany { count, what })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::ROW;

    #[test]
    fn a_tree_has_room_for_as_many_triangles_as_its_error_says() {
        let bytes = u64::from(Link::LIMIT) * ROW as u64;
        assert_eq!((Link::LIMIT, bytes), (1 << 28, 8 << 30));
        assert_eq!([100, 57].map(|each| bytes / each / 1_000_000), [85, 150]);
    }

    #[test]
    fn more_primitives_than_ids_are_refused() {
        let most = Link::LIMIT as usize;
        assert_eq!(BuildError::check_count(most, "triangles"), Ok(Link::LIMIT));
        let error = BuildError::check_count(most + 1, "triangles").expect_err("one too many");
        assert_eq!(
            error.to_string(),
            "268435457 triangles are more than the 268435456 that ids can count; split the scene"
        );
    }
}
