//! The highlight of the classic formula: `k_s (N . H)^n`, with `H` halfway between light and viewer.
//!
//! Blinn 1977 in the place where Whitted (1980) keeps Phong's term: a mirrored ray cannot hit a light without extent, so
//! the light's own reflection is drawn as a spot. Lights of `falloff none` and intensity `I` give a sample of weight
//! `pi I`; the lobe is `f = k_s (N . H)^n / (pi cos_i)`, so that the reflected radiance `f cos_i (pi I)` is
//! `k_s (N . H)^n I` as in the formula. It conserves no energy, is not reciprocal, and ends abruptly where the light sets.
use std::f32::consts::PI;

use durer_core::{
    math::{Point2, Vector3, float::pow},
    spectrum::Spectrum,
};

use super::gloss;

/// Smallest cosine the lobe divides by; below it the light has set. `f` stays finite for weights up to 1e6.
const MIN_COSINE: f32 = 1e-30;

/// The classic highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// `k_s`.
    pub specular: Spectrum,
    /// `n`, 0 or more: larger is smaller and sharper.
    pub exponent: f32,
}

impl Highlight {
    /// A direction whose half vector lies at a point of the unit square, spread by the same power; `None` if that leads
    /// into the surface.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Vector3> {
        let up = Vector3::new(0.0, 0.0, if wo.z < 0.0 { -1.0 } else { 1.0 });
        let h = gloss::draw(up, self.exponent, u);
        let wi = h * (2.0 * wo.dot(h)) - wo;
        (wo.dot(h) > 0.0 && wi.z * wo.z > 0.0).then_some(wi)
    }
    /// Density of [`Highlight::draw`] at `wi`, 1/sr.
    pub(super) fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let h = wo + wi;
        if wo.z * wi.z <= 0.0 || h.length_squared() == 0.0 {
            return 0.0;
        }
        let h = h.normalize();
        let up = Vector3::new(0.0, 0.0, if wo.z < 0.0 { -1.0 } else { 1.0 });
        gloss::pdf(up, self.exponent, h) / (4.0 * wo.dot(h))
    }
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let h = wo + wi;
        let length = h.length();
        if wo.z * wi.z <= 0.0 || wi.z.abs() < MIN_COSINE || length == 0.0 {
            return Spectrum::BLACK;
        }
        let cos_h = (h.z / length).abs().min(1.0);
        // PERF: ln c <= c - 1, so beyond this the power is below the smallest float (bench render).
        if self.exponent * (cos_h - 1.0) < -104.0 {
            return Spectrum::BLACK;
        }
        self.specular * (pow(cos_h, self.exponent) / (PI * wi.z.abs()))
    }
}
