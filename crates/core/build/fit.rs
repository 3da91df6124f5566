//! Smooth reflectances of colours: the table of `src/spectrum/upsample.rs`.
//!
//! Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling": the reflectance at a
//! wavelength is `S(a x² + b x + c)` with `S(t) = 1/2 + t / (2 sqrt(1 + t²))`, here with `x` from 0 at 360 nm to 1 at
//! 830 nm. The three numbers are found by Levenberg's and Marquardt's method, so that under D65 it has the wanted linear
//! Rec. 709 colour, or, where no such curve has it (pure and bright colours), comes near.
use super::{
    layers::{SIZE, layer},
    observer::{COUNT, DAYLIGHT, MATCHING},
};

/// Wavelengths of the sums, spread evenly.
const NODES: usize = 95;
/// Steps at most.
const STEPS: usize = 40;
/// Beyond this a curve is a step, and steeper ones change no colour.
const STEEPEST: f64 = 400.0;

/// Sums over wavelengths: what the reflectance at a node adds to red, green and blue.
pub(super) struct Sums {
    nodes: [(f64, [f64; 3]); NODES],
}

impl Sums {
    /// Straight lines between the nodes, each nanometre counted.
    pub(super) fn new() -> Self {
        let mut nodes = [(0.0, [0.0; 3]); NODES];
        for (i, (x, _)) in nodes.iter_mut().enumerate() {
            *x = i as f64 / (NODES - 1) as f64;
        }
        for (i, (matching, light)) in MATCHING.iter().zip(DAYLIGHT).enumerate() {
            let at = i as f64 / (COUNT - 1) as f64 * (NODES - 1) as f64;
            let below = (at as usize).min(NODES - 2);
            let u = at - below as f64;
            for (c, weight) in matching.iter().enumerate() {
                let all = f64::from(*weight) * f64::from(light);
                nodes[below].1[c] += all * (1.0 - u);
                nodes[below + 1].1[c] += all * u;
            }
        }
        Self { nodes }
    }

    /// The colour of a curve, and how it changes with each of its numbers.
    fn colour(&self, curve: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let (mut sum, mut slopes) = ([0.0; 3], [[0.0; 3]; 3]);
        for (x, weights) in &self.nodes {
            let t = (curve[0] * x + curve[1]) * x + curve[2];
            let root = (1.0 + t * t).sqrt();
            let (value, slope) = (0.5 + 0.5 * t / root, 0.5 / (root * root * root));
            for c in 0..3 {
                sum[c] += weights[c] * value;
                let own = weights[c] * slope;
                slopes[c][0] += own * x * x;
                slopes[c][1] += own * x;
                slopes[c][2] += own;
            }
        }
        (sum, slopes)
    }

    /// The curve whose colour is nearest to `wanted`, looked for from another one on.
    pub(super) fn fit(&self, wanted: [f64; 3], from: [f64; 3]) -> [f64; 3] {
        let (mut curve, mut damping) = (from, 1e-4);
        let miss = |colour: [f64; 3]| [0, 1, 2].map(|c| wanted[c] - colour[c]);
        let square = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>();
        let (colour, mut slopes) = self.colour(curve);
        let mut missed = miss(colour);
        for _ in 0..STEPS {
            if square(missed) < 1e-14 || damping > 1e8 {
                break;
            }
            let next = add(curve, step(&slopes, missed, damping)).map(|v| v.clamp(-STEEPEST, STEEPEST));
            let (colour, new_slopes) = self.colour(next);
            if square(miss(colour)) < square(missed) {
                (curve, slopes, missed) = (next, new_slopes, miss(colour));
                damping *= 0.1;
            } else {
                damping *= 10.0;
            }
        }
        curve
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + b[i])
}

/// `(JᵀJ + damping diag(JᵀJ))⁻¹ Jᵀ missed`.
fn step(slopes: &[[f64; 3]; 3], missed: [f64; 3], damping: f64) -> [f64; 3] {
    let dot = |i: usize, j: usize| (0..3).map(|c| slopes[c][i] * slopes[c][j]).sum::<f64>();
    let mut m = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(i, j)));
    for (i, row) in m.iter_mut().enumerate() {
        row[i] += damping * row[i] + 1e-18;
    }
    let right = [0, 1, 2].map(|i| (0..3).map(|c| slopes[c][i] * missed[c]).sum::<f64>());
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // The matrix is symmetric: its rows are its columns (Cramer's rule).
    let volume = dot(m[0], cross(m[1], m[2]));
    let of = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| dot(a, cross(b, c)) / volume;
    let found = [of(right, m[1], m[2]), of(m[0], right, m[2]), of(m[0], m[1], right)];
    if found.iter().all(|v| v.is_finite()) { found } else { [0.0; 3] }
}

/// The share of the largest component that the others have, at a node: denser near 0, where curves are steep.
fn share(i: usize) -> f64 {
    let root = i as f64 / (SIZE - 1) as f64;
    root * root
}

/// The table: for each of the three largest components, each largest value, each share of the two others (in cyclic order;
/// the last varies fastest), the three numbers of the curve.
pub(super) fn table() -> Vec<[f32; 3]> {
    let sums = Sums::new();
    let mut all = vec![[0.0; 3]; 3 * SIZE * SIZE * SIZE];
    for largest in 0..3 {
        for y in 0..SIZE {
            for x in 0..SIZE {
                let mut fit = |z: usize, from: [f64; 3]| {
                    let bright = layer(z);
                    let mut rgb = [0.0; 3];
                    rgb[largest] = bright;
                    rgb[(largest + 1) % 3] = bright * share(x);
                    rgb[(largest + 2) % 3] = bright * share(y);
                    let curve = sums.fit(rgb, from);
                    all[((largest * SIZE + z) * SIZE + y) * SIZE + x] = curve.map(|v| v as f32);
                    curve
                };
                let start = SIZE / 3;
                let mut curve = [0.0; 3];
                for z in start..SIZE {
                    curve = fit(z, curve);
                }
                curve = [0.0; 3];
                for z in (0..=start).rev() {
                    curve = fit(z, curve);
                }
            }
        }
    }
    all
}
