//! One segment of a curve as the ray sees it: four cubics in Bernstein form, three coordinates and the radius.
use durer_core::glam::DVec3;

use super::{
    Curves,
    bernstein::{Bernstein, Cubic},
    ray_frame::RayFrame,
};

/// How often a strand is clipped. Each time a thin one shrinks to little more than what the ray passes.
const CLIPS: u32 = 3;
/// Kept at both ends of a clipped strand as a fraction of its length, against rounding.
const MARGIN: f64 = 1e-6;

/// A segment, or the part of it near the ray, in the frame of the ray. Its parameter `s` runs from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strand {
    pub(super) x: Cubic,
    pub(super) y: Cubic,
    pub(super) z: Cubic,
    /// Negative where there is no surface.
    pub(super) r: Cubic,
    /// Bound on the error of each coordinate.
    pub(super) own_error: f64,
    /// The segment's parameter at both ends.
    ends: (f64, f64),
}

impl Strand {
    /// `None` if the ray comes nowhere near enough, sideways and along it, to meet a ball around a point of the curve.
    pub(super) fn near(curves: &Curves, segment: u32, frame: &RayFrame, t_max: f32) -> Option<Self> {
        // Of the control points, which may be larger than what a basis makes of them.
        let mut reach = 0f64;
        let [x, y, z] = curves.bezier_points(segment, |p| {
            let projected = frame.project(p);
            reach = reach.max(projected.abs().max_element());
            projected
        });
        let mut strand = Self {
            x: Bernstein(x),
            y: Bernstein(y),
            z: Bernstein(z),
            r: Bernstein(curves.bezier_radii(segment)),
            own_error: RayFrame::own_error(reach),
            ends: (0.0, 1.0),
        };
        for _ in 0..CLIPS {
            let r = strand.r.max();
            if !frame.overlaps(strand.z.min() - r, strand.z.max() + r, t_max) {
                return None;
            }
            let (lo, hi) = strand.band()?;
            if hi - lo > 0.5 {
                break;
            }
            strand = strand.part(lo, hi);
        }
        Some(strand)
    }

    /// The ends of all that can be hit: where the hulls of x and of y come within the largest radius.
    fn band(&self) -> Option<(f64, f64)> {
        let r = self.r.max() + self.own_error;
        let ((x_lo, x_hi), (y_lo, y_hi)) = (within(&self.x, r), within(&self.y, r));
        let (lo, hi) = (x_lo.max(y_lo) - MARGIN, x_hi.min(y_hi) + MARGIN);
        (lo <= hi).then(|| (lo.max(0.0), hi.min(1.0)))
    }

    fn part(&self, lo: f64, hi: f64) -> Self {
        let (x, y, z, r) =
            (self.x.part(lo, hi), self.y.part(lo, hi), self.z.part(lo, hi), self.r.part(lo, hi));
        Self { x, y, z, r, ends: (self.along(lo), self.along(hi)), ..*self }
    }

    /// Of another cubic of the segment the part that this is.
    pub(super) fn same_part(&self, whole: &Cubic) -> Cubic {
        whole.part(self.ends.0, self.ends.1)
    }

    /// The segment's parameter at `s`.
    pub(super) fn along(&self, s: f64) -> f64 {
        let (from, to) = self.ends;
        from * (1.0 - s) + to * s
    }

    /// The same seen by the ray that runs the other way.
    pub(super) fn reversed(&self) -> Self {
        Self { z: self.z.negated(), ..*self }
    }

    pub(super) fn center(&self, s: f64) -> DVec3 {
        DVec3::new(self.x.at(s), self.y.at(s), self.z.at(s))
    }
    /// [`heading`] of the strand.
    pub(super) fn heading(&self, s: f64) -> DVec3 {
        heading(&[self.x, self.y, self.z], s)
    }

    /// On which side of the curve a point at `from_center` lies, as a fraction of the radius in `[-1, 1]`: positive on
    /// the side of direction times curve. 0 where the ray looks along the curve.
    pub(super) fn side(&self, s: f64, from_center: DVec3, r: f64) -> f32 {
        let heading = self.heading(s);
        let length = heading.truncate().length();
        let across = from_center.y * heading.x - from_center.x * heading.y;
        let v = across / (length * r);
        if v.is_finite() { v.clamp(-1.0, 1.0) as f32 } else { 0.0 }
    }
}

/// Where a curve runs to at `s`: its derivative, or where that vanishes at an end the direction, not to scale, in which
/// the end is left. Zero for a curve in one place.
pub(super) fn heading(curve: &[Cubic; 3], s: f64) -> DVec3 {
    let velocity = DVec3::from_array(curve.map(|c| c.with_slope(s).1));
    if velocity != DVec3::ZERO {
        return velocity;
    }
    let away = |from: usize, to: usize| {
        Some(DVec3::from_array(curve.map(|c| c.0[to] - c.0[from]))).filter(|d| *d != DVec3::ZERO)
    };
    let found = if s < 0.5 { away(0, 2) } else { away(1, 3) };
    found.or_else(|| away(0, 3)).unwrap_or(DVec3::ZERO)
}

/// Between which parameters the convex hull of the control polygon has values in `[-r, r]`: a larger and a smaller
/// number if nowhere.
fn within(c: &Cubic, r: f64) -> (f64, f64) {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut include = |s: f64| (lo, hi) = (lo.min(s), hi.max(s));
    for i in 0..4 {
        let (a, at_a) = (c.0[i], i as f64 / 3.0);
        if a.abs() <= r {
            include(at_a);
        }
        for j in i + 1..4 {
            let (b, step) = (c.0[j], (j - i) as f64 / 3.0);
            for level in [-r, r] {
                if (a < level) != (b < level) {
                    include(at_a + step * ((level - a) / (b - a)));
                }
            }
        }
    }
    (lo, hi)
}
