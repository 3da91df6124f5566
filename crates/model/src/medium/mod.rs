//! What fills places: the inside of transparent bodies, and what floats in it or in the air.
//!
//! A body has an index of refraction, absorbs, and gives way or not where bodies overlap ([`Medium`]). What scatters or glows
//! is a [`Volume`]: fog, smoke, milk, fire. Bodies and surfaces say what fills the two sides of them ([`Fill`]).
//!
//! Absorption follows Beer and Lambert: after a way `t` the share `exp(-sigma_a t)` is left. Priorities follow Schmidt and
//! Budge ("Simple Nested Dielectrics in Ray Traced Images", 2002): where bodies overlap, the one of the highest priority
//! fills the place, and the surfaces of the others are not there.
//!
//! A new kind of volume is one file here and one line in [`MEDIA`].
mod cloud;
mod flight;
mod glimpse;
mod glow;
mod glowing;
mod grid;
mod halfspace;
mod homogeneous;
mod inside;
mod majorant;
mod matter;
mod nanovdb;
mod phase;
mod preset;
mod refraction;
mod rgbgrid;
mod uniformgrid;
mod volume;

use durer_core::{
    math::float::exp,
    spectrum::{Basis, Color, Curve, Spectrum},
};
use durer_scene::{Args, Entry, ParamDefault, ParamSpec, ParamType};

pub(crate) use self::grid::Grid;
pub use self::{
    cloud::Cloud,
    flight::{Draws, End, Flier, Flight, Passage},
    glowing::Glowing,
    halfspace::HalfSpace,
    homogeneous::Homogeneous,
    inside::Inside,
    nanovdb::NanoVdb,
    phase::{HenyeyGreenstein, Phase, Turn},
    rgbgrid::RgbGrid,
    uniformgrid::UniformGrid,
    volume::Volume,
};

/// All kinds of volume.
pub const MEDIA: &[Entry<Volume>] = &[
    Entry::of::<Homogeneous>(),
    Entry::of::<UniformGrid>(),
    Entry::of::<RgbGrid>(),
    Entry::of::<Cloud>(),
    Entry::of::<NanoVdb>(),
];

/// What floats at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fill {
    /// Nothing.
    #[default]
    Nothing,
    /// The volume of this index in the scene.
    Volume(u32),
    /// What the material of this index in the scene has below its surface: [`Inside`].
    Below(u32),
}

/// What kind of surface is around a medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hull {
    /// That of a transparent body, which refracts.
    Body,
    /// Another one: that of a leaf or a sheet, of which only the two sides matter.
    Sheet,
    /// None: rays pass as if nothing were there, and are in something else behind.
    Open,
}

/// The inside of a transparent body, or what a surface has behind and before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// What surface is around it.
    pub hull: Hull,
    /// Index of refraction, at 587.6 nm if it changes: absolute for bodies with a priority, else relative to what the body
    /// lies in. Above 0.
    pub eta_d: f32,
    /// How it changes with wavelength, if it does.
    pub dispersion: Option<Curve>,
    /// Absorption coefficient `sigma_a`, in 1/m, 0 or more.
    pub absorption: Color,
    /// Who gives way: the higher one stays. Bodies without one are taken to lie in each other and never to overlap.
    pub priority: Option<i32>,
    /// What floats in it. If nobody says so: in bodies with a priority nothing, else what floats around them.
    pub inside: Option<Fill>,
    /// What floats around it, if somebody says so.
    pub outside: Option<Fill>,
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
    /// The parameter `medium`, which compiling resolves.
    pub const INSIDE: ParamSpec = ParamSpec::new(
        "medium",
        ParamType::Text,
        ParamDefault::Unset,
        "Name of the medium that floats inside, as MakeNamedMedium gives it. What a shape's MediumInterface says counts first.",
    );

    /// Clear matter in a body of this index.
    pub fn clear(eta: f32) -> Self {
        Self {
            hull: Hull::Body,
            eta_d: eta,
            dispersion: None,
            absorption: Color::BLACK,
            priority: None,
            inside: None,
            outside: None,
        }
    }
    /// The sides of a surface that is no body's.
    pub fn sides(hull: Hull) -> Self {
        Self { hull, ..Self::clear(1.0) }
    }
    /// The index of refraction by which a sample's rays are bent.
    #[inline]
    pub fn eta(&self, basis: &Basis) -> f32 {
        match &self.dispersion {
            None => self.eta_d,
            Some(curve) => basis.leading(curve, self.eta_d),
        }
    }
    /// Reads index, priority and absorption of a body.
    pub(crate) fn read(args: &mut Args<'_>) -> Self {
        let (eta, dispersion) = Self::refraction(args);
        let priority = args.is_set(Self::PRIORITY.name).then(|| args.int(Self::PRIORITY.name));
        Self { dispersion, absorption: args.color(Self::ABSORPTION.name), priority, ..Self::clear(eta) }
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
