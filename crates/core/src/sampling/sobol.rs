//! Sobol points with hashed Owen scrambling (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! In the first two dimensions every base-2 elementary interval of area `2^-m` holds one of the first `2^m` points: a
//! (0, 2)-sequence. The others follow from the direction numbers of Joe and Kuo 2008, "Constructing Sobol Sequences with
//! Better Two-Dimensional Projections".

//!
//! PERF: coordinates are computed with their bits in reverse, the most significant last: that is how the scrambling wants
//! them, and reversing is what costs most of all (bench render).

/// Dimension 1, reversed: the generator matrix of the primitive polynomial x + 1 is Pascal's triangle mod 2, a Kronecker
/// power of [[1, 1], [0, 1]], so that a vector is multiplied in one step per factor.
#[inline]
const fn dimension1(index: u32) -> u32 {
    let mut x = index;
    x ^= (x & 0xAAAA_AAAA) >> 1;
    x ^= (x & 0xCCCC_CCCC) >> 2;
    x ^= (x & 0xF0F0_F0F0) >> 4;
    x ^= (x & 0xFF00_FF00) >> 8;
    x ^ (x & 0xFFFF_0000) >> 16
}

/// How many dimensions there are.
pub(super) const DIMENSIONS: usize = 11;

/// From the third dimension on: degree and inner coefficients of the primitive polynomial, and the first direction numbers.
const DIRECTIONS: [(usize, u32, [u32; 5]); DIMENSIONS - 2] = [
    (2, 1, [1, 3, 0, 0, 0]),
    (3, 1, [1, 3, 1, 0, 0]),
    (3, 2, [1, 1, 1, 0, 0]),
    (4, 1, [1, 1, 3, 3, 0]),
    (4, 4, [1, 3, 5, 13, 0]),
    (5, 2, [1, 1, 5, 5, 17]),
    (5, 4, [1, 1, 5, 5, 5]),
    (5, 7, [1, 1, 7, 11, 19]),
    (5, 11, [1, 1, 5, 1, 1]),
];

/// What each value of each four bits of the index adds to a coordinate, reversed.
type Nibbles = [[u32; 16]; 8];

/// One table for each dimension from the third on. PERF: eight look-ups, where the matrix would take a step for each bit
/// that is set; 512 bytes for a dimension.
static TABLES: [Nibbles; DIMENSIONS - 2] = tables();

const fn tables() -> [Nibbles; DIMENSIONS - 2] {
    let mut tables = [[[0; 16]; 8]; DIMENSIONS - 2];
    let mut d = 0;
    while d < DIMENSIONS - 2 {
        let columns = columns(DIRECTIONS[d].0, DIRECTIONS[d].1, &DIRECTIONS[d].2);
        let mut i = 0;
        while i < 128 {
            let (group, value) = (i / 16, i % 16);
            let mut bit = 0;
            while bit < 4 {
                if value >> bit & 1 == 1 {
                    tables[d][group][value] ^= columns[4 * group + bit];
                }
                bit += 1;
            }
            i += 1;
        }
        d += 1;
    }
    tables
}

/// The generator matrix, column by column, reversed: a recurrence whose coefficients are those of a primitive polynomial
/// mod 2.
const fn columns(degree: usize, inner: u32, first: &[u32; 5]) -> [u32; 32] {
    let mut columns = [0; 32];
    let mut i = 0;
    while i < 32 {
        if i < degree {
            columns[i] = first[i] << (31 - i);
        } else {
            columns[i] = columns[i - degree] ^ columns[i - degree] >> degree;
            let mut k = 1;
            while k < degree {
                if inner >> (degree - 1 - k) & 1 == 1 {
                    columns[i] ^= columns[i - k];
                }
                k += 1;
            }
        }
        i += 1;
    }
    i = 0;
    while i < 32 {
        columns[i] = columns[i].reverse_bits();
        i += 1;
    }
    columns
}

/// A coordinate of the point, in a dimension below [`DIMENSIONS`], its bits reversed.
#[inline]
fn reversed(index: u32, dimension: usize) -> u32 {
    match dimension {
        // The van der Corput sequence.
        0 => index,
        1 => dimension1(index),
        _ => {
            let table = &TABLES[dimension - 2];
            (0..8).fold(0, |sum, i| sum ^ table[i][(index >> (4 * i) & 15) as usize])
        }
    }
}

/// A coordinate of the point, in a dimension below [`DIMENSIONS`], scrambled by `seed`.
#[inline]
pub(super) fn scrambled(index: u32, dimension: usize, seed: u32) -> u32 {
    permute(reversed(index, dimension), seed).reverse_bits()
}

/// Owen scrambling: a random permutation of the binary digits' subtrees, chosen by `seed`.
#[inline]
pub(super) const fn owen_scramble(x: u32, seed: u32) -> u32 {
    permute(x.reverse_bits(), seed).reverse_bits()
}

/// Owen scrambling of reversed bits: the multiplications by even numbers let each bit depend on the lower ones only (Laine
/// and Karras 2011).
#[inline]
const fn permute(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^ x.wrapping_mul(0x53A2_2864)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinate(index: u32, dimension: usize) -> u32 {
        reversed(index, dimension).reverse_bits()
    }

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
            assert_eq!(coordinate(i, 1), by_direction_numbers(i), "{i:x}");
        }
    }

    #[test]
    fn every_dimension_fills_the_intervals_of_every_power_of_two() {
        for dimension in 0..DIMENSIONS {
            for m in 0..=10u32 {
                let mut seen = vec![0; 1 << m];
                for i in 3 << m..4 << m {
                    seen[coordinate(i, dimension).checked_shr(32 - m).unwrap_or(0) as usize] += 1;
                }
                assert_eq!(seen, vec![1; 1 << m], "dimension {dimension} m {m}");
            }
        }
    }

    #[test]
    fn direction_numbers_give_the_published_points() {
        // By hand from the first two direction numbers of each.
        let of = |i: u32| [2, 3, 4, 5].map(|d| f64::from(coordinate(i, d)) / 2f64.powi(32));
        assert_eq!(of(1), [0.5; 4]);
        assert_eq!(of(3), [0.25, 0.25, 0.75, 0.75]);
        assert_eq!(of(2), [0.75, 0.75, 0.25, 0.25]);
    }

    #[test]
    fn no_two_dimensions_are_alike() {
        let rows: Vec<Vec<u32>> =
            (0..DIMENSIONS).map(|d| (0..32).map(|bit| coordinate(1 << bit, d)).collect()).collect();
        for (d, row) in rows.iter().enumerate() {
            assert!(rows[..d].iter().all(|other| other != row), "{d}");
        }
    }
}
