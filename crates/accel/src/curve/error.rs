//! Why curves cannot be used.
use thiserror::Error;

/// A mistake in [`Curves`](super::Curves).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CurveError {
    /// There is not one radius for each control point.
    #[error("the curves have {points} control points but {radii} radii; give each point its radius")]
    RadiusCount {
        /// Number of control points.
        points: usize,
        /// Number of radii.
        radii: usize,
    },
    /// Oriented curves need one normal for each control point, others none.
    #[error(
        "the curves have {normals} normals where {expected} are expected; oriented curves have one for each control point, others have none"
    )]
    NormalCount {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        normals: usize,
    },
    /// A control point has an infinite or NaN coordinate.
    #[error("control point {point} has a coordinate that is infinite or NaN; give it a finite position")]
    PointNotFinite {
        /// Index into `points`.
        point: usize,
    },
    /// A radius is negative, infinite or NaN.
    #[error("the radius of control point {point} is negative, infinite or NaN; give it one of 0 or more")]
    RadiusInvalid {
        /// Index into `radii`.
        point: usize,
    },
    /// A normal is zero, infinite or NaN.
    #[error("the normal of control point {point} is zero, infinite or NaN; give it a direction")]
    NormalInvalid {
        /// Index into `normals`.
        point: usize,
    },
    /// A segment begins too near the end of the control points.
    #[error(
        "segment {segment} begins at control point {first} and needs {needed}, but there are {points} (counted from 0); correct the index or add points"
    )]
    SegmentOutOfRange {
        /// Index into `segments`.
        segment: usize,
        /// The index it holds.
        first: u32,
        /// How many control points a segment has.
        needed: usize,
        /// Number of control points.
        points: usize,
    },
}
