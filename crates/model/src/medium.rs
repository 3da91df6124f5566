//! What fills a transparent body: its index of refraction, how much light it absorbs, and who gives way where bodies
//! overlap.
//!
//! Absorption follows Beer and Lambert: after a way `t` the share `exp(-sigma_a t)` is left. Priorities follow Schmidt and
//! Budge ("Simple Nested Dielectrics in Ray Traced Images", 2002): where bodies overlap, the one of the highest priority
//! fills the place, and the surfaces of the others are not there.
use durer_core::{
    math::float::exp,
    spectrum::{Basis, Color, Curve, Spectrum},
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// The inside of a transparent body.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Index of refraction, at 587.6 nm if it changes: absolute for bodies with a priority, else relative to what the body lies in. Above 0.
    pub eta_d: f32,
    /// How it changes with wavelength, if it does.
    pub dispersion: Option<Curve>,
    /// Absorption coefficient `sigma_a`, in 1/m, 0 or more.
    pub absorption: Color,
    /// Who gives way: the higher one stays. Bodies without one are taken to lie in each other and never to overlap.
    pub priority: Option<i32>,
}

impl Medium {
    /// The parameter `priority`.
    pub(crate) const PRIORITY: ParamSpec = ParamSpec::new(
        "priority",
        ParamType::Int,
        ParamDefault::Unset,
        "Where transparent bodies overlap the one of higher priority is there. With it eta is absolute, not relative.",
    );
    /// The parameter `absorption`.
    pub(crate) const ABSORPTION: ParamSpec = ParamSpec::color(
        "absorption",
        [0.0; 3],
        "Absorption coefficient of the inside, in 1/m (Beer-Lambert).",
    )
    .range(0.0, f32::INFINITY);

    /// One that absorbs nothing.
    pub fn clear(eta: f32) -> Self {
        Self { eta_d: eta, dispersion: None, absorption: Color::BLACK, priority: None }
    }
    /// The index of refraction by which a sample's rays are bent.
    #[inline]
    pub fn eta(&self, basis: &Basis) -> f32 {
        match &self.dispersion {
            None => self.eta_d,
            Some(curve) => basis.leading(curve, self.eta_d),
        }
    }
    /// Reads priority and absorption of a body of this index.
    pub(crate) fn read(args: &mut Args<'_>, (eta_d, dispersion): (f32, Option<Curve>)) -> Self {
        let priority = args.is_set(Self::PRIORITY.name).then(|| args.int(Self::PRIORITY.name));
        Self { eta_d, dispersion, absorption: args.color(Self::ABSORPTION.name), priority }
    }
    /// True if it absorbs anything.
    pub fn absorbs(&self) -> bool {
        self.absorption != Color::BLACK
    }
    /// The share of light that is left after `length` metres; after an infinite way all of what is absorbed at all is gone.
    pub fn transmittance(&self, basis: &Basis, length: f32) -> Spectrum {
        // Without the distinction nothing (0) times an infinite way would be NaN.
        let left = |sigma: f32| if sigma > 0.0 { exp(-sigma * length) } else { 1.0 };
        match basis {
            Basis::Rgb => basis.reflectance(self.absorption.map(left)),
            Basis::Spectral(_) => basis.unbounded(self.absorption).map(left),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_fades_exponentially() {
        let absorption = Color::new(0.5, 0.0, 2.0);
        let medium = Medium { absorption, ..Medium::clear(1.5) };
        let [r, g, b] = Basis::Rgb.to_rgb(medium.transmittance(&Basis::Rgb, 1.0));
        assert!((r - 0.606_531).abs() < 1e-6 && g == 1.0 && (b - 0.135_335).abs() < 1e-6);
        let far = medium.transmittance(&Basis::Rgb, f32::INFINITY);
        assert_eq!(Basis::Rgb.to_rgb(far), [0.0, 1.0, 0.0]);
    }
}
