//! The order in which pixels follow each other where a sequence of points is dealt out over a picture: a Z through every
//! square of four squares, mirrored and turned at random (Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte
//! Carlo Sampling Error via Hierarchical Ordering of Pixels").
use super::sobol::owen_scramble;

/// The lower bit of each pair of bits.
const LOW: u32 = 0x5555_5555;

/// The lower 16 bits, each in the place of a pair.
const fn spread(x: u32) -> u32 {
    let x = x & 0xFFFF;
    let x = (x | (x << 8)) & 0x00FF_00FF;
    let x = (x | (x << 4)) & 0x0F0F_0F0F;
    let x = (x | (x << 2)) & 0x3333_3333;
    (x | (x << 1)) & LOW
}

/// Where the pixel at the lower 16 bits of `x` and `y` comes. Which two of four squares follow each other, those side by
/// side, those above each other or those across, and which comes first, a hash says anew in every square: else columns of
/// pixels would have the same errors.
pub(super) const fn place(x: u32, y: u32, seed: u32) -> u32 {
    let (x, y) = (spread(x), spread(y));
    let z = x | (y << 1);
    // What scrambling adds to a bit depends on the higher bits alone: on the square that the four lie in.
    let across = ((owen_scramble(z, seed) ^ z) >> 1) & LOW;
    let stacked = ((owen_scramble(z, !seed) ^ z) >> 1) & LOW & !across;
    let beside = LOW & !across & !stacked;
    let (high, low) = (((x ^ y) & across) | (x & stacked) | (y & beside), (y & stacked) | (x & !stacked));
    owen_scramble(low | (high << 1), seed.rotate_left(16))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_square_of_a_power_of_two_is_a_run_of_the_curve() {
        for seed in [0, 1, 0xDEAD_BEEF] {
            for level in 0..=4u32 {
                let side = 1 << level;
                for (x0, y0) in [(0, 0), (3, 5), (4095, 4095)] {
                    let mut places: Vec<u32> = (0..side * side)
                        .map(|i| place(x0 * side + i % side, y0 * side + i / side, seed))
                        .collect();
                    places.sort_unstable();
                    let first = places[0];
                    assert_eq!(first % (side * side), 0);
                    assert_eq!(places, (first..first + side * side).collect::<Vec<_>>(), "{level} {seed}");
                }
            }
        }
    }

    #[test]
    fn all_three_ways_of_pairing_four_pixels_occur() {
        let mut partners = [0u32; 3];
        for square in 0..4096u32 {
            let (x, y) = (2 * (square % 64), 2 * (square / 64));
            let first = place(x, y, 7) / 2;
            let others = [place(x + 1, y, 7), place(x, y + 1, 7), place(x + 1, y + 1, 7)];
            let partner = others.iter().position(|p| p / 2 == first).expect("one of them");
            partners[partner] += 1;
        }
        // Expected 1024, 1024, 2048; the deviations are 28 and 32.
        let [beside, below, across] = partners;
        assert!(beside.abs_diff(1024) < 130 && below.abs_diff(1024) < 130, "{partners:?}");
        assert!(across.abs_diff(2048) < 150, "{partners:?}");
    }
}
