//! A rectangle sampled by solid angle (Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical
//! Rectangles").
//!
//! In coordinates with the eye at the origin, axes along the edges and the rectangle at `z = z_0 < 0`, its solid angle is
//! the sum of the inner angles of the spherical quadrilateral less `2 pi`. The first number chooses `x` so that the part
//! to the left has its share of the solid angle, the second `y` so that `y / |p|` is uniform.
use std::f64::consts::TAU;

use durer_core::glam::DVec3;

use super::between;

/// Below this solid angle the difference of angles has lost too many digits, and area does as well.
const SMALLEST: f64 = 1e-5;

/// A rectangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    from: DVec3,
    /// Unit vectors along the edges and perpendicular.
    axes: [DVec3; 3],
    /// Smallest and largest coordinates along the edges.
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// z of the unit normals of the planes through the eye and the edges of smallest and largest y.
    b: [f64; 2],
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle of a corner and two perpendicular edges, seen from `from`; `None` where its solid angle is too small
    /// to be worth it, and from points of its plane.
    pub(super) fn of(corner: DVec3, edges: [DVec3; 2], from: DVec3) -> Option<Self> {
        let lengths = edges.map(DVec3::length);
        let (ex, ey) = (edges[0] / lengths[0], edges[1] / lengths[1]);
        let towards = corner - from;
        let ez = ex.cross(ey).normalize();
        let ez = if towards.dot(ez) > 0.0 { -ez } else { ez };
        let z = towards.dot(ez);
        let (x0, y0) = (towards.dot(ex), towards.dot(ey));
        let (x, y) = ([x0, x0 + lengths[0]], [y0, y0 + lengths[1]]);
        // Planes through the eye and the edges, in order around the rectangle.
        let at = |x, y| DVec3::new(x, y, z);
        let corners = [at(x[0], y[0]), at(x[1], y[0]), at(x[1], y[1]), at(x[0], y[1])];
        let plane = |i: usize| corners[i].cross(corners[(i + 1) % 4]).normalize_or_zero();
        let planes = [plane(0), plane(1), plane(2), plane(3)];
        let inner = |i: usize| between(-planes[i], planes[(i + 1) % 4]);
        let k = TAU - inner(2) - inner(3);
        let solid_angle = inner(0) + inner(1) - k;
        (z < 0.0 && solid_angle > SMALLEST).then(|| Self {
            from,
            axes: [ex, ey, ez],
            x,
            y,
            z,
            b: [planes[0].z, planes[2].z],
            k,
            solid_angle,
        })
    }
    /// Density of every direction, 1/sr.
    pub(super) fn density(&self) -> f64 {
        1.0 / self.solid_angle
    }
    /// A point of the rectangle; `u` in `[0, 1)²`.
    pub(super) fn point(&self, u: [f64; 2]) -> DVec3 {
        let (sin, cos) = libm::sincos(u[0] * self.solid_angle + self.k);
        let f = (cos * self.b[0] - self.b[1]) / sin;
        let c = (1.0 / (f * f + self.b[0] * self.b[0]).sqrt()).copysign(f).clamp(-1.0, 1.0);
        let x = (-c * self.z / (1.0 - c * c).sqrt()).clamp(self.x[0], self.x[1]);
        let across2 = x * x + self.z * self.z;
        let height = |y: f64| y / (across2 + y * y).sqrt();
        let h = height(self.y[0]) + u[1] * (height(self.y[1]) - height(self.y[0]));
        let y = (h * (across2 / (1.0 - h * h)).sqrt()).clamp(self.y[0], self.y[1]);
        let [ex, ey, ez] = self.axes;
        self.from + ex * x + ey * y + ez * self.z
    }
}
