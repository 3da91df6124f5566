//! Ray against point: spheres and discs in great number, for particles, spray and point clouds.
//!
//! In the frame of the ray, in f64, a sphere around `(x, y, z)` is met at `z -+ sqrt(r^2 - x^2 - y^2)`, which does not
//! cancel like the discriminant of the usual quadratic equation (Physically Based Rendering, 4th edition, section 6.8.3),
//! and a disc with normal `n` at `z + (x n_x + y n_y) / n_z`.
//!
//! A point whose radius is 0 is never hit.
mod error;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point3, Ray, Vector3},
};

pub use error::PointError;

use crate::curve::RayFrame;

/// What is around a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PointKind {
    /// A sphere; a ray that starts inside meets it on its way out.
    Sphere,
    /// A disc that faces every ray. A ray that starts in the sphere around it does not meet it, because a disc that turns
    /// with the ray passes through any point of that sphere.
    Disc,
    /// A disc across [`Points::normals`].
    OrientedDisc,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// What is around them.
    pub kind: PointKind,
    /// Centres.
    pub centers: Vec<Point3>,
    /// Radii, 0 or more.
    pub radii: Vec<f32>,
    /// [`PointKind::OrientedDisc`]: a normal each, of any length. Else empty.
    pub normals: Vec<Vector3>,
}

/// A meeting of ray and point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointHit {
    /// Ray parameter.
    pub t: f32,
    /// Unit normal. Sphere: out of it. Disc: against the ray. Oriented disc: as given.
    pub n_g: Vector3,
}

impl Points {
    /// Finds the first mistake.
    ///
    /// # Errors
    /// If counts do not match, a centre is not finite, a radius is negative or not finite, or a normal is zero or not
    /// finite.
    pub fn check(&self) -> Result<(), PointError> {
        let centers = self.centers.len();
        if self.radii.len() != centers {
            return Err(PointError::RadiusCount { centers, radii: self.radii.len() });
        }
        let expected = if self.kind == PointKind::OrientedDisc { centers } else { 0 };
        if self.normals.len() != expected {
            return Err(PointError::NormalCount { expected, normals: self.normals.len() });
        }
        if let Some(point) = self.centers.iter().position(|p| !p.is_finite()) {
            return Err(PointError::CenterNotFinite { point });
        }
        if let Some(point) = self.radii.iter().position(|r| !(r.is_finite() && *r >= 0.0)) {
            return Err(PointError::RadiusInvalid { point });
        }
        match self.normals.iter().position(|n| !n.is_finite() || n.to_array() == [0.0; 3]) {
            Some(point) => Err(PointError::NormalInvalid { point }),
            None => Ok(()),
        }
    }

    /// The box around a point; infinite where that leaves the range of f32.
    ///
    /// # Panics
    /// If there is no such point, or the points are not sound ([`Self::check`]).
    pub fn bounds(&self, prim: u32) -> Bounds3 {
        let (center, r) = (self.centers[prim as usize].to_f64(), self.radius(prim));
        let reach = match self.kind {
            PointKind::Sphere | PointKind::Disc => DVec3::splat(r),
            PointKind::OrientedDisc => {
                let n = self.normals[prim as usize].to_f64().normalize();
                // sqrt(1 - n_a^2) without its cancellation.
                r * DVec3::from_array(DVec3::AXES.map(|axis| n.cross(axis).length()))
            }
        };
        let pad = (center.abs() + reach) * (8.0 * f64::EPSILON);
        let (min, max) = (center - reach - pad, center + reach + pad);
        Bounds3::new(
            Point3::from(min.to_array().map(|x| (x as f32).next_down())),
            Point3::from(max.to_array().map(|x| (x as f32).next_up())),
        )
    }

    /// The nearest place with `t` in `[ray.t_min, t_max]` where the ray meets the point, further from the origin than its
    /// own error bound. `ray.t_max` is not looked at. `None` for rays that can hit nothing.
    ///
    /// # Panics
    /// If there is no such point, or the points are not sound ([`Self::check`]).
    pub fn intersect(&self, prim: u32, ray: &Ray, t_max: f32) -> Option<PointHit> {
        self.intersect_in(&RayFrame::new(ray)?, prim, t_max)
    }
    /// [`Self::intersect`] for many points and one ray, whose constants are computed once.
    ///
    /// # Panics
    /// As that does.
    pub fn intersect_in(&self, frame: &RayFrame, prim: u32, t_max: f32) -> Option<PointHit> {
        let (center, r) = (frame.project(self.centers[prim as usize]), self.radius(prim));
        let room = r * r - center.x * center.x - center.y * center.y;
        if !(r > 0.0 && room >= 0.0) {
            return None;
        }
        let off = RayFrame::own_error(center.abs().max_element()) + frame.start_error();
        let (t, n_g) = match self.kind {
            PointKind::Sphere => sphere(frame, center, r, off)?,
            PointKind::Disc => {
                // An origin on the sphere counts as inside.
                let outside = center.length() > r + off;
                let t = if outside { frame.t_ahead(center.z, off) } else { None };
                (t?, frame.turn_back(-DVec3::Z))
            }
            PointKind::OrientedDisc => {
                let normal = self.normals[prim as usize];
                let n = frame.turn(normal).normalize();
                (disc(frame, center, r, n, off)?, Vector3::from_f64(normal.to_f64().normalize()))
            }
        };
        (t <= t_max).then_some(PointHit { t, n_g })
    }

    fn radius(&self, prim: u32) -> f64 {
        f64::from(self.radii[prim as usize])
    }
}

/// Parameter and normal of the first way in or out after `t_min`. The centre may be `off` along each axis.
fn sphere(frame: &RayFrame, center: DVec3, r: f64, off: f64) -> Option<(f32, Vector3)> {
    let half = (r * r - center.x * center.x - center.y * center.y).sqrt();
    // |sqrt(g + e) - sqrt(g)| <= min(e / sqrt(g), sqrt(e))
    let g_error = 4.0 * r * off + 2.0 * off * off;
    let error = off + (g_error / half).min(g_error.sqrt());
    [-half, half].into_iter().find_map(|depth| {
        let t = frame.t_ahead(center.z + depth, error)?;
        Some((t, frame.turn_back(DVec3::new(-center.x, -center.y, depth) / r)))
    })
}

/// Parameter at which the ray meets the disc with unit normal `n`.
fn disc(frame: &RayFrame, center: DVec3, r: f64, n: DVec3, off: f64) -> Option<f32> {
    let beyond = (center.x * n.x + center.y * n.y) / n.z;
    let distance_squared = center.x * center.x + center.y * center.y + beyond * beyond;
    // False for the NaN of a disc seen edge-on.
    let inside = distance_squared <= r * r;
    let error = off * (1.0 + n.truncate().length() / n.z.abs());
    if inside { frame.t_ahead(center.z + beyond, error) } else { None }
}
