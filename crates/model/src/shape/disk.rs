//! Disk, ring or sector of one, perpendicular to the z axis (Physically Based Rendering, 4th edition, section 6.4).
//!
//! `t = (h - o_z) / d_z`; a hit counts if `r_i^2 <= x^2 + y^2 <= r^2` and `0 <= phi <= phi_max`.
use std::f32::consts::TAU;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point2, Point3, Ray, Vector3},
    sampling::concentric_disk,
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    ALPHA, AreaPoint, Geometry, Outline, PHI_MAX, Shape, ShapeHit, arc_angle, azimuth, plane::Carrier,
};
use crate::Surface;

/// A disk at `z = height`; the outside is towards +z. `u = phi / phi_max`, `v` is 0 at the rim and 1 at the inner
/// radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    carrier: Carrier,
    radius: f32,
    inner_radius: f32,
    /// Radians.
    phi_max: f32,
}

impl Disk {
    /// Of the given radii in metres (`inner_radius < radius`), from phi = 0 to `phi_max` degrees.
    pub fn new(height: f32, radius: f32, inner_radius: f32, phi_max: f32) -> Self {
        let carrier = Carrier::new(DVec3::new(0.0, 0.0, height.into()), DVec3::Z);
        Self { carrier, radius, inner_radius, phi_max: arc_angle(phi_max) }
    }
}

impl Shape for Disk {
    fn bounds(&self) -> Bounds3 {
        let (r, z) = (self.radius, self.carrier.origin.z as f32);
        Bounds3::new(Point3::new(-r, -r, z), Point3::new(r, r, z))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (t, p) = self.carrier.hit(ray)?;
        let squared = p.truncate().length_squared();
        let (outer, inner) = (f64::from(self.radius), f64::from(self.inner_radius));
        let inside = squared <= outer * outer
            && squared >= inner * inner
            && (self.phi_max == TAU || azimuth(p.x as f32, p.y as f32) <= self.phi_max);
        inside.then_some(ShapeHit { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let exact = self.carrier.point_near(ray, hit.t);
        let distance = exact.truncate().length();
        let width = self.radius - self.inner_radius;
        let uv = Point2::new(
            azimuth(exact.x as f32, exact.y as f32) / self.phi_max,
            (self.radius - distance as f32) / width,
        );
        // The centre has no azimuth: any will do.
        let (x, y) = if distance > 0.0 { (exact.x / distance, exact.y / distance) } else { (1.0, 0.0) };
        let flat = self.carrier.surface(exact, uv, [1.0; 2]);
        Surface {
            dpdu: Vector3::new(-flat.p.y, flat.p.x, 0.0) * self.phi_max,
            dpdv: Vector3::new(x as f32, y as f32, 0.0) * -width,
            ..flat
        }
    }

    fn area(&self) -> f32 {
        self.phi_max * 0.5 * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)
    }

    fn outline(&self) -> Outline {
        Outline::Curved
    }

    /// Squares of a whole disk become rings; of rings and sectors the square of the radius is uniform.
    fn by_area(&self, u: Point2) -> Option<AreaPoint> {
        let (outer, inner) = (f64::from(self.radius), f64::from(self.inner_radius));
        let (x, y) = if inner == 0.0 && self.phi_max == TAU {
            let [x, y] = concentric_disk(u).map(f64::from);
            (x * outer, y * outer)
        } else {
            let r = (inner * inner + (outer * outer - inner * inner) * f64::from(u.x)).sqrt();
            let (sin, cos) = libm::sincos(f64::from(self.phi_max) * f64::from(u.y));
            (r * cos, r * sin)
        };
        let p = DVec3::new(x, y, self.carrier.origin.z);
        Some(AreaPoint { p, n: DVec3::Z, density: self.area_density(p, p) })
    }

    fn area_density(&self, _from: DVec3, _p: DVec3) -> f64 {
        let (outer, inner) = (f64::from(self.radius), f64::from(self.inner_radius));
        2.0 / (f64::from(self.phi_max) * (outer - inner) * (outer + inner))
    }
}

impl Kind for Disk {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "disk",
        aliases: &[],
        doc: "A disk perpendicular to the z axis; with an inner radius a ring, with a smaller angle a sector.",
        params: &[
            ParamSpec::float("height", 0.0, "Its z coordinate.").unit("m"),
            ParamSpec::float("radius", 1.0, "Outer radius; more than innerradius.")
                .unit("m")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("innerradius", 0.0, "Radius of the hole.").unit("m").range(0.0, f32::INFINITY),
            PHI_MAX,
            ALPHA,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let (height, radius) = (args.float("height"), args.float("radius"));
        let (inner_radius, phi_max) = (args.float("innerradius"), args.float("phimax"));
        if args.is_sound() && inner_radius >= radius {
            args.error(
                "radius",
                format!("\"radius\" is {radius}, expected more than innerradius {inner_radius}"),
            );
        }
        args.is_sound().then(|| Geometry::shape(Self::new(height, radius, inner_radius, phi_max)))
    }
}
