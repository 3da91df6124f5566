//! Light and reflectance: [`Color`] describes, [`Spectrum`] is what travels along a ray, [`Basis`] turns one into the
//! other and is the only code that knows what a lane means.

mod basis;
mod cie;
mod color;
mod curve;
mod illuminant;
mod index;
mod lamp;
mod lanes;
mod layers;
mod light_color;
mod metal;
mod named;
mod observer;
mod sampled;
mod upsample;
mod wavelengths;
mod white;

pub use basis::{Basis, Carried, Lane};
pub use color::{Color, luminance};
pub use curve::Curve;
pub use index::{abbe_number, index};
pub use lanes::Spectrum;
pub use light_color::LightColor;
pub use metal::{conductor, conductor_of, curve, extinction};
pub use named::{Named, named, named_curve, named_light, spectrum_names};
pub use sampled::{HELIUM_D, HUES, Sampled, share_weights};
pub use wavelengths::{AtWavelength, Wavelengths};
pub use white::{D65, adaptation, daylight, tristimulus, xyz_from_rec709};
