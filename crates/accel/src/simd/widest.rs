//! Loops compiled twice: for any processor, and for those with AVX2.
//!
//! The compiler never fuses a product and a sum by itself, so both give the same bits.

/// A loop to be compiled so. `run` is `#[inline(always)]`, and so is what it calls in earnest.
pub(crate) trait Work {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run(self) -> Self::Output;
}

/// Does some work with the instructions that the processor has.
#[inline]
pub(crate) fn widest<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if super::Avx2::detect().is_some() {
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn wide<W: Work>(work: W) -> W::Output {
            work.run()
        }
        // SAFETY: `Avx2` proves the features.
        return unsafe { wide(work) };
    }
    work.run()
}
