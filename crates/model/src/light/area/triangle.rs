//! A triangle sampled by solid angle (Arvo 1995, "Stratified Sampling of Spherical Triangles").
//!
//! The solid angle is `2 atan2(a.(b x c), 1 + a.b + b.c + c.a)` (Van Oosterom and Strackee 1983). The first number
//! chooses a point of the arc from the third to the first corner so that the part up to it has its share of the solid
//! angle, the second a point of the arc from there to the second corner, uniform in its cosine.
use std::f64::consts::PI;

use durer_core::glam::DVec3;

use super::between;

/// Below this solid angle the inner angles have lost too many digits, and area does as well.
const SMALLEST: f64 = 1e-5;
/// Beyond this one, nearly the half sphere, so have the planes of the arcs.
const LARGEST: f64 = 6.22;

/// A triangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalTriangle {
    from: DVec3,
    /// A corner, and the normal of the plane, which need not be of unit length.
    corner: DVec3,
    normal: DVec3,
    /// Unit vectors to the corners.
    towards: [DVec3; 3],
    /// Inner angle at the first corner.
    alpha: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The triangle seen from `from`; `None` where its solid angle is too small or too large to be sampled.
    pub(super) fn of(corners: [DVec3; 3], from: DVec3) -> Option<Self> {
        let [a, b, c] = corners.map(|p| (p - from).normalize_or_zero());
        let volume = a.dot(b.cross(c)).abs();
        let solid_angle = 2.0 * libm::atan2(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        if !(SMALLEST..=LARGEST).contains(&solid_angle) {
            return None;
        }
        let alpha = between(a.cross(b), a.cross(c));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        Some(Self { from, corner: corners[0], normal, towards: [a, b, c], alpha, solid_angle })
    }
    /// Density of every direction, 1/sr.
    pub(super) fn density(&self) -> f64 {
        1.0 / self.solid_angle
    }
    /// A point of the triangle; `u` in `[0, 1)²`. `None` if rounding leaves no direction.
    pub(super) fn point(&self, u: [f64; 2]) -> Option<DVec3> {
        let [a, b, c] = self.towards;
        let (sin_alpha, cos_alpha) = libm::sincos(self.alpha);
        // The sub-triangle's area is beta' + gamma' + alpha - pi; Arvo's s and t are of area - alpha.
        let (s, t) = libm::sincos(u[0] * self.solid_angle - self.alpha);
        let cos_side = a.dot(b);
        let p = t - cos_alpha;
        let q = s + sin_alpha * cos_side;
        let upper = (q * t - p * s) * cos_alpha - q;
        let lower = (q * s + p * t) * sin_alpha;
        let cos_b = (upper / lower).clamp(-1.0, 1.0);
        let cos_b = if cos_b.is_nan() { 1.0 } else { cos_b };
        let beyond = (c - a * c.dot(a)).normalize_or_zero();
        let on_arc = a * cos_b + beyond * (1.0 - cos_b * cos_b).sqrt();
        let cos = 1.0 - u[1] * (1.0 - on_arc.dot(b));
        let aside = (on_arc - b * on_arc.dot(b)).normalize_or_zero();
        let w = b * cos + aside * (1.0 - cos * cos).max(0.0).sqrt();
        let t = (self.corner - self.from).dot(self.normal) / w.dot(self.normal);
        let p = self.from + w * t;
        (t > 0.0 && p.is_finite()).then_some(p)
    }
}

/// A point of a triangle, uniform over its area; `u` in `[0, 1)²`.
pub(super) fn point_by_area([a, b, c]: [DVec3; 3], u: [f64; 2]) -> DVec3 {
    let root = u[0].sqrt();
    a * (1.0 - root) + b * (root * (1.0 - u[1])) + c * (root * u[1])
}

/// Area of a triangle.
pub(super) fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Whether a triangle can be told from a point or a line, and its unit normal on the side from which it is seen
/// counter-clockwise; `None` if not.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let n = (b - a).cross(c - a).normalize_or_zero();
    (n != DVec3::ZERO).then_some(n)
}

const _: () = assert!(LARGEST < 2.0 * PI);
