//! The first two Sobol dimensions with hashed Owen scrambling (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! Every base-2 elementary interval of area `2^-m` holds one of the first `2^m` points: a (0, 2)-sequence.

/// Dimension 0: the van der Corput sequence.
pub(super) const fn dimension0(index: u32) -> u32 {
    index.reverse_bits()
}

/// Dimension 1: generator matrix of the primitive polynomial x + 1, whose columns are rows of Pascal's triangle mod 2.
pub(super) const fn dimension1(mut index: u32) -> u32 {
    let mut result = 0;
    let mut column = 1u32 << 31;
    while index != 0 {
        if index & 1 != 0 {
            result ^= column;
        }
        column ^= column >> 1;
        index >>= 1;
    }
    result
}

/// Owen scrambling: a random permutation of the binary digits' subtrees, chosen by `seed`. The multiplications by even
/// numbers let each bit depend on the lower ones only, hence the reversals (Laine and Karras 2011).
pub(super) const fn owen_scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^= x.wrapping_mul(0x53A2_2864);
    x.reverse_bits()
}
