//! Jittered strata (Cook 1986, "Stochastic Sampling in Computer Graphics"): `N` samples fill the cells of a grid, in an
//! order that a hash permutes anew for every pixel and dimension (the permutation is that of Kensler 2013,
//! "Correlated Multi-Jittered Sampling": a bijection of a power of two, walked until it falls below `N`).
use super::hash::{combine, unit_float};
use crate::math::Point2;

/// Beyond this many samples the cells are hardly wider than the numbers are fine: single random numbers do as well.
const MOST: u32 = 1 << 22;
/// Beyond this many samples a divisor is not looked for: the few cells without a sample no longer matter.
const MOST_DIVIDED: u32 = 1 << 10;

/// Where in its cell a sample lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Anywhere.
    Random,
    /// In the middle.
    Centre,
}

/// Columns and rows of at least `n` cells, close to a square: exactly `n` if that is a product of two numbers of which one
/// is at most double the other, else as many rows of a square as are needed.
#[inline]
fn grid(n: u32) -> (u32, u32) {
    let side = n.isqrt() + u32::from(n.isqrt().pow(2) < n);
    let most = if n <= MOST_DIVIDED { (2 * n).isqrt() } else { side };
    let columns = (side..=most).find(|columns| n.is_multiple_of(*columns)).unwrap_or(side).max(1);
    (columns, n.div_ceil(columns))
}

/// Where index `i` lies in a random order of `0..n`, for `i < n`.
fn permuted(i: u32, n: u32, seed: u32) -> u32 {
    let mask = n.next_power_of_two().wrapping_sub(1);
    let mut x = i;
    loop {
        x ^= seed;
        x = x.wrapping_mul(0xE170_893D) ^ (seed >> 16);
        x ^= (x & mask) >> 4;
        x = (x ^ (seed >> 8)).wrapping_mul(0x0929_EB3F) ^ (seed >> 23);
        x ^= (x & mask) >> 1;
        x = x.wrapping_mul(1 | (seed >> 27)).wrapping_mul(0x6935_FA69);
        x ^= (x & mask) >> 11;
        x = x.wrapping_mul(0x74DC_B303);
        x ^= (x & mask) >> 2;
        x = x.wrapping_mul(0x9E50_1CC3);
        x ^= (x & mask) >> 2;
        x = x.wrapping_mul(0xC860_A3DF) & mask;
        x ^= x >> 5;
        if x < n {
            return x.wrapping_add(seed) % n;
        }
    }
}

/// The part of a cell, two numbers in `[0, 1)`, that sample `index` of the dimension hashed in `h` takes.
#[inline]
fn inside(h: u64, index: u32, place: Place) -> [f32; 2] {
    match place {
        Place::Centre => [0.5, 0.5],
        Place::Random => {
            let bits = combine(h, u64::from(index));
            [unit_float(bits as u32), unit_float((bits >> 32) as u32)]
        }
    }
}

/// `(cell + u) / cells`, below 1 whatever rounding does.
#[inline]
fn within(cell: u32, u: f32, cells: u32) -> f32 {
    ((cell as f32 + u) / cells as f32).min(1.0 - f32::EPSILON / 2.0)
}

/// Sample `index` of `count` in the unit interval; `h` is the hash of pixel and dimension.
#[inline]
pub(super) fn interval(h: u64, index: u32, count: u32, place: Place) -> f32 {
    let [u, _] = inside(h, index, place);
    if count > MOST {
        u
    } else {
        within(permuted(index % count.max(1), count.max(1), (h >> 32) as u32), u, count.max(1))
    }
}

/// Sample `index` of `count` in the unit square; `h` is the hash of pixel and dimension.
#[inline]
pub(super) fn square(h: u64, index: u32, count: u32, place: Place) -> Point2 {
    let [u, v] = inside(h, index, place);
    if count > MOST {
        return Point2::new(u, v);
    }
    let (columns, rows) = grid(count.max(1));
    let cells = columns * rows;
    let cell = permuted(index % cells, cells, (h >> 32) as u32);
    Point2::new(within(cell % columns, u, columns), within(cell / columns, v, rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_hold_all_samples_and_are_close_to_square() {
        assert_eq!(
            [1, 2, 4, 6, 7, 8, 16, 18, 32, 64].map(grid),
            [(1, 1), (2, 1), (2, 2), (3, 2), (3, 3), (4, 2), (4, 4), (6, 3), (8, 4), (8, 8)]
        );
        for n in 1..3000 {
            let (columns, rows) = grid(n);
            assert!(columns * rows >= n && (columns - 1) * rows < n.max(2) && rows <= columns, "{n}");
            assert!(columns <= 2 * rows || n < 3, "{n}: {columns} x {rows}");
        }
    }

    #[test]
    fn every_order_is_a_permutation_and_orders_differ() {
        for n in [1, 2, 3, 16, 17, 100] {
            let order = |seed: u32| (0..n).map(|i| permuted(i, n, seed)).collect::<Vec<_>>();
            for seed in [0, 1, 0xDEAD_BEEF] {
                let mut sorted = order(seed);
                sorted.sort_unstable();
                assert_eq!(sorted, (0..n).collect::<Vec<_>>(), "{n} {seed}");
            }
            assert!(n < 16 || order(0x1234_5678) != order(0x8765_4321));
        }
    }

    #[test]
    fn every_place_of_a_permutation_is_equally_likely() {
        let (n, trials) = (7u32, 14_000u32);
        let mut counts = [[0u32; 7]; 7];
        for t in 0..trials {
            let seed = combine(u64::from(t), 3) as u32;
            (0..n).for_each(|i| counts[i as usize][permuted(i, n, seed) as usize] += 1);
        }
        // Each count is binomial with mean 2000 and deviation 41.
        assert!(counts.iter().flatten().all(|c| c.abs_diff(trials / n) < 200), "{counts:?}");
    }
}
