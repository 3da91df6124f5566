//! How much a smooth interface reflects.
//!
//! Fresnel's equations for dielectrics (Born and Wolf, Principles of Optics, section 1.5.2), with `c_i`, `c_t` the
//! cosines on the two sides and `eta = eta_t / eta_i`:
//! `r_s = (c_i - eta c_t) / (c_i + eta c_t)`, `r_p = (eta c_i - c_t) / (eta c_i + c_t)`, `F = (r_s² + r_p²) / 2`;
//! and Schlick's approximation `F = f0 + (1 - f0) (1 - c)^5` (Schlick 1994).
use durer_core::{math::float::sqr, spectrum::Spectrum};

use super::refract::cos_transmitted;

/// Reflectances for light polarised perpendicular (s) and parallel (p) to the plane of incidence. `cos_i` in `[0, 1]`,
/// `eta` the index on the far side divided by that on the near side. Ones on total internal reflection.
pub fn fresnel_polarized(cos_i: f32, eta: f32) -> (f32, f32) {
    let Some(cos_t) = cos_transmitted(cos_i, 1.0 / eta) else {
        return (1.0, 1.0);
    };
    if eta == 1.0 {
        return (0.0, 0.0);
    }
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    (sqr(s), sqr(p))
}

/// Reflectance for unpolarised light; arguments as in [`fresnel_polarized`].
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let (s, p) = fresnel_polarized(cos_i, eta);
    0.5 * (s + p)
}

/// Reflectance at normal incidence of a dielectric of relative index `eta`; the same from both sides.
pub fn normal_reflectance(eta: f32) -> f32 {
    sqr((eta - 1.0) / (eta + 1.0))
}

/// Schlick's approximation: from `f0` at `cos = 1` to 1 at grazing incidence.
pub fn schlick(f0: Spectrum, cos: f32) -> Spectrum {
    let rise = schlick_rise(cos);
    f0.map(|f| f + (1.0 - f) * rise)
}

/// How far reflectance has risen from its value at normal to that at grazing incidence: `(1 - cos)^5`.
pub(super) fn schlick_rise(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    sqr(sqr(m)) * m
}
