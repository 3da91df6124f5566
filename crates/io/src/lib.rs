//! Files: scene importers and a writer, image readers and writers, and the folder a scene may read from.
#![forbid(unsafe_code)]
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)]

mod assets;
mod caught;
pub mod export;
mod gzip;
pub mod image;
pub mod import;
mod ptex;
mod tensor;
mod volume;

pub use assets::FileAssets;
pub use caught::hush_decoders;
