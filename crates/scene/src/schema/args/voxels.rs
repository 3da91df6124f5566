//! Grids of voxels in files that parameters name.
use super::Args;
use crate::Voxels;

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
}
