//! What floats on the way of a ray, as the document tells it.
use serde::{Deserialize, Serialize};

use crate::{Scene, probe, spectrum::Basis};

use super::{
    capture::{of_light, of_weight, world},
    number::{Number, Place, Rgb},
};

/// What floats on the way of a ray.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Floating {
    /// The medium's name.
    pub medium: String,
    /// What light from the end of the way is multiplied with: what is left of it, or scattered, by the density of that end.
    pub weight: Rgb,
    /// Of `local`, what the medium sends out on the way.
    pub sent: Rgb,
    /// The probability of getting as far; 1 where nothing is drawn.
    pub passed: Number,
    /// The particle that the ray met; null if it met none.
    pub scattered: Option<Scattered>,
}

/// A place where light is scattered.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Scattered {
    /// Where.
    pub point: Place,
    /// Absorption coefficient there, 1/m.
    pub sigma_a: Rgb,
    /// Scattering coefficient there, 1/m.
    pub sigma_s: Rgb,
    /// How directions are drawn: `henyey-greenstein`, `waterdrops`, `rayleigh`, `table`, `sggx` or `blend`.
    pub phase: String,
    /// Mean cosine of the deflection.
    pub g: Number,
}

pub(super) fn floating(scene: &Scene, basis: &Basis, event: &probe::Floating) -> Floating {
    // Below surfaces light is scattered by the mean cosine.
    let phase = scene.volume_of(event.fill).map_or("henyey-greenstein", |volume| volume.phase().name());
    Floating {
        medium: scene.fill_name(event.fill).to_owned(),
        weight: of_weight(basis, event.weight),
        sent: of_light(basis, event.sent),
        passed: Number(event.passed),
        scattered: event.particle.map(|particle| Scattered {
            point: world(&scene.view, particle.p),
            sigma_a: of_weight(basis, particle.sigma_a),
            sigma_s: of_weight(basis, particle.sigma_s),
            phase: phase.to_owned(),
            g: Number(particle.g),
        }),
    }
}
