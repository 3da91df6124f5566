//! The stateless sampler: every number can be asked for again, in any order, on any thread.
use super::{
    Dim,
    hash::{combine, unit_float},
    sobol,
};
use crate::math::Point2;

/// How sample indices become numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol pairs, padded: stratified in every pair of numbers, random between pairs.
    #[default]
    Sobol,
    /// Unrelated random numbers.
    Independent,
}

/// The numbers of one sample of one pixel, at one node of its ray tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    kind: SamplerKind,
    /// Hash of (seed, pixel, way through the ray tree).
    key: u64,
    /// Index of the sample within its pixel.
    index: u32,
    /// Samples the pixel will get in all.
    count: u32,
}

impl Sampler {
    /// The sampler of sample `index` out of `count` in `pixel`.
    ///
    /// With a `count` of one, [`Dim::Pixel`] gives the pixel's centre: a picture without antialiasing has straight edges.
    pub fn new(kind: SamplerKind, seed: u64, pixel: [u32; 2], index: u32, count: u32) -> Self {
        let pixel = (u64::from(pixel[1]) << 32) | u64::from(pixel[0]);
        Self { kind, key: combine(seed, pixel), index, count }
    }

    /// The sampler of a child ray: different numbers for every `branch` (mirror and transmitted ray, i-th of n rays).
    #[must_use]
    #[inline]
    pub fn fork(self, branch: u32) -> Self {
        // PERF: one multiplication, as most forks are never asked for a number; d2 mixes the key (bench render).
        let key = (self.key ^ (u64::from(branch) + 1)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
        Self { key, ..self }
    }

    /// The `i`-th of `n` samplers that share the work of this one: where several rays take the place of one, their
    /// numbers together are those of `n` times as many samples, and as well spread over the whole pixel.
    #[must_use]
    pub fn split(self, i: u32, n: u32) -> Self {
        debug_assert!(i < n, "part {i} of {n}");
        Self {
            index: self.index.wrapping_mul(n).wrapping_add(i),
            count: self.count.saturating_mul(n),
            ..self
        }
    }

    /// A number in `[0, 1)`.
    pub fn d1(&self, dim: Dim) -> f32 {
        self.d2(dim).x
    }

    /// A point in `[0, 1)²`.
    pub fn d2(&self, dim: Dim) -> Point2 {
        if dim == Dim::Pixel && self.count == 1 {
            return Point2::new(0.5, 0.5);
        }
        let h = combine(self.key, dim as u64);
        match self.kind {
            SamplerKind::Independent => {
                let bits = combine(h, u64::from(self.index));
                Point2::new(unit_float(bits as u32), unit_float((bits >> 32) as u32))
            }
            SamplerKind::Sobol => {
                // Shuffling the index by a nested permutation decorrelates dimensions and keeps the net (Burley 2020).
                let shuffled = sobol::owen_scramble(self.index, h as u32);
                let scramble = combine(h, 1);
                Point2::new(
                    unit_float(sobol::owen_scramble(sobol::dimension0(shuffled), scramble as u32)),
                    unit_float(sobol::owen_scramble(sobol::dimension1(shuffled), (scramble >> 32) as u32)),
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(kind: SamplerKind, seed: u64, dim: Dim, n: u32) -> Vec<Point2> {
        (0..n).map(|i| Sampler::new(kind, seed, [3, 7], i, n).d2(dim)).collect()
    }

    #[test]
    fn every_elementary_interval_of_a_sobol_pair_holds_one_point() {
        for m in 1..=8u32 {
            let n = 1 << m;
            for seed in 0..8 {
                let points = points(SamplerKind::Sobol, seed, Dim::Lens, n);
                for split in 0..=m {
                    let (nx, ny) = (1 << split, 1 << (m - split));
                    let mut seen = vec![0; n as usize];
                    for p in &points {
                        let cell = (p.x * nx as f32) as u32 + nx * (p.y * ny as f32) as u32;
                        seen[cell as usize] += 1;
                    }
                    assert!(seen.iter().all(|&c| c == 1), "m {m} split {split} seed {seed}");
                }
            }
        }
    }

    #[test]
    fn dimensions_pixels_branches_and_seeds_are_uncorrelated() {
        let n = 4096;
        let base = |i: u32| Sampler::new(SamplerKind::Sobol, 1, [i % 64, i / 64], 0, 16);
        let others: [&dyn Fn(u32) -> f32; 4] = [
            &|i| base(i).d1(Dim::Time),
            &|i| base(i).fork(1).d1(Dim::Light),
            &|i| Sampler::new(SamplerKind::Sobol, 2, [i % 64, i / 64], 0, 16).d1(Dim::Light),
            &|i| base(i + 1).d1(Dim::Light),
        ];
        for other in others {
            let sum: f32 =
                (0..n).map(|i| (base(i).d1(Dim::Light) - 0.5) * (other(i) - 0.5)).sum::<f32>() / n as f32;
            assert!((sum * 12.0).abs() < 0.05, "correlation {}", sum * 12.0);
        }
    }

    #[test]
    fn both_kinds_are_uniform() {
        for kind in [SamplerKind::Sobol, SamplerKind::Independent] {
            let p = points(kind, 9, Dim::Scatter, 1024);
            let mean = p.iter().fold(Point2::default(), |a, &b| a + b) * (1.0 / 1024.0);
            assert!((mean.x - 0.5).abs() < 0.03 && (mean.y - 0.5).abs() < 0.03, "{kind:?} {mean:?}");
            assert!(p.iter().all(|p| p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0));
        }
    }

    #[test]
    fn the_parts_of_all_samples_are_one_net() {
        let base = |i: u32| Sampler::new(SamplerKind::Sobol, 3, [5, 9], i, 16).fork(2);
        for dim in [Dim::Light, Dim::Scatter] {
            let mut cells = [[0; 8]; 8];
            for p in (0..16).flat_map(|i| (0..4).map(move |j| base(i).split(j, 4).d2(dim))) {
                cells[(p.y * 8.0) as usize][(p.x * 8.0) as usize] += 1;
            }
            assert_eq!(cells, [[1; 8]; 8], "{dim:?}");
        }
    }

    #[test]
    fn one_sample_goes_through_the_centre_of_the_pixel() {
        let s = Sampler::new(SamplerKind::Sobol, 5, [1, 2], 0, 1);
        assert_eq!(s.d2(Dim::Pixel), Point2::new(0.5, 0.5));
        assert_ne!(s.d2(Dim::Lens), Point2::new(0.5, 0.5));
    }
}
