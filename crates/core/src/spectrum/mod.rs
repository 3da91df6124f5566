//! Light and reflectance: [`Color`] describes, [`Spectrum`] is what travels along a ray, [`Basis`] turns one into the
//! other and is the only code that knows what a lane means.

mod basis;
mod color;
mod lanes;
mod metal;
mod named;
mod observer;
mod sampled;

pub use basis::Basis;
pub use color::{Color, luminance};
pub use lanes::Spectrum;
pub use metal::{conductor, conductor_of, curve};
pub use named::{Named, named, spectrum_names};
pub use sampled::{HELIUM_D, Sampled, blackbody, glow};
