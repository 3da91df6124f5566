//! What a film keeps beside colours, if it is asked for: pbrt-v4's films `gbuffer` and `spectral`.
//!
//! Sums are in f64. All samples of a pixel are added by whoever has its tile, in the order of their numbers: a running sum
//! has the same bits whatever the number of threads.

mod buckets;
mod surfaces;

pub use buckets::Buckets;
pub use surfaces::add as add_met;

use durer_model::filter::Filter;
use durer_scene::Space;

use super::{Pixel, Splat, Tile, splats::BucketSplats};

/// Which layers a film has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layers {
    /// What eye rays meet first, in a space, and how much samples differ.
    Surfaces(Space),
    /// Light by its wavelength.
    Buckets(Buckets),
}

/// A channel of a picture: a number for each pixel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// As pbrt-v4 calls it in a file.
    pub name: String,
    /// The numbers.
    pub values: Vec<f32>,
}

impl Layers {
    /// Numbers that are summed for each pixel.
    pub fn sums(&self) -> usize {
        match self {
            Self::Surfaces(_) => surfaces::SUMS,
            Self::Buckets(buckets) => buckets.sums(),
        }
    }

    /// Bytes of memory for each pixel at most.
    pub fn bytes(&self) -> u64 {
        let splats = match self {
            Self::Surfaces(_) => 0,
            Self::Buckets(buckets) => u64::from(buckets.count) * size_of::<i128>() as u64,
        };
        (self.sums() * size_of::<f64>()) as u64 + splats
    }
}

/// The sums of all pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Planes {
    layers: Layers,
    width: u32,
    sums: Vec<f64>,
    splats: Option<BucketSplats>,
}

impl Planes {
    pub(super) fn new(layers: Layers, width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { layers, width, sums: vec![0.0; pixels * layers.sums()], splats: None }
    }

    fn rows(&self, tile: Tile) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (width, sums) = (self.width as usize, self.layers.sums());
        let at = move |x: u32, y: u32| (y as usize * width + x as usize) * sums;
        (tile.y0..tile.y1).map(move |y| at(tile.x0, y)..at(tile.x1, y))
    }

    /// The sums of a tile, pixel by pixel.
    pub(super) fn read(&self, tile: Tile, out: &mut Vec<f64>) {
        self.rows(tile).for_each(|row| out.extend_from_slice(&self.sums[row]));
    }

    /// Puts them back.
    pub(super) fn write(&mut self, tile: Tile, sums: &[f64]) {
        let mut rest = sums;
        for row in self.rows(tile) {
            let (now, later) = rest.split_at(row.len());
            self.sums[row].copy_from_slice(now);
            rest = later;
        }
    }

    /// Adds what came to pixels of `window` that are not those of its samples; see [`Buckets::lanes`].
    pub(super) fn splat(
        &mut self,
        splats: &[Splat],
        lanes: &[[(usize, f32); 4]],
        filter: &Filter,
        window: Tile,
    ) {
        let Layers::Buckets(buckets) = self.layers else { return };
        let pixels = self.sums.len() / self.layers.sums();
        let plane =
            self.splats.get_or_insert_with(|| BucketSplats::new(self.width, pixels, buckets.count as usize));
        splats.iter().zip(lanes).for_each(|(splat, lanes)| plane.add((splat.film, lanes), filter, window));
    }

    /// The channels, of a film whose colours are these; `samples` were taken of all pixels.
    pub(super) fn developed(&self, pixels: &[Pixel], samples: u64) -> Vec<Layer> {
        let each = self.sums.chunks_exact(self.layers.sums());
        let names = match self.layers {
            Layers::Surfaces(_) => surfaces::NAMES.iter().map(|name| (*name).to_owned()).collect(),
            Layers::Buckets(buckets) => buckets.names(),
        };
        let mut layers: Vec<Layer> = names
            .into_iter()
            .map(|name: String| Layer { name, values: Vec::with_capacity(pixels.len()) })
            .collect();
        for (index, (sums, pixel)) in each.zip(pixels).enumerate() {
            let mut put = |channel: usize, value: f32| layers[channel].values.push(value);
            match self.layers {
                Layers::Surfaces(_) => {
                    surfaces::developed(sums, pixel).into_iter().enumerate().for_each(|(i, v)| put(i, v));
                }
                Layers::Buckets(buckets) => (0..buckets.count as usize).for_each(|bucket| {
                    let brought = self.splats.as_ref().map_or(0.0, |s| s.of(index, bucket, samples));
                    put(bucket, Buckets::mean(sums, bucket) + brought);
                }),
            }
        }
        layers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_put_back_where_they_were_read() {
        let mut planes = Planes::new(Layers::Buckets(Buckets { count: 2, range: [400.0, 700.0] }), 5, 4);
        let tile = Tile { x0: 1, y0: 2, x1: 4, y1: 4 };
        let mut sums = Vec::new();
        planes.read(tile, &mut sums);
        assert_eq!(sums.len(), 6 * 4);
        sums.iter_mut().zip(1..).for_each(|(sum, i)| *sum = f64::from(i));
        planes.write(tile, &sums);
        let mut again = Vec::new();
        planes.read(tile, &mut again);
        assert_eq!(again, sums);
        // The second pixel of the tile's second row is the picture's (2, 3).
        assert_eq!(planes.sums[(3 * 5 + 2) * 4], 17.0);
        assert_eq!(planes.sums.iter().filter(|v| **v != 0.0).count(), 24);
    }
}
