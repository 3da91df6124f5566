//! Infinite plane.
//!
//! Implicit form `H(P) = n.P + D = 0`; with unit `n`, `H(P)` is the signed distance. Inserting `P = o + t d` gives
//! `t = -(D + n.o) / (n.d)` (lecture, "Ray-Plane Intersection"). The implicit form is also what tells how good a hit is:
//! the point `o + t d` is put back on the plane in f64 (`P - H(P) n`) before it is rounded, so its error is one rounding
//! of its coordinates however far away it lies.
use durer_core::{
    glam::DVec3,
    math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3, error::gamma},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Geometry, Outline, Shape, ShapeHit, accept};
use crate::{Surface, texture::Footprint};

/// A plane through a point with axes for texture coordinates, in f64: what all flat shapes lie in.
///
/// Of x, y and z leave out the axis nearest to the normal. The first of the other two, projected into the plane, is the
/// u axis; the v axis is perpendicular to it, on the side of the second. A floor (normal y) has u = x and v = z, a wall
/// (normal z) u = x and v = y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carrier {
    /// A point of the plane.
    pub(super) origin: DVec3,
    /// Unit normal.
    pub(super) n: DVec3,
    /// Unit u axis.
    pub(super) u: DVec3,
    /// Unit v axis.
    pub(super) v: DVec3,
}

impl Carrier {
    /// `normal` need not be of unit length, but not zero.
    pub(super) fn new(origin: DVec3, normal: DVec3) -> Self {
        let n = normal.normalize();
        let (first, second) = match Vector3::from_f64(n).max_axis() {
            0 => (DVec3::Y, DVec3::Z),
            1 => (DVec3::X, DVec3::Z),
            _ => (DVec3::X, DVec3::Y),
        };
        let u = (first - n * n.dot(first)).normalize();
        let v = n.cross(u).normalize();
        Self { origin, n, u, v: if v.dot(second) < 0.0 { -v } else { v } }
    }
    /// The lecture's `H(P)`: distance, positive on the side of the normal.
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.n.dot(p - self.origin)
    }
    /// Coordinates along the two axes.
    pub(super) fn coordinates(&self, p: DVec3) -> [f64; 2] {
        [self.u.dot(p - self.origin), self.v.dot(p - self.origin)]
    }
    /// The parameter at which `ray` meets the plane and a bound on its absolute error. `None` if it lies behind the ray,
    /// for rays that are parallel to the plane as far as can be told, and degenerate ones.
    #[inline]
    pub(super) fn meet(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let sum = |v: DVec3| v.abs().element_sum();
        let slope = self.n.dot(d);
        let slope_error = 8.0 * f64::EPSILON * sum(d);
        let height_error = 8.0 * f64::EPSILON * (sum(o) + sum(self.origin));
        // PERF: one division; it rounds t once more than two would (bench render).
        let inverse = 1.0 / slope;
        let t = -self.height(o) * inverse;
        if t < ray.t_min.into() || !(slope.abs() > slope_error && t.is_finite()) {
            return None;
        }
        let error = (height_error + t.abs() * slope_error) * inverse.abs() + 2.0 * f64::EPSILON * t.abs();
        Some((t, error))
    }
    /// [`Self::meet`] as far as the ray's interval allows, with the point, which is finite in f32.
    pub(super) fn hit(&self, ray: &Ray) -> Option<(f32, DVec3)> {
        let (t, error) = self.meet(ray)?;
        let rounded = accept(ray, t, error)?;
        let p = self.point(ray, t);
        Point3::from_f64(p).is_finite().then_some((rounded, p))
    }
    /// The point at which the ray meets the plane, or that at `t` if it is parallel; put back on the plane.
    pub(super) fn point_near(&self, ray: &Ray, t: f32) -> DVec3 {
        self.point(ray, self.meet(ray).map_or(t.into(), |(t, _)| t))
    }
    fn point(&self, ray: &Ray, t: f64) -> DVec3 {
        let p = ray.o.to_f64() + ray.d.to_f64() * t;
        p - self.n * self.height(p)
    }
    /// The surface at a point of the plane; `size` is the length of a unit of u and v.
    pub(super) fn surface(&self, exact: DVec3, uv: Point2, size: [f64; 2]) -> Surface {
        let p = Point3::from_f64(exact);
        let n = Normal3::from_f64(self.n);
        Surface {
            p,
            // One rounding to f32; the second covers those of f64, also of the plane's own origin.
            p_error: (p - Point3::ZERO).abs() * gamma(2)
                + Vector3::from_f64(self.origin.abs() + exact.abs().max_element())
                    * (f64::EPSILON * 8.0) as f32,
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu: Vector3::from_f64(self.u * size[0]),
            dpdv: Vector3::from_f64(self.v * size[1]),
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }
}

/// An infinite plane; the outside is where the normal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    carrier: Carrier,
    uv_scale: f64,
}

impl Plane {
    /// The plane through `point`; `normal` need not be of unit length, but not zero. Texture coordinates count from
    /// `point`, `uv_scale` to the metre: for normal +y `u = x` and `v = z` times the scale.
    pub fn new(point: Point3, normal: Vector3, uv_scale: f32) -> Self {
        Self { carrier: Carrier::new(point.to_f64(), normal.to_f64()), uv_scale: uv_scale.into() }
    }
    /// `H(P) = n.P + D`: the distance of `p` in metres, positive on the side of the normal.
    pub fn signed_distance(&self, p: Point3) -> f32 {
        self.carrier.height(p.to_f64()) as f32
    }
}

impl Shape for Plane {
    fn bounds(&self) -> Bounds3 {
        Bounds3::UNBOUNDED
    }
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (t, error) = self.carrier.meet(ray)?;
        let t = accept(ray, t, error)?;
        ray.at(t).is_finite().then_some(ShapeHit { t, u: 0.0, v: 0.0 })
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let p = self.carrier.point_near(ray, hit.t);
        let [u, v] = self.carrier.coordinates(p);
        let uv = Point2::new((u * self.uv_scale) as f32, (v * self.uv_scale) as f32);
        self.carrier.surface(p, uv, [1.0 / self.uv_scale; 2])
    }
    fn area(&self) -> f32 {
        f32::INFINITY
    }
    fn outline(&self) -> Outline {
        Outline::Infinite
    }
}

impl Kind for Plane {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "plane",
        aliases: &[],
        doc: "An infinite plane. Texture coordinates count from the point: along x and z for a floor (normal y), along x \
              and y for a wall (normal z), along y and z for normal x; tilted planes use those axes projected into them.",
        params: &[
            ParamSpec::new(
                "point",
                ParamType::Point3,
                ParamDefault::Triple([0.0; 3]),
                "A point of the plane.",
            )
            .unit("m"),
            ParamSpec::new(
                "normal",
                ParamType::Vector3,
                ParamDefault::Triple([0.0, 1.0, 0.0]),
                "Direction of the outside; any length but 0.",
            ),
            ParamSpec::float("uvscale", 1.0, "Texture coordinates per metre.")
                .unit("1/m")
                .above(0.0, f32::INFINITY),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let (point, normal) = (Point3::from(args.triple("point")), Vector3::from(args.triple("normal")));
        let uv_scale = args.float("uvscale");
        if normal == Vector3::ZERO {
            args.error("normal", "\"normal\" is the zero vector, which has no direction");
        }
        args.is_sound().then(|| Geometry::shape(Self::new(point, normal, uv_scale)))
    }
}
