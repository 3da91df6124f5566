//! What eye rays meet first: means over the samples of a pixel that meet something, and how much the light of these differs.
//!
//! As pbrt-v4's film `gbuffer` has it: lengths of mean normals are 1; `Albedo` counts what misses everything as black, as
//! colours do; `Variance` is that of single samples, `sum (c - mean)² / (n - 1)`, and `RelativeVariance` is that by the mean.
use super::Pixel;
use crate::integrator::Met;

/// The channels.
pub(super) const NAMES: [&str; 22] = [
    "P.X",
    "P.Y",
    "P.Z",
    "N.X",
    "N.Y",
    "N.Z",
    "Ns.X",
    "Ns.Y",
    "Ns.Z",
    "u",
    "v",
    "dzdx",
    "dzdy",
    "Albedo.R",
    "Albedo.G",
    "Albedo.B",
    "Variance.R",
    "Variance.G",
    "Variance.B",
    "RelativeVariance.R",
    "RelativeVariance.G",
    "RelativeVariance.B",
];
/// What is summed with weights comes first, in the order of the channels.
const MET: usize = 16;
/// Then the weights.
const WEIGHT: usize = MET;
/// The number of samples.
const COUNT: usize = WEIGHT + 1;
/// The mean of each colour.
const MEAN: usize = COUNT + 1;
/// The sum of its squared differences from the mean.
const SQUARES: usize = MEAN + 3;
/// All of them.
pub(super) const SUMS: usize = SQUARES + 3;

/// Adds a sample of a colour to the sums of a pixel.
pub fn add(sums: &mut [f64], met: &Met, rgb: [f32; 3], weight: f32) {
    let numbers = met.p.into_iter().chain(
        [&met.n[..], &met.ns, &met.uv, &met.dz, &met.albedo].into_iter().flatten().map(|v| f64::from(*v)),
    );
    sums.iter_mut().zip(numbers).for_each(|(sum, v)| *sum += f64::from(weight) * v);
    sums[WEIGHT] += f64::from(weight);
    sums[COUNT] += 1.0;
    // Welford 1962.
    for (i, v) in rgb.into_iter().enumerate() {
        let before = f64::from(v) - sums[MEAN + i];
        sums[MEAN + i] += before / sums[COUNT];
        sums[SQUARES + i] += before * (f64::from(v) - sums[MEAN + i]);
    }
}

/// The channels of a pixel; all 0 where nothing was met.
pub(super) fn developed(sums: &[f64], pixel: &Pixel) -> [f32; 22] {
    let mut out = [0.0; 22];
    let by = |sum: f64, by: f64| if by == 0.0 { 0.0 } else { sum / by };
    let length = |at: usize| sums[at..at + 3].iter().map(|v| v * v).sum::<f64>().sqrt();
    for (i, channel) in out.iter_mut().enumerate() {
        let value = match i {
            0..3 | 9..11 => by(sums[i], sums[WEIGHT]),
            3..9 => by(sums[i], length(i / 3 * 3)),
            11..13 => by(sums[i], sums[WEIGHT]).abs(),
            13..16 => by(sums[i], pixel.weight.into()),
            16..19 => variance(sums, i - 16),
            _ => by(variance(sums, i - 19), sums[MEAN + i - 19]),
        };
        *channel = value as f32;
    }
    out
}

fn variance(sums: &[f64], color: usize) -> f64 {
    if sums[COUNT] < 2.0 { 0.0 } else { sums[SQUARES + color] / (sums[COUNT] - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variances_are_those_of_the_textbook() {
        let values: Vec<f32> = (0..50).map(|i| 1000.0 + (i * 37 % 11) as f32).collect();
        let met = Met { p: [1.0, 2.0, 3.0], n: [0.0, 0.0, -2.0], ns: [0.6, 0.8, 0.0], ..NOTHING };
        let mut sums = [0.0; SUMS];
        values.iter().for_each(|v| add(&mut sums, &met, [*v, 2.0 * v, 7.0], 0.5));
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / 50.0;
        let variance = values.iter().map(|v| (f64::from(*v) - mean).powi(2)).sum::<f64>() / 49.0;
        let out = developed(&sums, &Pixel { sum: [0.0; 3], weight: 50.0 });
        assert!((f64::from(out[16]) / variance - 1.0).abs() < 1e-6, "{} {variance}", out[16]);
        assert!((f64::from(out[17]) / (4.0 * variance) - 1.0).abs() < 1e-6 && out[18] == 0.0);
        assert!((f64::from(out[19]) * mean / variance - 1.0).abs() < 1e-6);
        assert_eq!(out[0..9], [1.0, 2.0, 3.0, 0.0, 0.0, -1.0, 0.6, 0.8, 0.0]);
    }

    #[test]
    fn albedo_is_black_where_nothing_is_met() {
        let mut sums = [0.0; SUMS];
        add(&mut sums, &Met { albedo: [0.5, 0.25, 1.0], uv: [0.5, 0.5], ..NOTHING }, [1.0; 3], 1.0);
        let out = developed(&sums, &Pixel { sum: [0.0; 3], weight: 4.0 });
        assert_eq!((&out[9..11], &out[13..17]), (&[0.5, 0.5][..], &[0.125, 0.0625, 0.25, 0.0][..]));
        assert_eq!(developed(&[0.0; SUMS], &Pixel::default()), [0.0; 22]);
    }

    const NOTHING: Met =
        Met { p: [0.0; 3], n: [0.0; 3], ns: [0.0; 3], uv: [0.0; 2], dz: [0.0; 2], albedo: [0.0; 3] };
}
