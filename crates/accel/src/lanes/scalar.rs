//! One lane: what tests and single triangles use.
use super::{LaneMask, Lanes};

impl LaneMask for bool {
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
        u32::from(self)
    }
}

impl Lanes for f32 {
    type Token = ();
    type Array = [Self; 1];
    type Mask = bool;
    const ZEROS: [Self; 1] = [0.0];

    #[inline(always)]
    fn splat((): (), x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn load((): (), from: &[Self; 1]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [Self; 1]) {
        to[0] = self;
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
        if self < o { self } else { o }
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        if self > o { self } else { o }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
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
    fn le_bits(self, o: Self) -> bool {
        Lanes::le(self, o)
    }
    #[inline(always)]
    fn le(self, o: Self) -> bool {
        self <= o
    }
    #[inline(always)]
    fn lt(self, o: Self) -> bool {
        self < o
    }
}
