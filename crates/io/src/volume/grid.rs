//! A grid of an OpenVDB file: what it is, where it is, and its tree.
use std::collections::HashMap;

use durer_core::glam::{DAffine3, DMat3, DVec3};
use durer_scene::Voxels;

use super::{
    bytes::{Bytes, Why},
    packed::Packing,
    tree::Tree,
};

/// Bits that say how values are packed.
const ZLIB: u32 = 1;
const ACTIVE_ONLY: u32 = 2;
const BLOSC: u32 = 4;

/// Name, type and place of a grid.
#[derive(Clone, Debug)]
pub(super) struct Descriptor {
    pub(super) name: String,
    kind: String,
    parent: String,
    grid: u64,
    /// The byte behind it.
    pub(super) end: u64,
}

/// Names, types and values.
pub(super) fn metadata(bytes: &mut Bytes<'_>) -> Result<HashMap<String, Vec<u8>>, Why> {
    let count = bytes.u32()?;
    let mut all = HashMap::new();
    for _ in 0..count {
        let name = bytes.text()?;
        bytes.text()?;
        let length = bytes.u32()? as usize;
        all.insert(name, bytes.take(length)?.to_vec());
    }
    Ok(all)
}

impl Descriptor {
    pub(super) fn read(bytes: &mut Bytes<'_>) -> Result<Self, Why> {
        let name = bytes.text()?;
        // Of several with the same name each has a number behind a separator.
        let name = name.split('\u{1e}').next().unwrap_or_default().to_owned();
        let (kind, parent) = (bytes.text()?, bytes.text()?);
        let [grid, _, end] = [bytes.i64()?, bytes.i64()?, bytes.i64()?].map(|at| at.max(0) as u64);
        Ok(Self { name, kind, parent, grid, end })
    }

    /// The voxels of the grid.
    pub(super) fn voxels(&self, data: &[u8]) -> Result<Voxels, Why> {
        let name = &self.name;
        let half = match self.kind.as_str() {
            "Tree_float_5_4_3" => false,
            "Tree_float_5_4_3_HalfFloat" => true,
            kind => {
                return Err(Why::Refused(format!(
                    "grid \"{name}\" is of type {kind}; Tree_float_5_4_3 is read, with or without half floats"
                )));
            }
        };
        if !self.parent.is_empty() {
            return Err(Why::Refused(format!("grid \"{name}\" is an instance of \"{}\"", self.parent)));
        }
        let mut bytes = Bytes::new(data);
        bytes.jump(self.grid)?;
        let flags = bytes.u32()?;
        let packing = Packing {
            zlib: flags & ZLIB != 0,
            blosc: flags & BLOSC != 0,
            active_only: flags & ACTIVE_ONLY != 0,
            half,
        };
        let known = metadata(&mut bytes)?;
        let is_level_set = known.get("class").is_some_and(|class| class == b"level set");
        let world_from_index = placement(&mut bytes)?;
        let tree = Tree::read(&mut bytes, packing, is_level_set)?;
        if tree.blocks.is_empty() {
            return Err(Why::Damaged(format!("grid \"{name}\" has no voxels above 0")));
        }
        let too_large = || Why::TooLarge(format!("grid \"{name}\" is too large or too far spread"));
        tree.blocks.finish(&world_from_index).ok_or_else(too_large)
    }
}

/// Where the voxel of an index is.
fn placement(bytes: &mut Bytes<'_>) -> Result<DAffine3, Why> {
    let kind = bytes.text()?;
    // Behind the scale stand four values that follow from it.
    let scale = |bytes: &mut Bytes<'_>| -> Result<DVec3, Why> {
        let scale = bytes.triple()?;
        for _ in 0..4 {
            bytes.triple()?;
        }
        Ok(DVec3::from(scale))
    };
    let placed = match kind.as_str() {
        "UniformScaleMap" | "ScaleMap" => DAffine3::from_scale(scale(bytes)?),
        "TranslationMap" => DAffine3::from_translation(DVec3::from(bytes.triple()?)),
        "UniformScaleTranslateMap" | "ScaleTranslateMap" => {
            let translation = DVec3::from(bytes.triple()?);
            DAffine3::from_translation(translation) * DAffine3::from_scale(scale(bytes)?)
        }
        "AffineMap" | "UnitaryMap" => {
            // Rows are where the axes go: points stand before the matrix.
            let mut rows = [DVec3::ZERO; 4];
            for row in &mut rows {
                *row = DVec3::from(bytes.triple()?);
                bytes.f64()?;
            }
            let [x, y, z, origin] = rows;
            DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), origin)
        }
        other => {
            return Err(Why::Refused(format!(
                "a grid is placed by a {other}; scales, translations and matrices are read"
            )));
        }
    };
    let is_sound = placed.is_finite() && placed.matrix3.determinant() != 0.0;
    is_sound
        .then_some(placed)
        .ok_or_else(|| Why::Damaged("the place of a grid is flat or infinite".to_owned()))
}
