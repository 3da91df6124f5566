//! Random numbers as pure functions of (seed, pixel, sample index, branch, named dimension).

mod density;
mod dimension;
mod hash;
mod sampler;
mod sobol;
mod strata;
mod warp;

pub use density::LinearDensity;
pub use dimension::Dim;
pub use sampler::{Sampler, SamplerKind};
pub use warp::{concentric_disk, cosine_hemisphere};
