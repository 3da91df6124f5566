//! Disney's clear coat (Burley 2012, "Physically Based Shading at Disney", section 5.6), as Mitsuba has it:
//! `f = share F D G / 4` with Schlick's `F` of 0.04, `D = (a² - 1) / (pi ln a² (1 + (a² - 1) cos² h))`, whose tails are longer than
//! those of GGX, and `G` that of GGX facets of width 0.25 from either direction by itself.
use std::f32::consts::PI;

use durer_core::{
    math::{
        Point2, Vector3,
        float::{cos, ln, pow, sin, sqr},
    },
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, Glossy, fresnel::schlick_rise, ggx};

/// A coat, the same from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Varnish {
    /// How much of it is there, in `[0, 1]`.
    pub share: f32,
    /// Width, above 0 and below 1.
    pub alpha: f32,
}

impl Varnish {
    /// What is reflected at normal incidence.
    const F0: f32 = 0.04;
    /// Width of the facets that shadow each other.
    const SHADOWING: f32 = 0.25;

    /// Density of normals, 1/sr.
    fn distribution(&self, h: Vector3) -> f32 {
        let a2 = sqr(self.alpha);
        (a2 - 1.0) / (PI * ln(a2) * (sqr(h.x) + sqr(h.y) + a2 * sqr(h.z)))
    }
    /// The half vector, and the cosine between it and either direction; `None` if they are on two sides.
    fn half(wo: Vector3, wi: Vector3) -> Option<(Vector3, f32)> {
        let sum = wo + wi;
        let length = sum.length();
        (wo.z * wi.z > 0.0 && length > 0.0).then(|| (sum / length, 0.5 * length))
    }
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let Some((h, cos_d)) = Self::half(wo, wi) else { return Spectrum::BLACK };
        let fresnel = Self::F0 + (1.0 - Self::F0) * schlick_rise(cos_d);
        let seen = |w: Vector3| ggx::masking(w.z.abs(), Self::SHADOWING);
        Spectrum::splat(0.25 * self.share * fresnel * self.distribution(h) * seen(wo) * seen(wi))
    }
    /// Density of [`Varnish::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        Self::half(wo, wi).map_or(0.0, |(h, cos_d)| self.distribution(h) * h.z.abs() / (4.0 * cos_d))
    }
    /// The direction at a point of the unit square, mirrored at a normal drawn with the density `D cos`; `None` if it leads
    /// into the surface.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        let a2 = sqr(self.alpha);
        let sin2 = ((pow(a2, 1.0 - u.y) - a2) / (1.0 - a2)).clamp(0.0, 1.0);
        let (r, z, phi) = (sin2.sqrt(), (1.0 - sin2).sqrt(), 2.0 * PI * u.x);
        let h = Vector3::new(r * cos(phi), r * sin(phi), if wo.z < 0.0 { -z } else { z });
        let wi = h * (2.0 * wo.dot(h)) - wo;
        let pdf = self.pdf(wo, wi);
        let branch =
            Branch { kind: BranchKind::Reflection, wi, weight: self.eval(wo, wi) * (wi.z.abs() / pdf) };
        (pdf > 0.0 && branch.weight.is_finite()).then_some(Drawn { branch, pdf })
    }
    /// Share of the light of a uniform sky that leaves towards `wo`, about.
    pub(super) fn strength(&self, wo: Vector3) -> f32 {
        let cos = wo.z.abs().min(1.0);
        self.share * cos * (Self::F0 + schlick_rise(cos))
    }
    /// Reflection that looks about the same: what integrators see that draw no directions.
    pub(super) fn look(&self) -> Glossy {
        Glossy { scale: self.share, ..Glossy::clear(Self::F0, self.alpha) }
    }
}
