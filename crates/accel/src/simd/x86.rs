//! Registers of x86-64: eight lanes with AVX2, sixteen with AVX-512.
//!
//! The operations are `#[inline(always)]` and end up in the functions of `simd::entry` that have the features switched
//! on. A value of these types can only be made with a token, and a token only after asking the processor.
use std::arch::x86_64::{
    __m256, __m512, __mmask16, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_and_ps, _mm256_andnot_ps,
    _mm256_castps_si256, _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpgt_epi32, _mm256_div_ps,
    _mm256_fmadd_ps, _mm256_loadu_ps, _mm256_max_epi32, _mm256_max_ps, _mm256_min_epi32, _mm256_min_ps,
    _mm256_movemask_ps, _mm256_mul_ps, _mm256_or_ps, _mm256_set1_epi32, _mm256_set1_ps, _mm256_storeu_ps,
    _mm256_sub_ps, _mm256_xor_ps, _mm512_abs_ps, _mm512_add_ps, _mm512_castps_si512, _mm512_castsi512_ps,
    _mm512_cmp_ps_mask, _mm512_cmple_epi32_mask, _mm512_div_ps, _mm512_fmadd_ps, _mm512_loadu_ps,
    _mm512_max_epi32, _mm512_max_ps, _mm512_min_epi32, _mm512_min_ps, _mm512_mul_ps, _mm512_set1_ps,
    _mm512_storeu_ps, _mm512_sub_ps,
};

use crate::lanes::{LaneMask, Lanes};

/// Proof of AVX2 and FMA.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    pub(crate) fn detect() -> Option<Self> {
        let has = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        has.then_some(Self(()))
    }
}

/// Proof of AVX-512 (F, VL, DQ) besides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(Avx2);

impl Avx512 {
    pub(crate) fn detect() -> Option<Self> {
        let has = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq");
        Avx2::detect().filter(|_| has).map(Self)
    }
}

/// Tokens that eight lanes can be made with.
pub(crate) trait HasAvx2: Copy {}
impl HasAvx2 for Avx2 {}
impl HasAvx2 for Avx512 {}

/// Eight lanes, made with the token `T`.
pub(crate) struct Ymm<T>(__m256, T);

impl<T: Copy> Clone for Ymm<T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Copy> Copy for Ymm<T> {}

impl<T: HasAvx2> LaneMask for Ymm<T> {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        // SAFETY: a value of this type proves AVX.
        Self(unsafe { _mm256_and_ps(self.0, other.0) }, self.1)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        // SAFETY: a value of this type proves AVX.
        Self(unsafe { _mm256_or_ps(self.0, other.0) }, self.1)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: a value of this type proves AVX.
        unsafe { _mm256_movemask_ps(self.0) as u32 }
    }
}

macro_rules! binary_bits {
    ($($name:ident = $intrinsic:ident $into:ident $from:ident),* $(,)?) => {$(
        #[inline(always)]
        fn $name(self, o: Self) -> Self {
            // SAFETY: a value of this type proves the registers it lies in; casts change no bits.
            Self(unsafe { $from($intrinsic($into(self.0), $into(o.0))) }, self.1)
        }
    )*};
}

macro_rules! binary {
    ($($name:ident = $intrinsic:ident),* $(,)?) => {$(
        #[inline(always)]
        fn $name(self, o: Self) -> Self {
            // SAFETY: a value of this type proves the registers it lies in.
            Self(unsafe { $intrinsic(self.0, o.0) }, self.1)
        }
    )*};
}

impl<T: HasAvx2> Lanes for Ymm<T> {
    type Token = T;
    type Array = [f32; 8];
    type Mask = Self;
    const ZEROS: [f32; 8] = [0.0; 8];

    binary!(
        add = _mm256_add_ps,
        sub = _mm256_sub_ps,
        mul = _mm256_mul_ps,
        div = _mm256_div_ps,
        min = _mm256_min_ps,
        max = _mm256_max_ps,
    );
    binary_bits!(
        max_bits = _mm256_max_epi32 _mm256_castps_si256 _mm256_castsi256_ps,
        min_bits = _mm256_min_epi32 _mm256_castps_si256 _mm256_castsi256_ps,
    );

