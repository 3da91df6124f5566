//! Lobes so broad that directions are drawn by the cosine alone, all on one side and the same from both sides.
//!
//! Rough plaster and clay: EON (Portsmouth, Kutz and Hill 2024, "EON: A Practical Energy-Preserving Rough Diffuse BRDF"),
//! Fujii's form of the model of Oren and Nayar (1994) with the light that bounces between the facets added. With
//! `s = wo . wi - cos_o cos_i`, divided by the larger cosine where positive:
//! `f = rho / pi A (1 + r s) + rho_ms / pi (1 - E(o)) (1 - E(i)) / (1 - <E>)`.
use std::f32::consts::{FRAC_1_PI, PI};

use durer_core::{
    math::{
        Vector3,
        float::{acos, sqr},
    },
    spectrum::Spectrum,
};

use super::{Bounced, Burley, Leaving, Sheen, Under, coat::Body};

/// A broad lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Matte {
    /// Rough diffuse reflection.
    Rough {
        /// `rho`: what of light is left after one bounce, in `[0, 1]`.
        once: Spectrum,
        /// `rho_ms`: the same for light that bounces more than once.
        more: Spectrum,
        /// `r`, in `[0, 1]`: 0 is Lambert's law.
        roughness: f32,
    },
    /// A body under a clear coat.
    Coated(Body),
    /// Fibres on top.
    Sheen(Sheen),
    /// What glossy lobes lose between their facets.
    Bounced(Bounced),
    /// Disney's body with its sheen.
    Burley(Burley),
    /// A body below layers that reflect.
    Under(Under),
    /// What leaves a smooth boundary from below.
    Leaving(Leaving),
}

/// `1/2 - 2 / (3 pi)` and `2/3 - 28 / (15 pi)`.
const C: [f32; 2] = [0.5 - 2.0 / (3.0 * PI), 2.0 / 3.0 - 28.0 / (15.0 * PI)];

impl Matte {
    /// Rough diffuse reflection: `albedo` is about the share of light reflected, in `[0, 1]`; at 1 nothing is lost.
    /// `roughness` is in `[0, 1]`.
    pub fn rough(albedo: Spectrum, roughness: f32) -> Self {
        let mean = mean(roughness);
        let more = albedo.map(|rho| sqr(rho) * mean / (1.0 - rho * (1.0 - mean)));
        Self::Rough { once: albedo, more, roughness }
    }
    /// The same, dimmed.
    pub(super) fn scaled(self, by: f32) -> Self {
        match self {
            Self::Rough { once, more, roughness } => {
                Self::Rough { once: once * by, more: more * by, roughness }
            }
            Self::Coated(body) => Self::Coated(body.scaled(by)),
            Self::Sheen(sheen) => Self::Sheen(Sheen { color: sheen.color * by, ..sheen }),
            Self::Bounced(bounced) => Self::Bounced(bounced.scaled(by)),
            Self::Burley(burley) => Self::Burley(burley.scaled(by)),
            Self::Under(under) => Self::Under(under.scaled(by)),
            Self::Leaving(leaving) => Self::Leaving(leaving.scaled(by)),
        }
    }
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let side = if self.is_behind() { -wi.z } else { wi.z };
        if wo.z * side <= 0.0 {
            return Spectrum::BLACK;
        }
        match self {
            Self::Rough { once, more, roughness } => rough((*once, *more), *roughness, wo, wi),
            Self::Coated(body) => body.eval(wo, wi),
            Self::Sheen(sheen) => sheen.eval(wo, wi),
            Self::Bounced(bounced) => bounced.eval(wo, wi),
            Self::Burley(burley) => burley.eval(wo, wi),
            Self::Under(under) => under.eval(wo, wi),
            Self::Leaving(leaving) => leaving.eval(wi),
        }
    }
    /// Share of the light of a uniform sky that leaves towards `wo`.
    pub(super) fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        match self {
            Self::Rough { once, more, roughness } => {
                let single = single(wo.z.abs().min(1.0), *roughness);
                *more * (1.0 - single) + *once * single
            }
            Self::Coated(body) => body.directional_albedo(wo),
            Self::Sheen(sheen) => sheen.color * sheen.hidden,
            Self::Bounced(bounced) => bounced.directional_albedo(wo),
            Self::Burley(burley) => burley.directional_albedo(wo),
            Self::Under(under) => under.albedo(),
            Self::Leaving(leaving) => leaving.albedo(),
        }
    }
    /// Share of the light of a uniform sky that leaves: on the whole, or of what is below something else towards the viewer.
    pub fn albedo(&self) -> Spectrum {
        match self {
            Self::Rough { once, more, roughness } => {
                let single = mean(*roughness);
                *more * (1.0 - single) + *once * single
            }
            Self::Coated(body) => body.albedo(),
            Self::Sheen(sheen) => sheen.color * sheen.hidden,
            Self::Bounced(bounced) => bounced.albedo(),
            Self::Burley(burley) => burley.albedo(),
            Self::Under(under) => under.albedo(),
            Self::Leaving(leaving) => leaving.albedo(),
        }
    }
    /// Whether its light leaves on the side that it does not come from.
    pub(super) fn is_behind(&self) -> bool {
        matches!(self, Self::Under(Under { is_behind: true, .. }) | Self::Leaving(_))
    }
}

/// What white facets of this roughness send towards a cosine after one bounce.
fn single(cos: f32, roughness: f32) -> f32 {
    let a = 1.0 / (1.0 + C[0] * roughness);
    let sin = (1.0 - sqr(cos)).max(0.0).sqrt();
    // The second part tends to 0 at grazing incidence: sin / cos (1 - sin³) - sin, with 1 - sin³ without cancellation.
    let one_less_cube = sqr(cos) / (1.0 + sin) * (1.0 + sin + sqr(sin));
    let rest = if cos > 0.0 { sin * one_less_cube / cos - sin } else { -sin };
    let g = sin * (acos(cos) - sin * cos) + 2.0 / 3.0 * rest;
    a * (1.0 + roughness * FRAC_1_PI * g)
}

/// Its mean over cosines.
fn mean(roughness: f32) -> f32 {
    (1.0 + C[1] * roughness) / (1.0 + C[0] * roughness)
}

fn rough((albedo, multiple): (Spectrum, Spectrum), roughness: f32, wo: Vector3, wi: Vector3) -> Spectrum {
    let (co, ci) = (wo.z.abs().min(1.0), wi.z.abs().min(1.0));
    let s = wo.dot(wi) - co * ci;
    let s = if s > 0.0 { s / co.max(ci) } else { s };
    let once = (1.0 + roughness * s) / (1.0 + C[0] * roughness);
    let lost = 1.0 - mean(roughness);
    if lost <= 1e-6 {
        return albedo * (FRAC_1_PI * once);
    }
    let more = (1.0 - single(co, roughness)) * (1.0 - single(ci, roughness)) / lost;
    (albedo * once.max(0.0) + multiple * more.max(0.0)) * FRAC_1_PI
}
