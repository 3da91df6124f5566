//! How much a smooth interface reflects.
//!
//! Fresnel's equations for dielectrics (Born and Wolf, Principles of Optics, section 1.5.2), with `c_i`, `c_t` the
//! cosines on the two sides and `eta = eta_t / eta_i`:
//! `r_s = (c_i - eta c_t) / (c_i + eta c_t)`, `r_p = (eta c_i - c_t) / (eta c_i + c_t)`, `F = (r_s² + r_p²) / 2`;
//! and Schlick's approximation `F = f0 + (1 - f0) (1 - c)^5` (Schlick 1994). Conductors: the same equations with the
//! complex index `eta + i k`, in real arithmetic (Born and Wolf, section 14.2).
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

/// Reflectance for unpolarised light of a conductor of index `eta + i k`, relative to the side that light comes from; with
/// `k` 0 that of a dielectric. `cos_i` in `[0, 1]`.
pub fn fresnel_conductor(cos_i: f32, eta: f32, k: f32) -> f32 {
    let c2 = sqr(cos_i);
    let s2 = (1.0 - c2).max(0.0);
    // The index's square behind the surface, less the square of the sine: (a + i b)².
    let re = sqr(eta) - sqr(k) - s2;
    let abs = (sqr(re) + 4.0 * sqr(eta * k)).sqrt();
    let a = (0.5 * (abs + re)).max(0.0).sqrt();
    let s = ratio(abs + c2, 2.0 * a * cos_i);
    let p = s * ratio(c2 * abs + sqr(s2), 2.0 * a * cos_i * s2);
    0.5 * (s + p)
}

/// `(x - y) / (x + y)`, 1 where both are 0.
fn ratio(x: f32, y: f32) -> f32 {
    if x + y > 0.0 { ((x - y) / (x + y)).max(0.0) } else { 1.0 }
}

/// How reflectance depends on the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflectance {
    /// Schlick's approximation.
    Schlick {
        /// At normal incidence, in `[0, 1]`.
        f0: Spectrum,
        /// At grazing incidence, in `[0, 1]`: 1 in nature; that of `f0` where it shall not depend on the angle.
        f90: Spectrum,
    },
    /// Fresnel's equations with the index `eta + i k`, relative to the outside; with `k` 0 those of a dielectric.
    Index {
        /// Real part, above 0.
        eta: Spectrum,
        /// Extinction, 0 or more.
        k: Spectrum,
    },
    /// What a dielectric reflects, tinted.
    Tinted {
        /// Relative index, above 0.
        eta: f32,
        /// Factor on it, in `[0, 1]`.
        tint: Spectrum,
    },
    /// Not what a dielectric reflects but the rest, tinted.
    Passed {
        /// Relative index, above 0.
        eta: f32,
        /// Factor on it, in `[0, 1]`.
        tint: Spectrum,
    },
}

impl Reflectance {
    /// That of a dielectric of relative index `eta`.
    pub const fn dielectric(eta: f32) -> Self {
        Self::Index { eta: Spectrum::splat(eta), k: Spectrum::BLACK }
    }
    /// At the cosine of incidence.
    pub fn at(&self, cos: f32) -> Spectrum {
        match *self {
            Self::Schlick { f0, f90 } => {
                let rise = schlick_rise(cos);
                f0.zip(f90, |f0, f90| f0 + (f90 - f0) * rise)
            }
            Self::Index { eta, k } => eta.zip(k, |eta, k| fresnel_conductor(cos.min(1.0), eta, k)),
            Self::Tinted { eta, tint } => tint * fresnel_dielectric(cos.min(1.0), eta),
            Self::Passed { eta, tint } => tint * (1.0 - fresnel_dielectric(cos.min(1.0), eta)),
        }
    }
    /// At normal and at grazing incidence.
    pub fn ends(&self) -> (Spectrum, Spectrum) {
        match *self {
            Self::Schlick { f0, f90 } => (f0, f90),
            Self::Index { .. } => (self.at(1.0), Spectrum::ONE),
            Self::Tinted { tint, .. } => (self.at(1.0), tint),
            Self::Passed { .. } => (self.at(1.0), Spectrum::BLACK),
        }
    }
}
