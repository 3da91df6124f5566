//! The only door to files: `compile` asks, `durer-io` answers.
use std::sync::Arc;

use crate::{Mesh, Ptex, Tensors, Voxels};

/// Bounds on what a hostile file may make us allocate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest file read, in bytes, after decompression.
    pub file_bytes: u64,
    /// Most bytes that one packed file may unpack to; never more than `file_bytes`.
    pub unpacked_bytes: u64,
    /// Most pixels of one image.
    pub image_pixels: u64,
    /// Deepest nesting of nodes, includes or attribute blocks.
    pub depth: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { file_bytes: 8 << 30, unpacked_bytes: 2 << 30, image_pixels: 1 << 28, depth: 256 }
    }
}

/// Why an asset could not be had, by whose fault it is.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AssetError {
    /// No such file.
    #[error("{path}: file not found")]
    Missing {
        /// As asked for.
        path: String,
    },
    /// The operating system refused.
    #[error("{path}: {reason}")]
    Io {
        /// As asked for.
        path: String,
        /// What it said.
        reason: String,
    },
    /// The bytes are not what they claim to be.
    #[error("{path}: {reason}")]
    Format {
        /// As asked for.
        path: String,
        /// What is wrong with them.
        reason: String,
    },
    /// A format we do not read.
    #[error("{path}: {reason}")]
    Unsupported {
        /// As asked for.
        path: String,
        /// What it is and what we read instead.
        reason: String,
    },
    /// Larger than [`Limits`] allow.
    #[error("{path}: {reason}")]
    Limits {
        /// As asked for.
        path: String,
        /// Which limit.
        reason: String,
    },
    /// A path that leads out of the scene's folder.
    #[error("{path}: leads out of the scene's folder (for safety only files below it are read)")]
    Outside {
        /// As asked for.
        path: String,
    },
}

impl AssetError {
    /// As asked for.
    pub fn path(&self) -> &str {
        match self {
            Self::Missing { path }
            | Self::Io { path, .. }
            | Self::Format { path, .. }
            | Self::Unsupported { path, .. }
            | Self::Limits { path, .. }
            | Self::Outside { path } => path,
        }
    }
}

/// Pixels of an image, rows from top to bottom, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageData {
    /// 8 bits per channel.
    U8(Vec<u8>),
    /// 16 bits per channel.
    U16(Vec<u16>),
    /// Floats.
    F32(Vec<f32>),
}

/// A decoded image. Values are as stored: whoever uses it knows whether they are sRGB-encoded or linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA).
    pub channels: u32,
    /// `width * height * channels` values.
    pub data: ImageData,
}

/// Where a scene's files come from. Paths are as the scene file spells them.
pub trait Assets: Sync {
    /// The contents of the file at `path`, decompressed if it is gzip.
    ///
    /// # Errors
    /// Why they could not be had.
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError>;
    /// The triangles of the PLY file at `path`.
    ///
    /// # Errors
    /// Why they could not be had.
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError>;
    /// The image at `path`.
    ///
    /// # Errors
    /// Why it could not be had.
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError>;
    /// The names of the grids of voxels in the file at `path`.
    ///
    /// # Errors
    /// Why they could not be had.
    fn grids(&self, path: &str) -> Result<Vec<String>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    /// The grid called `name` in the file at `path`.
    ///
    /// # Errors
    /// Why it could not be had.
    fn voxels(&self, path: &str, name: &str) -> Result<Voxels, AssetError> {
        let _ = name;
        Err(AssetError::Missing { path: path.to_owned() })
    }
    /// The arrays of numbers in the file at `path`.
    ///
    /// # Errors
    /// Why they could not be had.
    fn tensors(&self, path: &str) -> Result<Arc<Tensors>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    /// The pictures of faces in the file at `path`.
    ///
    /// # Errors
    /// Why they could not be had.
    fn ptex(&self, path: &str) -> Result<Arc<Ptex>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    /// What to do about `error`: where was looked, and what is there that is called nearly the same.
    fn advice(&self, _error: &AssetError) -> Option<String> {
        None
    }
}
