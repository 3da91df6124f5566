//! The closed set of lobes and what each contributes.
use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};

use super::{
    Blurred, BranchKind, Branches, Draws, Gloss, Glossy, GlossyView, Hair, Highlight, Interface, Layered,
    Matte, Measured, Phong, Sheet, Tilted, Varnish,
};

/// One way in which a surface scatters light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe<'a> {
    /// Lambert: `f = albedo / pi`, on both sides.
    Diffuse {
        /// Share of light reflected, in `[0, 1]`.
        albedo: Spectrum,
    },
    /// The classic ambient coefficient `k_a`: replaces the diffuse albedo in the ambient term; reflects no light.
    Ambient {
        /// `k_a`.
        coefficient: Spectrum,
    },
    /// The classic highlight of a light without extent.
    Highlight(Highlight),
    /// Rough reflection.
    Glossy(Glossy),
    /// Perfect mirror.
    Mirror {
        /// Share of light reflected.
        weight: Spectrum,
    },
    /// Smooth boundary of a transparent body: reflection and refraction.
    Interface(Interface),
    /// A mirror blurred by a power of the cosine.
    Gloss(Gloss),
    /// Blurred boundary of a transparent body.
    Blurred(Blurred),
    /// Broad reflection that is not Lambert's.
    Matte(Matte),
    /// Light from the other side spread evenly: `f = albedo / pi`.
    Behind {
        /// Share of light transmitted, in `[0, 1]`.
        albedo: Spectrum,
    },
    /// A normalised highlight.
    Phong(Phong),
    /// Disney's clear coat.
    Varnish(Varnish),
    /// What light does between a coat and a metal below it.
    Layered(Layered),
    /// Rough or sharp reflection about a normal of its own.
    Tilted(Tilted),
    /// Rough transmission through something thin.
    Sheet(Sheet),
    /// A strand of hair, around which light is scattered.
    Hair(Hair),
    /// Reflection as it was measured.
    Measured(Measured<'a>),
    /// Light goes straight on: partial coverage, or transmission through something thin.
    PassThrough {
        /// Share of light that passes.
        weight: Spectrum,
    },
}

/// Parts of the unit interval by which draws choose among the kinds of a [`Layered`] lobe: 0.7, 0.2 and 0.1 of them.
const CHOICES: f32 = 10.0;

/// The mirror direction of `wo` about the z axis.
pub(super) fn mirrored(wo: Vector3) -> Vector3 {
    Vector3::new(-wo.x, -wo.y, wo.z)
}

