//! A rectangle sampled by solid angle (Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical
//! Rectangles").
//!
//! In coordinates with the eye at the origin and axes along the edges and the normal, its solid angle is the sum
//! of the inner angles of the spherical quadrilateral less `2 pi`. The angle at the corner `(x, y)` of distance `r` is `pi / 2`
//! plus or minus `atan(x y / |z| r)`; sums and differences of those come from products of the complex numbers `|z| r + i x y`.
//! The first number chooses `x` so that the part to the left has its share of the solid angle, the second `y` so that
//! `y / |p|` is uniform.
use std::f64::consts::TAU;

use durer_core::glam::DVec3;

/// Below this solid angle the difference of angles has lost too many digits, and area does as well.
const SMALLEST: f64 = 1e-5;

/// Cosine up to which edges count as perpendicular: what rounding makes of a right angle.
const PERPENDICULAR: f64 = 1e-6;

/// A rectangle with what is the same for all points that see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) corner: DVec3,
    pub(super) edges: [DVec3; 2],
    /// Unit vectors along the edges and perpendicular, on the outside.
    axes: [DVec3; 3],
    lengths: [f64; 2],
}

impl Rectangle {
    /// From a corner and two edges; `None` if they are not perpendicular.
    pub(super) fn new(corner: DVec3, [e, f]: [DVec3; 2]) -> Option<Self> {
        let lengths = [e.length(), f.length()];
        let n = e.cross(f).normalize_or_zero();
        let is_one = e.dot(f).abs() <= PERPENDICULAR * lengths[0] * lengths[1];
        is_one.then(|| Self { corner, edges: [e, f], axes: [e / lengths[0], f / lengths[1], n], lengths })
    }
    /// Unit normal, on the outside.
    pub(super) fn normal(&self) -> DVec3 {
        self.axes[2]
    }
}

/// A rectangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle<'r> {
    rectangle: &'r Rectangle,
    from: DVec3,
    /// Smallest and largest coordinates along the edges.
    x: [f64; 2],
    y: [f64; 2],
    /// Along the normal.
    z: f64,
    /// Cosine and sine of the difference of the angles at the two corners of smallest x.
    left: [f64; 2],
    solid_angle: f64,
}

impl<'r> SphericalRectangle<'r> {
    /// The rectangle seen from `from`; `None` where its solid angle is too small to be worth it, and from points of its
    /// plane.
    pub(super) fn of(rectangle: &'r Rectangle, from: DVec3) -> Option<Self> {
        let towards = rectangle.corner - from;
        let [x, y, z] = rectangle.axes.map(|axis| towards.dot(axis));
        let [width, height] = rectangle.lengths;
        let (x, y) = ([x, x + width], [y, y + height]);
        let at = |x: f64, y: f64| (z.abs() * (x * x + y * y + z * z).sqrt(), x * y);
        // a b* of two complex numbers: its argument is the difference of theirs.
        let turn = |(a, c): (f64, f64), (b, d): (f64, f64)| (a * b + c * d, c * b - a * d);
        let right = turn(at(x[1], y[1]), at(x[1], y[0]));
        let left = turn(at(x[0], y[1]), at(x[0], y[0]));
        let (cos, sin) = turn(right, left);
        let solid_angle = libm::atan2(sin, cos);
        let passes_pi = solid_angle < 0.0 && right.1 > 0.0 && left.1 < 0.0;
        let solid_angle = if passes_pi { solid_angle + TAU } else { solid_angle };
        let length = (left.0 * left.0 + left.1 * left.1).sqrt();
        let left = [left.0 / length, left.1 / length];
        let this = Self { rectangle, from, x, y, z, left, solid_angle };
        (z != 0.0 && solid_angle > SMALLEST).then_some(this)
    }
    /// Density of every direction, 1/sr.
    pub(super) fn density(&self) -> f64 {
        1.0 / self.solid_angle
    }
    /// A point of the rectangle; `u` in `[0, 1)²`.
    pub(super) fn point(&self, u: [f64; 2]) -> DVec3 {
        let z2 = self.z * self.z;
        // z of the unit normals of the planes through the eye and the edges of smallest and largest y.
        let b = self.y.map(|y| y / (y * y + z2).sqrt());
        let (sin, cos) = libm::sincos(u[0] * self.solid_angle);
        let [c, s] = self.left;
        let (sin, cos) = (sin * c + cos * s, cos * c - sin * s);
        let f = (b[1] - cos * b[0]) / sin;
        let c2 = 1.0 / (f * f + b[0] * b[0]);
        let x = ((c2 / (1.0 - c2).max(0.0)).sqrt().copysign(f) * self.z.abs()).clamp(self.x[0], self.x[1]);
        let across2 = x * x + z2;
        let height = |y: f64| y / (across2 + y * y).sqrt();
        let h = height(self.y[0]) + u[1] * (height(self.y[1]) - height(self.y[0]));
        let y = (h * (across2 / (1.0 - h * h)).sqrt()).clamp(self.y[0], self.y[1]);
        let [ex, ey, ez] = self.rectangle.axes;
        self.from + ex * x + ey * y + ez * self.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The part of a rectangle of sides `a` and `b` that lies above one of its corners, at distance `d`: `atan(a b / d r)`.
    fn above_a_corner(a: f64, b: f64, d: f64) -> f64 {
        (a * b).atan2(d * (a * a + b * b + d * d).sqrt())
    }

    #[test]
    fn solid_angles_are_those_of_the_closed_form_up_to_a_half_space() {
        let sides = [DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
        let rectangle = Rectangle::new(DVec3::ZERO, sides).expect("a right angle");
        for (x, y) in [(1.0, 1.5), (0.2, 2.9), (0.0, 0.0), (1.0, 0.0)] {
            for d in [30.0, 3.0, 0.5, 0.1, 1e-3, 1e-6] {
                let parts = [(x, y), (2.0 - x, y), (x, 3.0 - y), (2.0 - x, 3.0 - y)];
                let expected: f64 = parts.iter().map(|(a, b)| above_a_corner(*a, *b, d)).sum();
                for z in [d, -d] {
                    let from = DVec3::new(x, y, z);
                    let seen = SphericalRectangle::of(&rectangle, from).expect("large enough");
                    let solid_angle = 1.0 / seen.density();
                    assert!((solid_angle / expected - 1.0).abs() < 1e-9, "{from}: {solid_angle} {expected}");
                    // Halves of the first number have halves of the angle on their sides.
                    let p = seen.point([0.5, 0.5]);
                    let left =
                        Rectangle::new(DVec3::ZERO, [DVec3::new(p.x, 0.0, 0.0), sides[1]]).expect("a part");
                    let part = SphericalRectangle::of(&left, from).map_or(0.0, |seen| 1.0 / seen.density());
                    assert!((part / expected - 0.5).abs() < 1e-4, "{from}: {part} of {expected}");
                }
            }
        }
    }
}
