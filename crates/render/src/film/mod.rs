//! Sums of samples whose bits do not depend on who adds them, or when.
//!
//! Samples of a pixel are grouped in blocks of [`BLOCK`]. Inside a block: sequential f32. Above: a fixed binary tree,
//! split at the largest power of two, kept as a binary counter of whole films. Every shard of a render is one node of
//! that tree, so that any order of merging along the tree is the same arithmetic. Splats have a plane of their own.

mod develop;
mod layers;
mod sensor;
mod splats;
mod tile;
mod tonemap;

pub use develop::{DataPicture, DepthRange, Developed, develop, develop_data, develop_survey};
pub use layers::{Buckets, Layer, Layers, add_met};
pub use sensor::{Developing, Sensor};
pub use splats::Splat;
pub use tile::Tile;
pub use tonemap::ToneMap;

use durer_model::filter::Filter;
use layers::Planes;
use splats::Splats;

/// Samples per block.
pub const BLOCK: u32 = 64;

/// Sum and weight of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Weighted sum of the samples: linear Rec. 709, or the numbers of a data picture.
    pub sum: [f32; 3],
    /// Sum of the weights.
    pub weight: f32,
}

impl Pixel {
    /// Adds a sample.
    pub fn add(&mut self, value: [f32; 3], weight: f32) {
        for (sum, v) in self.sum.iter_mut().zip(value) {
            *sum += weight * v;
        }
        self.weight += weight;
    }
    /// The sum of two pixels.
    #[must_use]
    pub fn merged(&self, o: &Self) -> Self {
        Self { sum: std::array::from_fn(|i| self.sum[i] + o.sum[i]), weight: self.weight + o.weight }
    }
    /// Weighted mean; zero where no sample counted.
    pub fn mean(&self) -> [f32; 3] {
        if self.weight == 0.0 { [0.0; 3] } else { self.sum.map(|s| s / self.weight) }
    }
}

/// A picture being summed.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Finished nodes of the tree, largest first: (blocks, pixels).
    finished: Vec<(u32, Vec<Pixel>)>,
    /// The block being filled.
    current: Vec<Pixel>,
    /// What samples added to pixels that are not theirs, if any did.
    splats: Option<Box<Splats>>,
    /// What it keeps beside colours, if it does.
    planes: Option<Box<Planes>>,
    /// Samples taken of all pixels.
    samples: u64,
}

impl Film {
    /// An empty film.
    pub fn new(width: u32, height: u32) -> Self {
        let current = vec![Pixel::default(); width as usize * height as usize];
        Self { width, height, finished: Vec::new(), current, splats: None, planes: None, samples: 0 }
    }

    /// The same, with layers beside colours.
    #[must_use]
    pub fn with(self, layers: Option<Layers>) -> Self {
        let planes = layers.map(|layers| Box::new(Planes::new(layers, self.width, self.height)));
        Self { planes, ..self }
    }

    /// The sums of the layers inside a tile, pixel by pixel; nothing where there are none.
    pub fn read_layers(&self, tile: Tile, out: &mut Vec<f64>) {
        out.clear();
        self.planes.iter().for_each(|planes| planes.read(tile, out));
    }
    /// Puts back what [`Film::read_layers`] gave, with samples added.
    pub fn write_layers(&mut self, tile: Tile, sums: &[f64]) {
        self.planes.iter_mut().for_each(|planes| planes.write(tile, sums));
    }
    /// Adds to layers what splats bring to them, see [`Buckets::lanes`].
    pub fn splat_layers(
        &mut self,
        splats: &[Splat],
        lanes: &[[(usize, f32); 4]],
        filter: &Filter,
        window: Tile,
    ) {
        if !lanes.is_empty() {
            self.planes.iter_mut().for_each(|planes| planes.splat(splats, lanes, filter, window));
        }
    }
    /// What the film holds beside colours.
    pub fn layers(&self) -> Vec<Layer> {
        let Some(planes) = &self.planes else { return Vec::new() };
        planes.developed(&self.pixels(), self.samples)
    }

    /// The sums of the block being filled, inside a tile, row by row.
    pub fn read(&self, tile: Tile, out: &mut Vec<Pixel>) {
        out.clear();
        for y in tile.y0..tile.y1 {
            out.extend_from_slice(&self.current[self.row(tile, y)]);
        }
    }
    /// Puts back what [`Film::read`] gave, with samples added.
    pub fn write(&mut self, tile: Tile, pixels: &[Pixel]) {
        let width = (tile.x1 - tile.x0) as usize;
        for (y, row) in (tile.y0..tile.y1).zip(pixels.chunks_exact(width)) {
            let range = self.row(tile, y);
            self.current[range].copy_from_slice(row);
        }
    }
    fn row(&self, tile: Tile, y: u32) -> std::ops::Range<usize> {
        let start = y as usize * self.width as usize;
        start + tile.x0 as usize..start + tile.x1 as usize
    }

