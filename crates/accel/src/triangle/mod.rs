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
mod lanes;

use durer_core::math::{Point3, Ray};
use wide::f32x4;

use crate::{
    layout::Axis,
    slab::{Measured, greater},
};

pub use cramer::cramer;
use lanes::Corners;
pub(crate) use lanes::{Found, Reach, packet};

/// Directions smaller than this times the largest component move a ray along no axis: boxes cannot exclude it there.
const HARDLY: f32 = 1.0 / (1 << 20) as f32;

/// With edge functions up to this and `t` up to some [`T_MAX`] products stay below the largest number.
const HUGE: f32 = 1e18;
/// Largest distance of coordinates in multiples of a ray's direction that f32 is trusted with.
pub(crate) const T_MAX: f32 = 1e19;
/// Largest coordinate whose square f32 is trusted with, four of them together.
pub(crate) const COORDINATE_MAX: f32 = 2e18;

/// The two other axes and the longest, by the longest: a turn that keeps right-handedness.
const AXES: [[Axis; 3]; 3] =
    [[Axis::Y, Axis::Z, Axis::X], [Axis::Z, Axis::X, Axis::Y], [Axis::X, Axis::Y, Axis::Z]];

/// A ray's constants for testing triangles.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    /// Origin, by `axes`.
    o: [f32; 3],
    /// The last is the axis along which the direction is largest.
    axes: [Axis; 3],
    /// Shear along the first and second axis, scale of the last.
    x: f32,
    y: f32,
    z: f32,
    /// `1 / d` along the first and second axis.
    reciprocal: [f32; 2],
    /// 0, or infinity for an axis along which the ray hardly moves.
    slack: [f32; 2],
    /// Largest edge function that f32 is trusted with; 0 if with none.
    huge: f32,
}

impl Shear {
    /// `None` for a zero or non-finite direction, or one so short that its reciprocal is not finite.
    pub fn new(ray: &Ray) -> Option<Self> {
        let measured = Measured::of(ray);
        measured.is_valid().then(|| Self::of_valid(&measured))
    }

    /// Of a ray that has a direction.
    #[inline(always)]
    pub(crate) fn of_valid(ray: &Measured) -> Self {
        let [x, y, z, _] = ray.d.abs().to_array();
        // PERF: numbers, not branches: which axis is longest cannot be foretold (bench kernel).
        let of_two = usize::from(y > x);
        let last = if z > greater(x, y) { 2 } else { of_two };
        let axes = AXES[last];
        let (o, d) = (ray.o.as_array(), ray.d.as_array());
        let o = [o[axes[0].index()], o[axes[1].index()], o[axes[2].index()]];
        let d = [d[axes[0].index()], d[axes[1].index()], d[axes[2].index()]];
        let d = f32x4::new([d[0], d[1], d[2], 1.0]);
        let long = f32x4::splat(d.as_array()[2]);
        // PERF: one division of three (bench kernel).
        let (r, ratios) = ((f32x4::ONE / d).to_array(), (d / long).to_array());
        let moves = d.abs().simd_ge(long.abs() * HARDLY);
        let crossed = (f32x4::from(r) & moves).to_array();
        let slack = (f32x4::splat(f32::INFINITY) & !moves).to_array();
        Self {
            o,
            axes,
            x: ratios[0],
            y: ratios[1],
            z: r[2],
            reciprocal: [crossed[0], crossed[1]],
            slack: [slack[0], slack[1]],
            huge: HUGE,
        }
    }

    /// Everything is taken again in f64: for rays among coordinates so large that products overflow.
    pub(crate) fn distrust(&mut self) {
        self.huge = 0.0;
    }

