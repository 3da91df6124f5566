//! Closed intervals of one real number: time spans and parameter ranges.
use serde::Serialize;

/// `[min, max]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub min: f32,
    /// Upper end.
    pub max: f32,
}

impl Interval {
    /// From both ends.
    #[inline]
    pub const fn new(min: f32, max: f32) -> Self {
        Self { min, max }
    }
    /// The interval that holds only `v`.
    #[inline]
    pub const fn point(v: f32) -> Self {
        Self { min: v, max: v }
    }
    /// The point a fraction `u` in `[0, 1]` of the way from `min` to `max`.
    #[inline]
    pub fn at(self, u: f32) -> f32 {
        super::float::lerp(u, self.min, self.max)
    }
}
