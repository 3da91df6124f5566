//! What broad lobes add to others: fibres on top (sheen), and the light that bounces several times between facets.
//!
//! **Sheen** (KHR_materials_sheen): `f = c D V` with `D = (2 + 1/a) sin^(1/a) h / (2 pi)` (Estevez and Kulla 2017,
//! "Production Friendly Microfacet Sheen BRDF") and `V = 1 / (4 (c_o + c_i - c_o c_i))` (Neubelt and Pettineo 2013). Seen along
//! the surface that reflects more than arrives: it is divided by what it reflects along the lower of both directions, where that
//! is more than 1.
//! **Compensation** (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"): with `E` the share of white
//! facets after one bounce, `f = F (1 - E(o)) (1 - E(i)) / (pi (1 - <E>))`, where `F` is what is left of light that bounces
//! more than once. White facets then lose nothing (validation.md E3).
use std::f32::consts::{FRAC_1_PI, PI};

use durer_core::{
    math::{
        Vector3,
        float::{pow, sqr},
    },
    spectrum::Spectrum,
};

use super::{
    Distribution, Facets, Reflectance,
    glossy::single_scattered,
    sheen_table::{SIZE, TABLE},
};

/// Points of the integrals over cosines.
const STEPS: usize = 12;

/// Fibres that stand on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheen {
    /// Their colour, in `[0, 1]`.
    pub color: Spectrum,
    /// Width of the distribution, in `(0, 1]`.
    pub alpha: f32,
    /// Share that white fibres reflect of a uniform sky towards the viewer: what they hide of what is below.
    pub hidden: f32,
}

impl Sheen {
    /// Least width.
    const LEAST: f32 = 1e-2;

    /// Fibres of this colour and width, seen from `wo`.
    pub fn new(color: Spectrum, alpha: f32, wo: Vector3) -> Self {
        Self { color, alpha: alpha.max(Self::LEAST), hidden: Self::hides(alpha, wo.z.abs().min(1.0)) }
    }
    /// Share that white fibres of this width reflect at most of a uniform sky towards a cosine in `[0, 1]`.
    pub(super) fn hides(alpha: f32, cos: f32) -> f32 {
        Self::sent(alpha, cos).min(1.0)
    }
    /// What the formula says of it: at grazing incidence more than 1.
    fn sent(alpha: f32, cos: f32) -> f32 {
        let place = |v: f32| {
            let x = v.clamp(0.0, 1.0).sqrt() * (SIZE - 1) as f32;
            let i = (x as usize).min(SIZE - 2);
            (i, x - i as f32)
        };
        let ((row, v), (column, u)) = (place(alpha), place(cos));
        let along = |r: usize| TABLE[r][column] * (1.0 - u) + TABLE[r][column + 1] * u;
        along(row) * (1.0 - v) + along(row + 1) * v
    }
    fn factor(&self, o: Vector3, i: Vector3) -> f32 {
        let h = (o + i).normalize();
        let sin2 = sqr(h.x) + sqr(h.y);
        let power = 1.0 / self.alpha;
        let d = if sin2 > 0.0 { (2.0 + power) * pow(sin2.min(1.0), 0.5 * power) / (2.0 * PI) } else { 0.0 };
        let (co, ci) = (o.z.abs().min(1.0), i.z.abs().min(1.0));
        let too_much = Self::sent(self.alpha, co).max(Self::sent(self.alpha, ci)).max(1.0);
        d / ((4.0 * (co + ci - co * ci)).max(1e-6) * too_much)
    }
    pub(super) fn eval(&self, o: Vector3, i: Vector3) -> Spectrum {
        self.color * self.factor(o, i)
    }
}

/// Light that bounces between facets more than once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounced {
    color: Spectrum,
    alpha: f32,
    like: Distribution,
    /// `1 - <E>`.
    lost: f32,
}

impl Bounced {
    /// What is missing from a lobe of these facets, as far as the table of `E` tells; none for smooth ones.
    pub fn of(reflectance: &Reflectance, facets: &Facets) -> Option<Self> {
        if facets.is_smooth() {
            return None;
        }
        let (alpha, like) = (facets.alpha(), facets.distribution());
        // 2 integral of f(cos) cos dcos.
        let cos = |i: usize| ((i as f32 + 0.5) / STEPS as f32).sqrt();
        let mean = (0..STEPS).map(|i| single_scattered(cos(i), alpha, like)).sum::<f32>() / STEPS as f32;
        let fresnel = (0..STEPS).fold(Spectrum::BLACK, |sum, i| sum + reflectance.at(cos(i))) / STEPS as f32;
        let lost = (1.0 - mean).max(1e-6);
        let color = fresnel.map(|f| sqr(f) * mean / (1.0 - f * lost).max(1e-6));
        Some(Self { color, alpha, like, lost })
    }
    pub(super) fn eval(&self, o: Vector3, i: Vector3) -> Spectrum {
        self.color * (FRAC_1_PI * self.lost_towards(o) * self.lost_towards(i) / self.lost)
    }
    pub(super) fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        self.color * self.lost_towards(wo)
    }
    /// `1 - E`.
    fn lost_towards(&self, w: Vector3) -> f32 {
        (1.0 - single_scattered(w.z.abs().min(1.0), self.alpha, self.like)).max(0.0)
    }
    pub(super) fn albedo(&self) -> Spectrum {
        self.color * self.lost
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { color: self.color * by, ..self }
    }
}
