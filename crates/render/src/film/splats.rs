//! What samples add to pixels that are not theirs: sums of a plane of their own.
//!
//! A splat is light that arrives at a place of the picture. A pixel gets it by the reconstruction filter `h` about its
//! middle, of integral 1: with `n` samples that each may splat, spread over all of a picture of `w h` pixels, the pixel's
//! share is `w h / n sum v h`. Sums are whole numbers of `2^-56`: they do not depend on who adds them, or when.
use durer_model::filter::Filter;

use super::Tile;

/// Steps of the sums in a unit of light.
const UNIT: f64 = (1u64 << 56) as f64;

/// A value at a place of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// In pixels from the upper left corner.
    pub film: [f32; 2],
    /// Linear Rec. 709.
    pub rgb: [f32; 3],
}

/// Sums of all pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Splats {
    width: u32,
    sums: Vec<[i128; 3]>,
}

impl Splats {
    pub(super) fn new(width: u32, height: u32) -> Self {
        Self { width, sums: vec![[0; 3]; width as usize * height as usize] }
    }

    /// Adds a splat to the pixels of `window` that the filter gives a part of it.
    pub(super) fn add(&mut self, splat: &Splat, filter: &Filter, window: Tile) {
        reached(splat.film, filter, window, |x, y, share| {
            let pixel = &mut self.sums[y as usize * self.width as usize + x as usize];
            pixel.iter_mut().zip(splat.rgb).for_each(|(sum, v)| put(sum, v, share));
        });
    }

    /// The sum of a pixel, for a picture that was sampled as often as it has pixels; `samples` were taken.
    pub(super) fn of(&self, index: usize, samples: u64) -> [f32; 3] {
        let scale = scale(self.sums.len(), samples);
        self.sums[index].map(|sum| (sum as f64 * scale) as f32)
    }
}

/// The same of light by its wavelength: a sum for each bucket of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BucketSplats {
    width: u32,
    buckets: usize,
    sums: Vec<i128>,
}

impl BucketSplats {
    pub(super) fn new(width: u32, pixels: usize, buckets: usize) -> Self {
        Self { width, buckets, sums: vec![0; pixels * buckets] }
    }

    /// Adds what a splat at a place of the picture brings to buckets.
    pub(super) fn add(
        &mut self,
        (film, lanes): ([f32; 2], &[(usize, f32); 4]),
        filter: &Filter,
        window: Tile,
    ) {
        reached(film, filter, window, |x, y, share| {
            let pixel = (y as usize * self.width as usize + x as usize) * self.buckets;
            lanes.iter().for_each(|&(bucket, v)| put(&mut self.sums[pixel + bucket], v, share));
        });
    }

    /// As [`Splats::of`].
    pub(super) fn of(&self, index: usize, bucket: usize, samples: u64) -> f32 {
        let scale = scale(self.sums.len() / self.buckets, samples);
        (self.sums[index * self.buckets + bucket] as f64 * scale) as f32
    }
}

/// What a step of a sum is in a picture of so many pixels, of which so many samples were taken.
fn scale(pixels: usize, samples: u64) -> f64 {
    pixels as f64 / samples.max(1) as f64 / UNIT
}

fn put(sum: &mut i128, v: f32, share: f64) {
    *sum = sum.saturating_add((f64::from(v) * share * UNIT) as i128);
}

/// Calls `with` for every pixel of `window` that the filter gives a part of what is at a place of the picture: x, y, the part.
fn reached(film: [f32; 2], filter: &Filter, window: Tile, mut with: impl FnMut(u32, u32, f64)) {
    let radius = filter.radius();
    // Pixels whose middle is near enough.
    let near = |i: usize, first: u32, end: u32| {
        let from = (film[i] - radius[i] - 0.5).ceil().max(first as f32);
        let to = (film[i] + radius[i] - 0.5).floor().min(end as f32 - 1.0);
        // Places that are no numbers are nowhere.
        if from <= to { from as u32..to as u32 + 1 } else { 0..0 }
    };
    for y in near(1, window.y0, window.y1) {
        for x in near(0, window.x0, window.x1) {
            let offset = [film[0] - x as f32 - 0.5, film[1] - y as f32 - 0.5];
            with(x, y, f64::from(filter.at(offset)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Tile = Tile { x0: 0, y0: 0, x1: 9, y1: 7 };

    fn all(splats: &Splats) -> Vec<[f32; 3]> {
        (0..splats.sums.len()).map(|i| splats.of(i, 63)).collect()
    }

    #[test]
    fn an_even_picture_stays_even() {
        for filter in [Filter::pixel(), Filter::usual()] {
            let mut splats = Splats::new(9, 7);
            let n = 64;
            // One splat of 1 for each cell of a grid, beyond the edges too.
            let cells = |pixels: i32| (-3 * n..(pixels + 3) * n).map(move |i| (i as f32 + 0.5) / n as f32);
            let value = 1.0 / (n * n) as f32;
            for y in cells(7) {
                for x in cells(9) {
                    splats.add(&Splat { film: [x, y], rgb: [value; 3] }, &filter, WINDOW);
                }
            }
            for pixel in all(&splats) {
                assert!((pixel[1] - 1.0).abs() < 2e-3, "{pixel:?}");
            }
        }
    }

    #[test]
    fn the_order_does_not_matter_and_nothing_leaves_the_window() {
        let crop = Tile { x0: 2, y0: 1, x1: 6, y1: 5 };
        let splat = |i: u32| {
            let h = i.wrapping_mul(0x9E37_79B9);
            let u = |shift: u32| (h.rotate_left(shift) >> 8) as f32 / (1 << 24) as f32;
            let value = if i.is_multiple_of(50) { 1e7 } else { 1e-6 } * u(7);
            Splat { film: [9.0 * u(0), 7.0 * u(13)], rgb: [value, 2.0 * value, -value] }
        };
        let filter = Filter::usual();
        let (mut forward, mut backward) = (Splats::new(9, 7), Splats::new(9, 7));
        (0..1000).for_each(|i| forward.add(&splat(i), &filter, crop));
        (0..1000).rev().for_each(|i| backward.add(&splat(i), &filter, crop));
        assert_eq!(forward, backward);
        for (i, sum) in forward.sums.iter().enumerate() {
            let (x, y) = (i as u32 % 9, i as u32 / 9);
            let inside = (2..6).contains(&x) && (1..5).contains(&y);
            assert_eq!(inside, *sum != [0; 3], "{x} {y}");
        }
        forward.add(&Splat { film: [f32::NAN, 1.0], rgb: [1.0; 3] }, &filter, WINDOW);
        assert_eq!(forward, backward);
    }
}
