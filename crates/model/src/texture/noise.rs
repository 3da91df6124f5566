//! Gradient noise and sums of it.
//!
//! Space is cut into unit cells. Each corner has a gradient, which a permutation picks out of sixteen; the linear functions
//! that they stand for are blended with `6 t^5 - 15 t^4 + 10 t^3`, whose first two derivatives vanish at both ends
//! (Perlin 2002, "Improving Noise"; permutation and gradients are the ones of pbrt-v4, so that its scenes look the same).
//! Noise is 0 at the corners, has mean 0 and repeats after 256 cells.
//!
//! Sums of octaves, each 1.99 times as fine as the one before and `omega` times as strong, leave out what is finer than a
//! footprint (Musgrave 1994; Physically Based Rendering, 3rd edition, section 10.6).
use durer_core::math::float::{ln, sqr};

/// A permutation of all bytes: Perlin's.
#[rustfmt::skip]
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99,
    37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27,
    166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102,
    143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116,
    188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126,
    255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152,
    2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113,
    224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241,
    81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176, 115, 121,
    50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215,
    61, 156, 180,
];

/// Gradients: the middles of a cube's edges, four of them twice, so that there are sixteen.
const GRADIENTS: [[f32; 3]; 16] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
];

/// Noise is of no larger magnitude: at a corner `d` away a function is at most `|dx| + |dy| + |dz|`, and the mean of each of
/// these by the weights of the corners is at most 1/2.
pub(super) const LARGEST: f32 = 1.5;

/// How much finer each octave is than the one before.
const LACUNARITY: f64 = 1.99;

/// The mean magnitude of noise, near enough: what an octave that is left out adds to turbulence.
const MEAN_MAGNITUDE: f32 = 0.2;

/// Noise at a point; 0 where it is not finite.
pub(crate) fn noise(p: [f64; 3]) -> f32 {
    if !p.iter().all(|c| c.is_finite()) {
        return 0.0;
    }
    let cell = p.map(f64::floor);
    let offset: [f32; 3] = std::array::from_fn(|i| (p[i] - cell[i]) as f32);
    // Casts saturate: beyond 2^63 there are no fractions anyway.
    let corner = cell.map(|c| c as i64);
    let weight = offset.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let at = |x: usize, y: usize, z: usize| {
        let pick = |hash: u8, c: i64, step: usize| {
            PERMUTATION[usize::from(hash.wrapping_add((c.wrapping_add(step as i64) & 255) as u8))]
        };
        let hash = pick(pick(pick(0, corner[0], x), corner[1], y), corner[2], z);
        let [gx, gy, gz] = GRADIENTS[usize::from(hash & 15)];
        let d = |i: usize, step: usize| offset[i] - step as f32;
        gx * d(0, x) + gy * d(1, y) + gz * d(2, z)
    };
    let blend = |t: f32, a: f32, b: f32| a + (b - a) * t;
    let row = |y: usize, z: usize| blend(weight[0], at(0, y, z), at(1, y, z));
    let face = |z: usize| blend(weight[1], row(0, z), row(1, z));
    blend(weight[2], face(0), face(1))
}

/// What is summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sum {
    /// Noise: fractional Brownian motion, mean 0.
    Fbm,
    /// Its magnitude: turbulence, with creases.
    Turbulence,
}

/// A sum of octaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Octaves {
    pub(super) sum: Sum,
    /// At most.
    pub(super) octaves: u32,
    /// Strength of each by that of the one before.
    pub(super) omega: f32,
}

impl Octaves {
    /// The sum at `p`; `width` is the longer side of the footprint, of which an octave needs twice as much.
    pub(super) fn at(&self, p: [f64; 3], width: f32) -> f32 {
        let most = self.octaves as f32;
        let seen =
            if width > 0.0 { (-1.0 - ln(width) * std::f32::consts::LOG2_E).clamp(0.0, most) } else { most };
        let whole = seen.floor();
        let value = |frequency: f64| {
            let noise = noise(p.map(|c| c * frequency));
            if self.sum == Sum::Turbulence { noise.abs() } else { noise }
        };
        let (mut sum, mut frequency, mut strength) = (0.0, 1.0, 1.0);
        for _ in 0..whole as u32 {
            sum += strength * value(frequency);
            frequency *= LACUNARITY;
            strength *= self.omega;
        }
        // The last octave fades in.
        let rest = if self.sum == Sum::Turbulence { MEAN_MAGNITUDE } else { 0.0 };
        let share = smooth((seen - whole - 0.3) / 0.4);
        if share > 0.0 || rest > 0.0 {
            let last = if share > 0.0 { value(frequency) } else { 0.0 };
            sum += strength * (rest + (last - rest) * share);
        }
        for _ in whole as u32..self.octaves {
            sum += strength * rest;
            strength *= self.omega;
        }
        sum
    }

    /// The sum is of no larger magnitude.
    pub(super) fn largest(&self) -> f32 {
        let strengths = std::iter::successors(Some(1.0f32), |s| Some(s * self.omega.abs()));
        // One more than octaves: turbulence adds the mean of one that is left out.
        strengths.take(self.octaves as usize + 1).map(|s| s * (LARGEST + MEAN_MAGNITUDE)).sum()
    }
}

/// `3 t² - 2 t³`, and constant outside `[0, 1]`.
fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    sqr(t) * (3.0 - 2.0 * t)
}
