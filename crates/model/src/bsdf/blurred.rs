//! A boundary between two media that is not smooth: frosted glass, and the translucency of Cook, Porter and Carpenter
//! (1984).
//!
//! Microfacets (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"): a normal is drawn among
//! those seen from `wo`, light is mirrored and refracted at it. Both directions are followed, each with the share that
//! Fresnel's equations give at that normal: `weight = F G2 / G1` and `(1 - F) G2 / G1`. As at the smooth interface,
//! intensities are not scaled by the square of the index.
use durer_core::{
    math::{Normal3, Point2, Vector3},
    spectrum::Spectrum,
};

use super::{
    Branch, BranchKind, Branches, Drawn, Draws, Facets, Interface, Lobe, gloss, lobe::mirrored, refract,
    scatter::OfLobe,
};

/// Indices that differ by less are equal: floats are too coarse for the microfacet normal between directions so close.
const MATCHED: f32 = 1e-4;

/// The width of facets below which lights are hardly ever found through them.
const NARROW: f32 = 0.3;

/// How directions are spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blur {
    /// By `cos^n` about the mirrored and the refracted direction; see [`super::Gloss`]. From 1e6 on: not at all.
    Cosine {
        /// `n` about the mirrored direction.
        reflection: f32,
        /// `n` about the refracted direction.
        transmission: f32,
    },
    /// By microfacets.
    Microfacet(Facets),
}

/// An interface seen through a blur.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blurred {
    /// The boundary, as if it were smooth.
    pub interface: Interface,
    /// How directions are spread.
    pub blur: Blur,
}

impl Lobe<'_> {
    /// A boundary between two media whose facets are these.
    pub fn boundary(interface: Interface, facets: Facets) -> Self {
        match facets.is_smooth() {
            true => Self::Interface(interface),
            false => Self::Blurred(Blurred { interface, blur: Blur::Microfacet(facets) }),
        }
    }
}

