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

/// Half the distance between 1 and the next number.
const U: f32 = f32::EPSILON / 2.0;
/// Slack of directions and boxes, twice what the triangle test needs and more.
const SLACK: f32 = 16.0 * U;
/// Slack of what the origin does to a sum.
const ORIGIN_SLACK: f32 = 4.0 * U;
/// Smallest component of a direction compared to its largest: below it the ray moves along the axis by nothing.
const FLOOR: f32 = 1e-18;
/// Products of reciprocals and coordinates stay below the largest number.
const PRODUCT_MAX: f32 = 1e37;

/// A ray's constants for meeting planes, by axis: `t = plane * r + c`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    /// For the planes by which the ray enters; the fourth lane means nothing.
    pub(crate) near_r: [f32; 4],
    pub(crate) near_c: [f32; 4],
    /// For those by which it leaves.
    pub(crate) far_r: [f32; 4],
    pub(crate) far_c: [f32; 4],
    /// Which plane it enters by: 0 the lower, 1 the upper.
    pub(crate) near_side: [usize; 3],
    o: [f32; 3],
    /// Absolute slack of rays that begin behind their origin.
    behind: [f32; 3],
}

impl Slab {
    /// For boxes inside `region`, whose coordinates are at most this large. `None` for a ray that can hit nothing: a zero
    /// or non-finite direction or a non-finite origin.
    #[inline(always)]
    pub(crate) fn new<const ROBUST: bool>(ray: &Ray, region: f32) -> Option<Self> {
        let (o, d) = (lanes(ray.o.to_array()), lanes(ray.d.to_array()));
        let (size, away) = (d.abs(), o.abs());
        let largest = greater(greater(ray.d.x.abs(), ray.d.y.abs()), ray.d.z.abs());
        // 0 x is 0 only for finite x: one comparison instead of six.
        let finite = (o * 0.0 + d * 0.0).simd_eq(f32x4::ZERO).all();
        if !(finite && largest > 0.0 && (1.0 / largest).is_finite()) {
            return None;
        }
        let farthest = greater(greater(greater(ray.o.x.abs(), ray.o.y.abs()), ray.o.z.abs()), region);
        // Keeps products finite, so that there is no infinity less infinity.
        let finite_floor = farthest * (1.0 / PRODUCT_MAX);
        let floor = f32x4::splat(greater(FLOOR * largest, finite_floor));
        let slack = if ROBUST { SLACK * largest } else { 0.0 };
        let origin_slack = f32x4::splat(if ROBUST { ORIGIN_SLACK } else { 0.0 });
        // PERF: in vectors, for ten divisions one after another are a tenth of a short ray (bench kernel).
        let near = (f32x4::ONE / (size + slack).fast_max(floor)).copysign(d);
        let far = (f32x4::ONE / (size - slack).fast_max(floor)).copysign(d);
        let slab = Self {
            near_r: near.to_array(),
            near_c: (-(o * near) - origin_slack * (away * near.abs())).to_array(),
            far_r: far.to_array(),
            far_c: (origin_slack * (away * far.abs()) - o * far).to_array(),
            near_side: [ray.d.x, ray.d.y, ray.d.z].map(|d| (d.to_bits() >> 31) as usize),
            o: ray.o.to_array(),
            behind: [0.0; 3],
        };
        let is_short = finite_floor > SLACK * largest;
        if ray.t_min < 0.0 || is_short {
            return Some(slab.widened(ray.d.to_array(), slack, ray.t_min, is_short));
        }
        Some(slab)
    }

    /// Rays that begin behind their origin, and those so short that coordinates divided by them overflow.
    #[cold]
    fn widened(mut self, d: [f32; 3], slack: f32, t_min: f32, is_short: bool) -> Self {
        for a in 0..3 {
            if is_short {
                // Boxes are never left.
                (self.far_r[a], self.far_c[a]) = (0.0, f32::MAX);
            }
            if t_min < 0.0 {
                // What is relative errs the other way behind the origin; no error there is larger than this.
                let size = d[a].abs();
                let behind = if size > 2.0 * slack { 4.0 * slack / size * -t_min } else { f32::MAX / 4.0 };
                self.behind[a] = behind;
                self.near_c[a] -= 2.0 * behind;
                self.far_c[a] += 2.0 * behind;
            }
        }
        self
    }

    /// The stretch inside a box that was [`grown`]; it lies within what any node around the box grown again admits.
    #[inline]
    pub(crate) fn window(&self, b: &Bounds3) -> Window {
        let sides = [b.min.to_array(), b.max.to_array()];
        let mut window = Window::ALL;
        for a in 0..3 {
            let (near, far) = (sides[self.near_side[a]][a], sides[1 - self.near_side[a]][a]);
            let entry = near * self.near_r[a] - self.o[a] * self.near_r[a] - self.behind[a];
            let exit = far * self.far_r[a] - self.o[a] * self.far_r[a] + self.behind[a];
            window.near = greater(window.near, entry);
            window.far = lesser(window.far, if self.far_r[a] == 0.0 { f32::MAX } else { exit });
        }
        window
    }
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

/// Three coordinates in a vector; the fourth lane repeats the third.
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
        let slab = Slab::new::<true>(&Ray::new(o.into(), d.into()), 1.0).expect("valid ray");
        slab.window(&unit()).admits(0.0, f32::INFINITY)
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
            assert!(Slab::new::<true>(&Ray::new(Point3::ZERO, d.into()), 1.0).is_none(), "{d:?}");
        }
        let far = Ray::new(Point3::splat(f32::INFINITY), Vector3::splat(1.0));
        assert!(Slab::new::<true>(&far, 1.0).is_none());
    }

    #[test]
    fn huge_coordinates_give_numbers() {
        let ray = Ray::new(Point3::splat(1e30), Vector3::new(0.0, 1.0, -0.0));
        let slab = Slab::new::<true>(&ray, 1e32).expect("valid ray");
        let window = slab.window(&grown(&Bounds3::new(Point3::splat(-1e32), Point3::splat(1e32)), 2e32));
        assert!(window.admits(0.0, f32::MAX), "{window:?}");
    }
}
