//! Ray against triangle, watertight.
//!
//! The triangle is moved and sheared so that the ray becomes the z axis; the signs of the three edge functions
//! `e_ab = a_x b_y - a_y b_x` decide, and `t` is their weighted mean of the vertices' depths (Woop, Benthin, Wald 2013,
//! "Watertight Ray/Triangle Intersection"). A vertex is projected the same way whichever triangle it belongs to and the
//! rounding of a difference keeps its sign, so two triangles that share an edge never both miss. When an edge function
//! is exactly 0 in f32 (or overflows) it is taken again in f64, where products of f32 are exact.
//!
//! Both sides count. The lecture's own test is [`cramer`].
mod cramer;

use durer_core::math::{Point3, Ray};

pub use cramer::cramer;

/// A ray's constants for testing triangles.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    o: Point3,
    /// Axis along which the direction is largest.
    axis: usize,
    /// Shear along the next axis, the one after it, and scale of the largest.
    x: f32,
    y: f32,
    z: f32,
}

impl Shear {
    /// `None` for a zero or non-finite direction, or one so short that its reciprocal is not finite.
    pub fn new(ray: &Ray) -> Option<Self> {
        let axis = ray.d.max_axis();
        let z = 1.0 / ray.d[axis];
        if !(z.is_finite() && ray.d.is_finite()) {
            return None;
        }
        let ratio = |a: usize| ray.d[a % 3] / ray.d[axis];
        Some(Self { o: ray.o, axis, x: ratio(axis + 1), y: ratio(axis + 2), z })
    }

    /// `p` with the ray as z axis; z is left in units of length.
    #[inline(always)]
    fn project<const AXIS: usize>(&self, p: &Point3) -> [f32; 3] {
        let q = [p.x - self.o.x, p.y - self.o.y, p.z - self.o.z];
        let z = q[AXIS];
        [q[(AXIS + 1) % 3] - self.x * z, q[(AXIS + 2) % 3] - self.y * z, z]
    }
}

/// A meeting of ray and triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter.
    pub t: f32,
    /// Weights of the three vertices: each in `[0, 1]`, their sum 1 within 2e-6.
    pub weights: [f32; 3],
}

/// Where the ray of `shear` meets the triangle, if at some `t` in `[t_min, t_max]` that is larger in magnitude than its
/// own rounding error bound. Degenerate triangles and those seen exactly edge-on are never hit.
#[inline]
pub fn intersect(shear: &Shear, triangle: &[Point3; 3], t_min: f32, t_max: f32) -> Option<TriangleHit> {
    match shear.axis {
        0 => along::<0>(shear, triangle, t_min, t_max),
        1 => along::<1>(shear, triangle, t_min, t_max),
        _ => along::<2>(shear, triangle, t_min, t_max),
    }
}

#[inline(always)]
fn along<const AXIS: usize>(
    s: &Shear,
    triangle: &[Point3; 3],
    t_min: f32,
    t_max: f32,
) -> Option<TriangleHit> {
    let [a, b, c] = triangle;
    let (a, b, c) = (s.project::<AXIS>(a), s.project::<AXIS>(b), s.project::<AXIS>(c));
    let e0 = b[0] * c[1] - b[1] * c[0];
    let e1 = c[0] * a[1] - c[1] * a[0];
    let e2 = a[0] * b[1] - a[1] * b[0];
    // A sign that is not 0 is right; two different ones settle it whatever the third is.
    if (e0 < 0.0 || e1 < 0.0 || e2 < 0.0) && (e0 > 0.0 || e1 > 0.0 || e2 > 0.0) {
        return None;
    }
    let reciprocal = 1.0 / (e0 + e1 + e2);
    let ordinary = e0 != 0.0 && e1 != 0.0 && e2 != 0.0 && reciprocal.is_finite() && reciprocal != 0.0;
    if !ordinary {
        return exact(s, [a, b, c], t_min, t_max);
    }
    let weights = [e0 * reciprocal, e1 * reciprocal, e2 * reciprocal];
    let t = (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) * s.z;
    if !(t_min <= t && t <= t_max) {
        return None;
    }
    let largest = e0.abs().max(e1.abs()).max(e2.abs());
    let bound = t_error(s, &[a, b, c], f64::from(largest), f64::from(reciprocal));
    (f64::from(t.abs()) > bound).then_some(TriangleHit { t, weights })
}

/// The same in f64, from the projected vertices: the signs of the edge functions are exact.
#[cold]
#[inline(never)]
fn exact(s: &Shear, vertices: [[f32; 3]; 3], t_min: f32, t_max: f32) -> Option<TriangleHit> {
    let [a, b, c] = vertices.map(|v| v.map(f64::from));
    let e0 = b[0] * c[1] - b[1] * c[0];
    let e1 = c[0] * a[1] - c[1] * a[0];
    let e2 = a[0] * b[1] - a[1] * b[0];
    if (e0 < 0.0 || e1 < 0.0 || e2 < 0.0) && (e0 > 0.0 || e1 > 0.0 || e2 > 0.0) {
        return None;
    }
    let reciprocal = 1.0 / (e0 + e1 + e2);
    if !reciprocal.is_finite() {
        return None;
    }
    let weights = [e0 * reciprocal, e1 * reciprocal, e2 * reciprocal];
    let t = ((weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) * f64::from(s.z)) as f32;
    if !(t.is_finite() && t_min <= t && t <= t_max) {
        return None;
    }
    let largest = e0.abs().max(e1.abs()).max(e2.abs());
    let bound = t_error(s, &vertices, largest, reciprocal);
    (f64::from(t.abs()) > bound).then_some(TriangleHit { t, weights: weights.map(|w| w as f32) })
}

/// Bound on the absolute error of `t` (Physically Based Rendering, 4th edition, section 6.8.7): the roundings of the
/// projection carried through edge functions and weighted mean. f64 only so that it cannot overflow.
fn t_error(s: &Shear, vertices: &[[f32; 3]; 3], largest_edge: f64, reciprocal: f64) -> f64 {
    let g = |n| f64::from(durer_core::math::error::gamma(n));
    let reach =
        |i: usize| f64::from(vertices[0][i].abs().max(vertices[1][i].abs()).max(vertices[2][i].abs()));
    let (x, y, z) = (reach(0), reach(1), reach(2));
    let (dx, dy, dz) = (g(5) * (x + z), g(5) * (y + z), g(3) * z);
    let d_edge = 2.0 * (g(2) * x * y + dy * x + dx * y);
    let d_t = 3.0 * (g(3) * largest_edge * z + d_edge * z + dz * largest_edge);
    d_t * (reciprocal * f64::from(s.z)).abs()
}
