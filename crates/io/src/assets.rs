//! The folder a scene may read from.
use std::path::PathBuf;

use durer_scene::Limits;

/// Files below one folder, and images embedded in the scene file itself.
#[derive(Debug)]
pub struct FileAssets {
    folder: PathBuf,
    limits: Limits,
}

impl FileAssets {
    /// Assets below `folder`.
    pub fn new(folder: PathBuf, limits: Limits) -> Self {
        Self { folder, limits }
    }
}
