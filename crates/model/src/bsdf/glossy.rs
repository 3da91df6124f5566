//! Rough reflection: isotropic GGX with Schlick's Fresnel term, `f = F D V` (glTF 2.0, appendix B).
//!
//! Single scattering: light that would bounce twice between microfacets is lost, up to two thirds of it at alpha = 1
//! (validation.md E3). The directional albedo is the split sum `E = f0 A(cos, alpha) + B(cos, alpha)` (Karis 2013,
//! "Real Shading in Unreal Engine 4"), read from a table of our own, made by quadrature: see `albedo.rs`.
//!
//! **Gloss without sampling.** An integrator that spawns one ray per lobe (Whitted's) cannot blur a reflection. It sees
//! the lobe twice, and both parts together weigh `E`: as a mirror branch, whose share fades from 1 at alpha <= 0.02 to 0
//! at alpha >= 0.2, and as a [`GlossyView`] with the rest. Below alpha = 1e-3 the lobe *is* a mirror with Schlick's term,
//! and `eval` is black (pbrt-v4's threshold of effective smoothness). An integrator that samples lobes replaces both.

mod albedo;
mod albedo_table;

use durer_core::{
    math::{Vector3, float::sqr},
    spectrum::Spectrum,
};

use super::{GlossyView, ggx, lobe::mirrored, schlick};

/// Below this `alpha` the lobe is a mirror.
const SMOOTH: f32 = 1e-3;
/// Up to this `alpha` the mirror branch carries everything.
const SHARP: f32 = 0.02;
/// From this `alpha` on the mirror branch carries nothing.
const BLURRED: f32 = 0.2;
/// Cosines are taken to be at least this: `f` stays finite at grazing incidence.
const MIN_COSINE: f32 = 1e-6;

/// A rough reflecting surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glossy {
    /// Reflectance at normal incidence, in `[0, 1]`.
    pub f0: Spectrum,
    /// GGX roughness in `[0, 1]`.
    pub alpha: f32,
    /// Factor on the whole lobe: coverage, in `[0, 1]`.
    pub scale: f32,
}

impl Glossy {
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
        schlick(self.f0, 0.5 * length) * (dv * self.scale)
    }
    /// Share of the light from a uniform sky that leaves towards `wo`, without the factor `scale`.
    pub fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        let cos = wo.z.abs().min(1.0);
        if self.alpha < SMOOTH {
            return schlick(self.f0, cos);
        }
        let (a, b) = albedo::split_sum(cos, self.alpha);
        self.f0.map(|f| f * a + b)
    }
    /// Share of the lobe that the mirror branch carries, in `[0, 1]`.
    pub fn mirror_share(&self) -> f32 {
        let t = ((BLURRED - self.alpha) / (BLURRED - SHARP)).clamp(0.0, 1.0);
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
