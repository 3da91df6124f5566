//! One direction for a path: a lobe is chosen by what it scatters, more or less, then a direction of it.
//!
//! Weights are `f cos / density` over all lobes that spread: whichever of them the direction comes from, the others that
//! could have given it count with it (one-sample balance heuristic, Veach and Guibas 1995). Perfectly sharp directions
//! have no density and are met by nothing else.
//!
//! Paths carry radiance: it grows by the square of the index of refraction where light enters the denser side, so that
//! what a path finds behind an interface counts `1 / eta²`. (The branching integrators carry Whitted's intensity.)
use durer_core::{
    math::{Point2, Vector3, float::sqr},
    sampling::cosine_hemisphere,
    spectrum::Spectrum,
};
use std::f32::consts::{FRAC_1_PI, PI};

use super::{Blur, Blurred, BranchKind, Branches, Bsdf, Drawn, Facets, Lobe, Matte, Tilted};

/// A direction that a path goes on in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// On which side.
    pub kind: BranchKind,
    /// Unit direction.
    pub wi: Vector3,
    /// What radiance from there is multiplied with: `f cos / pdf`; of sharp directions their share by the probability of
    /// the choice.
    pub weight: Spectrum,
    /// Density of the direction, over all lobes, 1/sr; `None` if it is sharp.
    pub pdf: Option<f32>,
    /// Probability with which its lobe, and of a sharp one this direction, was chosen.
    pub chance: f32,
    /// Number of the lobe.
    pub lobe: usize,
    /// Light goes straight on, as if nothing were there: no bounce.
    pub passes: bool,
    /// By what radiance changed because of the index: 1 on the same side.
    pub compression: f32,
}

/// A direction of one lobe.
pub(super) struct OfLobe {
    pub(super) kind: BranchKind,
    pub(super) wi: Vector3,
    /// `f cos / pdf`, or the share of a sharp direction by its `chance`; before compression.
    pub(super) weight: Spectrum,
    /// Of this lobe alone.
    pub(super) pdf: Option<f32>,
    /// Of a sharp direction, among those of its lobe.
    pub(super) chance: f32,
}

impl OfLobe {
    /// One of the sharp directions, chosen by what they carry.
    pub(super) fn sharp(branches: &Branches, choice: f32) -> Option<Self> {
        let total: f32 = branches.iter().map(|b| b.weight.mean()).sum();
        let mut left = choice * total;
        let mut chosen = None;
        for branch in branches.iter() {
            let own = branch.weight.mean();
            if own > 0.0 {
                chosen = Some((branch, own / total));
                if left < own {
                    break;
                }
            }
            left -= own;
        }
        let (branch, chance) = chosen?;
        let weight = branch.weight / chance;
        Some(Self { kind: branch.kind, wi: branch.wi, weight, pdf: None, chance })
    }
    fn drawn(drawn: &Drawn) -> Self {
        let branch = drawn.branch;
        Self { kind: branch.kind, wi: branch.wi, weight: branch.weight, pdf: Some(drawn.pdf), chance: 1.0 }
    }
}

/// The other side counts by this.
fn on_side(wo: Vector3, wi: Vector3) -> BranchKind {
    if wo.z * wi.z > 0.0 { BranchKind::Reflection } else { BranchKind::Transmission }
}

