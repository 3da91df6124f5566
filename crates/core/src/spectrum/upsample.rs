//! Smooth spectra of colours: the curves that `build/fit.rs` found while durer was built, looked up and blended.
//!
//! Between the table's layers of brightness `v` the weights are linear in `S⁻¹(v) = (v - 1/2) / sqrt(v (1 - v))`, so that
//! greys come out exactly. Colours come back within 0.002 (in the mean 0.0005) where a reflectance can have them; bright
//! pure colours, which nothing reflects, come out duller.
use super::{
    layers::{SIZE, layer},
    observer::RANGE,
};

/// The table of `build/fit.rs`, as 32-bit floats, low bytes first.
const TABLE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/upsample.bin"));

const LAYERS: [f32; SIZE] = {
    let (mut layers, mut i) = ([0.0; SIZE], 0);
    while i < SIZE {
        layers[i] = layer(i) as f32;
        i += 1;
    }
    layers
};

/// A reflectance over wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Smooth {
    /// `a x² + b x + c`, `x` from 0 to 1 over the visible range.
    curve: [f32; 3],
    scale: f32,
}

impl Smooth {
    /// The curve of a colour of which no component is above 1; negative ones count as 0.
    pub(super) fn of(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| v.max(0.0));
        let largest = (0..3).fold(0, |best, i| if rgb[i] > rgb[best] { i } else { best });
        let bright = rgb[largest];
        if bright.is_nan() || bright <= 0.0 {
            return Self { curve: [0.0; 3], scale: 0.0 };
        }
        let shares = [1, 2].map(|i| rgb[(largest + i) % 3] / bright);
        if shares == [1.0; 2] {
            return Self { curve: [0.0; 3], scale: 2.0 * bright };
        }
        let within = bright.clamp(LAYERS[0], LAYERS[SIZE - 1]);
        let z = LAYERS.partition_point(|v| *v <= within).clamp(1, SIZE - 1) - 1;
        let [low, high] = [inverse(LAYERS[z]), inverse(LAYERS[z + 1])];
        let u = (inverse(within) - low) / (high - low);
        let [(x, p), (y, q)] = shares.map(|share| {
            let at = share.min(1.0).sqrt() * (SIZE - 1) as f32;
            let below = (at as usize).min(SIZE - 2);
            (below, at - below as f32)
        });
        let mut curve = [0.0; 3];
        for (dz, wz) in [(0, 1.0 - u), (1, u)] {
            for (dy, wy) in [(0, 1.0 - q), (1, q)] {
                for (dx, wx) in [(0, 1.0 - p), (1, p)] {
                    let node = ((largest * SIZE + z + dz) * SIZE + y + dy) * SIZE + x + dx;
                    let weight = wz * wy * wx;
                    for (i, sum) in curve.iter_mut().enumerate() {
                        *sum += weight * number(3 * node + i);
                    }
                }
            }
        }
        // What is darker than all layers is a share of the darkest.
        Self { curve, scale: (bright / LAYERS[0]).min(1.0) }
    }

    /// Its value at a wavelength in nm.
    #[inline]
    pub(super) fn at(&self, nm: f32) -> f32 {
        let x = (nm - RANGE.0 as f32) / (RANGE.1 - RANGE.0) as f32;
        let t = (self.curve[0] * x + self.curve[1]) * x + self.curve[2];
        self.scale * (0.5 + 0.5 * t / (1.0 + t * t).sqrt())
    }
}

/// `S⁻¹`.
fn inverse(v: f32) -> f32 {
    (v - 0.5) / (v * (1.0 - v)).sqrt()
}

/// A number of the table.
#[inline]
fn number(i: usize) -> f32 {
    let bytes = &TABLE[4 * i..4 * i + 4];
    f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

#[cfg(test)]
mod tests {
    use super::{
        super::observer::{COUNT, DAYLIGHT, MATCHING},
        *,
    };

    /// The colour of a reflectance under D65.
    fn colour(smooth: &Smooth) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for i in 0..COUNT {
            let value = f64::from(smooth.at((RANGE.0 as usize + i) as f32)) * f64::from(DAYLIGHT[i]);
            sum.iter_mut().zip(MATCHING[i]).for_each(|(sum, c)| *sum += value * f64::from(c));
        }
        sum
    }

    fn miss(rgb: [f32; 3]) -> f64 {
        let got = colour(&Smooth::of(rgb));
        (0..3).map(|c| (got[c] - f64::from(rgb[c])).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn greys_are_the_same_at_all_wavelengths() {
        for v in [0.0, 1e-4, 0.18, 0.5, 0.73, 1.0] {
            let smooth = Smooth::of([v; 3]);
            assert!([360.0, 500.0, 830.0].iter().all(|nm| smooth.at(*nm) == v), "{v}");
        }
        // Next to grey is next to that.
        assert!((Smooth::of([0.73, 0.73, 0.7299]).at(550.0) - 0.73).abs() < 2e-4);
    }

    #[test]
    fn colours_come_back() {
        let (mut sum, mut count) = (0.0, 0.0);
        for i in 0..1000u32 {
            let rgb = [i % 10, i / 10 % 10, i / 100].map(|v| (v as f32 + 0.5) / 11.0);
            assert!(miss(rgb) < 2e-3, "{rgb:?}: {}", miss(rgb));
            (sum, count) = (sum + miss(rgb), count + 1.0);
        }
        assert!(sum / count < 6e-4, "{}", sum / count);
        for rgb in [[0.63, 0.065, 0.05], [0.14, 0.45, 0.091], [1.0, 0.378_676, 0.013_473], [2e-4, 1e-4, 0.0]]
        {
            assert!(miss(rgb) < 1e-3, "{rgb:?}: {}", miss(rgb));
        }
    }

    #[test]
    fn curves_are_shares_of_light_and_smooth() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.9, 0.05, 0.05]] {
            let smooth = Smooth::of(rgb);
            let values: Vec<f32> = (360..=830).map(|nm| smooth.at(nm as f32)).collect();
            assert!(values.iter().all(|v| (0.0..=1.0).contains(v)), "{rgb:?}");
            // A quadratic turns once.
            let turns = values.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
            assert!(turns <= 1, "{rgb:?}: {turns}");
        }
    }
}
