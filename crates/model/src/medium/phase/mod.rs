//! Directions after a particle: phase functions.
//!
//! A direction is drawn from one density for all wavelengths. Where drops of water send each wavelength elsewhere, light
//! counts by what its own phase function is by that density.
mod drops;
mod henyey_greenstein;
mod rayleigh;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use durer_core::{
    math::{
        Frame, Normal3, Point2, Vector3,
        float::{cos, sin, sqr},
    },
    spectrum::{Basis, Spectrum},
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use self::drops::Drops;
pub use self::henyey_greenstein::HenyeyGreenstein;
use super::matter::Matter;

/// How particles of a volume scatter. Densities are by solid angle, 1/sr, and depend on the cosine of the deflection.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// By the mean cosine alone.
    HenyeyGreenstein(HenyeyGreenstein),
    /// As drops of water do: with rainbows.
    Drops(Arc<Drops>),
    /// As molecules of air do: as much back as on, half as much to the sides.
    Rayleigh,
}

impl Phase {
    /// The parameter `phase`.
    pub(super) const WHICH: ParamSpec = ParamSpec::new(
        "phase",
        ParamType::Choice(&["henyeygreenstein", "waterdrops", "rayleigh"]),
        ParamDefault::Text("henyeygreenstein"),
        "Where particles send light: henyeygreenstein (by \"g\"), waterdrops (as round drops of water do, with rainbows) or \
         rayleigh (as molecules of air do).",
    );

    /// Reads it, and the mean cosine if that is asked for.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let phase = match args.text(Self::WHICH.name) {
            "waterdrops" => Self::Drops(Arc::new(Drops::new())),
            "rayleigh" => Self::Rayleigh,
            _ => return Self::HenyeyGreenstein(HenyeyGreenstein::new(args.float(Matter::G.name))),
        };
        if args.is_set(Matter::G.name) {
            let message = format!("\"g\" has no effect beside the phase function \"{}\"", phase.name());
            args.warning(Matter::G.name, message);
        }
        phase
    }

    /// What documents call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::HenyeyGreenstein(_) => "henyey-greenstein",
            Self::Drops(_) => "waterdrops",
            Self::Rayleigh => "rayleigh",
        }
    }
    /// The mean cosine of the deflection, over all wavelengths.
    pub fn g(&self) -> f32 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.g(),
            Self::Drops(drops) => drops.mean_cos(),
            Self::Rayleigh => 0.0,
        }
    }
    /// Density of going on with this cosine of the deflection.
    pub fn density(&self, cos: f32) -> f32 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.density(cos),
            Self::Drops(drops) => drops.density(cos),
            Self::Rayleigh => rayleigh::density(cos),
        }
    }
    /// The share of light that goes there by that density: ones where all wavelengths scatter alike.
    pub fn tint(&self, basis: &Basis, cos: f32) -> Spectrum {
        match self {
            Self::HenyeyGreenstein(_) | Self::Rayleigh => Spectrum::ONE,
            Self::Drops(drops) => drops.tint(basis, cos),
        }
    }
    /// A unit direction after unit direction `w`, at a point of the unit square.
    pub fn deflected(&self, w: Vector3, u: Point2) -> Vector3 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.deflected(w, u),
            Self::Drops(drops) => turned(w, drops.cos(u.x), u.y),
            Self::Rayleigh => turned(w, rayleigh::cos(u.x), u.y),
        }
    }
}

/// A unit direction of this cosine to unit direction `w`, turned around it by `u` of a full turn.
fn turned(w: Vector3, cosine: f32, u: f32) -> Vector3 {
    let sine = (1.0 - sqr(cosine)).max(0.0).sqrt();
    let azimuth = std::f32::consts::TAU * u;
    let local = Vector3::new(sine * cos(azimuth), sine * sin(azimuth), cosine);
    Frame::from_z(Normal3::from(w)).to_world(local).normalize()
}
