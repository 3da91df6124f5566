//! One segment of a curve as the ray sees it: four cubics in Bernstein form, three coordinates and the radius.
use durer_core::glam::DVec3;

use super::{
    Curves,
    bernstein::{Bernstein, Cubic},
    ray_frame::RayFrame,
};

/// A segment in the frame of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strand {
    pub(super) x: Cubic,
    pub(super) y: Cubic,
    pub(super) z: Cubic,
    /// Negative where there is no surface.
    pub(super) r: Cubic,
    /// Bound on the error of each coordinate.
    pub(super) own_error: f64,
}

impl Strand {
    pub(super) fn new(curves: &Curves, segment: u32, frame: &RayFrame) -> Self {
        let [x, y, z] = curves.bezier_points(segment, |p| frame.project(p));
        let reach = [x, y, z].iter().flatten().fold(0f64, |a, b| a.max(b.abs()));
        let r = Bernstein(curves.bezier_radii(segment));
        Self { x: Bernstein(x), y: Bernstein(y), z: Bernstein(z), r, own_error: RayFrame::own_error(reach) }
    }

    /// Whether the ray comes near enough, sideways and along it, to meet a ball around any point of the curve.
    pub(super) fn may_be_hit(&self, frame: &RayFrame, t_max: f32) -> bool {
        let r = self.r.max();
        let across = |c: &Cubic| c.min() <= r && c.max() >= -r;
        across(&self.x) && across(&self.y) && frame.overlaps(self.z.min() - r, self.z.max() + r, t_max)
    }

    /// The same seen by the ray that runs the other way.
    pub(super) fn reversed(&self) -> Self {
        Self { z: self.z.negated(), ..*self }
    }

    pub(super) fn center(&self, s: f64) -> DVec3 {
        DVec3::new(self.x.at(s), self.y.at(s), self.z.at(s))
    }
    /// Derivative of the centre by `s`.
    pub(super) fn velocity(&self, s: f64) -> DVec3 {
        DVec3::new(self.x.with_slope(s).1, self.y.with_slope(s).1, self.z.with_slope(s).1)
    }
    /// Where the curve runs to at `s`, not to scale: the derivative, or where it vanishes at an end the direction in
    /// which the end is left.
    pub(super) fn heading(&self, s: f64) -> DVec3 {
        let velocity = self.velocity(s);
        if velocity != DVec3::ZERO {
            return velocity;
        }
        let control = |i: usize| DVec3::new(self.x.0[i], self.y.0[i], self.z.0[i]);
        let away = |from: usize, to: usize| Some(control(to) - control(from)).filter(|d| *d != DVec3::ZERO);
        let ahead = away(0, 2).or_else(|| away(0, 3));
        let behind = away(1, 3).or_else(|| away(0, 3));
        if s < 0.5 { ahead } else { behind }.unwrap_or(DVec3::ZERO)
    }

    /// On which side of the curve a point at `from_center` lies, as a fraction of the radius in `[-1, 1]`: positive on
    /// the side of direction times curve. 0 where the ray looks along the curve.
    pub(super) fn side(&self, s: f64, from_center: DVec3, r: f64) -> f32 {
        let heading = self.heading(s);
        let length = heading.x.hypot(heading.y);
        let across = from_center.y * heading.x - from_center.x * heading.y;
        let v = across / (length * r);
        if v.is_finite() { v.clamp(-1.0, 1.0) as f32 } else { 0.0 }
    }
}
