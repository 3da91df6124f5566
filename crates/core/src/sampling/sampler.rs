//! The stateless sampler: every number can be asked for again, in any order, on any thread.
use super::{
    Dim,
    hash::{combine, unit_float},
    sobol,
    strata::{self, Place},
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
    /// One random number in each cell of a grid, cells in random order (Cook 1984): stratified in every pair of numbers
    /// and in every single number, random between them.
    Stratified,
    /// The middles of those cells.
    Regular,
}

impl SamplerKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Sobol, Self::Independent, Self::Stratified, Self::Regular];
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
    #[inline]
    pub fn new(kind: SamplerKind, seed: u64, pixel: [u32; 2], index: u32, count: u32) -> Self {
        let pixel = (u64::from(pixel[1]) << 32) | u64::from(pixel[0]);
        Self { kind, key: combine(seed, pixel), index, count }
    }

    /// The sampler whose every number is the middle of `[0, 1)`.
    #[inline]
    pub fn middle() -> Self {
        Self { kind: SamplerKind::Regular, key: 0, index: 0, count: 1 }
    }

    /// Everything it is, in hexadecimal digits: kind, key, index and count.
    pub fn to_hex(&self) -> String {
        format!("{:x}{:016x}{:08x}{:08x}", self.kind as u8, self.key, self.index, self.count)
    }
    /// The sampler of which [`Sampler::to_hex`] gave `hex`; `None` if none gave it.
    pub fn from_hex(hex: &str) -> Option<Self> {
        let number = |digits: std::ops::Range<usize>| u64::from_str_radix(hex.get(digits)?, 16).ok();
        let kind = SamplerKind::ALL.into_iter().find(|&kind| Some(kind as u64) == number(0..1))?;
        let (key, index, count) = (number(1..17)?, number(17..25)? as u32, number(25..33)? as u32);
        let sampler = Self { kind, key, index, count };
        (sampler.to_hex() == hex).then_some(sampler)
    }

    /// Samples the pixel will get in all, as far as is known.
    #[inline]
    pub fn count(&self) -> u32 {
        self.count
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
    #[inline]
    pub fn split(self, i: u32, n: u32) -> Self {
        debug_assert!(i < n, "part {i} of {n}");
        Self {
            index: self.index.wrapping_mul(n).wrapping_add(i),
            count: self.count.saturating_mul(n),
            ..self
        }
    }

    /// The sampler that `n` samples with consecutive indices have in common: its numbers are spread over an `n`-th of
    /// them.
    #[must_use]
    #[inline]
    pub fn shared_by(self, n: u32) -> Self {
        let n = n.max(1);
        Self { index: self.index / n, count: self.count.div_ceil(n), ..self }
    }

    /// A number in `[0, 1)`.
    #[inline]
    pub fn d1(&self, dim: Dim) -> f32 {
        let place = match self.kind {
            // PERF: only half of the point (bench render).
            SamplerKind::Sobol => {
                let h = combine(self.key, dim as u64);
                let shuffled = sobol::owen_scramble(self.index, h as u32);
                let scramble = combine(h, 1) as u32;
                return unit_float(sobol::owen_scramble(sobol::dimension0(shuffled), scramble));
            }
            SamplerKind::Independent => return self.d2(dim).x,
            SamplerKind::Stratified => Place::Random,
            SamplerKind::Regular => Place::Centre,
        };
        strata::interval(combine(self.key, dim as u64), self.index, self.count, place)
    }

    /// A point in `[0, 1)²`.
    #[inline]
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
            SamplerKind::Stratified => strata::square(h, self.index, self.count, Place::Random),
            SamplerKind::Regular => strata::square(h, self.index, self.count, Place::Centre),
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
mod tests;
