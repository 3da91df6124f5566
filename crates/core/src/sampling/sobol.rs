//! The first two Sobol dimensions with hashed Owen scrambling (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! Every base-2 elementary interval of area `2^-m` holds one of the first `2^m` points: a (0, 2)-sequence.

/// Dimension 0: the van der Corput sequence.
#[inline]
pub(super) const fn dimension0(index: u32) -> u32 {
    index.reverse_bits()
}

/// Dimension 1: the generator matrix of the primitive polynomial x + 1 is Pascal's triangle mod 2, a Kronecker power of
/// [[1, 1], [0, 1]], so that a vector is multiplied in one step per factor.
#[inline]
pub(super) const fn dimension1(index: u32) -> u32 {
    let mut x = index.reverse_bits();
    x ^= (x & 0x5555_5555) << 1;
    x ^= (x & 0x3333_3333) << 2;
    x ^= (x & 0x0F0F_0F0F) << 4;
    x ^= (x & 0x00FF_00FF) << 8;
    x ^ (x & 0x0000_FFFF) << 16
}

/// Owen scrambling: a random permutation of the binary digits' subtrees, chosen by `seed`. The multiplications by even
/// numbers let each bit depend on the lower ones only, hence the reversals (Laine and Karras 2011).
#[inline]
pub(super) const fn owen_scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^= x.wrapping_mul(0x53A2_2864);
    x.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column by column: each direction number is the one before it, xored with itself shifted by one.
    fn by_direction_numbers(mut index: u32) -> u32 {
        let (mut result, mut column) = (0, 1u32 << 31);
        while index != 0 {
            if index & 1 != 0 {
                result ^= column;
            }
            column ^= column >> 1;
            index >>= 1;
        }
        result
    }

    #[test]
    fn kronecker_steps_equal_the_matrix_product() {
        for i in (0..5000).chain([u32::MAX, 1 << 31, 0xDEAD_BEEF, 0x1234_5678]) {
            assert_eq!(dimension1(i), by_direction_numbers(i), "{i:x}");
        }
    }
}
