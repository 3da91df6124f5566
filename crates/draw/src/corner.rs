//! Where a trail turns sharply: curves end there and begin anew.
//!
//! A smooth curve turns the less the shorter the way one looks at, a corner does not: the turn is taken over a short way and
//! compared with that over a longer one.
use durer_core::glam::DVec2;

/// Ways on both sides over which the turn is taken, in pixels. Of a smooth curve's turn over the longer one the shorter has
/// two fifths.
const NEAR: f64 = 1.0;
const FAR: f64 = 2.5;
/// Turns over the shorter way from which on there is a corner, in radians, with the share they must have of that over the
/// longer one: gentle corners must be plain.
const SHARP: [(f64, f64); 2] = [(0.3, 0.65), (0.6, 0.45)];
/// Of the corners within so many pixels only the sharpest counts.
const APART: f64 = 1.5;
/// Sides of a corner are taken as straight from here to there, in pixels from it.
const SIDE: [f64; 2] = [0.25, 2.5];
/// How far the point where they meet may lie from the corner that was found, in pixels.
const NEARBY: f64 = 0.25;

/// A polygonal line, open or closed, as a function of the way along it.
struct Way<'a> {
    points: &'a [DVec2],
    /// The way from the first point to each.
    sums: Vec<f64>,
    closed: bool,
    total: f64,
}

impl<'a> Way<'a> {
    fn new(points: &'a [DVec2], closed: bool) -> Self {
        let mut sums = vec![0.0];
        for pair in points.windows(2) {
            sums.push(sums[sums.len() - 1] + pair[0].distance(pair[1]));
        }
        let back = if closed { points[0].distance(points[points.len() - 1]) } else { 0.0 };
        let total = sums[sums.len() - 1] + back;
        Self { points, sums, closed, total }
    }

    /// The point this far along; `None` beyond the ends.
    fn at(&self, s: f64) -> Option<DVec2> {
        let s = if self.closed { s.rem_euclid(self.total) } else { s };
        if s < 0.0 || s > self.total {
            return None;
        }
        let next = self.sums.partition_point(|&sum| sum <= s);
        let from = next - 1;
        let to = next % self.points.len();
        let end = self.sums.get(next).copied().unwrap_or(self.total);
        let u = if end > self.sums[from] { (s - self.sums[from]) / (end - self.sums[from]) } else { 0.0 };
        Some(self.points[from].lerp(self.points[to], u))
    }

    /// The turn at a point over so many pixels on both sides, in radians; 0 where the line is too short for it.
    fn turn(&self, index: usize, reach: f64) -> f64 {
        let here = self.points[index];
        let s = self.sums[index];
        match (self.at(s - reach), self.at(s + reach)) {
            (Some(a), Some(b)) if a != here && b != here => (here - a).angle_to(b - here).abs(),
            _ => 0.0,
        }
    }

    /// Where the straight sides of a corner meet, if that is near.
    fn meeting(&self, index: usize) -> Option<DVec2> {
        let (here, s) = (self.points[index], self.sums[index]);
        let side = |sign: f64| {
            let [a, b] = SIDE.map(|reach| self.at(s + sign * reach));
            let (a, b) = (a?, b?);
            let middle = self.at(s + sign * 0.5 * (SIDE[0] + SIDE[1]))?;
            let way = (b - a).normalize_or_zero();
            // Of a bent side the part next to the corner is not known well enough.
            (way.perp_dot(middle - a).abs() < 0.04).then_some((a, way))
        };
        let ((p, v), (q, w)) = (side(-1.0)?, side(1.0)?);
        let det = v.perp_dot(w);
        if det.abs() < 0.3 {
            return None;
        }
        let meeting = p + v * ((q - p).perp_dot(w) / det);
        (meeting.distance(here) < NEARBY).then_some(meeting)
    }
}

/// Indices of the corners of a line, rising, and where each is exactly. The ends of an open line are none.
pub(crate) fn corners(points: &[DVec2], closed: bool) -> Vec<(usize, DVec2)> {
    if points.len() < 3 {
        return Vec::new();
    }
    let way = Way::new(points, closed);
    let inner = if closed { 0..points.len() } else { 1..points.len() - 1 };
    let is_corner = |&(i, near): &(usize, f64)| {
        // The last stretch before an end of the line is too short for the longer look.
        let left = if closed { FAR } else { FAR.min(way.sums[i]).min(way.total - way.sums[i]) };
        let far = way.turn(i, left.max(NEAR));
        SHARP.iter().any(|&(turn, share)| near > turn && near > share * far)
    };
    let mut sharp: Vec<(usize, f64)> = inner.map(|i| (i, way.turn(i, NEAR))).filter(is_corner).collect();
    sharp.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut kept: Vec<usize> = Vec::new();
    for (index, _) in sharp {
        let is_apart = |&other: &usize| {
            let apart = (way.sums[index] - way.sums[other]).abs();
            apart.min(if closed { way.total - apart } else { apart }) >= APART
        };
        if kept.iter().all(is_apart) {
            kept.push(index);
        }
    }
    kept.sort_unstable();
    kept.into_iter().map(|i| (i, way.meeting(i).unwrap_or(points[i]))).collect()
}
