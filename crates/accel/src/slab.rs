//! Ray against box: where it enters and leaves, rounded so that no box around a hit is ever missed.
//!
//! A plane at `x` is met at `(x - o) / d`, computed as one fused `x r + c` with `r = 1 / d`, `c = -o r`. Three things can
//! go wrong by rounding, and each has its slack:
//! - The triangle test projects each vertex with an error of up to 6 u times its distance, u = 2^-24: along the ray this is
//!   a sideways error that grows with `t`. So a ray may be anywhere within `d ± 16 u |d|` of where it is: the plane by which
//!   it enters is met with the larger of both, that by which it leaves with the smaller (Woop, Benthin, Wald 2013,
//!   "Watertight Ray/Triangle Intersection", section 4, moves the origin instead, by the size of the whole scene).
//! - The rest of that error grows with the triangle: boxes are built 16 u larger than what they hold, see [`grown`].
//! - `o r` is rounded: 4 u |o r| either way.
use durer_core::math::{Bounds3, Ray};
use wide::f32x4;

use crate::triangle::{COORDINATE_MAX, T_MAX};

/// Half the distance between 1 and the next number.
const U: f32 = f32::EPSILON / 2.0;
/// Slack of directions and boxes, twice what the triangle test needs and more.
const SLACK: f32 = 16.0 * U;
/// Slack of what the origin does to a sum.
const ORIGIN_SLACK: f32 = 4.0 * U;
/// Smallest component of a direction compared to its length: below it the ray moves along the axis by nothing.
const FLOOR: f32 = 1e-18;
/// The reciprocal of the largest component of any shorter direction is infinite.
const SHORTEST: f32 = 9e-39;
/// Directions from this length on need no care.
const SHORT: f32 = 1e-18;
/// Boxes farther behind the origin than this are not told apart.
const BACK_MAX: f32 = 1e30;
/// Products of reciprocals and coordinates stay below the largest number.
const PRODUCT_MAX: f32 = 1e37;

/// A ray's constants for meeting planes, by axis: `t = plane * r + c`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    /// For the planes by which the ray enters; the fourth lanes hold nothing.
    pub(crate) near_r: f32x4,
    pub(crate) near_c: f32x4,
    /// For those by which it leaves.
    pub(crate) far_r: f32x4,
    pub(crate) far_c: f32x4,
    /// Whether it enters by the upper plane.
    pub(crate) enters_above: [bool; 3],
    o: f32x4,
    /// Absolute slack of rays that begin behind their origin.
    behind: f32x4,
    /// What nodes' boxes add to `t`: 0, or `-t_min` of a ray that begins behind its origin, so that nothing is negative.
    pub(crate) shift: f32,
}

