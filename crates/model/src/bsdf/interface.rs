//! A smooth boundary between two media: one reflected and one refracted direction.
//!
//! The side is read from `wo`: the ray enters when `wo.z > 0`. Radiance is not scaled by the square of the index on
//! refraction: what is carried is Whitted's intensity, as seen by a camera outside (validation.md I4).
use durer_core::{
    math::{Normal3, Vector3},
    spectrum::Spectrum,
};

use super::{BranchKind, Branches, fresnel_dielectric, lobe::mirrored, refract};

/// How light is divided between reflection and transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Split {
    /// By Fresnel's equations, times these factors; on total internal reflection everything is reflected.
    Fresnel {
        /// Factor on what is reflected.
        reflection: Spectrum,
        /// Factor on what is transmitted.
        transmission: Spectrum,
    },
    /// By Whitted's constants; on total internal reflection nothing is transmitted and the reflection stays as it is.
    Constant {
        /// `k_s`.
        reflection: Spectrum,
        /// `k_t`.
        transmission: Spectrum,
    },
}

/// A smooth dielectric interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Index of refraction on the inside (z < 0), divided by that on the outside. Above 0.
    pub eta: f32,
    /// How light is divided.
    pub split: Split,
}

impl Interface {
    /// A clear interface that loses nothing.
    pub const fn clear(eta: f32) -> Self {
        Self { eta, split: Split::Fresnel { reflection: Spectrum::ONE, transmission: Spectrum::ONE } }
    }
    /// The same, dimmed on both ways.
    pub(super) fn scaled(self, by: f32) -> Self {
        let split = match self.split {
            Split::Fresnel { reflection, transmission } => {
                Split::Fresnel { reflection: reflection * by, transmission: transmission * by }
            }
            Split::Constant { reflection, transmission } => {
                Split::Constant { reflection: reflection * by, transmission: transmission * by }
            }
        };
        Self { split, ..self }
    }
    /// The index on the far side of `wo`, divided by that on its own.
    pub(super) fn eta_seen(&self, wo: Vector3) -> f32 {
        if wo.z > 0.0 { self.eta } else { 1.0 / self.eta }
    }
    /// What is reflected and what is transmitted, at a cosine of incidence and the index as in [`Self::eta_seen`].
    pub(super) fn shares(&self, cos: f32, eta: f32) -> (Spectrum, Spectrum) {
        match self.split {
            Split::Fresnel { reflection, transmission } => {
                let f = fresnel_dielectric(cos.min(1.0), eta);
                (reflection * f, transmission * (1.0 - f))
            }
            Split::Constant { reflection, transmission } => (reflection, transmission),
        }
    }
    pub(super) fn add_branches(&self, wo: Vector3, branches: &mut Branches) {
        let eta = self.eta_seen(wo);
        let refracted = refract(wo, Normal3::new(0.0, 0.0, 1.0), 1.0 / eta);
        let (reflection, transmission) = self.shares(wo.z.abs(), eta);
        branches.add(BranchKind::Reflection, mirrored(wo), reflection);
        match refracted {
            Some(wi) => branches.add(BranchKind::Transmission, wi, transmission),
            None if self.transmits() => branches.total_internal_reflection = Some(transmission),
            None => {}
        }
    }
    /// Share of light that arrives at the end of `wo`, from both directions together.
    pub(super) fn strength(&self, wo: Vector3) -> f32 {
        let (reflection, transmission) = self.shares(wo.z.abs(), self.eta_seen(wo));
        reflection.mean() + transmission.mean()
    }
    fn transmits(&self) -> bool {
        !matches!(self.split, Split::Constant { transmission, .. } if transmission.is_black())
    }
    pub(super) fn tint(&self) -> Spectrum {
        match self.split {
            Split::Fresnel { transmission, .. } => transmission,
            Split::Constant { reflection, transmission } => reflection + transmission,
        }
    }
}
