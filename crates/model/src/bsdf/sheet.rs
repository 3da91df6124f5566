//! A rough sheet too thin to displace light: what passes it is spread as its facets would reflect it, seen from behind
//! (KHR_materials_transmission): `f(o, i) = f_r(o, i')` with `i'` the mirror image of `i` below the sheet.
use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, Facets, Glossy, Reflectance};

/// Rough transmission straight on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// What would be reflected, in place of passing.
    mirrored: Glossy,
}

impl Sheet {
    /// What `outside`, of Schlick's reflectance, lets through: `1 - F` for each facet, tinted.
    pub fn below(outside: &Glossy, tint: Spectrum) -> Self {
        let (f0, f90) = outside.reflectance.ends();
        let left = |f: Spectrum| tint * f.map(|f| (1.0 - f).max(0.0));
        Self {
            mirrored: Glossy {
                reflectance: Reflectance::Schlick { f0: left(f0), f90: left(f90) },
                ..*outside
            },
        }
    }
    /// What these facets of a dielectric let through, tinted.
    pub fn through(eta: f32, facets: Facets, tint: Spectrum) -> Self {
        Self { mirrored: Glossy { reflectance: Reflectance::Passed { eta, tint }, facets, scale: 1.0 } }
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { mirrored: Glossy { scale: self.mirrored.scale * by, ..self.mirrored } }
    }
    /// The facets.
    pub(super) fn glossy(&self) -> &Glossy {
        &self.mirrored
    }
    pub(super) fn regularize(&mut self, blurred: impl Fn(f32) -> f32) {
        self.mirrored.facets = self.mirrored.facets.map(blurred);
    }
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        self.mirrored.eval(wo, flipped(wi))
    }
    /// Density of [`Sheet::draw`], 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.mirrored.pdf(wo, flipped(wi))
    }
    /// The direction at a point of the unit square; `None` if a facet sends it back.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        let drawn = self.mirrored.draw(wo, u)?;
        let branch = Branch { kind: BranchKind::Transmission, wi: flipped(drawn.branch.wi), ..drawn.branch };
        Some(Drawn { branch, ..drawn })
    }
    /// Share of light that passes towards `wo`.
    pub(super) fn passed(&self, wo: Vector3) -> Spectrum {
        self.mirrored.directional_albedo(wo) * self.mirrored.scale
    }
}

fn flipped(w: Vector3) -> Vector3 {
    Vector3::new(w.x, w.y, -w.z)
}
