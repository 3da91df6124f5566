//! Why points cannot be used.
use thiserror::Error;

/// A mistake in [`Points`](super::Points).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PointError {
    /// There is not one radius for each centre.
    #[error("there are {centers} centres but {radii} radii; give each point its radius")]
    RadiusCount {
        /// Number of centres.
        centers: usize,
        /// Number of radii.
        radii: usize,
    },
    /// Oriented discs need one normal for each centre, others none.
    #[error(
        "there are {normals} normals where {expected} are expected; oriented discs have one each, other points none"
    )]
    NormalCount {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        normals: usize,
    },
    /// A centre has an infinite or NaN coordinate.
    #[error("centre {point} has a coordinate that is infinite or NaN; give it a finite position")]
    CenterNotFinite {
        /// Index into `centers`.
        point: usize,
    },
    /// A radius is negative, infinite or NaN.
    #[error("the radius of point {point} is negative, infinite or NaN; give it one of 0 or more")]
    RadiusInvalid {
        /// Index into `radii`.
        point: usize,
    },
    /// A normal is zero, infinite or NaN.
    #[error("the normal of point {point} is zero, infinite or NaN; give it a direction")]
    NormalInvalid {
        /// Index into `normals`.
        point: usize,
    },
}
