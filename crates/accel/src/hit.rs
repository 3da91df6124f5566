//! What a query returns.
use durer_core::math::Vector3;

/// The nearest meeting of a ray and the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in multiples of the ray's direction.
    pub t: f32,
    /// Which instance, in the order they were added.
    pub instance: u32,
    /// Which triangle, quad, box, curve segment or point of the instance's geometry, in the order they were given.
    pub prim: u32,
    /// Triangles: weight of vertex 1. Quads: along the edge from vertex 0 to 1. Curves: along the segment, in `[0, 1]`.
    /// Points: 0. User geometry: whatever its callback returned.
    pub u: f32,
    /// Triangles: weight of vertex 2; vertex 0 has `1 - u - v`. Quads: along the edge from vertex 0 to 3. Curves: across,
    /// in `[-1, 1]` ([`CurveHit::v`](crate::curve::CurveHit::v)). Points: 0. User geometry: whatever its callback returned.
    pub v: f32,
    /// Normal of the surface in the instance's object space, not of unit length, on the side from which vertices are seen
    /// counter-clockwise. Curves and points: of unit length, on the side that their kind says
    /// ([`CurveHit::n_g`](crate::curve::CurveHit::n_g), [`PointHit::n_g`](crate::point::PointHit::n_g)). Zero for user geometry.
    pub n_g: Vector3,
}

/// What a shape's own intersection routine returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveHit {
    /// Ray parameter, in multiples of the ray's direction.
    pub t: f32,
    /// Free for the shape's use; handed on in [`Hit::u`].
    pub u: f32,
    /// Free for the shape's use; handed on in [`Hit::v`].
    pub v: f32,
}
