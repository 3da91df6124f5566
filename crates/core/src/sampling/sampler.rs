//! The stateless sampler: every number can be asked for again, in any order, on any thread.
use super::{
    Dim, SamplerKind, curve, halton,
    hash::{combine, combine_salted, unit_float},
    sobol,
    strata::{self, Place},
};
use crate::math::Point2;

/// The numbers of one sample of one pixel, at one node of its ray tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    kind: SamplerKind,
    /// Ways taken from the eye to here, if the kind asks.
    forks: u8,
    /// Place of the pixel on the curve through the picture, if the kind has one.
    place: u32,
    /// Hash of (seed, pixel, way through the ray tree), without the pixel where points are dealt out over the picture.
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
        let [x, y] = pixel;
        let of = |x: u32, y: u32| (u64::from(y) << 32) | u64::from(x);
        if kind.spans_pixels() {
            // Pictures of more than 65,536 pixels a side repeat the curve, with other numbers.
            let key = combine(seed, of(x >> 16, y >> 16) ^ 0x5EED_0F1A);
            Self { kind, forks: 0, place: curve::place(x, y, key as u32), key, index, count }
        } else {
            Self { kind, forks: 0, place: 0, key: combine(seed, of(x, y)), index, count }
        }
    }

    /// The sampler of another sample of the same pixel.
    #[must_use]
    #[inline]
    pub fn numbered(self, index: u32) -> Self {
        Self { index, ..self }
    }

    /// The sampler whose every number is the middle of `[0, 1)`.
    #[inline]
    pub fn middle() -> Self {
        Self { kind: SamplerKind::Regular, forks: 0, place: 0, key: 0, index: 0, count: 1 }
    }

    /// Everything it is, in hexadecimal digits: kind, key, index and count, then place and forks if one of them is not 0.
    pub fn to_hex(&self) -> String {
        let mut hex = format!("{:x}{:016x}{:08x}{:08x}", self.kind as u8, self.key, self.index, self.count);
        if self.place != 0 || self.forks != 0 {
            hex += &format!("{:08x}{:02x}", self.place, self.forks);
        }
        hex
    }
    /// The sampler of which [`Sampler::to_hex`] gave `hex`; `None` if none gave it.
    pub fn from_hex(hex: &str) -> Option<Self> {
        let number = |digits: std::ops::Range<usize>| u64::from_str_radix(hex.get(digits)?, 16).ok();
        let kind = SamplerKind::ALL.into_iter().find(|&kind| Some(kind as u64) == number(0..1))?;
        let (key, index, count) = (number(1..17)?, number(17..25)? as u32, number(25..33)? as u32);
        let (place, forks) =
            if hex.len() > 33 { (number(33..41)? as u32, number(41..43)? as u8) } else { (0, 0) };
        let possible = (place == 0 || kind.spans_pixels()) && (forks == 0 || kind.counts_forks());
        let sampler = Self { kind, forks, place, key, index, count };
        (possible && sampler.to_hex() == hex).then_some(sampler)
    }

    /// Samples the pixel will get in all, as far as is known.
    #[inline]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Index of the sample within its pixel, for the sampler of an eye ray.
    #[inline]
    pub fn index(&self) -> u32 {
        self.index
    }

    /// The sampler of a child ray: different numbers for every `branch` (mirror and transmitted ray, i-th of n rays).
    #[must_use]
    #[inline]
    pub fn fork(self, branch: u32) -> Self {
        // PERF: one multiplication, as most forks are never asked for a number; d2 mixes the key (bench render).
        let key = (self.key ^ (u64::from(branch) + 1)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
        Self { key, forks: self.forks.saturating_add(u8::from(self.kind.counts_forks())), ..self }
    }

    /// The sampler of another walk, whose numbers are multiplied with those of this one: of no set of points that the two
    /// would share.
    #[must_use]
    #[inline]
    pub fn apart(self, branch: u32) -> Self {
        let forked = self.fork(branch);
        Self { forks: forked.forks_unless(true), ..forked }
    }

    /// The `i`-th of `n` samplers that share the work of this one: where several rays take the place of one, their
    /// numbers together are those of `n` times as many samples, and as well spread over the whole pixel.
    #[must_use]
    #[inline]
    pub fn split(self, i: u32, n: u32) -> Self {
        debug_assert!(i < n, "part {i} of {n}");
        Self {
            forks: self.forks_unless(n > 1),
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
        // PERF: two divisions that most samples do without (bench render).
        if n <= 1 {
            return self;
        }
        let forks = self.forks_unless(true);
        // Other sets of points too, as the same ones belong to the samples in the group.
        let key = if forks == self.forks { self.key } else { combine(self.key, u64::from(n)) };
        Self { forks, key, index: self.index / n, count: self.count.div_ceil(n), ..self }
    }

    /// Points that are counted in another way are none of the set that eye and first hit share: to that the most ways lead.
    #[inline]
    fn forks_unless(self, counted_apart: bool) -> u8 {
        if counted_apart && self.kind.counts_forks() { u8::MAX } else { self.forks }
    }

    /// A number in `[0, 1)`.
    #[inline]
    pub fn d1(&self, dim: Dim) -> f32 {
        let place = match self.kind {
            // PERF: only half of the point (bench render).
            SamplerKind::PaddedSobol => return self.padded(dim).first(),
            SamplerKind::Sobol | SamplerKind::ZSobol => return self.joint(dim).first(),
            SamplerKind::Halton => return self.halton(dim, 1).x,
            SamplerKind::Independent => return self.d2(dim).x,
            SamplerKind::Stratified => Place::Random,
            SamplerKind::Regular => Place::Centre,
        };
        strata::interval(combine_salted(self.key, dim.salt()), self.index, self.count, place)
    }

    /// A point in `[0, 1)²`.
    #[inline]
    pub fn d2(&self, dim: Dim) -> Point2 {
        if dim == Dim::Pixel && self.count == 1 {
            return Point2::new(0.5, 0.5);
        }
        let h = || combine_salted(self.key, dim.salt());
        match self.kind {
            SamplerKind::Independent => {
                let bits = combine(h(), u64::from(self.index));
                Point2::new(unit_float(bits as u32), unit_float((bits >> 32) as u32))
            }
            SamplerKind::Stratified => strata::square(h(), self.index, self.count, Place::Random),
            SamplerKind::Regular => strata::square(h(), self.index, self.count, Place::Centre),
            SamplerKind::PaddedSobol => self.padded(dim).both(),
            SamplerKind::Sobol | SamplerKind::ZSobol => self.joint(dim).both(),
            SamplerKind::Halton => self.halton(dim, 2),
        }
    }

    /// A pair of its own. Shuffling the index by a nested permutation decorrelates pairs and keeps the net (Burley 2020).
    #[inline]
    fn padded(&self, dim: Dim) -> Scrambled {
        let h = combine_salted(self.key, dim.salt());
        let index = sobol::owen_scramble(self.index, h as u32);
        Scrambled { index, dimensions: [0, 1], scramble: combine(h, 1) }
    }

    /// Two dimensions of the set that eye and first hit share, or of a smaller one elsewhere.
    #[inline]
    fn joint(&self, dim: Dim) -> Scrambled {
        let (index, key) = self.point();
        let scramble = combine_salted(key, dim.salt());
        if let Some(dimensions) = dim.joint(self.forks) {
            return Scrambled { index, dimensions, scramble };
        }
        let (set, dimensions) = dim.in_set();
        let shuffle = combine_salted(key, Dim::salt_of_set(set)) as u32;
        Scrambled { index: sobol::owen_scramble(index, shuffle), dimensions, scramble }
    }

    /// Which point of a sequence this is, and the key of that sequence. One sequence is dealt out over `2^32` points; what
    /// lies beyond has others.
    #[inline]
    fn point(&self) -> (u32, u64) {
        if !self.kind.spans_pixels() {
            return (self.index, self.key);
        }
        let bits = 32 - self.count.saturating_sub(1).leading_zeros();
        let global = (u64::from(self.place) << bits) | u64::from(self.index);
        (global as u32, self.key ^ (global >> 32))
    }

    /// One or two coordinates of a Halton point; padded pairs where the primes run out.
    fn halton(&self, dim: Dim, numbers: usize) -> Point2 {
        let position = dim.position(self.forks).filter(|at| at + numbers <= halton::DIMENSIONS);
        let Some(position) = position else { return self.padded(dim).both() };
        let h = combine_salted(self.key, dim.salt());
        let coordinate = |i: usize, h: u64| halton::radical_inverse(self.index, self.count, position + i, h);
        let second = if numbers == 2 { coordinate(1, combine(h, 1)) } else { 0.0 };
        Point2::new(coordinate(0, h), second)
    }
}

/// A point of two Sobol dimensions, and how each is scrambled.
struct Scrambled {
    index: u32,
    dimensions: [usize; 2],
    scramble: u64,
}

impl Scrambled {
    #[inline]
    fn first(&self) -> f32 {
        unit_float(sobol::scrambled(self.index, self.dimensions[0], self.scramble as u32))
    }
    #[inline]
    fn both(&self) -> Point2 {
        let seed = (self.scramble >> 32) as u32;
        Point2::new(self.first(), unit_float(sobol::scrambled(self.index, self.dimensions[1], seed)))
    }
}

#[cfg(test)]
mod tests;
