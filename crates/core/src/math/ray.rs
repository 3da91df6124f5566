//! `P(t) = o + t d` with `t` in `[t_min, t_max]`.
use super::{Point3, Vector3};

/// A half line, or a segment of one, at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin.
    pub o: Point3,
    /// Direction; need not be normalised: `t` counts in multiples of it.
    pub d: Vector3,
    /// Smallest accepted parameter.
    pub t_min: f32,
    /// Largest accepted parameter; infinite for a half line.
    pub t_max: f32,
    /// Moment in seconds at which moving things are met.
    pub time: f32,
}

impl Ray {
    /// The half line `t >= 0` at time 0.
    #[inline]
    pub const fn new(o: Point3, d: Vector3) -> Self {
        Self { o, d, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 }
    }
    /// `o + t d`.
    #[inline]
    pub fn at(&self, t: f32) -> Point3 {
        self.o + self.d * t
    }
    /// True if `t` lies in `[t_min, t_max]` (false for NaN).
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        t >= self.t_min && t <= self.t_max
    }
}
