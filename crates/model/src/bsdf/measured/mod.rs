//! Reflection as it was measured: Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and
//! Rendering"; their database is at <https://rgl.epfl.ch/materials>.
//!
//! The half vector `m` is what the density of visible normals draws a point `u` of the unit square to, `m = R(u)`, for each
//! direction seen from: where facets are many, there are many points. Over `u` the measurement varies little, so that a coarse
//! lattice of colours holds it: `f cos_i = color(u) D(m) / (4 sigma(wo))`. A direction is drawn through the density of the
//! luminance over `u`, then through `R`: `pdf = p_lum(u) p_vndf(m) / (4 wo.m 2 pi² u_m sin_m)`, as elevations are squeezed to
//! `theta = u² pi / 2`. The same from both sides, as in pbrt-v4. Measurements, and lines between them, are not quite reciprocal.
mod tables;

use std::f32::consts::PI;

use durer_core::{
    math::{
        Point2, Vector3,
        float::{asin, atan2, cos, sin, sqr},
    },
    sampling::Blend,
    spectrum::{Basis, Spectrum},
};

pub use tables::Measurement;

use super::{Branch, BranchKind, Drawn, Facets, Glossy, Reflectance};

/// Cosines are taken to be at least this: `f` stays finite where light grazes.
const MIN_COSINE: f32 = 1e-6;

/// A surface of something measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<'a> {
    of: &'a Measurement,
    basis: Basis,
    /// The direction of azimuth 0, in the tangent plane.
    along: [f32; 2],
    scale: f32,
}

/// A direction that it is seen from.
struct View {
    /// In the frame of the measurement, above the surface.
    wo: Vector3,
    phi: f32,
    /// What other directions are multiplied with to come into that frame, after they are turned.
    signs: Vector3,
    /// The tables around it, and how much of the facets is seen.
    seen: (Blend, f32),
}

/// Angle to the normal of a unit vector, accurate near 0.
fn elevation(w: Vector3) -> f32 {
    let chord = Vector3::new(w.x, w.y, w.z - 1.0).length();
    2.0 * asin((0.5 * chord).min(1.0))
}

/// What densities over the unit square are divided by to be those of normals, by solid angle.
fn stretch(u: f32, sin_theta: f32) -> f32 {
    (2.0 * sqr(PI) * u * sin_theta).max(1e-6)
}

impl<'a> Measured<'a> {
    /// With azimuths counted from `along`, in the frame of the lobes.
    pub fn new(of: &'a Measurement, basis: Basis, along: Vector3) -> Self {
        let length = (sqr(along.x) + sqr(along.y)).sqrt();
        let along = if length > 0.0 { [along.x / length, along.y / length] } else { [1.0, 0.0] };
        Self { of, basis, along, scale: 1.0 }
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { scale: self.scale * by, ..self }
    }
    /// Width of GGX facets that look alike.
    pub(super) fn alpha(&self) -> f32 {
        self.of.alpha
    }
    /// What is reflected at normal incidence.
    pub(super) fn tint(&self) -> Spectrum {
        self.basis.unbounded(self.of.albedo(1.0)) * self.scale
    }
    /// Share of the light of a uniform sky that leaves towards `wo`, about.
    pub(super) fn strength(&self, wo: Vector3) -> f32 {
        let [r, g, b] = self.of.albedo(wo.z.abs()).rgb;
        (r + g + b) / 3.0 * self.scale
    }
    /// What it looks like to integrators that draw no directions.
    pub(super) fn look(&self) -> Glossy {
        let tint = self.tint();
        let reflectance = Reflectance::Schlick { f0: tint, f90: tint };
        Glossy { reflectance, facets: Facets::round(self.alpha()), scale: 1.0 }
    }

