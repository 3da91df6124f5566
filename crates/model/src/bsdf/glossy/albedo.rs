//! The two parts of the directional albedo of a glossy lobe.
//!
//! `A = integral (1 - s) D V cos`, `B = integral s D V cos` over the hemisphere, with `s = (1 - wo.h)^5`. The table holds
//! them at `alpha = (row / 15)²`, `cos = (column / 15)²`; row 0 is a mirror. Made by quadrature in double precision
//! (`durer_testkit::microfacet`), and checked against it by the test `albedo_table_is_the_integral`, whose ignored
//! neighbour prints it.

use super::{
    Distribution,
    albedo_table::{SIZE, TABLE},
    beckmann_table,
};

/// `(A, B)` of a lobe seen under `cos` in `[0, 1]`, with `alpha` in `[0, 1]`; bilinear in the square roots.
pub(super) fn split_sum(cos: f32, alpha: f32, like: Distribution) -> (f32, f32) {
    let table = match like {
        Distribution::Ggx => &TABLE,
        Distribution::Beckmann => &beckmann_table::TABLE,
    };
    let place = |v: f32| {
        let x = v.clamp(0.0, 1.0).sqrt() * (SIZE - 1) as f32;
        let i = (x as usize).min(SIZE - 2);
        (i, x - i as f32)
    };
    let ((row, v), (column, u)) = (place(alpha), place(cos));
    let read = |part: usize| {
        let at = |r: usize, c: usize| table[r][c][part];
        let along = |r: usize| at(r, column) * (1.0 - u) + at(r, column + 1) * u;
        along(row) * (1.0 - v) + along(row + 1) * v
    };
    (read(0), read(1))
}

/// Points of the mean.
const STEPS: usize = 120;

/// `2 integral of (A, B) cos dcos` of each row of GGX, by the midpoints of even steps over the square root of the cosine.
const MEANS: [[f32; 2]; SIZE] = {
    let mut means = [[0.0; 2]; SIZE];
    let mut row = 0;
    while row < SIZE {
        let (mut sums, mut weights) = ([0.0; 2], 0.0);
        let mut i = 0;
        while i < STEPS {
            let root = (i as f32 + 0.5) / STEPS as f32;
            let x = root * (SIZE - 1) as f32;
            let column = x as usize;
            let u = x - column as f32;
            let weight = root * root * root;
            let (low, high) = (TABLE[row][column], TABLE[row][column + 1]);
            sums[0] += weight * (low[0] * (1.0 - u) + high[0] * u);
            sums[1] += weight * (low[1] * (1.0 - u) + high[1] * u);
            weights += weight;
            i += 1;
        }
        means[row] = [sums[0] / weights, sums[1] / weights];
        row += 1;
    }
    means
};

/// The means of [`split_sum`] of GGX by the cosine, with `alpha` in `[0, 1]`.
pub(super) fn mean_split_sum(alpha: f32) -> (f32, f32) {
    let x = alpha.clamp(0.0, 1.0).sqrt() * (SIZE - 1) as f32;
    let row = (x as usize).min(SIZE - 2);
    let v = x - row as f32;
    let read = |part: usize| MEANS[row][part] * (1.0 - v) + MEANS[row + 1][part] * v;
    (read(0), read(1))
}
