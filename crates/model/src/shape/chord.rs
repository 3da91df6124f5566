//! The chord that a ball, or seen along its axis a cylinder, cuts out of a line.
//!
//! The foot point `l = o - (o.d / d.d) d` is where the line comes nearest to the centre; the roots lie half a chord before
//! and behind it, `t = -o.d / d.d -+ sqrt((r^2 - |l|^2) / d.d)`, which does not cancel like `b^2 - 4ac` (Physically Based
//! Rendering, 4th edition, section 6.8.3). All in f64 from the f32 ray, with a bound on the error of both roots.
use durer_core::{glam::DVec3, math::Ray};

use super::accept;

/// Both places where a line is as far from the origin as a radius says.
pub(super) struct Chord {
    pub(super) middle: f64,
    half: f64,
    /// 1 / d.d
    inverse: f64,
    /// Sum of the coordinates' sizes of where the ray starts.
    start: f64,
    radius: f64,
}

impl Chord {
    /// Of the line through `o` along `d`; `None` if it passes the centre at more than `radius`.
    #[inline]
    pub(super) fn of(o: DVec3, d: DVec3, radius: f32) -> Option<Self> {
        let r = f64::from(radius);
        let inverse = 1.0 / d.length_squared();
        let middle = -o.dot(d) * inverse;
        let room = r * r - (o + d * middle).length_squared();
        // False for the NaN of an infinite direction, and for a zero one.
        if !(room >= 0.0 && inverse.is_finite()) {
            return None;
        }
        Some(Self { middle, half: (room * inverse).sqrt(), inverse, start: o.abs().element_sum(), radius: r })
    }
    #[inline]
    pub(super) fn near(&self) -> f64 {
        self.middle - self.half
    }
    #[inline]
    pub(super) fn far(&self) -> f64 {
        self.middle + self.half
    }

    /// The root on the side of `t`, which rounding may have moved.
    #[inline]
    pub(super) fn root_at(&self, t: f32) -> f64 {
        if f64::from(t) <= self.middle { self.near() } else { self.far() }
    }

    /// A root rounded, if it is a hit of the ray.
    #[inline]
    pub(super) fn hit(&self, ray: &Ray, t: f64) -> Option<f32> {
        // PERF: the exact bound takes two roots and a division (bench render).
        let ahead = t - f64::from(ray.t_min);
        let clear = ahead > 0.0 && ahead * ahead > self.square_of_more_than_error();
        accept(ray, t, if clear { 0.0 } else { self.error() })
    }

    /// Bound on the absolute error of both roots.
    fn error(&self) -> f64 {
        // The foot point is off by some roundings of |o|; what that does to a square root is
        // |sqrt(x + e) - sqrt(x)| <= min(e / sqrt(x), sqrt(e)).
        let reach = self.start + self.radius;
        let room = 16.0 * f64::EPSILON * reach * reach * self.inverse;
        let half = (room / self.half).min(room.sqrt());
        half + 8.0 * f64::EPSILON * (self.start * self.inverse.sqrt() + self.middle.abs() + self.half)
    }

    /// More than the square of [`Self::error`], which with `reach` as there is at most
    /// `(sqrt(16 epsilon) + 24 epsilon) reach / |d|`.
    fn square_of_more_than_error(&self) -> f64 {
        let reach = self.start + self.radius;
        17.0 * f64::EPSILON * reach * reach * self.inverse
    }
}
