//! The two parts of the directional albedo of a GGX lobe.
//!
//! `A = integral (1 - s) D V cos`, `B = integral s D V cos` over the hemisphere, with `s = (1 - wo.h)^5`. The table holds
//! them at `alpha = (row / 15)²`, `cos = (column / 15)²`; row 0 is a mirror. Made by quadrature in double precision
//! (`durer_testkit::microfacet`), and checked against it by the test `albedo_table_is_the_integral`, whose ignored
//! neighbour prints it.

use super::albedo_table::{SIZE, TABLE};

/// `(A, B)` of a lobe seen under `cos` in `[0, 1]`, with `alpha` in `[0, 1]`; bilinear in the square roots.
pub(super) fn split_sum(cos: f32, alpha: f32) -> (f32, f32) {
    let place = |v: f32| {
        let x = v.clamp(0.0, 1.0).sqrt() * (SIZE - 1) as f32;
        let i = (x as usize).min(SIZE - 2);
        (i, x - i as f32)
    };
    let ((row, v), (column, u)) = (place(alpha), place(cos));
    let read = |part: usize| {
        let at = |r: usize, c: usize| TABLE[r][c][part];
        let along = |r: usize| at(r, column) * (1.0 - u) + at(r, column + 1) * u;
        along(row) * (1.0 - v) + along(row + 1) * v
    };
    (read(0), read(1))
}
