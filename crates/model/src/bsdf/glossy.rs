//! Rough reflection: microfacets, `f = F D V` (glTF 2.0, appendix B), with Schlick's or the exact Fresnel term.
//!
//! Single scattering: light that would bounce twice between microfacets is lost, up to two thirds of it at alpha = 1
//! (validation.md E3). The directional albedo is the split sum `E = f0 A(cos, alpha) + B(cos, alpha)` (Karis 2013,
//! "Real Shading in Unreal Engine 4"), read from a table of our own, made by quadrature: see `albedo.rs`. For the exact
//! term, and for widths that differ, it is an approximation; only views without sampling and choices of lobes use it then.
//!
//! **Gloss without sampling.** An integrator that spawns one ray per lobe (Whitted's) cannot blur a reflection. It sees
//! the lobe twice, and both parts together weigh `E`: as a mirror branch, whose share fades from 1 at alpha <= 0.02 to 0
//! at alpha >= 0.2, and as a [`GlossyView`] with the rest. Below alpha = 1e-3 the lobe *is* a mirror with Schlick's term,
//! and `eval` is black (pbrt-v4's threshold of effective smoothness). An integrator that draws directions replaces both.

mod albedo;
mod albedo_table;
mod beckmann_table;

use durer_core::{
    math::{Point2, Vector3, float::sqr},
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Distribution, Drawn, Facets, GlossyView, Reflectance, lobe::mirrored};

/// Share of a uniform sky that white facets of width `alpha` send towards a cosine after one bounce, by the table.
pub(super) fn single_scattered(cos: f32, alpha: f32, like: Distribution) -> f32 {
    let (a, b) = albedo::split_sum(cos, alpha, like);
    a + b
}

/// Below this `alpha` the lobe is a mirror.
pub const SMOOTH: f32 = 1e-3;
/// Up to this `alpha` the mirror branch carries everything.
const SHARP: f32 = 0.02;
/// Cosines are taken to be at least this: `f` stays finite at grazing incidence.
const MIN_COSINE: f32 = 1e-6;

/// A rough reflecting surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glossy {
    /// Fresnel's term.
    pub reflectance: Reflectance,
    /// Roughness.
    pub facets: Facets,
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
        if self.facets.is_smooth() || wo.z * wi.z <= 0.0 || length == 0.0 {
            return Spectrum::BLACK;
        }
        let h = h / length;
        let (cos_o, cos_i) = (wo.z.abs().max(MIN_COSINE), wi.z.abs().max(MIN_COSINE));
        let dv = self.facets.density(h) * self.facets.visibility((wo, cos_o), (wi, cos_i));
        // Half the length is the cosine between either direction and h; exactly the same from both.
        self.reflectance.at(0.5 * length) * (dv * self.scale)
    }
    /// A clear layer of this reflectance at normal incidence.
    pub(super) fn clear(f0: f32, alpha: f32) -> Self {
        let reflectance = Reflectance::Schlick { f0: Spectrum::splat(f0), f90: Spectrum::ONE };
        Self { reflectance, facets: Facets::round(alpha), scale: 1.0 }
    }
    /// Share of the light from a uniform sky that leaves towards `wo`, without the factor `scale`.
    pub fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        self.albedo_at(wo.z.abs().min(1.0))
    }
    /// The same by the cosine, in `[0, 1]`.
    pub(super) fn albedo_at(&self, cos: f32) -> Spectrum {
        match self.facets.is_smooth() {
            true => self.reflectance.at(cos),
            false => {
                let (f0, f90) = self.reflectance.ends();
                let (a, b) = albedo::split_sum(cos, self.facets.alpha(), self.facets.distribution());
                f0 * a + f90 * b
            }
        }
    }
    /// The same, of Schlick's reflectance between these ends and GGX facets of this width.
    pub(super) fn albedo_of((f0, f90): (Spectrum, Spectrum), alpha: f32, cos: f32) -> Spectrum {
        if alpha < SMOOTH {
            return (Reflectance::Schlick { f0, f90 }).at(cos);
        }
        let (a, b) = albedo::split_sum(cos, alpha, Distribution::Ggx);
        f0 * a + f90 * b
    }
    /// The mean of [`Glossy::directional_albedo`] by the cosine.
    pub(super) fn mean_albedo(&self) -> Spectrum {
        let (a, b) = albedo::mean_split_sum(self.facets.alpha());
        let (f0, f90) = self.reflectance.ends();
        f0 * a + f90 * b
    }
    /// Whether directions drawn from it differ: below `alpha` = 1e-3 it is a mirror.
    pub(super) fn spreads(&self) -> bool {
        !self.facets.is_smooth()
    }
    /// Density of [`Glossy::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let h = wo + wi;
        if wo.z * wi.z <= 0.0 || h.length_squared() == 0.0 {
            return 0.0;
        }
        let (o, h) = if wo.z < 0.0 { (-wo, -h.normalize()) } else { (wo, h.normalize()) };
        self.facets.masking(o) * self.facets.density(h) / (4.0 * o.z)
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
        let shadowing = self.facets.seen_by_both(o, wi);
        let branch = Branch {
            kind: BranchKind::Reflection,
            wi: wi * up,
            weight: self.reflectance.at(cos) * (shadowing * self.scale),
        };
        (!branch.weight.is_black()).then(|| Drawn { branch, pdf: self.pdf(wo, branch.wi) })
    }
    /// `o`, its direction mirrored at the visible microfacet normal of a point of the unit square, and the cosine between
    /// either and the normal.
    fn mirrored_at(&self, o: Vector3, u: Point2) -> (Vector3, Vector3, f32) {
        let h = self.facets.visible_normal(o, u);
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
        let weight = self.reflectance.at(cos) * self.scale;
        (wi.z <= 0.0).then(|| Branch { kind: BranchKind::Reflection, wi: wi * up, weight })
    }
    /// Share of the lobe that the mirror branch carries.
    pub(super) fn mirror_share(&self) -> f32 {
        let t = ((Self::BLURRED - self.facets.alpha()) / (Self::BLURRED - SHARP)).clamp(0.0, 1.0);
        sqr(t) * (3.0 - 2.0 * t)
    }
    pub(super) fn branch_weight(&self, wo: Vector3) -> Spectrum {
        let share = self.mirror_share() * self.scale;
        if share == 0.0 { Spectrum::BLACK } else { self.directional_albedo(wo) * share }
    }
    pub(super) fn view(&self, wo: Vector3) -> Option<GlossyView> {
        let share = (1.0 - self.mirror_share()) * self.scale;
        let weight = if share > 0.0 { self.directional_albedo(wo) * share } else { Spectrum::BLACK };
        (!weight.is_black()).then(|| GlossyView { wi: mirrored(wo), weight, alpha: self.facets.alpha() })
    }
}