impl Slab {
    /// For rays that are not odd.
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &Measured) -> Self {
        Self::with_floor::<ROBUST>(ray, FLOOR * ray.length)
    }

    /// With no reciprocal larger than that of `floor`.
    #[inline(always)]
    fn with_floor<const ROBUST: bool>(ray: &Measured, floor: f32) -> Self {
        let (o, d, length) = (ray.o, ray.d, ray.length);
        let size = d.abs();
        let floor = f32x4::splat(floor);
        let slack = f32x4::splat(if ROBUST { SLACK * length } else { 0.0 });
        let origin_slack = f32x4::splat(if ROBUST { ORIGIN_SLACK } else { 0.0 });
        // PERF: in vectors, for ten divisions one after another are a tenth of a short ray (bench kernel).
        let near = (f32x4::ONE / (size + slack).fast_max(floor)).copysign(d);
        let far = (f32x4::ONE / (size - slack).fast_max(floor)).copysign(d);
        let (at_near, at_far) = (o * near, o * far);
        let [x, y, z, _] = d.to_array();
        Self {
            near_r: near,
            near_c: -at_near - origin_slack * at_near.abs(),
            far_r: far,
            far_c: origin_slack * at_far.abs() - at_far,
            enters_above: [is_negative(x), is_negative(y), is_negative(z)],
            o,
            behind: f32x4::ZERO,
            shift: 0.0,
        }
    }

    /// For rays that begin behind their origin, are very short, or so short that coordinates divided by them overflow.
    #[cold]
    #[inline(never)]
    pub(crate) fn odd<const ROBUST: bool>(ray: &Measured, region: f32) -> Self {
        let length = ray.length;
        let slack = SLACK * length;
        let least = greater(ray.away, region) / PRODUCT_MAX;
        let floor = greater(greater(FLOOR * length, least), SHORTEST);
        let mut slab = Self::with_floor::<ROBUST>(ray, floor);
        if length < SHORT || least > slack {
            // Boxes are never left.
            (slab.far_r, slab.far_c) = (f32x4::ZERO, f32x4::splat(f32::MAX));
        }
        if ray.t_min < 0.0 {
            let back = lesser(-ray.t_min, BACK_MAX);
            // What is relative errs the other way behind the origin; no error there is larger than this.
            let of = |size: f32| match size > 2.0 * slack {
                true => 4.0 * slack / size * back,
                false => f32::MAX / 4.0,
            };
            let [x, y, z] = [0, 1, 2].map(|axis| of(ray.d.as_array()[axis].abs()));
            slab.behind = f32x4::new([x, y, z, z]);
            slab.shift = back;
            slab.near_c += slab.shift - slab.behind * 2.0;
            slab.far_c += slab.shift + slab.behind * 2.0;
        }
        slab
    }

    /// The stretch inside a box that was [`grown`]; it lies within what any node around the box grown again admits.
    #[inline(always)]
    pub(crate) fn window(&self, b: &Bounds3) -> Window {
        let (lower, upper) = (lanes(b.min.to_array()), lanes(b.max.to_array()));
        // A reciprocal's sign tells by which plane the ray enters.
        let rises = self.near_r.simd_ge(f32x4::ZERO) & !self.near_r.is_sign_negative();
        let (near, far) = (rises.bitselect(lower, upper), rises.bitselect(upper, lower));
        let entry = (near * self.near_r - self.o * self.near_r - self.behind).to_array();
        let is_left = self.far_r.simd_ne(f32x4::ZERO);
        let exit = far * self.far_r - self.o * self.far_r + self.behind;
        let exit = is_left.bitselect(exit, f32x4::splat(f32::MAX)).to_array();
        Window {
            near: greater(greater(entry[0], entry[1]), entry[2]),
            far: lesser(lesser(exit[0], exit[1]), exit[2]),
        }
    }
}

/// A ray in lanes, and how far it is from everything. The fourth lanes hold something that nobody asks for. PERF: so origin
/// and direction are one load each (bench kernel).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    pub(crate) o: f32x4,
    pub(crate) d: f32x4,
    t_min: f32,
    /// The sum of the direction's components in magnitude: its length, or up to 1.8 times that.
    length: f32,
    /// The same of the origin's.
    away: f32,
}

impl Measured {
    #[inline(always)]
    pub(crate) fn of(ray: &Ray) -> Self {
        let o = f32x4::new([ray.o.x, ray.o.y, ray.o.z, ray.d.x]);
        let d = f32x4::new([ray.d.x, ray.d.y, ray.d.z, ray.t_min]);
        Self { o, d, t_min: ray.t_min, length: sum(d), away: sum(o) }
    }

    /// False for a ray that can hit nothing: a zero or non-finite direction, or a non-finite origin.
    #[inline(always)]
    pub(crate) fn is_valid(&self) -> bool {
        // A sum is finite only if all of its terms are. PERF: not short-circuited (bench kernel).
        (SHORTEST <= self.length) & (self.length + self.away <= f32::MAX)
    }

    /// Whether a ray needs [`Slab::odd`] among things whose coordinates are at most `region`.
    #[inline(always)]
    pub(crate) fn is_odd(&self, region: f32) -> bool {
        (self.t_min < 0.0) | (self.length < SHORT) | self.is_far(region)
    }

    /// Whether edge functions and distances may overflow.
    #[inline(always)]
    pub(crate) fn is_far(&self, region: f32) -> bool {
        greater(self.away, region) > lesser(T_MAX * self.length, COORDINATE_MAX)
    }
}

/// The sum of three coordinates in magnitude.
#[inline(always)]
fn sum(v: f32x4) -> f32 {
    let [x, y, z, _] = v.abs().to_array();
    x + y + z
}

#[inline(always)]
fn is_negative(x: f32) -> bool {
    x.to_bits() >> 31 != 0
}

