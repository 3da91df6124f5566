//! The closed set of lobes and what each contributes.
use std::f32::consts::FRAC_1_PI;

use durer_core::{math::Vector3, spectrum::Spectrum};

use super::{BranchKind, Branches, Glossy, Highlight, Interface};

/// One way in which a surface scatters light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
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
    /// Light goes straight on: partial coverage, or transmission through something thin.
    PassThrough {
        /// Share of light that passes.
        weight: Spectrum,
    },
}

/// The mirror direction of `wo` about the z axis.
pub(super) fn mirrored(wo: Vector3) -> Vector3 {
    Vector3::new(-wo.x, -wo.y, wo.z)
}

impl Lobe {
    /// Value without the cosine, 1/sr; black for lobes that are perfectly sharp.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        match self {
            Self::Diffuse { albedo } if wo.z * wi.z > 0.0 => *albedo * FRAC_1_PI,
            Self::Highlight(highlight) => highlight.eval(wo, wi),
            Self::Glossy(glossy) => glossy.eval(wo, wi),
            Self::Diffuse { .. }
            | Self::Ambient { .. }
            | Self::Mirror { .. }
            | Self::Interface(_)
            | Self::PassThrough { .. } => Spectrum::BLACK,
        }
    }
    pub(super) fn add_branches(&self, wo: Vector3, branches: &mut Branches) {
        match self {
            Self::Diffuse { .. } | Self::Ambient { .. } | Self::Highlight(_) => {}
            Self::Glossy(glossy) => {
                branches.add(BranchKind::Reflection, mirrored(wo), glossy.branch_weight(wo))
            }
            Self::Mirror { weight } => branches.add(BranchKind::Reflection, mirrored(wo), *weight),
            Self::Interface(interface) => interface.add_branches(wo, branches),
            Self::PassThrough { weight } => branches.add(BranchKind::Transmission, -wo, *weight),
        }
    }
    /// The colour people would name; see [`super::Bsdf::albedo`].
    pub(super) fn tint(&self) -> Spectrum {
        match self {
            Self::Diffuse { albedo } => *albedo,
            Self::Ambient { .. } | Self::Highlight(_) => Spectrum::BLACK,
            Self::Glossy(glossy) => glossy.f0 * glossy.scale,
            Self::Mirror { weight } | Self::PassThrough { weight } => *weight,
            Self::Interface(interface) => interface.tint(),
        }
    }
}
