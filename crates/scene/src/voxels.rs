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
    /// The largest value of each block of `values`.
    largest: Vec<f32>,
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
    pieces: Vec<Piece>,
    values: Vec<f32>,
    /// Which block has this value everywhere, by its bits.
    even: HashMap<u32, u32>,
    /// Blocks that are filled, those that are filled twice counted twice.
    filled: usize,
    /// Most bytes that the values may take.
    room: usize,
}

/// A cube of blocks with the same values: where it begins, how many there are along an edge, and whose values.
#[derive(Clone, Copy, Debug)]
struct Piece {
    first: [i32; 3],
    count: i32,
    number: u32,
}

impl VoxelBlocks {
    /// Most bytes that a grid may take, and most blocks of the box around it.
    const MOST_BYTES: usize = 4 << 30;
    const MOST_PLACES: usize = 1 << 27;

    /// Nothing yet, and room for as many bytes of values.
    pub fn new(room: usize) -> Self {
        Self { room: room.min(Self::MOST_BYTES), ..Self::default() }
    }
    /// Adds the block of this number along each axis; `None` if all take too much memory.
    pub fn add(&mut self, block: [i32; 3], values: &[f32; VOLUME]) -> Option<()> {
        let number = self.stored(values)?;
        self.piece(Piece { first: block, count: 1, number })
    }
    /// Adds blocks, `count` along each axis from `first` on, with the same value everywhere.
    pub fn fill(&mut self, first: [i32; 3], count: i32, value: f32) -> Option<()> {
        let number = match self.even.get(&value.to_bits()) {
            Some(known) => *known,
            None => {
                let number = self.stored(&[value; VOLUME])?;
                self.even.insert(value.to_bits(), number);
                number
            }
        };
        self.piece(Piece { first, count, number })
    }
    fn stored(&mut self, values: &[f32; VOLUME]) -> Option<u32> {
        if (self.values.len() + VOLUME) * size_of::<f32>() > self.room {
            return None;
        }
        let number = (self.values.len() / VOLUME) as u32;
        self.values.extend_from_slice(values);
        Some(number)
    }
    fn piece(&mut self, piece: Piece) -> Option<()> {
        self.filled += usize::try_from(piece.count).ok()?.pow(3);
        self.pieces.push(piece);
        // What fills more than the largest box lies upon itself, or in a larger one.
        (self.filled <= Self::MOST_PLACES).then_some(())
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }
    /// All of them, with an empty voxel around, as straight lines between values reach so far; `world_from_index` says
    /// where the voxel of an index is. `None` if the box around them is too large.
    pub fn finish(self, world_from_index: &DAffine3) -> Option<Voxels> {
        let mut low = [0i64; 3];
        let mut blocks = [0usize; 3];
        for (i, (low, count)) in low.iter_mut().zip(&mut blocks).enumerate() {
            let begins =
                || self.pieces.iter().map(|p| (p.first.get(i).map_or(0, |&v| v.into()), i64::from(p.count)));
            *low = begins().map(|(first, _)| first).min()? - 1;
            let high = begins().map(|(first, count)| first + count).max()?;
            *count = usize::try_from(high - *low + 1).ok()?;
        }
        let [nx, ny, nz] = blocks;
        let all = nx.checked_mul(ny)?.checked_mul(nz).filter(|all| *all <= Self::MOST_PLACES)?;
        let mut table = vec![NONE; all];
        for piece in &self.pieces {
            let corner = piece.first.map(i64::from);
            let [x, y, z] =
                [0, 1, 2].map(|i| (corner.get(i).zip(low.get(i)).map_or(0, |(c, low)| c - low)) as usize);
            let count = usize::try_from(piece.count).ok()?;
            for row in (z..z + count).flat_map(|z| (y..y + count).map(move |y| (z * ny + y) * nx + x)) {
                table.get_mut(row..row + count)?.fill(piece.number);
            }
        }
        let size = blocks.map(|n| n * BLOCK);
        // Values stand at whole indices: the first one fills half a step before and behind.
        let corner = DVec3::from(low.map(|v| v as f64)) * BLOCK as f64 - 0.5;
        let extent = DVec3::from(size.map(|n| n as f64));
        let world_from_cube =
            *world_from_index * DAffine3::from_translation(corner) * DAffine3::from_scale(extent);
        let most = |values: &[f32; VOLUME]| values.iter().copied().fold(0.0, f32::max);
        let largest = self.values.as_chunks().0.iter().map(most).collect();
        Some(Voxels { size, blocks, table, values: self.values, largest, world_from_cube })
    }
}

impl Voxels {
    /// Which block of values stands there.
    fn number(&self, [x, y, z]: [usize; 3]) -> Option<usize> {
        let [nx, ny, nz] = self.blocks;
        if x >= nx || y >= ny || z >= nz {
            return None;
        }
        self.table.get((z * ny + y) * nx + x).map(|number| *number as usize)
    }
    fn block(&self, place: [usize; 3]) -> Option<&[f32]> {
        let start = self.number(place)? * VOLUME;
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
                    let largest = self.number([x, y, z]).and_then(|number| self.largest.get(number));
                    most = largest.map_or(most, |v| most.max(*v));
                }
            }
        }
        most
    }
    /// The largest value.
    pub fn most(&self) -> f32 {
        self.largest.iter().copied().fold(0.0, f32::max)
    }
}
