//! Rayleigh's phase function ("On the Light from the Sky, its Polarization and Colour", 1871): particles much smaller than the
//! wavelength, such as the molecules of air.
//!
//! `p(cos) = 3 (1 + cos²) / (16 pi)`. Its integral is `(cos³ + 3 cos + 4) / 8`, a cubic with one real root in closed form
//! (Frisvad 2011, "Importance Sampling the Rayleigh Phase Function"). Polarisation is left out.
use std::f32::consts::PI;

use durer_core::math::float::{pow, sqr};

/// Density of going on with this cosine of the deflection, 1/sr.
pub(super) fn density(cos: f32) -> f32 {
    3.0 / (16.0 * PI) * (1.0 + sqr(cos))
}

/// The cosine of a deflection, drawn by `u` in `[0, 1)`.
pub(super) fn cos(u: f32) -> f32 {
    // cos³ + 3 cos = 2 z; one half mirrors the other, in which nothing cancels.
    let z = 2.0 * (2.0 * u - 1.0);
    let root = pow(z.abs() + (sqr(z) + 1.0).sqrt(), 1.0 / 3.0);
    (root - 1.0 / root).min(1.0).copysign(z)
}