impl Blurred {
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        if wi.z == 0.0 || wo.z == 0.0 {
            return Spectrum::BLACK;
        }
        let reflects = wo.z * wi.z > 0.0;
        let weight = match self.blur {
            Blur::Cosine { .. } => {
                let (reflection, transmission) =
                    self.interface.shares(wo.z.abs(), self.interface.eta_seen(wo));
                if reflects { reflection } else { transmission }
            }
            Blur::Microfacet(_) if self.is_matched() => Spectrum::BLACK,
            Blur::Microfacet(facets) => {
                let (o, i, eta) = self.upright(wo, wi);
                let Some(h) = half_vector(o, i, eta) else { return Spectrum::BLACK };
                let (reflection, transmission) = self.interface.shares(o.dot(h).abs(), eta);
                (if reflects { reflection } else { transmission }) * facets.seen_by_both(o, i)
            }
        };
        weight * (self.pdf(wo, wi) / wi.z.abs())
    }

    /// Density with which [`Blurred::draw`] meets `wi`, 1/sr; 0 on a side where directions are perfectly sharp.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let reflects = wo.z * wi.z > 0.0;
        match self.blur {
            Blur::Cosine { reflection, .. } if reflects => spread_pdf(mirrored(wo), reflection, wi),
            Blur::Cosine { transmission, .. } => match self.refracted(wo) {
                Some(axis) => spread_pdf(axis, transmission, wi),
                None => 0.0,
            },
            Blur::Microfacet(_) if self.is_matched() => 0.0,
            Blur::Microfacet(facets) => {
                let (o, i, eta) = self.upright(wo, wi);
                let Some(h) = half_vector(o, i, eta) else { return 0.0 };
                let density = facets.visible_density(o, h);
                if reflects {
                    return density / (4.0 * o.dot(h));
                }
                let across = i.dot(h) + o.dot(h) / eta;
                density * i.dot(h).abs() / (across * across)
            }
        }
    }

    /// The directions at a point of the unit square, a mirrored and a refracted one, of those that are spread.
    pub(super) fn draw(&self, wo: Vector3, u: Point2, draws: &mut Draws) {
        match self.blur {
            Blur::Cosine { reflection, transmission } => {
                let eta = self.interface.eta_seen(wo);
                let shares = self.interface.shares(wo.z.abs(), eta);
                if reflection < gloss::SHARP {
                    let wi = gloss::draw(mirrored(wo), reflection, u);
                    self.add(wo, Branch { kind: BranchKind::Reflection, wi, weight: shares.0 }, draws);
                }
                match self.refracted(wo) {
                    Some(axis) if transmission < gloss::SHARP => {
                        let wi = gloss::draw(axis, transmission, u);
                        self.add(wo, Branch { kind: BranchKind::Transmission, wi, weight: shares.1 }, draws);
                    }
                    _ => {}
                }
            }
            Blur::Microfacet(_) if self.is_matched() => {}
            Blur::Microfacet(facets) => self.draw_microfacet(wo, &facets, u, draws),
        }
    }

    fn draw_microfacet(&self, wo: Vector3, facets: &Facets, u: Point2, draws: &mut Draws) {
        let (o, _, eta) = self.upright(wo, wo);
        if o.z == 0.0 {
            return;
        }
        let side = Vector3::new(1.0, 1.0, wo.z.signum());
        let [up, down] = self.split_at((o, eta), facets, u);
        if let Some((up, reflection)) = up.filter(|(up, _)| up.z > 0.0) {
            let weight = reflection * facets.seen_by_both(o, up);
            self.add(wo, Branch { kind: BranchKind::Reflection, wi: scaled(up, side), weight }, draws);
        }
        if let Some((down, transmission)) = down.filter(|(down, _)| down.z < 0.0) {
            let weight = transmission * facets.seen_by_both(o, down);
            self.add(wo, Branch { kind: BranchKind::Transmission, wi: scaled(down, side), weight }, draws);
        }
    }

    /// The directions that the visible microfacet normal of a point of the unit square mirrors and refracts `o` to, and
    /// their shares by Fresnel's equations.
    fn split_at(
        &self,
        (o, eta): (Vector3, f32),
        facets: &Facets,
        u: Point2,
    ) -> [Option<(Vector3, Spectrum)>; 2] {
        let h = facets.visible_normal(o, u);
        let (reflection, transmission) = self.interface.shares(o.dot(h).clamp(0.0, 1.0), eta);
        let up = h * (2.0 * o.dot(h)) - o;
        let down = refract(o, Normal3::from(h), 1.0 / eta);
        [Some((up, reflection)), down.map(|down| (down, transmission))]
    }

    /// What [`Blurred::draw`] loses to the wrong side of the surface, not dimmed by other microfacets.
    pub(super) fn lost(&self, wo: Vector3, u: Point2) -> [Option<Branch>; 2] {
        let Blur::Microfacet(facets) = self.blur else { return [None; 2] };
        let (o, _, eta) = self.upright(wo, wo);
        if o.z == 0.0 || self.is_matched() {
            return [None; 2];
        }
        let side = Vector3::new(1.0, 1.0, wo.z.signum());
        let [up, down] = self.split_at((o, eta), &facets, u);
        let branch = |kind| move |(wi, weight)| Branch { kind, wi: scaled(wi, side), weight };
        let lost = [
            up.filter(|(up, _)| up.z <= 0.0).map(branch(BranchKind::Reflection)),
            down.filter(|(down, _)| down.z >= 0.0).map(branch(BranchKind::Transmission)),
        ];
        lost.map(|branch| branch.filter(|b| !b.weight.is_black()))
    }

    /// One of the two directions, chosen by their shares.
    pub(super) fn scatter(&self, wo: Vector3, choice: f32, u: Point2) -> Option<OfLobe> {
        let (o, _, eta) = self.upright(wo, wo);
        let mut sharp = Branches::default();
        self.add_sharp_branches(wo, &mut sharp);
        let cos = match self.blur {
            _ if o.z == 0.0 => return None,
            Blur::Microfacet(_) if self.is_matched() => return OfLobe::sharp(&sharp, choice),
            Blur::Microfacet(facets) => o.dot(facets.visible_normal(o, u)),
            Blur::Cosine { .. } => o.z,
        };
        let reflected = self.reflected_share(cos, eta);
        let (kind, chance) = match choice < reflected {
            true => (BranchKind::Reflection, reflected),
            false => (BranchKind::Transmission, 1.0 - reflected),
        };
        let mut draws = Draws::default();
        self.draw(wo, u, &mut draws);
        let drawn = draws.iter().map(|d| (d.branch, Some(d.pdf * chance)));
        let mut all = drawn.chain(sharp.iter().map(|b| (*b, None)));
        let (branch, pdf) = all.find(|(branch, _)| branch.kind == kind)?;
        Some(OfLobe { kind, wi: branch.wi, weight: branch.weight / chance, pdf, chance })
    }

    /// Density of [`Blurred::scatter`] at `wi`, 1/sr; 0 on a side where directions are perfectly sharp.
    pub(super) fn density(&self, wo: Vector3, wi: Vector3) -> f32 {
        let pdf = self.pdf(wo, wi);
        if pdf == 0.0 {
            return 0.0;
        }
        let (o, i, eta) = self.upright(wo, wi);
        let cos = match self.blur {
            Blur::Cosine { .. } => o.z,
            Blur::Microfacet(_) => half_vector(o, i, eta).map_or(0.0, |h| o.dot(h)),
        };
        let reflected = self.reflected_share(cos, eta);
        pdf * if i.z > 0.0 { reflected } else { 1.0 - reflected }
    }

    /// Of what leaves at a cosine of incidence, the share that is reflected.
    fn reflected_share(&self, cos: f32, eta: f32) -> f32 {
        let (reflection, transmission) = self.interface.shares(cos.clamp(0.0, 1.0), eta);
        let (r, t) = (reflection.mean(), transmission.mean());
        if r + t > 0.0 { r / (r + t) } else { 0.0 }
    }

    fn add(&self, wo: Vector3, branch: Branch, draws: &mut Draws) {
        if !branch.weight.is_black() {
            draws.add(Drawn { branch, pdf: self.pdf(wo, branch.wi) });
        }
    }

    /// The directions that are not spread at all.
    pub(super) fn add_sharp_branches(&self, wo: Vector3, branches: &mut Branches) {
        if matches!(self.blur, Blur::Microfacet(_)) && self.is_matched() {
            self.interface.add_branches(wo, branches);
        } else if let Blur::Cosine { reflection, transmission } = self.blur {
            let mut all = Branches::default();
            self.interface.add_branches(wo, &mut all);
            for branch in all.iter() {
                let exponent = match branch.kind {
                    BranchKind::Reflection => reflection,
                    BranchKind::Transmission => transmission,
                };
                if exponent >= gloss::SHARP {
                    branches.add(branch.kind, branch.wi, branch.weight);
                }
            }
            branches.total_internal_reflection = all.total_internal_reflection;
        }
    }

    /// Whether the index is the same on both sides: microfacets of any direction let everything pass straight on, and a
    /// normal cannot be told from the directions it refracts between.
    fn is_matched(&self) -> bool {
        (self.interface.eta - 1.0).abs() < MATCHED
    }

    /// Whether it hardly spreads what passes it.
    pub(super) fn is_narrow(&self) -> bool {
        match self.blur {
            Blur::Microfacet(facets) => facets.alpha() < NARROW || self.is_matched(),
            Blur::Cosine { .. } => false,
        }
    }

    fn refracted(&self, wo: Vector3) -> Option<Vector3> {
        refract(wo, Normal3::new(0.0, 0.0, 1.0), 1.0 / self.interface.eta_seen(wo))
    }

    /// Both directions with `wo` on the upper side, and the index there and beyond.
    fn upright(&self, wo: Vector3, wi: Vector3) -> (Vector3, Vector3, f32) {
        let side = Vector3::new(1.0, 1.0, if wo.z < 0.0 { -1.0 } else { 1.0 });
        (scaled(wo, side), scaled(wi, side), self.interface.eta_seen(wo))
    }
}

fn scaled(a: Vector3, b: Vector3) -> Vector3 {
    Vector3::new(a.x * b.x, a.y * b.y, a.z * b.z)
}

/// Density about `axis`; 0 where the lobe is perfectly sharp.
fn spread_pdf(axis: Vector3, exponent: f32, w: Vector3) -> f32 {
    if exponent >= gloss::SHARP { 0.0 } else { gloss::pdf(axis, exponent, w) }
}

/// The microfacet normal, upper side, that sends light from `i` to `o`; `None` if there is none seen from its front.
fn half_vector(o: Vector3, i: Vector3, eta: f32) -> Option<Vector3> {
    let h = if i.z > 0.0 { o + i } else { o + i * eta };
    if h.length_squared() == 0.0 || o.z == 0.0 {
        return None;
    }
    let h = h.normalize();
    let h = if h.z < 0.0 { -h } else { h };
    (o.dot(h) > 0.0 && i.dot(h) * i.z > 0.0).then_some(h)
}
