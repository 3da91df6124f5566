//! What shading wants to know of a hit: the point, how far it may be off, and the directions along and across.
use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3, error::gamma},
};

use super::{CurveHit, CurveKind, Curves, bernstein::Bernstein, strand::heading};

/// The surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveSurface {
    /// The point, computed from the curve: more precise than `o + t d`.
    pub p: Point3,
    /// Bound on its distance to the surface along each axis, for `offset_ray_origin`. Ribbons that face the ray need no
    /// more than the others, because they are not met within two radii.
    pub p_error: Vector3,
    /// Along the curve, tangent to the surface; as long as the curve is per unit of `u`, unless an end's first control
    /// points coincide. Zero where the curve runs along the normal.
    pub dpdu: Vector3,
    /// Across, tangent to the surface and perpendicular to `dpdu`, towards larger `v`; as long as the radius. Zero where
    /// `dpdu` is.
    pub dpdv: Vector3,
}

impl Curves {
    /// The surface where `ray` met a segment with the result `hit`.
    ///
    /// # Panics
    /// If there is no such segment, or the curves are not sound ([`Self::check`]).
    pub fn surface(&self, segment: u32, ray: &Ray, hit: &CurveHit) -> CurveSurface {
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        let points = self.bezier_points(segment, |p| p.to_f64()).map(Bernstein);
        let center = DVec3::from_array(points.map(|c| c.at(u)));
        let velocity = heading(&points, u);
        let r = Bernstein(self.bezier_radii(segment)).at(u);
        let n = hit.n_g.to_f64().normalize_or_zero();
        let across = match self.kind {
            // Not from `n_g`, which twisted ribbons turn towards the curve's direction.
            CurveKind::Oriented => {
                let normals = self.bezier_normals(segment, |n| n.to_f64()).map(Bernstein);
                DVec3::from_array(normals.map(|n| n.at(u))).cross(velocity)
            }
            // On the side of direction times curve, whichever way the normal looks.
            CurveKind::Round | CurveKind::Flat => n.cross(velocity) * n.dot(ray.d.to_f64()).signum(),
        };
        let across = across.normalize_or_zero();
        let along = n.cross(across).normalize_or_zero();
        let p = match self.kind {
            CurveKind::Round => center + n * r,
            CurveKind::Flat | CurveKind::Oriented => center + across * (v * r),
        };
        // Rounding u and n_g slides the point along the surface, which it leaves by the square of that.
        let slide = f64::from(f32::EPSILON) * (velocity.length() + 2.0 * r);
        let bent = f64::from(f32::EPSILON) * r + if r > 0.0 { slide * slide / r } else { 0.0 };
        let p = Point3::from_f64(p);
        CurveSurface {
            p,
            p_error: (p - Point3::ZERO).abs() * gamma(2) + Vector3::splat(bent as f32),
            dpdu: Vector3::from_f64(along * velocity.dot(along)),
            dpdv: Vector3::from_f64(across * r),
        }
    }
}
