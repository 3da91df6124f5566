//! The part of the plane that a fill rule fills, exact also where loops overlap or cross.
//!
//! Horizontal lines through all vertices and crossings cut the polygon into slabs in which edges do not cross, so the
//! filled part of a slab is made of trapezoids. O(n²) for n edges.
use super::FillRule;

/// A directed edge.
type Edge = [[f64; 2]; 2];

/// What is filled between two edges and two heights.
struct Trapezoid<'e> {
    heights: [f64; 2],
    left: &'e Edge,
    right: &'e Edge,
}

/// The filled area of closed loops given as edges, in squares of the coordinates' unit.
pub(super) fn filled_area(edges: Vec<Edge>, rule: FillRule) -> f64 {
    let mut sum = 0.0;
    trapezoids(&edges, rule, |Trapezoid { heights: [low, high], left, right }| {
        let middle = 0.5 * (low + high);
        sum += (high - low) * (along(right, middle) - along(left, middle));
    });
    sum
}

/// Triangles that cover the filled area, each point once; counter-clockwise.
pub(super) fn triangles(edges: Vec<Edge>, rule: FillRule) -> Vec<[[f64; 2]; 3]> {
    let mut triangles = Vec::new();
    trapezoids(&edges, rule, |Trapezoid { heights: [low, high], left, right }| {
        let [a, b] = [left, right].map(|e| [along(e, low), low]);
        let [d, c] = [left, right].map(|e| [along(e, high), high]);
        triangles.extend([[a, b, c], [a, c, d]].into_iter().filter(|[p, q, r]| {
            let (pq, pr) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
            pq[0] * pr[1] - pq[1] * pr[0] > 0.0
        }));
    });
    triangles
}

fn trapezoids<'e>(edges: &'e [Edge], rule: FillRule, mut found: impl FnMut(Trapezoid<'e>)) {
    let mut levels: Vec<f64> = edges.iter().map(|e| e[0][1]).collect();
    for (i, a) in edges.iter().enumerate() {
        levels.extend(edges[..i].iter().filter_map(|b| crossing_height(a, b)));
    }
    levels.sort_unstable_by(f64::total_cmp);
    levels.dedup();
    for slab in levels.windows(2) {
        let heights = [slab[0], slab[1]];
        filled(edges, rule, 0.5 * (slab[0] + slab[1]), |left, right| {
            found(Trapezoid { heights, left, right });
        });
    }
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

/// Where an edge that is not horizontal is at height `y`.
fn along([a, b]: &Edge, y: f64) -> f64 {
    a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
}

/// The pairs of edges between which the horizontal line at `y` is filled.
fn filled<'e>(edges: &'e [Edge], rule: FillRule, y: f64, mut between: impl FnMut(&'e Edge, &'e Edge)) {
    let mut cuts: Vec<(f64, i32, &Edge)> = edges
        .iter()
        .filter(|[a, b]| (a[1] <= y) != (b[1] <= y))
        .map(|edge| (along(edge, y), if edge[0][1] <= y { 1 } else { -1 }, edge))
        .collect();
    cuts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut winding = 0;
    for pair in cuts.windows(2) {
        winding += pair[0].1;
        if rule.fills(winding) {
            between(pair[0].2, pair[1].2);
        }
    }
}
