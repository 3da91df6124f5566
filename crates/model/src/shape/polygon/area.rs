//! Area that a fill rule fills, exact also where loops overlap or cross.
//!
//! Horizontal lines through all vertices and crossings cut the polygon into slabs in which edges do not cross, so the
//! filled part of a slab is made of trapezoids: their width at mid-height times the slab's height. O(n²) for n edges.
use super::FillRule;

/// A directed edge.
type Edge = [[f64; 2]; 2];

/// The filled area of closed loops given as edges, in squares of the coordinates' unit.
pub(super) fn filled_area(edges: Vec<Edge>, rule: FillRule) -> f64 {
    let mut levels: Vec<f64> = edges.iter().map(|e| e[0][1]).collect();
    for (i, a) in edges.iter().enumerate() {
        levels.extend(edges[..i].iter().filter_map(|b| crossing_height(a, b)));
    }
    levels.sort_unstable_by(f64::total_cmp);
    levels.dedup();
    levels.windows(2).map(|w| (w[1] - w[0]) * filled_width(&edges, rule, 0.5 * (w[0] + w[1]))).sum()
}

/// Height at which two edges cross; `None` if they do not or are parallel.
fn crossing_height(a: &Edge, b: &Edge) -> Option<f64> {
    let (da, db) = ([a[1][0] - a[0][0], a[1][1] - a[0][1]], [b[1][0] - b[0][0], b[1][1] - b[0][1]]);
    let between = [b[0][0] - a[0][0], b[0][1] - a[0][1]];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let whole = cross(da, db);
    let (s, t) = (cross(between, db) / whole, cross(between, da) / whole);
    let crosses = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    crosses.then_some(a[0][1] + s * da[1])
}

/// Total length of the filled parts of the horizontal line at `y`.
fn filled_width(edges: &[Edge], rule: FillRule, y: f64) -> f64 {
    let mut cuts: Vec<(f64, i32)> = edges
        .iter()
        .filter(|[a, b]| (a[1] <= y) != (b[1] <= y))
        .map(|[a, b]| {
            let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            (x, if a[1] <= y { 1 } else { -1 })
        })
        .collect();
    cuts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut winding = 0;
    cuts.windows(2)
        .map(|w| {
            winding += w[0].1;
            if rule.fills(winding) { w[1].0 - w[0].0 } else { 0.0 }
        })
        .sum()
}
