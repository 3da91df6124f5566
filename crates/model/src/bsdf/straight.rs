//! What passes a surface without being bent: how a shadow ray sees transparent things.
//!
//! No light really takes that way through a body that refracts; it stands for the bent one that ends at the same places.
//! Fresnel's share is therefore taken at the angle on the optically thinner side: behind plates and balls it is that of
//! the bent path exactly (both ends of a path through them meet the surface at the angle at which the straight line
//! meets the first), and no window turns opaque because a straight line in it has an angle that no refracted ray has.
use durer_core::{math::Vector3, spectrum::Spectrum};

use super::{Bsdf, Interface, Lobe, Split, fresnel_dielectric};

/// What dims a straight line through an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Straight {
    /// The colour that the material transmits.
    Tinted,
    /// The same, times the share that is not reflected.
    Fresnel,
    /// Nothing that bends or spreads light lets any pass: what is left really takes the straight line.
    Clear,
}

impl Bsdf<'_> {
    /// What of the light that goes straight on leaves along `wo`, what is lost on the way along it included.
    pub fn passed(&self, wo: Vector3) -> Spectrum {
        self.arriving * self.straight(wo, Straight::Clear)
    }
    /// The share of light that passes along the line of unit direction `wo`, in the direction or against it. Black where
    /// the surface is opaque.
    pub fn straight(&self, wo: Vector3, how: Straight) -> Spectrum {
        self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + lobe.straight(wo, how))
    }
}

impl Lobe<'_> {
    fn straight(&self, wo: Vector3, how: Straight) -> Spectrum {
        match self {
            Self::Interface(_) | Self::Blurred(_) | Self::Sheet(_) if how == Straight::Clear => {
                Spectrum::BLACK
            }
            Self::Sheet(sheet) => sheet.passed(wo),
            Self::Interface(interface) => interface.straight(wo, how),
            Self::Blurred(blurred) => blurred.interface.straight(wo, how),
            Self::PassThrough { weight } => *weight,
            Self::Diffuse { .. }
            | Self::Ambient { .. }
            | Self::Highlight(_)
            | Self::Glossy(_)
            | Self::Gloss(_)
            | Self::Matte(_)
            | Self::Behind { .. }
            | Self::Phong(_)
            | Self::Varnish(_)
            | Self::Layered(_)
            | Self::Tilted(_)
            | Self::Hair(_)
            | Self::Measured(_)
            | Self::Mirror { .. } => Spectrum::BLACK,
        }
    }
}

impl Interface {
    fn straight(&self, wo: Vector3, how: Straight) -> Spectrum {
        let (Split::Fresnel { transmission, .. } | Split::Constant { transmission, .. }) = self.split;
        match how {
            Straight::Tinted | Straight::Clear => transmission,
            Straight::Fresnel => {
                let from_thinner = self.eta.max(1.0 / self.eta);
                transmission * (1.0 - fresnel_dielectric(wo.z.abs().min(1.0), from_thinner))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_loses_the_same_from_both_sides_and_through_opaque_things_all() {
        let wo = Vector3::new(0.866_025_4, 0.0, 0.5);
        for side in [wo, -wo] {
            for eta in [1.5, 1.0 / 1.5] {
                let glass = Bsdf::default().with(Lobe::Interface(Interface::clear(eta)));
                assert_eq!(glass.straight(side, Straight::Tinted), Spectrum::ONE);
                let passed = glass.straight(side, Straight::Fresnel).max();
                assert!((passed - (1.0 - 0.089_19)).abs() < 1e-5, "60 degrees, I5: {passed}");
            }
            let opaque = Bsdf::default().with(Lobe::Mirror { weight: Spectrum::ONE });
            assert!(opaque.straight(side, Straight::Tinted).is_black());
        }
    }
}