    /// A point relative to the origin, by `axes`.
    fn relative(&self, p: &Point3) -> [f32; 3] {
        std::array::from_fn(|i| p[self.axes[i].index()] - self.o[i])
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

/// Where the ray of `shear` meets the triangle, if at some `t` in `[t_min, t_max]`. Of a triangle that reaches back beyond
/// where the ray begins, `t` must be larger in magnitude than the bound on its own rounding error. Degenerate triangles and
/// those seen exactly edge-on are never hit.
pub fn intersect(shear: &Shear, triangle: &[Point3; 3], t_min: f32, t_max: f32) -> Option<TriangleHit> {
    let reach = Reach { t_min, t_max, floor: f32::NEG_INFINITY };
    let relative = triangle.each_ref().map(|p| shear.relative(p));
    let is_far = |v: &[f32; 3]| v.iter().any(|x| (x * shear.z).abs().max(x.abs()) > COORDINATE_MAX);
    if relative.iter().any(is_far) {
        return exact(shear, triangle, &reach);
    }
    let mut found = Found { t: [0.0], u: [0.0], v: [0.0] };
    let hit = lanes::test::<f32, true>((), shear, reach, One { triangle, relative: &relative }, &mut found);
    let (u, v) = (found.u[0], found.v[0]);
    (hit != 0).then_some(TriangleHit { t: found.t[0], weights: [1.0 - u - v, u, v] })
}

/// One triangle as a group.
#[derive(Clone, Copy)]
struct One<'t> {
    triangle: &'t [Point3; 3],
    relative: &'t [[f32; 3]; 3],
}

impl Corners<f32> for One<'_> {
    fn coordinate(self, (): (), _: &Shear, vertex: usize, axis: usize) -> f32 {
        self.relative[vertex][axis]
    }
    fn triangle(self, _: usize) -> [Point3; 3] {
        *self.triangle
    }
    fn lanes(self) -> u32 {
        1
    }
    fn anew(self) -> Self {
        self
    }
}

/// The same in f64, from the projected vertices: the signs of the edge functions are exact.
fn exact(shear: &Shear, triangle: &[Point3; 3], reach: &Reach) -> Option<TriangleHit> {
    let relative = triangle.each_ref().map(|p| shear.relative(p));
    let projected = relative.map(|[x, y, z]| [x - shear.x * z, y - shear.y * z, z].map(f64::from));
    let [a, b, c] = projected;
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
    let scale = f64::from(shear.z);
    let t = ((weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) * scale) as f32;
    let within = |t: f32| t.is_finite() && reach.t_min <= t && t <= reach.t_max;
    if !within(t) {
        return None;
    }
    let [entry, exit] = window(shear, &relative);
    let begin = reach.t_min.max(0.0);
    if relative.iter().any(|v| v[2] * shear.z <= begin) {
        let is_noise = f64::from(t.abs()) <= error_bound(&projected, &[e0, e1, e2], reciprocal, scale, t);
        if is_noise || exit < reach.t_min {
            return None;
        }
    }
    let t = t.max(entry).max(reach.floor);
    (t <= reach.t_max).then_some(TriangleHit { t, weights: weights.map(|w| w as f32) })
}

/// As in `lanes::keep`, in f64.
fn error_bound(p: &[[f64; 3]; 3], e: &[f64; 3], reciprocal: f64, scale: f64, t: f32) -> f64 {
    let g = |n| f64::from(durer_core::math::error::gamma(n));
    let error = |v: &[f64; 3], axis: usize| g(lanes::CORNER_ROUNDINGS) * (v[axis].abs() + v[2].abs());
    let edge = |p: &[f64; 3], q: &[f64; 3]| {
        let half = |a: usize, b: usize| p[a].abs() * error(q, b) + q[b].abs() * error(p, a);
        let products = (p[0] * q[1]).abs() + (p[1] * q[0]).abs();
        g(lanes::EDGE_ROUNDINGS) * products + half(0, 1) + half(1, 0)
    };
    let sum: f64 = (0..3)
        .map(|i| {
            let depth = p[i][2] * scale;
            let off = edge(&p[(i + 1) % 3], &p[(i + 2) % 3]) * (depth - f64::from(t)).abs();
            off + g(lanes::SUM_ROUNDINGS) * (e[i] * depth).abs()
        })
        .sum();
    sum * reciprocal.abs()
}

/// As `lanes::entry` and `lanes::exit`.
fn window(shear: &Shear, relative: &[[f32; 3]; 3]) -> [f32; 2] {
    let (mut entry, mut exit) = (f32::MIN, f32::MAX);
    for axis in 0..2 {
        let ts = relative.map(|v| v[axis] * shear.reciprocal[axis]);
        entry = entry.max(ts.into_iter().fold(f32::INFINITY, f32::min) - shear.slack[axis]);
        exit = exit.min(ts.into_iter().fold(f32::NEG_INFINITY, f32::max) + shear.slack[axis]);
    }
    [entry, exit]
}
