//! The highlight of the classic formula: `k_s (N . H)^n`, with `H` halfway between light and viewer.
//!
//! Blinn 1977 in the place where Whitted (1980) keeps Phong's term: a mirrored ray cannot hit a light without extent, so
//! the light's own reflection is drawn as a spot. Lights of `falloff none` and intensity `I` give a sample of weight
//! `pi I`; the lobe is `f = k_s (N . H)^n / (pi cos_i)`, so that the reflected radiance `f cos_i (pi I)` is
//! `k_s (N . H)^n I` as in the formula. It conserves no energy, is not reciprocal, and ends abruptly where the light sets.
use std::f32::consts::PI;

use durer_core::{
    math::{Vector3, float::pow},
    spectrum::Spectrum,
};

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
