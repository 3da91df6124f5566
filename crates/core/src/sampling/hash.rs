//! Integer hashing: the only source of randomness.

/// A permutation of 64-bit integers that decorrelates neighbours (the finaliser "moremur", Evensen 2019).
#[inline]
pub(super) const fn mix(mut x: u64) -> u64 {
    x ^= x >> 27;
    x = x.wrapping_mul(0x3C79_AC49_2BA7_B653);
    x ^= x >> 33;
    x = x.wrapping_mul(0x1C69_B3F7_4AC4_AE35);
    x ^ (x >> 27)
}

/// Hash of a pair; not symmetric.
#[inline]
pub(super) const fn combine(a: u64, b: u64) -> u64 {
    combine_salted(a, salt(b))
}

/// The second of a pair, made ready for [`combine_salted`].
#[inline]
pub(super) const fn salt(b: u64) -> u64 {
    mix(b.wrapping_add(0xD1B5_4A32_D192_ED03))
}

/// [`combine`] where the second of the pair is known long before.
#[inline]
pub(super) const fn combine_salted(a: u64, salt: u64) -> u64 {
    mix(a.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ salt)
}

/// The upper 24 bits as a float in `[0, 1)`.
#[inline]
pub(super) fn unit_float(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / (1u32 << 24) as f32)
}