impl Bsdf<'_> {
    /// A direction to go on in; `choice` in `[0, 1)` chooses among lobes, `u` within one. `None` if what is chosen keeps
    /// all light.
    pub fn scatter(&self, wo: Vector3, choice: f32, u: Point2) -> Option<Scattered> {
        let (lobe, chance, choice) = self.choose(wo, choice)?;
        let number = lobe;
        let lobe = self.lobes[number].as_ref()?;
        let own = lobe.scatter(wo, choice, u, chance == 1.0)?;
        let compression = lobe.compression(wo, own.kind);
        let common = Scattered {
            kind: own.kind,
            wi: own.wi,
            weight: self.arriving * own.weight * (compression / chance),
            pdf: None,
            chance: chance * own.chance,
            lobe: number,
            passes: matches!(lobe, Lobe::PassThrough { .. }),
            compression,
        };
        let Some(pdf) = own.pdf else { return Some(common) };
        if chance == 1.0 {
            return Some(Scattered { pdf: Some(pdf), ..common });
        }
        let (f, pdf) = self.eval_with_pdf(wo, own.wi);
        let weight = f * (own.wi.z.abs() / pdf);
        (pdf > 0.0 && !weight.is_black()).then_some(Scattered { pdf: Some(pdf), weight, ..common })
    }

    /// The probability with which [`Bsdf::scatter`] goes straight on as if nothing were there.
    pub fn passing_chance(&self, wo: Vector3) -> f32 {
        let passes = |lobe: &&Lobe| matches!(lobe, Lobe::PassThrough { .. });
        // PERF: most surfaces are there (bench render).
        if !self.lobes().any(|lobe| passes(&lobe)) {
            return 0.0;
        }
        if self.count == 1 {
            return 1.0;
        }
        let shows = self.shows_lights();
        let total: f32 = self.lobes().map(|lobe| lobe.strength(wo, shows)).sum();
        let passing: f32 = self.lobes().filter(passes).map(|lobe| lobe.strength(wo, shows)).sum();
        if total > 0.0 { passing / total } else { 0.0 }
    }

    /// Whether [`Bsdf::scatter`] has a choice among lobes, or among the ways of one.
    pub fn has_choice(&self) -> bool {
        match self.lobes[..self.count] {
            [Some(Lobe::Diffuse { .. } | Lobe::Behind { .. } | Lobe::Matte(_))] => false,
            [Some(Lobe::Glossy(glossy))] => !glossy.spreads(),
            _ => true,
        }
    }

    /// Value of all lobes that spread, without the cosine, as radiance, and the density with which [`Bsdf::scatter`] gives
    /// this direction; 1/sr both. Highlights beside mirrors are left out: the mirrors show what casts them.
    pub fn eval_with_pdf(&self, wo: Vector3, wi: Vector3) -> (Spectrum, f32) {
        if let [Some(lobe)] = &self.lobes[..self.count] {
            // PERF: what shares with nothing is not weighed (bench render).
            let density = lobe.density(wo, wi);
            if density <= 0.0 {
                return (Spectrum::BLACK, 0.0);
            }
            let f = lobe.eval(wo, wi) * lobe.compression(wo, on_side(wo, wi));
            return (self.arriving * f, density);
        }
        let (mut f, mut pdf, mut total) = (Spectrum::BLACK, 0.0, 0.0);
        let shows = self.shows_lights();
        let kind = on_side(wo, wi);
        for lobe in self.lobes() {
            let strength = lobe.strength(wo, shows);
            if strength > 0.0 {
                total += strength;
                let density = lobe.density(wo, wi);
                if density > 0.0 {
                    pdf += strength * density;
                    f += lobe.eval(wo, wi) * lobe.compression(wo, kind);
                }
            }
        }
        if total > 0.0 { (self.arriving * f, pdf / total) } else { (Spectrum::BLACK, 0.0) }
    }

    /// Value of all lobes that spread for a light that no path can meet, without the cosine, as radiance. 1/sr.
    pub fn eval_radiance(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let kind = on_side(wo, wi);
        let value = |lobe: &Lobe| lobe.eval(wo, wi) * lobe.compression(wo, kind);
        self.arriving * self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + value(lobe))
    }

    /// Blurs what is nearly sharp, where a path comes from a blurred bounce: so narrow a lobe finds by luck what no other
    /// way finds, and that is noise (pbrt-v4's regularization).
    pub fn regularize(&mut self) {
        for lobe in self.lobes[..self.count].iter_mut().flatten() {
            lobe.regularize();
        }
    }

    fn shows_lights(&self) -> bool {
        self.lobes().any(Lobe::shows_lights)
    }

    /// A lobe, the probability of it, and what is left of the number that chose it.
    fn choose(&self, wo: Vector3, choice: f32) -> Option<(usize, f32, f32)> {
        if self.count == 1 {
            return Some((0, 1.0, choice));
        }
        let shows = self.shows_lights();
        let strengths: [f32; Bsdf::MOST_LOBES] =
            std::array::from_fn(|i| self.lobes[i].as_ref().map_or(0.0, |lobe| lobe.strength(wo, shows)));
        let total: f32 = strengths.iter().sum();
        let mut left = choice * total;
        let mut chosen = None;
        for (i, &own) in strengths.iter().enumerate() {
            if own > 0.0 {
                chosen = Some((i, own / total, (left / own).clamp(0.0, 1.0 - f32::EPSILON / 2.0)));
                if left < own {
                    break;
                }
            }
            left -= own;
        }
        chosen
    }
}

