//! Vectors of floats, as the kernel's formulas see them.
//!
//! Box and triangle tests are written once, over [`Lanes`]; one lane (`f32`), the portable vectors of `wide` and the
//! registers in `simd/` run the same formula. Every operation rounds once, as IEEE 754 says, so all of them give the same
//! bits; only [`Lanes::fused`] may round once or twice, and nothing that reaches a hit uses it.
mod portable;
mod scalar;

pub(crate) use portable::Portable;

/// Results of comparisons, lane by lane.
pub(crate) trait LaneMask: Copy {
    fn and(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self;
    /// Bit `i` is set where lane `i` is true.
    fn bits(self) -> u32;
}

/// Several floats at once.
pub(crate) trait Lanes: Copy {
    /// Proof that the processor has these registers: only with it can lanes be made.
    type Token: Copy;
    /// The lanes in memory.
    type Array: Copy + AsRef<[f32]> + AsMut<[f32]>;
    type Mask: LaneMask;
    /// Zeros in memory.
    const ZEROS: Self::Array;

    fn splat(token: Self::Token, x: f32) -> Self;
    fn load(token: Self::Token, from: &Self::Array) -> Self;
    fn store(self, to: &mut Self::Array);
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn div(self, o: Self) -> Self;
    /// The lesser; either if one is NaN.
    fn min(self, o: Self) -> Self;
    /// The greater; either if one is NaN.
    fn max(self, o: Self) -> Self;
    fn abs(self) -> Self;
    /// `self * b + c`, rounded once or twice.
    fn fused(self, b: Self, c: Self) -> Self;
    /// The greater of two of which at least one is not negative. PERF: as whole numbers where that is quicker, three
    /// cycles of each of four steps that wait for each other (bench kernel).
    fn max_bits(self, o: Self) -> Self;
    /// The lesser of two that are not negative; some negative number if one is.
    fn min_bits(self, o: Self) -> Self;
    /// `self <= o`, for a `self` that is not negative.
    fn le_bits(self, o: Self) -> Self::Mask;
    /// `self <= o`; false for NaN.
    fn le(self, o: Self) -> Self::Mask;
    /// `self < o`; false for NaN.
    fn lt(self, o: Self) -> Self::Mask;
}
