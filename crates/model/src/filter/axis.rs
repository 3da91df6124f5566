//! Drawing from one direction of a filter.
//!
//! `g`, the polygon through `|f|` at equal steps, stands in for `|f|` as density, and the weight `f / g` makes up for the
//! difference. The factor that `g` lacks to be a density is the same for all samples and falls out of
//! `sum w v / sum w`.
use durer_core::sampling::LinearDensity;

use super::Profile;

/// Steps of the table per pixel, none of which a lobe of any filter is narrower than.
const STEPS: f32 = 64.0;
/// Parts of a step that the integral is summed from.
const PARTS: usize = 8;

/// A profile with the table to draw from it.
#[derive(Debug)]
pub(super) struct Axis {
    profile: Box<dyn Profile>,
    radius: f32,
    /// Of a step, in pixels.
    width: f32,
    /// `|f|` from the middle outwards; `None` if it is the same everywhere, or too small for f32.
    density: Option<LinearDensity>,
    /// Of `f` over both sides, in pixels.
    integral: f32,
    is_negative_somewhere: bool,
}

impl Axis {
    pub(super) fn new(profile: impl Profile + 'static, radius: f32) -> Self {
        let steps = (radius * STEPS).ceil().max(STEPS) as usize;
        let width = radius / steps as f32;
        let value = |i: usize| profile.at((i as f32 * width).min(radius)).abs();
        // PERF: a box needs no table (bench render).
        let is_flat = (1..=steps).all(|i| value(i) == value(0));
        let density = if is_flat { None } else { LinearDensity::new((0..=steps).map(value)) };
        // Simpson's rule, in f64: its error is far below that of a rounded f.
        let n = steps * PARTS;
        let f = |i: usize| f64::from(profile.at(radius * (i as f32 / n as f32)));
        let weight = |i: usize| if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        let sum: f64 = (0..=n).map(|i| weight(i) * f(i)).sum();
        Self {
            is_negative_somewhere: (0..=n).any(|i| f(i) < 0.0),
            integral: (2.0 * sum / 3.0 * f64::from(radius) / n as f64) as f32,
            profile: Box::new(profile),
            radius,
            width,
            density,
        }
    }

    pub(super) fn radius(&self) -> f32 {
        self.radius
    }
    pub(super) fn is_negative_somewhere(&self) -> bool {
        self.is_negative_somewhere
    }
    /// The normalised profile; zero outside.
    pub(super) fn at(&self, x: f32) -> f32 {
        if x.abs() <= self.radius { self.profile.at(x.abs()) / self.integral } else { 0.0 }
    }

    /// Offset and weight of a number in `[0, 1)`.
    pub(super) fn sample(&self, u: f32) -> (f32, f32) {
        let signed = 2.0 * u - 1.0;
        if signed == 0.0 {
            // PERF: the only sample of a pixel (bench render).
            return (0.0, 1.0);
        }
        let Some(density) = &self.density else { return (signed * self.radius, 1.0) };
        let (steps, g) = density.sample(signed.abs());
        let x = (steps * self.width).min(self.radius);
        // Where the density is zero no sample comes to lie but by rounding.
        let weight = if g > 0.0 { self.profile.at(x) / g } else { 0.0 };
        (if signed < 0.0 { -x } else { x }, weight)
    }
}
