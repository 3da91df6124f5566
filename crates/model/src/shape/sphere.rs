//! Sphere around the origin, whole or cut.
//!
//! Implicit form `H(P) = P.P - r^2 = 0` (lecture, "Sphere Representation"; Physically Based Rendering, 4th edition, section
//! 6.2), solved as a chord of the ray.
use std::f32::consts::{PI, TAU};

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3, error::gamma, float},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{ALPHA, AreaPoint, Geometry, Outline, PHI_MAX, RADIUS, Shape, ShapeHit, arc_angle, chord::Chord};
use crate::{Surface, texture::Footprint};

/// A sphere of radius `r` around the origin, kept where `z_min <= z <= z_max` and `0 <= phi <= phi_max`. The poles lie
/// on the z axis; the outside is away from the centre. `u = phi / phi_max`; `v` runs from 0 at `z_min` to 1 at `z_max`,
/// linear in the polar angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f32,
    z_min: f32,
    z_max: f32,
    /// Radians.
    phi_max: f32,
    /// Polar angles at `z_min` (the larger) and `z_max`, radians.
    theta: (f32, f32),
    whole: bool,
}

impl Sphere {
    /// A whole sphere.
    pub fn new(radius: f32) -> Self {
        Self::cut(radius, -radius, radius, 360.0)
    }
    /// The part between two heights (in any order, clamped to the sphere) and from phi = 0 to `phi_max` degrees.
    pub fn cut(radius: f32, z_min: f32, z_max: f32, phi_max: f32) -> Self {
        let clamp = |z: f32| z.clamp(-radius, radius);
        let (z_min, z_max) = (clamp(z_min.min(z_max)), clamp(z_min.max(z_max)));
        let theta = (float::acos(z_min / radius), float::acos(z_max / radius));
        let phi_max = arc_angle(phi_max);
        let whole = z_min == -radius && z_max == radius && phi_max == TAU;
        let theta = if whole { (PI, 0.0) } else { theta };
        Self { radius, z_min, z_max, phi_max, theta, whole }
    }

    fn chord(&self, ray: &Ray) -> Option<Chord> {
        Chord::of(ray.o.to_f64(), ray.d.to_f64(), self.radius)
    }

    /// The point at `t`, put back on the sphere.
    fn point(&self, ray: &Ray, t: f64) -> DVec3 {
        let p = ray.o.to_f64() + ray.d.to_f64() * t;
        let length = p.length();
        if length > 0.0 {
            p * (f64::from(self.radius) / length)
        } else {
            DVec3::new(0.0, 0.0, self.radius.into())
        }
    }

    fn keeps(&self, p: DVec3) -> bool {
        self.whole
            || (p.z >= f64::from(self.z_min)
                && p.z <= f64::from(self.z_max)
                && (self.phi_max == TAU || phi(p) <= self.phi_max))
    }
}

/// Azimuth in `[0, 2 pi]`.
fn phi(p: DVec3) -> f32 {
    super::azimuth(p.x as f32, p.y as f32)
}

impl Shape for Sphere {
    fn bounds(&self) -> Bounds3 {
        let r = self.radius;
        Bounds3::new(Point3::new(-r, -r, self.z_min), Point3::new(r, r, self.z_max))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let chord = self.chord(ray)?;
        if chord.far() < ray.t_min.into() || chord.near() as f32 > ray.t_max {
            return None;
        }
        [chord.near(), chord.far()].into_iter().find_map(|t| {
            let rounded = chord.hit(ray, t)?;
            (self.whole || self.keeps(self.point(ray, t))).then_some(ShapeHit { t: rounded, u: 0.0, v: 0.0 })
        })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        // Solved again: rounding t to f32 would slide the point along the ray by up to t * 2^-24.
        let t = self.chord(ray).map_or(hit.t.into(), |chord| chord.root_at(hit.t));
        let exact = self.point(ray, t);
        let p = Point3::from_f64(exact);
        let n = Normal3::from_f64(exact / f64::from(self.radius));
        let across = exact.truncate().length();
        let theta = float::atan2(across as f32, p.z);
        let (bottom, top) = self.theta;
        // A pole has no azimuth: any will do.
        let (cos_phi, sin_phi) = if across > 0.0 { (exact.x / across, exact.y / across) } else { (1.0, 0.0) };
        let down = Vector3::from_f64(DVec3::new(exact.z * cos_phi, exact.z * sin_phi, -across));
        let uv = Point2::new(phi(exact) / self.phi_max, (theta - bottom) / (top - bottom));
        Surface {
            p,
            p_error: (p - Point3::ZERO).abs() * gamma(5),
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu: Vector3::new(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: down * (top - bottom),
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }

    fn area(&self) -> f32 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    fn outline(&self) -> Outline {
        if self.whole { Outline::Sphere { radius: self.radius.into() } } else { Outline::Curved }
    }

    /// Archimedes: heights are uniform.
    fn by_area(&self, u: Point2) -> Option<AreaPoint> {
        let (r, low, high) = (f64::from(self.radius), f64::from(self.z_min), f64::from(self.z_max));
        let z = low + (high - low) * f64::from(u.x);
        let (sin, cos) = libm::sincos(f64::from(self.phi_max) * f64::from(u.y));
        let across = (r * r - z * z).max(0.0).sqrt();
        let p = DVec3::new(across * cos, across * sin, z);
        Some(AreaPoint { p, n: p / r, density: 1.0 / (f64::from(self.phi_max) * r * (high - low)) })
    }

    fn area_density(&self, _from: DVec3, _p: DVec3) -> f64 {
        1.0 / (f64::from(self.phi_max) * f64::from(self.radius) * f64::from(self.z_max - self.z_min))
    }
}

impl Kind for Sphere {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "sphere",
        aliases: &[],
        doc: "A sphere around the origin, whole or cut by two heights and an angle. Its poles lie on the z axis.",
        params: &[
            RADIUS,
            ParamSpec::new("zmin", ParamType::Float, ParamDefault::Unset, "Lowest z kept; default -radius.")
                .unit("m"),
            ParamSpec::new("zmax", ParamType::Float, ParamDefault::Unset, "Highest z kept; default radius.")
                .unit("m"),
            PHI_MAX,
            ALPHA,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let (radius, phi_max) = (args.float("radius"), args.float("phimax"));
        let z_min = args.optional_float("zmin").unwrap_or(-radius);
        let z_max = args.optional_float("zmax").unwrap_or(radius);
        if args.is_sound() && z_min.clamp(-radius, radius) == z_max.clamp(-radius, radius) {
            args.error("zmin", format!("nothing of the sphere lies between zmin {z_min} and zmax {z_max}"));
        }
        args.is_sound().then(|| Geometry::shape(Self::cut(radius, z_min, z_max, phi_max)))
    }
}
