//! OpenEXR 2: colours in; any float channels with metadata out, bit for bit.

mod complaint;
mod read;
mod write;

pub(super) use read::decode;
pub use read::read_exr_channels;
pub use write::{ExrPicture, ExrValue, encode_exr, write_exr};

/// One channel of floats.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedChannel {
    /// `R`, `depth.Z`, `normal.X`, ...
    pub name: String,
    /// `width * height` values, rows from top to bottom.
    pub values: Vec<f32>,
}