impl Lobe<'_> {
    /// Value without the cosine, 1/sr; black for lobes that are perfectly sharp.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        match self {
            Self::Diffuse { albedo } if wo.z * wi.z > 0.0 => *albedo * FRAC_1_PI,
            Self::Highlight(highlight) => highlight.eval(wo, wi),
            Self::Glossy(glossy) => glossy.eval(wo, wi),
            Self::Gloss(gloss) => gloss.eval(wo, wi),
            Self::Blurred(blurred) => blurred.eval(wo, wi),
            Self::Matte(matte) => matte.eval(wo, wi),
            Self::Behind { albedo } if wo.z * wi.z < 0.0 => *albedo * FRAC_1_PI,
            Self::Phong(phong) => phong.eval(wo, wi),
            Self::Varnish(varnish) => varnish.eval(wo, wi),
            Self::Layered(layered) => layered.eval(wo, wi),
            Self::Tilted(tilted) => tilted.eval(wo, wi),
            Self::Sheet(sheet) => sheet.eval(wo, wi),
            Self::Hair(hair) => hair.eval(wo, wi),
            Self::Measured(measured) => measured.eval(wo, wi),
            Self::Diffuse { .. }
            | Self::Behind { .. }
            | Self::Ambient { .. }
            | Self::Mirror { .. }
            | Self::Interface(_)
            | Self::PassThrough { .. } => Spectrum::BLACK,
        }
    }
    pub(super) fn add_branches(&self, wo: Vector3, branches: &mut Branches) {
        match self {
            Self::Diffuse { .. }
            | Self::Ambient { .. }
            | Self::Highlight(_)
            | Self::Matte(_)
            | Self::Hair(_)
            | Self::Behind { .. } => {}
            Self::Glossy(_) | Self::Phong(_) | Self::Varnish(_) | Self::Layered(_) | Self::Measured(_) => {
                let weight = self.look().map_or(Spectrum::BLACK, |glossy| glossy.branch_weight(wo));
                branches.add(BranchKind::Reflection, mirrored(wo), weight)
            }
            Self::Mirror { weight } => branches.add(BranchKind::Reflection, mirrored(wo), *weight),
            Self::Interface(interface) => interface.add_branches(wo, branches),
            Self::Gloss(gloss) => branches.add(BranchKind::Reflection, mirrored(wo), gloss.weight),
            Self::Blurred(blurred) => blurred.interface.add_branches(wo, branches),
            Self::Tilted(tilted) => {
                if let Some(branch) = tilted.branch(wo) {
                    branches.add(branch.kind, branch.wi, branch.weight);
                }
            }
            Self::Sheet(sheet) => branches.add(BranchKind::Transmission, -wo, sheet.passed(wo)),
            Self::PassThrough { weight } => branches.add(BranchKind::Transmission, -wo, *weight),
        }
    }
    /// Adds the directions that are perfectly sharp; see [`super::Bsdf::sharp`].
    pub(super) fn add_sharp_branches(&self, wo: Vector3, branches: &mut Branches) {
        match self {
            Self::Gloss(_)
            | Self::Phong(_)
            | Self::Varnish(_)
            | Self::Layered(_)
            | Self::Sheet(_)
            | Self::Measured(_) => {}
            Self::Glossy(glossy) | Self::Tilted(Tilted { glossy, .. }) if glossy.spreads() => {}
            Self::Blurred(blurred) => blurred.add_sharp_branches(wo, branches),
            _ => self.add_branches(wo, branches),
        }
    }
    /// Whether rays may follow it: mirrored, passed on or drawn.
    pub(super) fn is_followed(&self) -> bool {
        match self {
            Self::Diffuse { .. }
            | Self::Ambient { .. }
            | Self::Highlight(_)
            | Self::Matte(_)
            | Self::Hair(_)
            | Self::Behind { .. } => false,
            Self::Mirror { .. } | Self::Interface(_) | Self::PassThrough { .. } => true,
            Self::Glossy(_) | Self::Tilted(_) => true,
            Self::Gloss(_)
            | Self::Blurred(_)
            | Self::Phong(_)
            | Self::Varnish(_)
            | Self::Layered(_)
            | Self::Sheet(_)
            | Self::Measured(_) => true,
        }
    }
    /// Whether directions can be drawn from it.
    pub(super) fn spreads(&self) -> bool {
        match self {
            Self::Gloss(_)
            | Self::Blurred(_)
            | Self::Phong(_)
            | Self::Varnish(_)
            | Self::Layered(_)
            | Self::Sheet(_)
            | Self::Measured(_) => true,
            Self::Glossy(glossy) | Self::Tilted(Tilted { glossy, .. }) => glossy.spreads(),
            Self::Mirror { .. } | Self::Interface(_) | Self::PassThrough { .. } => false,
            _ => self.is_followed(),
        }
    }
    /// Adds directions drawn at a point of the unit square, if the lobe spreads them.
    pub(super) fn draw(&self, wo: Vector3, u: Point2, draws: &mut Draws) {
        match self {
            Self::Gloss(gloss) => draws.add(gloss.draw(wo, u)),
            Self::Glossy(glossy) if glossy.spreads() => {
                if let Some(drawn) = glossy.draw(wo, u) {
                    draws.add(drawn);
                }
            }
            Self::Blurred(blurred) => blurred.draw(wo, u, draws),
            Self::Phong(phong) => phong.draw(wo, u).into_iter().for_each(|drawn| draws.add(drawn)),
            Self::Varnish(varnish) => varnish.draw(wo, u).into_iter().for_each(|drawn| draws.add(drawn)),
            Self::Sheet(sheet) => sheet.draw(wo, u).into_iter().for_each(|drawn| draws.add(drawn)),
            Self::Measured(lobe) => lobe.draw(wo, u).into_iter().for_each(|drawn| draws.add(drawn)),
            Self::Tilted(tilted) if tilted.glossy.spreads() => {
                tilted.draw(wo, u).into_iter().for_each(|drawn| draws.add(drawn));
            }
            Self::Layered(layered) => {
                // The kind is chosen by what the first number tells beyond it.
                let stretched = u.x * CHOICES;
                let u = Point2::new(stretched - stretched.floor(), u.y);
                let choice = (stretched.floor() + 0.5) / CHOICES;
                layered.draw(wo, choice, u).into_iter().for_each(|drawn| draws.add(drawn));
            }
            _ => {}
        }
    }
    /// Density with which draws of this lobe meet `wi`, 1/sr; `None` if nothing is drawn from it.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> Option<f32> {
        match self {
            Self::Gloss(gloss) => Some(gloss.pdf(wo, wi)),
            Self::Glossy(glossy) if glossy.spreads() => Some(glossy.pdf(wo, wi)),
            Self::Blurred(blurred) => Some(blurred.pdf(wo, wi)),
            Self::Phong(phong) => Some(phong.pdf(wo, wi)),
            Self::Varnish(varnish) => Some(varnish.pdf(wo, wi)),
            Self::Layered(layered) => Some(layered.pdf(wo, wi)),
            Self::Tilted(tilted) if tilted.glossy.spreads() => Some(tilted.pdf(wo, wi)),
            Self::Sheet(sheet) => Some(sheet.pdf(wo, wi)),
            Self::Measured(measured) => Some(measured.pdf(wo, wi)),
            _ => None,
        }
    }
    /// Whether rays that follow it meet lights with extent, of which no highlight has to tell then.
    pub(super) fn shows_lights(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Interface(_) | Self::Gloss(_) | Self::Blurred(_))
    }
    /// Share of [`Lobe::eval`] that [`super::Bsdf::branches`] does not carry.
    pub(super) fn share_beside_branches(&self) -> f32 {
        match self {
            Self::Gloss(_) | Self::Blurred(_) | Self::Sheet(_) => 0.0,
            _ => self.look().map_or(1.0, |glossy| 1.0 - glossy.mirror_share()),
        }
    }
    /// Whether it is a boundary of a body that hardly spreads what passes it.
    pub(super) fn is_narrow(&self) -> bool {
        match self {
            Self::Interface(_) => true,
            Self::Blurred(blurred) => blurred.is_narrow(),
            _ => false,
        }
    }
    /// The glossy lobe that it is, or looks like to integrators that draw no directions.
    pub(super) fn look(&self) -> Option<Glossy> {
        match self {
            Self::Glossy(glossy) => Some(*glossy),
            Self::Phong(phong) => Some(phong.look()),
            Self::Varnish(varnish) => Some(varnish.look()),
            Self::Layered(layered) => layered.look(),
            Self::Tilted(tilted) => Some(tilted.glossy),
            Self::Measured(measured) => Some(measured.look()),
            _ => None,
        }
    }
    /// What integrators that draw no directions see beside its branch.
    pub(super) fn seen_glossy(&self, wo: Vector3) -> Option<GlossyView> {
        match self {
            Self::Tilted(tilted) => tilted.view(wo),
            _ => self.look()?.view(wo),
        }
    }
    /// The colour people would name; see [`super::Bsdf::albedo`].
    pub(super) fn tint(&self) -> Spectrum {
        match self {
            Self::Diffuse { albedo } => *albedo,
            Self::Ambient { .. } | Self::Highlight(_) => Spectrum::BLACK,
            Self::Glossy(glossy) => glossy.reflectance.ends().0 * glossy.scale,
            Self::Mirror { weight } | Self::PassThrough { weight } => *weight,
            Self::Gloss(gloss) => gloss.weight,
            Self::Matte(matte) => matte.albedo(),
            Self::Behind { albedo } => *albedo,
            Self::Phong(phong) => phong.specular,
            Self::Varnish(varnish) => varnish.look().reflectance.ends().0 * varnish.share,
            Self::Layered(layered) => {
                let narrow = layered.look().map_or(Spectrum::BLACK, |g| g.reflectance.ends().0 * g.scale);
                narrow + layered.albedo()
            }
            Self::Tilted(tilted) => tilted.glossy.reflectance.ends().0 * tilted.glossy.scale,
            Self::Hair(hair) => hair.tint(),
            Self::Measured(measured) => measured.tint(),
            Self::Sheet(sheet) => sheet.glossy().reflectance.ends().0 * sheet.glossy().scale,
            Self::Blurred(blurred) => blurred.interface.tint(),
            Self::Interface(interface) => interface.tint(),
        }
    }
    /// The same lobe, dimmed: its share in a mixture.
    #[must_use]
    pub(crate) fn scaled(self, by: f32) -> Self {
        match self {
            Self::Diffuse { albedo } => Self::Diffuse { albedo: albedo * by },
            Self::Ambient { coefficient } => Self::Ambient { coefficient: coefficient * by },
            Self::Highlight(h) => Self::Highlight(Highlight { specular: h.specular * by, ..h }),
            Self::Glossy(g) => Self::Glossy(Glossy { scale: g.scale * by, ..g }),
            Self::Mirror { weight } => Self::Mirror { weight: weight * by },
            Self::Interface(interface) => Self::Interface(interface.scaled(by)),
            Self::Gloss(g) => Self::Gloss(Gloss { weight: g.weight * by, ..g }),
            Self::Blurred(b) => Self::Blurred(Blurred { interface: b.interface.scaled(by), ..b }),
            Self::Matte(matte) => Self::Matte(matte.scaled(by)),
            Self::Behind { albedo } => Self::Behind { albedo: albedo * by },
            Self::Phong(p) => Self::Phong(Phong { specular: p.specular * by, ..p }),
            Self::Varnish(v) => Self::Varnish(Varnish { share: v.share * by, ..v }),
            Self::Layered(l) => Self::Layered(Layered { scale: l.scale * by, ..l }),
            Self::Tilted(t) => {
                Self::Tilted(Tilted { glossy: Glossy { scale: t.glossy.scale * by, ..t.glossy }, ..t })
            }
            Self::Sheet(sheet) => Self::Sheet(sheet.scaled(by)),
            Self::Hair(hair) => Self::Hair(hair.scaled(by)),
            Self::Measured(measured) => Self::Measured(measured.scaled(by)),
            Self::PassThrough { weight } => Self::PassThrough { weight: weight * by },
        }
    }
}
