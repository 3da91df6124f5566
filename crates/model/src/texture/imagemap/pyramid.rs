//! Smaller and smaller copies of an image (Williams 1983, "Pyramidal Parametrics"): each has half the columns and rows of
//! the one before, rounded down, until one texel is left.
//!
//! A texel is the mean, in linear light, of the area it covers in the finer copy: of two by two texels, or where a side is odd
//! of three with the shares that lie in it (Guthe and Heckbert 2005, "Non-Power-of-Two Mipmapping"). Means of all texels
//! are the same at every level.
use rayon::prelude::*;

use super::texels::Texels;

/// Copies of an image, the largest first; the image itself is not among them.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
    channels: usize,
}

/// One copy: linear values, rows from top to bottom, channels interleaved.
#[derive(Clone, Debug)]
struct Level {
    size: [u32; 2],
    values: Vec<f32>,
}

/// The texels of the finer row that a coarser texel covers, and how much of each.
fn covered(i: u32, coarse: u32, fine: u32) -> impl Iterator<Item = (u32, f32)> {
    // In units of 1 / coarse of a finer texel, so that all is whole.
    let (i, coarse, fine) = (u64::from(i), u64::from(coarse), u64::from(fine));
    let (start, end) = (i * fine, (i + 1) * fine);
    (start / coarse..end.div_ceil(coarse)).map(move |x| {
        let inside = end.min((x + 1) * coarse) - start.max(x * coarse);
        (x as u32, (inside as f64 / fine as f64) as f32)
    })
}

impl Pyramid {
    /// Of an image.
    pub(super) fn new(texels: &Texels) -> Self {
        let channels = texels.channels();
        // Grey with alpha is stored as two numbers.
        let stored = |x: u32, y: u32| {
            let [r, g, b, a] = texels.rgba(x, y);
            match channels {
                1 | 2 => [r, a, 0.0, 0.0],
                _ => [r, g, b, a],
            }
        };
        let mut levels: Vec<Level> = Vec::new();
        let mut size = [texels.width(), texels.height()];
        while size != [1, 1] {
            let (finer, last) = (size, levels.last());
            size = size.map(|n| (n / 2).max(1));
            let value = |x: u32, y: u32| match last {
                Some(level) => level.at(x, y, channels),
                None => stored(x, y),
            };
            let row = |y: u32| {
                (0..size[0]).flat_map(move |x| {
                    let mut sum = [0.0; 4];
                    for (fy, wy) in covered(y, size[1], finer[1]) {
                        for (fx, wx) in covered(x, size[0], finer[0]) {
                            let texel = value(fx, fy);
                            sum.iter_mut().zip(texel).for_each(|(s, v)| *s += wx * wy * v);
                        }
                    }
                    sum.into_iter().take(channels)
                })
            };
            let values = (0..size[1]).into_par_iter().flat_map_iter(row).collect();
            levels.push(Level { size, values });
        }
        Self { levels, channels }
    }

    /// How many.
    pub(super) fn count(&self) -> usize {
        self.levels.len()
    }
    /// Columns and rows of one.
    pub(super) fn size(&self, level: usize) -> [u32; 2] {
        self.levels[level].size
    }
    /// Linear RGBA, as [`Texels::rgba`].
    pub(super) fn rgba(&self, level: usize, x: u32, y: u32) -> [f32; 4] {
        let [r, g, b, a] = self.levels[level].at(x, y, self.channels);
        match self.channels {
            1 => [r, r, r, 1.0],
            2 => [r, r, r, g],
            3 => [r, g, b, 1.0],
            _ => [r, g, b, a],
        }
    }
    /// Heap memory in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| size_of_val(level.values.as_slice()) as u64).sum()
    }
}

impl Level {
    /// The values of a texel; 0 beyond its channels.
    fn at(&self, x: u32, y: u32, channels: usize) -> [f32; 4] {
        let first = (y as usize * self.size[0] as usize + x as usize) * channels;
        let mut all = [0.0; 4];
        all[..channels].copy_from_slice(&self.values[first..first + channels]);
        all
    }
}
