//! Phong's and Blinn's highlights, normalised so that they reflect no more than arrives.
//!
//! Phong, modified so as to be reciprocal (Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for
//! Physically Based Rendering"): `f = k_s (n + 2) / (2 pi) cos^n a` with `a` the angle to the mirror direction; directions
//! are drawn with density `(n + 1) / (2 pi) cos^n a`. Blinn: `f = k_s (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) cos^n h`
//! with `h` the angle between normal and half vector. Both reflect `k_s` at normal incidence, less at others.
use std::f32::consts::PI;

use durer_core::{
    math::{Point2, Vector3, float::pow},
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, Facets, Glossy, Reflectance, gloss, lobe::mirrored};

/// A normalised highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// `k_s`, in `[0, 1]`.
    pub specular: Spectrum,
    /// `n`, 0 or more.
    pub exponent: f32,
    /// About the normal and the half vector (Blinn) instead of about the mirror direction.
    pub half: bool,
}

impl Phong {
    /// `cos^n` between two directions.
    fn power(&self, a: Vector3, b: Vector3) -> f32 {
        let c = a.dot(b).min(1.0);
        // PERF: ln c <= c - 1, so beyond this the power is below the smallest float.
        if c <= 0.0 || self.exponent * (c - 1.0) < -104.0 { 0.0 } else { pow(c, self.exponent) }
    }
    fn up(wo: Vector3) -> Vector3 {
        Vector3::new(0.0, 0.0, if wo.z < 0.0 { -1.0 } else { 1.0 })
    }
    /// Value without the cosine, 1/sr; the same from both sides.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        if wo.z * wi.z <= 0.0 {
            return Spectrum::BLACK;
        }
        let n = self.exponent;
        if self.half {
            let norm = (n + 2.0) * (n + 4.0) / (8.0 * PI * (pow(2.0, -0.5 * n) + n));
            return self.specular * (norm * self.power((wo + wi).normalize(), Self::up(wo)));
        }
        self.specular * ((n + 2.0) / (2.0 * PI) * self.power(mirrored(wo), wi))
    }
    /// Density of [`Phong::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        if wo.z * wi.z <= 0.0 {
            return 0.0;
        }
        let factor = (self.exponent + 1.0) / (2.0 * PI);
        if self.half {
            let h = (wo + wi).normalize();
            return factor * self.power(h, Self::up(wo)) / (4.0 * wo.dot(h));
        }
        factor * self.power(mirrored(wo), wi)
    }
    /// The direction at a point of the unit square; `None` if it leads into the surface.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        let wi = if self.half {
            let h = gloss::about(Self::up(wo), self.exponent, u);
            h * (2.0 * wo.dot(h)) - wo
        } else {
            gloss::about(mirrored(wo), self.exponent, u)
        };
        let pdf = self.pdf(wo, wi);
        let branch =
            Branch { kind: BranchKind::Reflection, wi, weight: self.eval(wo, wi) * (wi.z.abs() / pdf) };
        (pdf > 0.0 && branch.weight.is_finite()).then_some(Drawn { branch, pdf })
    }
    /// Reflection that looks about the same: what integrators see that draw no directions.
    pub(super) fn look(&self) -> Glossy {
        let n = if self.half { self.exponent } else { 4.0 * self.exponent };
        let alpha = (2.0 / (n + 2.0)).sqrt();
        let reflectance = Reflectance::Schlick { f0: self.specular, f90: self.specular };
        Glossy { reflectance, facets: Facets::round(alpha.min(1.0)), scale: 1.0 }
    }
}
