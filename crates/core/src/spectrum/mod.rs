//! Light and reflectance: [`Color`] describes, [`Spectrum`] is what travels along a ray, [`Basis`] turns one into the
//! other and is the only code that knows what a lane means.

mod basis;
mod color;
mod lanes;

pub use basis::Basis;
pub use color::Color;
pub use lanes::Spectrum;
