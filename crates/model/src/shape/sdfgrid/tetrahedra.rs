//! Triangles near a surface between distances: each cell is six tetrahedra around a diagonal, in which distances are taken to be
//! linear (Doi and Koide 1991, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells").
use durer_core::glam::DVec3;

use super::cells::{Cells, corner};

/// Corners of the tetrahedra, of a cell whose x changes fastest.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// The triangles, seen counter-clockwise from where distances are above 0.
pub(super) fn triangles(cells: &Cells) -> Vec<[DVec3; 3]> {
    let mut all = Vec::new();
    for cell in cells.filled() {
        let values = cells.corners(cell);
        let place = |i: usize| corner([cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2)]);
        let crossing = |a: usize, b: usize| place(a).lerp(place(b), values[a] / (values[a] - values[b]));
        for tetrahedron in TETRAHEDRA {
            let [inside, outside] = [true, false]
                .map(|low| tetrahedron.into_iter().filter(|i| (values[*i] < 0.0) == low).collect::<Vec<_>>());
            let up = |t: [DVec3; 3]| {
                let away = outside.iter().map(|i| place(*i) - t[0]).sum::<DVec3>() * inside.len() as f64
                    - inside.iter().map(|i| place(*i) - t[0]).sum::<DVec3>() * outside.len() as f64;
                if (t[1] - t[0]).cross(t[2] - t[0]).dot(away) < 0.0 { [t[0], t[2], t[1]] } else { t }
            };
            match (inside.as_slice(), outside.as_slice()) {
                (&[a], &[b, c, d]) | (&[b, c, d], &[a]) => {
                    all.push(up([b, c, d].map(|other| crossing(a, other))));
                }
                (&[a, b], &[c, d]) => {
                    let [p, q, r, s] = [crossing(a, c), crossing(a, d), crossing(b, d), crossing(b, c)];
                    all.extend([up([p, q, r]), up([p, r, s])]);
                }
                _ => {}
            }
        }
    }
    all
}
