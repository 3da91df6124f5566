//! Rough reflection: isotropic GGX with Schlick's Fresnel term, `f = F D V` (glTF 2.0, appendix B).
//!
//! Single scattering: light that would bounce twice between microfacets is lost, up to two thirds of it at alpha = 1
//! (validation.md E3). The directional albedo is the split sum `E = f0 A(cos, alpha) + B(cos, alpha)` (Karis 2013,
//! "Real Shading in Unreal Engine 4"), read from a table of our own, made by quadrature: see `albedo.rs`.
//!
//! **Gloss without sampling.** An integrator that spawns one ray per lobe (Whitted's) cannot blur a reflection. It sees
//! the lobe twice, and both parts together weigh `E`: as a mirror branch, whose share fades from 1 at alpha <= 0.02 to 0
//! at alpha >= 0.2, and as a [`GlossyView`] with the rest. Below alpha = 1e-3 the lobe *is* a mirror with Schlick's term,
//! and `eval` is black (pbrt-v4's threshold of effective smoothness). An integrator that draws directions replaces both.

mod albedo;
mod albedo_table;

use durer_core::{
    math::{Point2, Vector3, float::sqr},
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, GlossyView, ggx, lobe::mirrored, schlick_rise};

/// Below this `alpha` the lobe is a mirror.
pub const SMOOTH: f32 = 1e-3;
/// Up to this `alpha` the mirror branch carries everything.
const SHARP: f32 = 0.02;
/// Cosines are taken to be at least this: `f` stays finite at grazing incidence.
const MIN_COSINE: f32 = 1e-6;

/// A rough reflecting surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glossy {
    /// Reflectance at normal incidence, in `[0, 1]`.
    pub f0: Spectrum,
    /// Reflectance at grazing incidence, in `[0, 1]`: 1 in nature; that of `f0` where it shall not depend on the angle.
    pub f90: Spectrum,
    /// GGX roughness in `[0, 1]`.
    pub alpha: f32,
    /// Factor on the whole lobe: coverage, in `[0, 1]`.
    pub scale: f32,
}

impl Glossy {
    /// From this `alpha` on the mirror branch carries nothing.
    pub const BLURRED: f32 = 0.2;

    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let h = wo + wi;
        let length = h.length();
        if self.alpha < SMOOTH || wo.z * wi.z <= 0.0 || length == 0.0 {
            return Spectrum::BLACK;
        }
        let h = h / length;
        let (cos_o, cos_i) = (wo.z.abs().max(MIN_COSINE), wi.z.abs().max(MIN_COSINE));
        let dv = ggx::distribution(h, self.alpha) * ggx::visibility(cos_o, cos_i, self.alpha);
        // Half the length is the cosine between either direction and h; exactly the same from both.
        self.fresnel(0.5 * length) * (dv * self.scale)
    }
    /// Share of the light from a uniform sky that leaves towards `wo`, without the factor `scale`.
    pub fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        let cos = wo.z.abs().min(1.0);
        if self.alpha < SMOOTH {
            return self.fresnel(cos);
        }
        let (a, b) = albedo::split_sum(cos, self.alpha);
        self.f0 * a + self.f90 * b
    }
    fn fresnel(&self, cos: f32) -> Spectrum {
        let rise = schlick_rise(cos);
        self.f0.zip(self.f90, |f0, f90| f0 + (f90 - f0) * rise)
    }
    /// Whether directions drawn from it differ: below `alpha` = 1e-3 it is a mirror.
    pub(super) fn spreads(&self) -> bool {
        self.alpha >= SMOOTH
    }
    /// Density of [`Glossy::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let h = wo + wi;
        if wo.z * wi.z <= 0.0 || h.length_squared() == 0.0 {
            return 0.0;
        }
        let (o, h) = if wo.z < 0.0 { (-wo, -h.normalize()) } else { (wo, h.normalize()) };
        ggx::masking(o.z, self.alpha) * ggx::distribution(h, self.alpha) / (4.0 * o.z)
    }
    /// The direction at a point of the unit square: a visible microfacet normal mirrors `wo`. `None` if it goes into the
    /// surface, where single scattering loses it.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        if wo.z == 0.0 {
            return None;
        }
        let up = wo.z.signum();
        let (o, wi, cos) = self.mirrored_at(wo * up, u);
        if wi.z <= 0.0 {
            return None;
        }
        // f cos / density = F G2 / G1.
        let shadowing =
            4.0 * o.z * wi.z * ggx::visibility(o.z, wi.z, self.alpha) / ggx::masking(o.z, self.alpha);
        let branch = Branch {
            kind: BranchKind::Reflection,
            wi: wi * up,
            weight: self.fresnel(cos) * (shadowing * self.scale),
        };
        (!branch.weight.is_black()).then(|| Drawn { branch, pdf: self.pdf(wo, branch.wi) })
    }
    /// `o`, its direction mirrored at the visible microfacet normal of a point of the unit square, and the cosine between
    /// either and the normal.
    fn mirrored_at(&self, o: Vector3, u: Point2) -> (Vector3, Vector3, f32) {
        let h = ggx::visible_normal(o, self.alpha, u);
        let cos = o.dot(h).min(1.0);
        (o, h * (2.0 * cos) - o, cos)
    }
    /// What [`Glossy::draw`] loses into the surface, not dimmed by other microfacets.
    pub(super) fn lost(&self, wo: Vector3, u: Point2) -> Option<Branch> {
        if wo.z == 0.0 {
            return None;
        }
        let up = wo.z.signum();
        let (_, wi, cos) = self.mirrored_at(wo * up, u);
        let weight = self.fresnel(cos) * self.scale;
        (wi.z <= 0.0).then(|| Branch { kind: BranchKind::Reflection, wi: wi * up, weight })
    }
    /// Share of the lobe that the mirror branch carries.
    pub(super) fn mirror_share(&self) -> f32 {
        let t = ((Self::BLURRED - self.alpha) / (Self::BLURRED - SHARP)).clamp(0.0, 1.0);
        sqr(t) * (3.0 - 2.0 * t)
    }
    pub(super) fn branch_weight(&self, wo: Vector3) -> Spectrum {
        let share = self.mirror_share() * self.scale;
        if share == 0.0 { Spectrum::BLACK } else { self.directional_albedo(wo) * share }
    }
    pub(super) fn view(&self, wo: Vector3) -> Option<GlossyView> {
        let share = (1.0 - self.mirror_share()) * self.scale;
        let weight = if share > 0.0 { self.directional_albedo(wo) * share } else { Spectrum::BLACK };
        (!weight.is_black()).then(|| GlossyView { wi: mirrored(wo), weight, alpha: self.alpha })
    }
}