    /// Closes the block being filled: every pixel has got its [`BLOCK`] samples.
    pub fn finish_block(&mut self) {
        let empty = vec![Pixel::default(); self.current.len()];
        let mut node = (1, std::mem::replace(&mut self.current, empty));
        while let Some((blocks, pixels)) = self.finished.pop() {
            if blocks != node.0 {
                self.finished.push((blocks, pixels));
                break;
            }
            node = (2 * blocks, merge(&pixels, &node.1));
        }
        self.finished.push(node);
    }

    /// Notes that so many samples were taken, and what they add to pixels of `window` by the filter.
    pub fn splat(&mut self, samples: u64, splats: &[Splat], filter: &Filter, window: Tile) {
        self.samples += samples;
        if splats.is_empty() {
            return;
        }
        let (width, height) = (self.width, self.height);
        let plane = self.splats.get_or_insert_with(|| Box::new(Splats::new(width, height)));
        splats.iter().for_each(|splat| plane.add(splat, filter, window));
    }

    /// Adds to the sum of a pixel what splats brought.
    fn with_splats(&self, index: usize, pixel: Pixel) -> Pixel {
        let Some(splats) = &self.splats else { return pixel };
        let brought = splats.of(index, self.samples);
        if pixel.weight == 0.0 && brought == [0.0; 3] {
            return pixel;
        }
        // Who has no samples of its own shows what others brought.
        let weight = if pixel.weight == 0.0 { 1.0 } else { pixel.weight };
        Pixel { sum: std::array::from_fn(|i| pixel.sum[i] + weight * brought[i]), weight }
    }

    /// The sum so far of one pixel; `None` if it lies outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Pixel> {
        let inside = x < self.width && y < self.height;
        let index = y as usize * self.width as usize + x as usize;
        let mut all = *self.current.get(index).filter(|_| inside)?;
        for (_, pixels) in self.finished.iter().rev() {
            all = pixels[index].merged(&all);
        }
        Some(self.with_splats(index, all))
    }

    /// The sums so far.
    pub fn pixels(&self) -> Vec<Pixel> {
        let mut all = self.current.clone();
        for (_, pixels) in self.finished.iter().rev() {
            all = merge(pixels, &all);
        }
        if self.splats.is_some() {
            all.iter_mut().enumerate().for_each(|(index, pixel)| *pixel = self.with_splats(index, *pixel));
        }
        all
    }
}

fn merge(left: &[Pixel], right: &[Pixel]) -> Vec<Pixel> {
    left.iter().zip(right).map(|(l, r)| l.merged(r)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(i: u32) -> f32 {
        let h = i.wrapping_mul(0x9E37_79B9) ^ 0x55;
        let firefly = if h.is_multiple_of(97) { 1e6 } else { 1.0 };
        (h >> 8) as f32 / (1 << 24) as f32 * firefly
    }

    fn filled(samples: u32) -> Film {
        let mut film = Film::new(1, 1);
        let tile = Tile { x0: 0, y0: 0, x1: 1, y1: 1 };
        let mut pixels = Vec::new();
        for i in 0..samples {
            film.read(tile, &mut pixels);
            pixels[0].add([sample(i); 3], 1.0);
            film.write(tile, &pixels);
            if (i + 1) % BLOCK == 0 {
                film.finish_block();
            }
        }
        film
    }

    /// The tree of film.md, recursively.
    fn node(first: u32, blocks: u32, samples: u32) -> f32 {
        if blocks == 1 {
            return (first..(first + BLOCK).min(samples)).fold(0.0, |s, i| s + sample(i));
        }
        let left = if blocks.is_power_of_two() { blocks / 2 } else { 1 << blocks.ilog2() };
        node(first, left, samples) + node(first + left * BLOCK, blocks - left, samples)
    }

    #[test]
    fn sums_follow_the_fixed_tree_bit_for_bit() {
        for samples in [1u32, 63, 64, 65, 128, 200, 448, 1024, 1000] {
            let expected = node(0, samples.div_ceil(BLOCK), samples);
            assert_eq!(filled(samples).pixels()[0].sum[0].to_bits(), expected.to_bits(), "{samples} samples");
        }
    }

    #[test]
    fn the_tree_is_more_accurate_than_a_running_sum() {
        let n = 1 << 16;
        let exact: f64 = (0..n).map(|i| f64::from(sample(i))).sum();
        let running = (0..n).fold(0.0f32, |s, i| s + sample(i));
        let tree = filled(n).pixels()[0].sum[0];
        assert!((f64::from(tree) - exact).abs() < (f64::from(running) - exact).abs());
    }

    #[test]
    fn pixels_without_samples_are_black() {
        assert_eq!(Pixel::default().mean(), [0.0; 3]);
    }
}
