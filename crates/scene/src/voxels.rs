//! Numbers on a grid in space, most of which are the same: clouds of other programs.
use std::collections::HashMap;

use durer_core::glam::{DAffine3, DVec3};

/// Voxels in blocks of eight by eight by eight; where there is no block they are 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Voxels {
    /// How many voxels there are along each axis.
    pub size: [usize; 3],
    /// How many blocks there are along each axis.
    blocks: [usize; 3],
    /// Where the values of each block begin, in blocks, x changing fastest.
    table: Vec<u32>,
    /// Values block by block, x changing fastest.
    values: Vec<f32>,
    /// Where the unit cube is that all voxels fill together.
    pub world_from_cube: DAffine3,
}

/// Voxels of a block along an axis.
pub const BLOCK: usize = 8;
const VOLUME: usize = BLOCK * BLOCK * BLOCK;
/// No block.
const NONE: u32 = u32::MAX;

/// Values on their way into [`Voxels`].
#[derive(Clone, Debug, Default)]
pub struct VoxelBlocks {
    places: HashMap<[i32; 3], u32>,
    values: Vec<f32>,
}

impl VoxelBlocks {
    /// Most bytes that a grid may take, and most blocks of the box around it.
    const MOST_BYTES: usize = 4 << 30;
    const MOST_PLACES: usize = 1 << 27;

    /// Adds the block of this number along each axis; `None` if all take too much memory.
    pub fn add(&mut self, block: [i32; 3], values: &[f32; VOLUME]) -> Option<()> {
        if (self.values.len() + VOLUME) * size_of::<f32>() > Self::MOST_BYTES {
            return None;
        }
        let number = (self.values.len() / VOLUME) as u32;
        self.places.insert(block, number);
        self.values.extend_from_slice(values);
        Some(())
    }
    /// Adds blocks, `count` along each axis from `first` on, with the same value everywhere.
    pub fn fill(&mut self, first: [i32; 3], count: i32, value: f32) -> Option<()> {
        self.add(first, &[value; VOLUME])?;
        let number = *self.places.get(&first)?;
        for z in 0..count {
            for y in 0..count {
                for x in 0..count {
                    if self.places.len() > Self::MOST_PLACES {
                        return None;
                    }
                    self.places.insert([first.first()? + x, first.get(1)? + y, first.get(2)? + z], number);
                }
            }
        }
        Some(())
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
    /// All of them, with an empty voxel around, as straight lines between values reach so far; `world_from_index` says
    /// where the voxel of an index is. `None` if the box around them is too large.
    pub fn finish(self, world_from_index: &DAffine3) -> Option<Voxels> {
        let axis = |i: usize| move |block: &[i32; 3]| block.get(i).copied().map_or(0, i64::from);
        let mut low = [0i64; 3];
        let mut blocks = [0usize; 3];
        for (i, (low, count)) in low.iter_mut().zip(&mut blocks).enumerate() {
            *low = self.places.keys().map(axis(i)).min()? - 1;
            let high = self.places.keys().map(axis(i)).max()? + 1;
            *count = usize::try_from(high - *low + 1).ok()?;
        }
        let [nx, ny, nz] = blocks;
        let all = nx.checked_mul(ny)?.checked_mul(nz).filter(|all| *all <= Self::MOST_PLACES)?;
        let mut table = vec![NONE; all];
        for (block, number) in &self.places {
            let [x, y, z] = [0, 1, 2].map(|i| (axis(i)(block) - low.get(i).copied().unwrap_or(0)) as usize);
            *table.get_mut((z * ny + y) * nx + x)? = *number;
        }
        let size = blocks.map(|n| n * BLOCK);
        // Values stand at whole indices: the first one fills half a step before and behind.
        let corner = DVec3::from(low.map(|v| v as f64)) * BLOCK as f64 - 0.5;
        let extent = DVec3::from(size.map(|n| n as f64));
        let world_from_cube =
            *world_from_index * DAffine3::from_translation(corner) * DAffine3::from_scale(extent);
        Some(Voxels { size, blocks, table, values: self.values, world_from_cube })
    }
}

impl Voxels {
    fn block(&self, [x, y, z]: [usize; 3]) -> Option<&[f32]> {
        let [nx, ny, nz] = self.blocks;
        if x >= nx || y >= ny || z >= nz {
            return None;
        }
        let start = *self.table.get((z * ny + y) * nx + x)?;
        let start = start as usize * VOLUME;
        self.values.get(start..start + VOLUME)
    }
    /// The value at an index along each axis; 0 outside.
    #[inline]
    pub fn value(&self, index: [i64; 3]) -> f32 {
        let [x, y, z] = index;
        if x < 0 || y < 0 || z < 0 {
            return 0.0;
        }
        let [x, y, z] = [x as usize, y as usize, z as usize];
        let values = self.block([x / BLOCK, y / BLOCK, z / BLOCK]);
        let place = ((z % BLOCK) * BLOCK + y % BLOCK) * BLOCK + x % BLOCK;
        values.and_then(|values| values.get(place)).copied().unwrap_or(0.0)
    }
    /// A bound on the values from one to another index along each axis, both included: that of all blocks there.
    pub fn most_in(&self, span: [[i64; 2]; 3]) -> f32 {
        let [xs, ys, zs] =
            span.map(|[from, to]| (from.max(0) as usize / BLOCK)..=(to.max(0) as usize / BLOCK));
        let mut most = 0.0f32;
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    let values = self.block([x, y, z]).unwrap_or_default();
                    most = values.iter().copied().fold(most, f32::max);
                }
            }
        }
        most
    }
    /// The largest value.
    pub fn most(&self) -> f32 {
        self.values.iter().copied().fold(0.0, f32::max)
    }
}
