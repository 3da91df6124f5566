//! Light that photons brought, as the document tells it.
use serde::{Deserialize, Serialize};

use crate::{probe, spectrum::Basis};

use super::{
    capture::of_light,
    number::{Number, Rgb},
};

/// Light that photons brought to the surface that was hit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Gathered {
    /// Photons within the disc.
    pub photons: u32,
    /// Radius of the disc, in metres.
    pub radius: Number,
    /// Of `local`, what the surface scatters of their light.
    pub radiance: Rgb,
}

pub(super) fn gathered(basis: &Basis, event: &probe::Gathered) -> Gathered {
    let probe::Gathered { photons, radius, radiance } = *event;
    Gathered { photons, radius: Number(radius), radiance: of_light(basis, radiance) }
}
