//! The tree of a grid: a root, nodes of 32³ and of 16³ children, leaves of 8³ voxels. All nodes come first, then the values
//! of all leaves in the same order.
use durer_scene::VoxelBlocks;

use super::{
    bytes::{Bytes, Mask, Why},
    packed::Packing,
};

/// Children of the two kinds of inner nodes along an axis, as powers of two, and voxels of a leaf.
const INNER: [usize; 2] = [5, 4];
const LEAF: usize = 512;
/// Edge of a leaf, in voxels.
const EDGE: i32 = 8;
/// Bytes of values that a byte of the file may become: a leaf, which has two masks at least, becomes less. What is full of
/// large cubes of different values becomes more; such files are made to fill memory.
const MOST_PER_BYTE: usize = 16;
/// Bytes that any file may become.
const FREE: usize = 64 << 20;

/// The voxels of a tree.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) blocks: VoxelBlocks,
}

/// A tree that is being read.
struct Reader<'b, 'd> {
    bytes: &'b mut Bytes<'d>,
    packing: Packing,
    background: f32,
    is_level_set: bool,
    tree: Tree,
    /// Leaves whose values come later.
    leaves: Vec<[i32; 3]>,
}

fn too_large() -> Why {
    Why::TooLarge("its voxels take more than 4 GiB, or more than a file of this length holds".to_owned())
}

/// The parts of `n` in steps of `2^log` along x, y and z; z changes fastest.
fn local(n: usize, log: usize) -> [i32; 3] {
    let mask = (1 << log) - 1;
    [n >> (2 * log), (n >> log) & mask, n & mask].map(|i| i as i32)
}

impl Tree {
    pub(super) fn read(bytes: &mut Bytes<'_>, packing: Packing, is_level_set: bool) -> Result<Self, Why> {
        let room = bytes.length().saturating_mul(MOST_PER_BYTE).saturating_add(FREE);
        bytes.u32()?;
        let background = bytes.f32()?;
        let (tiles, children) = (bytes.u32()?, bytes.u32()?);
        let (tree, leaves) = (Self { blocks: VoxelBlocks::new(room) }, Vec::new());
        let mut reader = Reader { bytes, packing, background, is_level_set, tree, leaves };
        for _ in 0..tiles {
            let origin = reader.bytes.index()?;
            let (value, is_active) = (reader.bytes.f32()?, reader.bytes.u8()? != 0);
            let density = reader.density(value, is_active);
            reader.tile(origin, EDGE << (INNER[0] + INNER[1]), density)?;
        }
        for _ in 0..children {
            let origin = reader.bytes.index()?;
            reader.node(origin, 0)?;
        }
        reader.values()?;
        Ok(reader.tree)
    }
}

impl Reader<'_, '_> {
    /// What of a value counts: densities above 0; of a level set the inside, with a ramp across the surface.
    fn density(&self, value: f32, is_active: bool) -> f32 {
        let density = match self.is_level_set {
            true if self.background > 0.0 => (-value / self.background).clamp(0.0, 1.0),
            true => 0.0,
            false if is_active => value,
            false => 0.0,
        };
        if density.is_finite() && density > 0.0 { density } else { 0.0 }
    }

    /// A cube of one density.
    fn tile(&mut self, origin: [i32; 3], edge: i32, density: f32) -> Result<(), Why> {
        if density == 0.0 {
            return Ok(());
        }
        let first = origin.map(|c| c.div_euclid(EDGE));
        self.tree.blocks.fill(first, edge / EDGE, density).ok_or_else(too_large)
    }

    fn node(&mut self, origin: [i32; 3], level: usize) -> Result<(), Why> {
        let Some(&log) = INNER.get(level) else {
            Mask::read(self.bytes, LEAF)?;
            self.leaves.push(origin);
            return Ok(());
        };
        let count = 1 << (3 * log);
        let (children, active) = (Mask::read(self.bytes, count)?, Mask::read(self.bytes, count)?);
        let values = self.packing.values(self.bytes, (count, active), self.background)?;
        let below: usize = INNER.iter().skip(level + 1).sum();
        let edge = EDGE << below;
        let place = |n: usize| {
            let [x, y, z] = local(n, log).map(|i| i * edge);
            let [ox, oy, oz] = origin;
            [ox.wrapping_add(x), oy.wrapping_add(y), oz.wrapping_add(z)]
        };
        for (n, value) in values.into_iter().enumerate() {
            if children.is_on(n) {
                continue;
            }
            let density = self.density(value, active.is_on(n));
            self.tile(place(n), edge, density)?;
        }
        for n in (0..count).filter(|&n| children.is_on(n)) {
            self.node(place(n), level + 1)?;
        }
        Ok(())
    }

    /// The values of all leaves.
    fn values(&mut self) -> Result<(), Why> {
        for origin in std::mem::take(&mut self.leaves) {
            let active = Mask::read(self.bytes, LEAF)?;
            let values = self.packing.values(self.bytes, (LEAF, active), self.background)?;
            let mut block = [0.0; LEAF];
            let mut is_any = false;
            for (n, value) in values.into_iter().enumerate() {
                let density = self.density(value, active.is_on(n));
                is_any |= density > 0.0;
                // In the file z changes fastest, in a block x does.
                let [x, y, z] = local(n, 3).map(|i| i as usize);
                if let Some(place) = block.get_mut((z * 8 + y) * 8 + x) {
                    *place = density;
                }
            }
            if is_any {
                self.tree.blocks.add(origin.map(|c| c.div_euclid(EDGE)), &block).ok_or_else(too_large)?;
            }
        }
        Ok(())
    }
}
