//! Is a point inside a polygon of the plane?
//!
//! Two answers (lecture, "Point in Polygon"): count the edges that a half line from the point crosses, or how often the
//! outline winds around the point. They agree on polygons whose loops neither cross nor overlap in the same sense.
//!
//! The half line runs towards +x. An edge holds its lower end, not its upper one, and a point on an edge lies to the
//! right of it: of several polygons that tile the plane exactly one contains any point. The side of an edge is computed
//! from its lower to its upper end, so both polygons at an edge get the same number, whatever their sense.

/// What counts as inside where loops overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// Points with an odd crossing number.
    #[default]
    EvenOdd,
    /// Points with a winding number other than 0.
    NonZero,
}

impl FillRule {
    /// Whether a point belongs to the polygon of these directed edges.
    pub fn contains(self, p: [f64; 2], edges: impl IntoIterator<Item = [[f64; 2]; 2]>) -> bool {
        match self {
            Self::EvenOdd => crossing_number(p, edges) % 2 == 1,
            Self::NonZero => winding_number(p, edges) != 0,
        }
    }
    /// Whether a region around which the outline winds `winding` times belongs to it.
    pub(super) fn fills(self, winding: i32) -> bool {
        match self {
            Self::EvenOdd => winding.rem_euclid(2) == 1,
            Self::NonZero => winding != 0,
        }
    }
}

/// Number of edges that the half line from `p` towards +x crosses. Edges of closed loops, in any order.
pub fn crossing_number(p: [f64; 2], edges: impl IntoIterator<Item = [[f64; 2]; 2]>) -> u32 {
    edges.into_iter().map(|edge| crossing(p, edge).unsigned_abs()).sum()
}

/// How often the outline winds around `p`: counter-clockwise minus clockwise turns, counted where edges cross the half
/// line towards +x, upwards positive (Sunday 2001). Edges of closed loops, in any order.
pub fn winding_number(p: [f64; 2], edges: impl IntoIterator<Item = [[f64; 2]; 2]>) -> i32 {
    edges.into_iter().map(|edge| crossing(p, edge)).sum()
}

/// 1 if the edge crosses the half line upwards, -1 downwards, 0 if not.
fn crossing([x, y]: [f64; 2], [from, to]: [[f64; 2]; 2]) -> i32 {
    let upwards = from[1] <= y && y < to[1];
    let downwards = to[1] <= y && y < from[1];
    if !(upwards || downwards) {
        return 0;
    }
    let (low, high) = if upwards { (from, to) } else { (to, from) };
    let side = (high[0] - low[0]) * (y - low[1]) + (low[0] - x) * (high[1] - low[1]);
    match side > 0.0 {
        false => 0,
        true if upwards => 1,
        true => -1,
    }
}
