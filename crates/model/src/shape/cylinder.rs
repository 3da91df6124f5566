//! Cylinder about the z axis, open at both ends (Physically Based Rendering, 4th edition, section 6.3).
//!
//! `x^2 + y^2 = r^2`: seen along z, the chord that a circle cuts out of the ray.
use std::f32::consts::TAU;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3, error::gamma},
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    ALPHA, AreaPoint, Geometry, Outline, PHI_MAX, RADIUS, Shape, ShapeHit, arc_angle, azimuth, chord::Chord,
};
use crate::{Surface, texture::Footprint};

/// The part of a cylinder with `z_min <= z <= z_max` and `0 <= phi <= phi_max`. The outside is away from the axis.
/// `u = phi / phi_max`; `v` runs from 0 at `z_min` to 1 at `z_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    radius: f32,
    z_min: f32,
    z_max: f32,
    /// Radians.
    phi_max: f32,
}

impl Cylinder {
    /// Between two heights (in any order) and from phi = 0 to `phi_max` degrees.
    pub fn new(radius: f32, z_min: f32, z_max: f32, phi_max: f32) -> Self {
        Self { radius, z_min: z_min.min(z_max), z_max: z_min.max(z_max), phi_max: arc_angle(phi_max) }
    }

    fn chord(&self, ray: &Ray) -> Option<Chord> {
        let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
        // An infinite z would give points that are no numbers.
        let chord = Chord::of(flat(ray.o.to_f64()), flat(ray.d.to_f64()), self.radius)?;
        (ray.o.z.is_finite() && ray.d.z.is_finite()).then_some(chord)
    }

    /// The point at `t`, put back on the cylinder.
    fn point(&self, ray: &Ray, t: f64) -> DVec3 {
        let p = ray.o.to_f64() + ray.d.to_f64() * t;
        let across = p.truncate().length();
        let factor = f64::from(self.radius) / across;
        DVec3::new(p.x * factor, p.y * factor, p.z)
    }

    fn keeps(&self, p: DVec3) -> bool {
        p.z >= f64::from(self.z_min)
            && p.z <= f64::from(self.z_max)
            && (self.phi_max == TAU || azimuth(p.x as f32, p.y as f32) <= self.phi_max)
    }
}

impl Shape for Cylinder {
    fn bounds(&self) -> Bounds3 {
        let r = self.radius;
        Bounds3::new(Point3::new(-r, -r, self.z_min), Point3::new(r, r, self.z_max))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let chord = self.chord(ray)?;
        [chord.near(), chord.far()].into_iter().find_map(|t| {
            let rounded = chord.hit(ray, t)?;
            self.keeps(self.point(ray, t)).then_some(ShapeHit { t: rounded, u: 0.0, v: 0.0 })
        })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        // Solved again: rounding t to f32 would slide the point along the ray by up to t * 2^-24.
        let t = self.chord(ray).map_or(hit.t.into(), |chord| chord.root_at(hit.t));
        let exact = self.point(ray, t);
        let p = Point3::from_f64(exact);
        let n = Normal3::from_f64(DVec3::new(exact.x, exact.y, 0.0) / f64::from(self.radius));
        let height = self.z_max - self.z_min;
        let uv = Point2::new(azimuth(p.x, p.y) / self.phi_max, ((p.z - self.z_min) / height).clamp(0.0, 1.0));
        Surface {
            p,
            p_error: (p - Point3::ZERO).abs() * gamma(5),
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu: Vector3::new(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: Vector3::new(0.0, 0.0, height),
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }

    fn area(&self) -> f32 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    fn outline(&self) -> Outline {
        Outline::Curved
    }

    fn by_area(&self, u: Point2) -> Option<AreaPoint> {
        let (r, low, high) = (f64::from(self.radius), f64::from(self.z_min), f64::from(self.z_max));
        let (sin, cos) = libm::sincos(f64::from(self.phi_max) * f64::from(u.y));
        let p = DVec3::new(r * cos, r * sin, low + (high - low) * f64::from(u.x));
        Some(AreaPoint { p, n: DVec3::new(cos, sin, 0.0), density: self.area_density(p, p) })
    }

    fn area_density(&self, _from: DVec3, _p: DVec3) -> f64 {
        1.0 / (f64::from(self.phi_max) * f64::from(self.radius) * f64::from(self.z_max - self.z_min))
    }
}

impl Kind for Cylinder {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "cylinder",
        aliases: &[],
        doc: "A cylinder about the z axis, open at both ends; with a smaller angle a part of one.",
        params: &[
            RADIUS,
            ParamSpec::float("zmin", -1.0, "Lowest z.").unit("m"),
            ParamSpec::float("zmax", 1.0, "Highest z.").unit("m"),
            PHI_MAX,
            ALPHA,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let (radius, phi_max) = (args.float("radius"), args.float("phimax"));
        let (z_min, z_max) = (args.float("zmin"), args.float("zmax"));
        if args.is_sound() && z_min == z_max {
            args.error("zmin", format!("zmin and zmax are both {z_min}: nothing lies between them"));
        }
        args.is_sound().then(|| Geometry::shape(Self::new(radius, z_min, z_max, phi_max)))
    }
}