/// A box around `b` by the slack that tests of boxes and triangles need; `extent` is the size of what it holds a part of.
pub(crate) fn grown(b: &Bounds3, extent: f32) -> Bounds3 {
    // The last term sees to a box that is a point at the origin.
    let by = |x: f32| SLACK * extent + 4.0 * U * x.abs() + f32::MIN_POSITIVE;
    let down = |x: f32| (x - by(x)).max(f32::MIN);
    let up = |x: f32| (x + by(x)).min(f32::MAX);
    let (lo, hi) = (b.min.to_array(), b.max.to_array());
    Bounds3 { min: lo.map(down).into(), max: hi.map(up).into() }
}

/// The length of the longest edge.
pub(crate) fn extent(b: &Bounds3) -> f32 {
    let d = b.diagonal();
    greater(greater(d.x, d.y), d.z).min(f32::MAX)
}

/// `min` and `max` in one instruction each; no argument is ever NaN.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Three coordinates in a vector.
#[inline(always)]
fn lanes([x, y, z]: [f32; 3]) -> f32x4 {
    f32x4::new([x, y, z, z])
}

/// The stretch of a ray inside a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// Entry.
    pub(crate) near: f32,
    /// Exit.
    pub(crate) far: f32,
}

impl Window {
    /// Of all of space.
    pub(crate) const ALL: Self = Self { near: f32::NEG_INFINITY, far: f32::INFINITY };
    /// Of nothing.
    pub(crate) const NONE: Self = Self { near: f32::INFINITY, far: f32::NEG_INFINITY };

    /// Whether a hit in `[t_min, t_max]` is possible. Equality counts: ties are decided by id, not by traversal.
    #[inline(always)]
    pub(crate) fn admits(&self, t_min: f32, t_max: f32) -> bool {
        self.near <= self.far && self.near <= t_max && self.far >= t_min
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_core::math::{Point3, Vector3};

    fn unit() -> Bounds3 {
        grown(&Bounds3::new(Point3::ZERO, Point3::splat(1.0)), 1.0)
    }
    fn admits(o: [f32; 3], d: [f32; 3]) -> bool {
        let ray = Ray::new(o.into(), d.into());
        let measured = Measured::of(&ray);
        assert!(measured.is_valid());
        Slab::new::<true>(&measured).window(&unit()).admits(0.0, f32::INFINITY)
    }

    #[test]
    fn rays_in_planes_along_edges_and_through_corners_enter() {
        assert!(admits([-1.0, 0.0, 0.5], [1.0, 0.0, 0.0]), "in a face");
        assert!(admits([-1.0, 0.0, 1.0], [1.0, 0.0, -0.0]), "along an edge");
        assert!(admits([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]), "through a corner");
        assert!(admits([1.0, 1.0, 1.0], [1.0, 1.0, 1.0]), "starting at a corner, leaving");
        assert!(!admits([-1.0, -1e-5, 0.5], [1.0, 0.0, 0.0]), "beside a face");
        assert!(!admits([2.0, 0.5, 0.5], [1.0, 0.0, 0.0]), "behind");
    }

    #[test]
    fn impossible_rays_are_refused() {
        for d in [[0.0; 3], [f32::NAN, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0], [1e-44, 0.0, 0.0]] {
            assert!(!Measured::of(&Ray::new(Point3::ZERO, d.into())).is_valid(), "{d:?}");
        }
        let far = Ray::new(Point3::splat(f32::INFINITY), Vector3::splat(1.0));
        assert!(!Measured::of(&far).is_valid());
    }

    #[test]
    fn huge_coordinates_give_numbers() {
        let ray = Ray::new(Point3::splat(1e30), Vector3::new(0.0, 1.0, -0.0));
        let ray = Measured::of(&ray);
        assert!(
            ray.is_odd(1e32)
                && !Measured::of(&Ray::new(Point3::ZERO, Vector3::new(0.0, 1.0, 0.0))).is_odd(1e10)
        );
        let slab = Slab::odd::<true>(&ray, 1e32);
        let window = slab.window(&grown(&Bounds3::new(Point3::splat(-1e32), Point3::splat(1e32)), 2e32));
        assert!(window.admits(0.0, f32::MAX), "{window:?}");
    }
}
