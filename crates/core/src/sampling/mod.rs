//! Random numbers as pure functions of (seed, pixel, sample index, branch, named dimension).

mod curve;
mod density;
mod dimension;
mod halton;
mod hash;
mod kind;
mod lattice;
mod piecewise;
mod sampler;
mod sobol;
mod strata;
mod warp;

pub use density::LinearDensity;
pub use dimension::Dim;
pub use kind::SamplerKind;
pub use lattice::{Axes, Blend, Lattice, Place, between, rises};
pub use piecewise::PiecewiseLinear2D;
pub use sampler::Sampler;
pub use warp::{concentric_disk, concentric_polar, cosine_hemisphere};
