//! Eight lanes on any processor.
use wide::f32x8;

use super::{LaneMask, Lanes};

/// The token of vectors that need no special processor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

impl LaneMask for f32x8 {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.to_bitmask()
    }
}

impl Lanes for f32x8 {
    type Token = Portable;
    type Array = [f32; 8];
    type Mask = Self;
    const ZEROS: [f32; 8] = [0.0; 8];

    #[inline(always)]
    fn splat(_: Portable, x: f32) -> Self {
        Self::splat(x)
    }
    #[inline(always)]
    fn load(_: Portable, from: &[f32; 8]) -> Self {
        Self::new(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        *to = self.to_array();
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self + o
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self - o
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self * o
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self / o
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        self.fast_min(o)
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        self.fast_max(o)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn max_bits(self, o: Self) -> Self {
        Lanes::max(self, o)
    }
    #[inline(always)]
    fn min_bits(self, o: Self) -> Self {
        Lanes::min(self, o)
    }
    #[inline(always)]
    fn le_bits(self, o: Self) -> Self {
        Lanes::le(self, o)
    }
    #[inline(always)]
    fn le(self, o: Self) -> Self {
        self.simd_le(o)
    }
    #[inline(always)]
    fn lt(self, o: Self) -> Self {
        self.simd_lt(o)
    }
}
