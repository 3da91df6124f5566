//! Halton points (Halton 1960): the digits of the index, mirrored at the point, in a prime base for each dimension. Digits
//! are scrambled as Owen (1995) does: by a random permutation for every digit and every value of the digits before it. The
//! permutations are affine maps modulo the base; these take two different digits to any two different ones with the same
//! chance, which is all that Owen's variance depends on.
use super::hash::combine;

/// The bases.
const PRIMES: [u32; DIMENSIONS] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103,
    107, 109, 113, 127, 131, 137,
];

/// How many there are.
pub(super) const DIMENSIONS: usize = 33;

/// Point `index` of `count` in a dimension below [`DIMENSIONS`], in `[0, 1)`; `h` is the hash of pixel and dimension. Digits
/// that the count has no need of are random.
pub(super) fn radical_inverse(index: u32, count: u32, dimension: usize, h: u64) -> f32 {
    let base = u64::from(PRIMES[dimension]);
    let (mut rest, mut cells, mut cell, mut hash) = (u64::from(index), 1u64, 0u64, h);
    while cells < u64::from(count) {
        // Four bytes for each of the two random numbers below the base.
        let (factor, shift) = (((hash >> 32) * (base - 1)) >> 32, ((hash & 0xFFFF_FFFF) * base) >> 32);
        let digit = rest % base;
        rest /= base;
        cell = cell * base + (digit * (factor + 1) + shift) % base;
        cells *= base;
        hash = combine(h, (cells << 32) ^ cell);
    }
    let inside = (hash >> 40) as f64 * (1.0 / (1u64 << 24) as f64);
    (((cell as f64 + inside) / cells as f64) as f32).min(1.0 - f32::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_the_first_primes() {
        let is_prime = |n: &u32| (2..*n).all(|d| !n.is_multiple_of(d));
        let primes: Vec<u32> = (2..).filter(is_prime).take(DIMENSIONS).collect();
        assert_eq!(primes, PRIMES);
    }

    #[test]
    fn as_many_points_as_a_power_of_the_base_fill_its_cells() {
        for (dimension, digits) in [(0, 1), (0, 5), (1, 4), (2, 3), (4, 2), (32, 1)] {
            let n = PRIMES[dimension].pow(digits);
            for count in [n, 2 * n] {
                for h in 0..50 {
                    let of = |i| f64::from(radical_inverse(i, count, dimension, combine(h, 1)));
                    let mut found: Vec<f64> = (n..2 * n).map(of).collect();
                    found.sort_by(f64::total_cmp);
                    // Rounding to f32 may take a number over the edge of its cell.
                    let outside =
                        |(cell, u): &(usize, &f64)| (**u * f64::from(n) - *cell as f64 - 0.5).abs() > 0.5001;
                    let lost = found.iter().enumerate().find(outside);
                    assert_eq!(lost, None, "dimension {dimension}, {digits} digits");
                }
            }
        }
    }
}
