//! Disney's matte body with the sheen on it (Burley 2012, "Physically Based Shading at Disney"; 2015, "Extending the Disney
//! BRDF to a BSDF with Integrated Subsurface Scattering").
//!
//! With `F(c) = (1 - c)^5`, `d` half the angle between both directions, `r = 2 roughness cos² d`:
//! `f = c / pi ((1 - F_o / 2) (1 - F_i / 2) + r (F_o + F_i + F_o F_i (r - 1))) + sheen F_d`. `flatness` mixes in, for the factor
//! of `c / pi`, what looks like light that went below: `1.25 (s (1 / (c_o + c_i) - 1/2) + 1/2)` with
//! `s = (1 + (r / 2 - 1) F_o) (1 + (r / 2 - 1) F_i)`. At grazing incidence that is more than arrives, where the body is white.
use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{Vector3, float::lerp, float::sqr},
    spectrum::Spectrum,
};

use super::fresnel::schlick_rise;

/// The body, the same from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burley {
    /// `c`, in `[0, 1]`.
    pub color: Spectrum,
    /// Of the sheen, with the share of it.
    pub sheen: Spectrum,
    /// In `[0, 1]`.
    pub roughness: f32,
    /// In `[0, 1]`.
    pub flatness: f32,
}

impl Burley {
    /// Mean of `F` over the angle between light and half vector, roughly.
    const RISE: f32 = 0.04;

    /// Value without the cosine, 1/sr.
    pub(super) fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let (co, ci) = (wo.z.abs().min(1.0), wi.z.abs().min(1.0));
        let (fo, fi) = (schlick_rise(co), schlick_rise(ci));
        // Half the length of the sum is the cosine of half the angle between them.
        let cos_d = (0.5 * (wo + wi).length()).min(1.0);
        let r = 2.0 * self.roughness * sqr(cos_d);
        let body = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) + r * (fo + fi + fo * fi * (r - 1.0));
        let body = match self.flatness > 0.0 {
            true => {
                let s = lerp(fo, 1.0, 0.5 * r) * lerp(fi, 1.0, 0.5 * r);
                lerp(self.flatness, body, 1.25 * (s * (1.0 / (co + ci) - 0.5) + 0.5))
            }
            false => body,
        };
        self.color * (FRAC_1_PI * body) + self.sheen * schlick_rise(cos_d)
    }
    /// Share of the light of a uniform sky that leaves, about.
    pub(super) fn albedo(&self) -> Spectrum {
        (self.color + self.sheen * Self::RISE).map(|v| v.min(1.0))
    }
    /// The same towards a direction.
    pub(super) fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        self.color + self.sheen * (Self::RISE + schlick_rise(wo.z.abs()))
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { color: self.color * by, sheen: self.sheen * by, ..self }
    }
}
