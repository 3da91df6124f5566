//! Grids of voxels, arrays of numbers, and pictures of faces in files that parameters name.
use std::sync::Arc;

use super::Args;
use crate::{Ptex, Tensors, Voxels};

impl Args<'_> {
    /// The names of the grids of voxels in the file that a [`crate::ParamType::File`] names; `None` as with images.
    pub fn grids(&mut self, name: &str) -> Option<Vec<String>> {
        let (assets, _) = self.assets?;
        self.found(name, assets.grids(self.text(name)), "nothing is shown")
    }

    /// One of them; `None` as with images.
    pub fn voxels(&mut self, name: &str, grid: &str) -> Option<Voxels> {
        let (assets, _) = self.assets?;
        self.found(name, assets.voxels(self.text(name), grid), "nothing is shown")
    }

    /// The arrays of numbers in the file that a [`crate::ParamType::File`] names; `None` as with images.
    pub fn tensors(&mut self, name: &str) -> Option<Arc<Tensors>> {
        let (assets, _) = self.assets?;
        self.found(name, assets.tensors(self.text(name)), "a placeholder is shown")
    }

    /// The pictures of faces in the file that a [`crate::ParamType::File`] names; `None` as with images.
    pub fn ptex(&mut self, name: &str) -> Option<Arc<Ptex>> {
        let (assets, _) = self.assets?;
        self.found(name, assets.ptex(self.text(name)), "a placeholder is shown")
    }
}