impl Lobe<'_> {
    /// What share of light it sends towards `wo`, more or less; 0 if no path shall follow it. `shows`: some lobe shows
    /// lights, so that no highlight has to stand for them.
    fn strength(&self, wo: Vector3, shows: bool) -> f32 {
        match self {
            Self::Ambient { .. } => 0.0,
            Self::Highlight(_) if shows => 0.0,
            Self::Diffuse { albedo } | Self::Behind { albedo } => albedo.mean(),
            Self::Matte(matte) => matte.directional_albedo(wo).mean(),
            Self::Phong(phong) => phong.specular.mean(),
            Self::Varnish(varnish) => varnish.strength(wo),
            Self::Layered(layered) => layered.strength(wo),
            Self::Highlight(highlight) => highlight.specular.mean(),
            Self::Glossy(glossy) => glossy.directional_albedo(wo).mean() * glossy.scale,
            Self::Tilted(tilted) => tilted.directional_albedo(wo).mean() * tilted.glossy.scale,
            Self::Sheet(sheet) => sheet.passed(wo).mean(),
            Self::Hair(hair) => hair.strength(wo),
            Self::Measured(measured) => measured.strength(wo),
            Self::Mirror { weight } | Self::PassThrough { weight } => weight.mean(),
            Self::Gloss(gloss) => gloss.weight.mean(),
            Self::Interface(interface) => interface.strength(wo),
            Self::Blurred(blurred) => blurred.interface.strength(wo),
        }
    }

    /// A direction of this lobe; if it is not `alone`, a spread one's weight and density do not matter.
    fn scatter(&self, wo: Vector3, choice: f32, u: Point2, alone: bool) -> Option<OfLobe> {
        let sharp = || {
            let mut branches = Branches::default();
            self.add_sharp_branches(wo, &mut branches);
            OfLobe::sharp(&branches, choice)
        };
        match self {
            Self::Diffuse { albedo } => cosine(wo, *albedo, u),
            Self::Behind { albedo } => {
                cosine(-wo, *albedo, u).map(|own| OfLobe { kind: BranchKind::Transmission, ..own })
            }
            Self::Matte(matte) => {
                let (from, kind) = match matte.is_behind() {
                    true => (-wo, BranchKind::Transmission),
                    false => (wo, BranchKind::Reflection),
                };
                let own = cosine(from, Spectrum::ONE, u)?;
                let weight = matte.eval(wo, own.wi) * PI;
                (!weight.is_black()).then_some(OfLobe { kind, weight, ..own })
            }
            Self::Phong(phong) => phong.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Varnish(varnish) => varnish.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Layered(layered) if alone => layered.draw(wo, choice, u).as_ref().map(OfLobe::drawn),
            // PERF: a walk saved (bench render).
            Self::Layered(layered) => layered.direction(wo, choice, u).map(|wi| OfLobe {
                kind: BranchKind::Reflection,
                wi,
                weight: Spectrum::ONE,
                pdf: Some(1.0),
                chance: 1.0,
            }),
            Self::Highlight(highlight) => {
                let wi = highlight.draw(wo, u)?;
                let pdf = highlight.pdf(wo, wi);
                let weight = highlight.eval(wo, wi) * (wi.z.abs() / pdf);
                Some(OfLobe { kind: BranchKind::Reflection, wi, weight, pdf: Some(pdf), chance: 1.0 })
                    .filter(|_| pdf > 0.0)
            }
            Self::Glossy(glossy) if glossy.spreads() => glossy.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Tilted(tilted) if tilted.glossy.spreads() => tilted.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Sheet(sheet) => sheet.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Measured(measured) => measured.draw(wo, u).as_ref().map(OfLobe::drawn),
            Self::Hair(hair) => {
                let wi = hair.draw(wo, choice, u);
                let pdf = hair.pdf(wo, wi);
                let weight = hair.eval(wo, wi) * (wi.z.abs() / pdf);
                Some(OfLobe { kind: on_side(wo, wi), wi, weight, pdf: Some(pdf), chance: 1.0 })
                    .filter(|own| pdf > 0.0 && own.weight.is_finite())
            }
            Self::Gloss(gloss) => Some(OfLobe::drawn(&gloss.draw(wo, u))),
            Self::Blurred(blurred) => blurred.scatter(wo, choice, u),
            Self::Ambient { .. }
            | Self::Glossy(_)
            | Self::Tilted(_)
            | Self::Mirror { .. }
            | Self::Interface(_)
            | Self::PassThrough { .. } => sharp(),
        }
    }

    fn regularize(&mut self) {
        match self {
            Self::Glossy(glossy) | Self::Tilted(Tilted { glossy, .. }) => {
                glossy.facets = glossy.facets.map(blurred);
            }
            Self::Sheet(sheet) => sheet.regularize(blurred),
            Self::Interface(interface) => {
                let blur = Blur::Microfacet(Facets::round(blurred(0.0)));
                *self = Self::Blurred(Blurred { interface: *interface, blur });
            }
            Self::Layered(layered) => {
                layered.coat = layered.coat.map(blurred);
                layered.below = layered.below.map(blurred);
            }
            Self::Blurred(Blurred { blur: Blur::Microfacet(facets), .. }) => *facets = facets.map(blurred),
            _ => {}
        }
    }

    /// Density of [`Lobe::scatter`] at `wi`, 1/sr; 0 where it is sharp.
    fn density(&self, wo: Vector3, wi: Vector3) -> f32 {
        match self {
            Self::Diffuse { .. } if wo.z * wi.z > 0.0 => wi.z.abs() * FRAC_1_PI,
            Self::Behind { .. } if wo.z * wi.z < 0.0 => wi.z.abs() * FRAC_1_PI,
            Self::Matte(matte) if (wo.z * wi.z > 0.0) != matte.is_behind() => wi.z.abs() * FRAC_1_PI,
            Self::Phong(phong) => phong.pdf(wo, wi),
            Self::Varnish(varnish) => varnish.pdf(wo, wi),
            Self::Layered(layered) => layered.pdf(wo, wi),
            Self::Highlight(highlight) => highlight.pdf(wo, wi),
            Self::Glossy(glossy) if glossy.spreads() => glossy.pdf(wo, wi),
            Self::Gloss(gloss) => gloss.pdf(wo, wi),
            Self::Tilted(tilted) if tilted.glossy.spreads() => tilted.pdf(wo, wi),
            Self::Sheet(sheet) => sheet.pdf(wo, wi),
            Self::Hair(hair) => hair.pdf(wo, wi),
            Self::Measured(measured) => measured.pdf(wo, wi),
            Self::Blurred(blurred) => blurred.density(wo, wi),
            Self::Diffuse { .. }
            | Self::Matte(_)
            | Self::Behind { .. }
            | Self::Ambient { .. }
            | Self::Glossy(_)
            | Self::Tilted(_)
            | Self::Mirror { .. }
            | Self::Interface(_)
            | Self::PassThrough { .. } => 0.0,
        }
    }

    /// What becomes of radiance beyond the surface on its way to this side: `1 / eta²` through an interface.
    fn compression(&self, wo: Vector3, kind: BranchKind) -> f32 {
        match (self, kind) {
            (Self::Interface(interface), BranchKind::Transmission) => 1.0 / sqr(interface.eta_seen(wo)),
            (Self::Blurred(blurred), BranchKind::Transmission) => 1.0 / sqr(blurred.interface.eta_seen(wo)),
            (Self::Matte(Matte::Leaving(leaving)), BranchKind::Transmission) => sqr(leaving.eta),
            _ => 1.0,
        }
    }
}

/// A roughness below 0.3, doubled, at least 0.1.
fn blurred(alpha: f32) -> f32 {
    if alpha < 0.3 { (2.0 * alpha).clamp(0.1, 0.3) } else { alpha }
}

/// A direction of a lobe that looks the same from everywhere.
fn cosine(wo: Vector3, albedo: Spectrum, u: Point2) -> Option<OfLobe> {
    if wo.z == 0.0 || albedo.is_black() {
        return None;
    }
    let w = cosine_hemisphere(u);
    let wi = if wo.z < 0.0 { -w } else { w };
    let pdf = Some(w.z * FRAC_1_PI);
    Some(OfLobe { kind: BranchKind::Reflection, wi, weight: albedo, pdf, chance: 1.0 })
}
