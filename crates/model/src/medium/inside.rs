//! The inside of a body that light walks in at random below its surface: wax, marble, skin, milk.
//!
//! It is the same everywhere on a walk, and what it is its material says at the place where the walk begins. Coefficients
//! come as they are, as a measured stuff, or as the share of light that shall come out again ([`super::HalfSpace`]).
use durer_core::spectrum::{Color, Spectrum};

use super::{Draws, Flight, HenyeyGreenstein, preset::Preset, volume::Local};

/// What scatters and absorbs below a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inside {
    /// Absorption coefficient, 1/m.
    pub sigma_a: Spectrum,
    /// Scattering coefficient, 1/m.
    pub sigma_s: Spectrum,
    /// How it scatters.
    pub phase: HenyeyGreenstein,
}

impl Inside {
    /// Of this mean free path in metres and this share of light that a particle scatters.
    pub fn new(mfp: Spectrum, albedo: Spectrum, phase: HenyeyGreenstein) -> Self {
        // Where nothing gets anywhere [`Inside::coarsened`] says how far it gets.
        let sigma_t = mfp.map(|l| 1.0 / l.max(1e-20));
        Self { sigma_a: sigma_t * albedo.map(|a| 1.0 - a), sigma_s: sigma_t * albedo, phase }
    }
    /// Absorption and scattering coefficient of a measured stuff by pbrt's name, in 1/mm.
    pub fn named(name: &str) -> Option<(Color, Color)> {
        Preset::named(name).map(|stuff| (stuff.sigma_a, stuff.sigma_s))
    }
    /// The names of measured stuffs.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Preset::names()
    }
    /// The same albedo with a mean free path of at least this many metres: places nearer to each other are the same to
    /// single precision.
    #[must_use]
    pub fn coarsened(self, least: f32) -> Self {
        let sigma_t = self.sigma_a + self.sigma_s;
        let by = sigma_t.map(|s| if s * least > 1.0 { 1.0 / (s * least) } else { 1.0 });
        Self { sigma_a: self.sigma_a * by, sigma_s: self.sigma_s * by, ..self }
    }
    /// The share of an even light that a half-space of it without a boundary sends back (van de Hulst, "Multiple Light
    /// Scattering", 1980, his fit for all asymmetries): what it looks like to those who do not walk.
    pub fn albedo(&self) -> Spectrum {
        self.sigma_a.zip(self.sigma_s, |a, s| {
            let forward = s * self.phase.g();
            let root = if a > 0.0 { (a / (a + s - forward)).sqrt() } else { 0.0 };
            let empty = a + s == 0.0;
            if empty { 0.0 } else { (1.0 - root) * (1.0 - 0.139 * root) / (1.0 + 1.17 * root) }
        })
    }
    /// Follows a ray of unit direction in it; see [`super::Volume::fly`].
    pub fn fly(&self, lanes: Spectrum, span: (f32, f32), draws: Draws<'_>) -> Flight {
        let local = Local { sigma_a: self.sigma_a, sigma_s: self.sigma_s, added: Spectrum::BLACK };
        local.fly_evenly((!self.sigma_s.is_black(), None), lanes, span, draws)
    }
}