    #[inline(always)]
    fn le_bits(self, o: Self) -> Self {
        // SAFETY: a value of this type proves AVX2; casts change no bits.
        let gt = unsafe {
            _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_castps_si256(self.0), _mm256_castps_si256(o.0)))
        };
        // SAFETY: as above; the complement of a mask.
        Self(unsafe { _mm256_xor_ps(gt, _mm256_castsi256_ps(_mm256_set1_epi32(-1))) }, self.1)
    }

    #[inline(always)]
    fn splat(token: T, x: f32) -> Self {
        // SAFETY: the token proves AVX.
        Self(unsafe { _mm256_set1_ps(x) }, token)
    }
    #[inline(always)]
    fn load(token: T, from: &[f32; 8]) -> Self {
        // SAFETY: the token proves AVX; the array holds the 32 bytes read, at any alignment.
        Self(unsafe { _mm256_loadu_ps(from.as_ptr()) }, token)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        // SAFETY: a value of this type proves AVX; the array holds the 32 bytes written, at any alignment.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: a value of this type proves AVX.
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) }, self.1)
    }
    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        // SAFETY: both tokens prove FMA.
        Self(unsafe { _mm256_fmadd_ps(self.0, b.0, c.0) }, self.1)
    }
    #[inline(always)]
    fn le(self, o: Self) -> Self {
        // SAFETY: a value of this type proves AVX.
        Self(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, o.0) }, self.1)
    }
    #[inline(always)]
    fn lt(self, o: Self) -> Self {
        // SAFETY: a value of this type proves AVX.
        Self(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, o.0) }, self.1)
    }
}

/// Sixteen lanes.
#[derive(Clone, Copy)]
pub(crate) struct Zmm(__m512, Avx512);

impl LaneMask for __mmask16 {
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

impl Lanes for Zmm {
    type Token = Avx512;
    type Array = [f32; 16];
    type Mask = __mmask16;
    const ZEROS: [f32; 16] = [0.0; 16];

    binary!(
        add = _mm512_add_ps,
        sub = _mm512_sub_ps,
        mul = _mm512_mul_ps,
        div = _mm512_div_ps,
        min = _mm512_min_ps,
        max = _mm512_max_ps,
    );
    binary_bits!(
        max_bits = _mm512_max_epi32 _mm512_castps_si512 _mm512_castsi512_ps,
        min_bits = _mm512_min_epi32 _mm512_castps_si512 _mm512_castsi512_ps,
    );

    #[inline(always)]
    fn le_bits(self, o: Self) -> __mmask16 {
        // SAFETY: a value of this type proves AVX-512; casts change no bits.
        unsafe { _mm512_cmple_epi32_mask(_mm512_castps_si512(self.0), _mm512_castps_si512(o.0)) }
    }

    #[inline(always)]
    fn splat(token: Avx512, x: f32) -> Self {
        // SAFETY: the token proves AVX-512.
        Self(unsafe { _mm512_set1_ps(x) }, token)
    }
    #[inline(always)]
    fn load(token: Avx512, from: &[f32; 16]) -> Self {
        // SAFETY: the token proves AVX-512; the array holds the 64 bytes read, at any alignment.
        Self(unsafe { _mm512_loadu_ps(from.as_ptr()) }, token)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        // SAFETY: a value of this type proves AVX-512; the array holds the 64 bytes written, at any alignment.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        Self(unsafe { _mm512_abs_ps(self.0) }, self.1)
    }
    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        // SAFETY: a value of this type proves AVX-512.
        Self(unsafe { _mm512_fmadd_ps(self.0, b.0, c.0) }, self.1)
    }
    #[inline(always)]
    fn le(self, o: Self) -> __mmask16 {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, o.0) }
    }
    #[inline(always)]
    fn lt(self, o: Self) -> __mmask16 {
        // SAFETY: a value of this type proves AVX-512.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, o.0) }
    }
}
