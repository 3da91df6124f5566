//! Gloss after Cook, Porter and Carpenter (1984): directions spread about a main one with density
//! `(n + 1) / (2 pi) cos^n`, all of the same weight.
//!
//! The lobe is not cut off at the surface: what would go through it is turned to its own side by mirroring, so that no
//! light is lost (validation.md F9 measures it where nothing has to be turned).
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Frame, Normal3, Point2, Vector3,
        float::{cos, pow, sin},
    },
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, lobe::mirrored};

/// From this exponent on a lobe is perfectly sharp: it is narrower than 0.1 degrees.
pub(super) const SHARP: f32 = 1e6;

/// Mirror reflection blurred by `cos^n` about the mirror direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// Share of light reflected.
    pub weight: Spectrum,
    /// `n`, 0 or more: larger is narrower.
    pub exponent: f32,
}

impl Gloss {
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        if wi.z == 0.0 { Spectrum::BLACK } else { self.weight * (self.pdf(wo, wi) / wi.z.abs()) }
    }
    /// Density of [`Gloss::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        pdf(mirrored(wo), self.exponent, wi)
    }
    /// The direction at a point of the unit square.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Drawn {
        let wi = draw(mirrored(wo), self.exponent, u);
        let branch = Branch { kind: BranchKind::Reflection, wi, weight: self.weight };
        Drawn { branch, pdf: self.pdf(wo, wi) }
    }
}

/// A direction about the unit vector `axis`, on its side of the surface.
pub(super) fn draw(axis: Vector3, exponent: f32, u: Point2) -> Vector3 {
    let w = about(axis, exponent, u);
    if w.z * axis.z < 0.0 { Vector3::new(w.x, w.y, -w.z) } else { w }
}

/// A direction about the unit vector `axis`, on any side of the surface.
pub(super) fn about(axis: Vector3, exponent: f32, u: Point2) -> Vector3 {
    let c = pow(1.0 - u.x, 1.0 / (exponent + 1.0));
    let s = (1.0 - c * c).max(0.0).sqrt();
    let phi = TAU * u.y;
    Frame::from_z(Normal3::from(axis)).to_world(Vector3::new(s * cos(phi), s * sin(phi), c))
}

/// Density of [`draw`] at `w`, 1/sr.
pub(super) fn pdf(axis: Vector3, exponent: f32, w: Vector3) -> f32 {
    if w.z * axis.z <= 0.0 {
        return 0.0;
    }
    let lobe = |w: Vector3| {
        let c = w.dot(axis).min(1.0);
        // PERF: ln c <= c - 1, so beyond this the power is below the smallest float (bench render).
        if c <= 0.0 || exponent * (c - 1.0) < -104.0 { 0.0 } else { pow(c, exponent) }
    };
    (exponent + 1.0) / (2.0 * PI) * (lobe(w) + lobe(Vector3::new(w.x, w.y, -w.z)))
}