    fn view(&self, wo: Vector3) -> Option<View> {
        if wo.z == 0.0 {
            return None;
        }
        let mut signs = Vector3::new(1.0, 1.0, 1.0) * wo.z.signum();
        let turned = self.turned(wo, signs);
        // Parts of a turn: half a turn further, or mirrored.
        let sign = |v: f32| if v >= 0.0 { -1.0 } else { 1.0 };
        let (x, y) = match self.of.parts {
            1 => (1.0, 1.0),
            2 => (sign(turned.y), sign(turned.y)),
            _ => (sign(turned.x), sign(turned.y)),
        };
        signs = Vector3::new(signs.x * x, signs.y * y, signs.z);
        let wo = self.turned(wo, signs);
        let phi = atan2(wo.y, wo.x);
        Some(View { wo, phi, signs, seen: self.of.seen(phi, elevation(wo)) })
    }
    /// A direction in the frame of the measurement.
    fn turned(&self, w: Vector3, signs: Vector3) -> Vector3 {
        let [x, y] = self.along;
        Vector3::new((w.x * x + w.y * y) * signs.x, (w.y * x - w.x * y) * signs.y, w.z * signs.z)
    }
    /// Back from there.
    fn back(&self, w: Vector3, signs: Vector3) -> Vector3 {
        let [x, y] = self.along;
        let w = Vector3::new(w.x * signs.x, w.y * signs.y, w.z * signs.z);
        Vector3::new(w.x * x - w.y * y, w.x * y + w.y * x, w.z)
    }
    /// The half vector in its unit square, and cosine and sine that count for densities; `None` if there is none.
    fn half(&self, view: &View, wi: Vector3) -> Option<(Point2, f32, f32)> {
        let sum = view.wo + wi;
        let length = sum.length();
        if wi.z <= 0.0 || length == 0.0 {
            return None;
        }
        let m = sum / length;
        let phi = atan2(m.y, m.x) - if self.of.is_isotropic { view.phi } else { 0.0 };
        let sin_theta = (sqr(m.x) + sqr(m.y)).sqrt();
        Some((tables::unit(phi, elevation(m)), 0.5 * length, sin_theta))
    }

    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let value = || {
            let view = self.view(wo)?;
            let wi = self.turned(wi, view.signs);
            let (m, ..) = self.half(&view, wi)?;
            let (u, _) = self.of.vndf.invert(&view.seen.0, m);
            Some(self.of.value(&self.basis, &view.seen, [u, m]) * (self.scale / wi.z.max(MIN_COSINE)))
        };
        value().unwrap_or(Spectrum::BLACK)
    }
    /// Density of [`Measured::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let density = || {
            let view = self.view(wo)?;
            let (m, cos, sin_theta) = self.half(&view, self.turned(wi, view.signs))?;
            let (u, visible) = self.of.vndf.invert(&view.seen.0, m);
            let light = self.of.luminance.density(&view.seen.0, u);
            Some(light * visible / (4.0 * cos * stretch(m.x, sin_theta)))
        };
        density().unwrap_or(0.0)
    }
    /// The direction at a point of the unit square; `None` if it leads into the surface.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        let view = self.view(wo)?;
        let (u, light) = self.of.luminance.sample(&view.seen.0, u);
        let (m, visible) = self.of.vndf.sample(&view.seen.0, u);
        let theta = sqr(m.x) * (PI / 2.0);
        let phi = (2.0 * m.y - 1.0) * PI + if self.of.is_isotropic { view.phi } else { 0.0 };
        let sin_theta = sin(theta);
        let normal = Vector3::new(sin_theta * cos(phi), sin_theta * sin(phi), cos(theta));
        let cos = view.wo.dot(normal);
        let wi = normal * (2.0 * cos) - view.wo;
        let pdf = light * visible / (4.0 * cos * stretch(m.x, sin_theta));
        if wi.z <= 0.0 || !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let weight = self.of.value(&self.basis, &view.seen, [u, m]) * (self.scale / pdf);
        let wi = self.back(wi, view.signs).normalize();
        let branch = Branch { kind: BranchKind::Reflection, wi, weight };
        branch.weight.is_finite().then_some(Drawn { branch, pdf })
    }
}
