//! Cubic Bezier curves through points.
//!
//! The method of Philip J. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems, 1990: with
//! the directions at both ends fixed, least squares give the lengths of the two handles for parameters that begin in
//! proportion to the way along the points and are then moved to the nearest points of the curve by Newton's method; what does
//! not fit is halved where it is worst.
use durer_core::glam::DVec2;

/// Steps that move the parameters.
const STEPS: usize = 6;
/// Half of the way over which a direction is taken, in pixels.
const REACH: f64 = 1.5;

/// A piece of a drawn line; it begins where the one before it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Straight to a point.
    Line(DVec2),
    /// A cubic Bezier curve: two handles and the end.
    Curve([DVec2; 3]),
}

impl Piece {
    /// Where it ends.
    pub fn end(&self) -> DVec2 {
        match self {
            Self::Line(end) | Self::Curve([_, _, end]) => *end,
        }
    }
    /// The point at parameter `u` from 0 to 1 of a piece that begins at `start`.
    pub fn at(&self, start: DVec2, u: f64) -> DVec2 {
        match *self {
            Self::Line(end) => start.lerp(end, u),
            Self::Curve([a, b, end]) => cubic(&[start, a, b, end], u),
        }
    }
}

fn cubic(p: &[DVec2; 4], u: f64) -> DVec2 {
    let v = 1.0 - u;
    p[0] * (v * v * v) + p[1] * (3.0 * v * v * u) + p[2] * (3.0 * v * u * u) + p[3] * (u * u * u)
}

/// First and second derivative.
fn derivatives(p: &[DVec2; 4], u: f64) -> [DVec2; 2] {
    let v = 1.0 - u;
    let d = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
    let first = (d[0] * (v * v) + d[1] * (2.0 * v * u) + d[2] * (u * u)) * 3.0;
    [first, ((d[1] - d[0]) * v + (d[2] - d[1]) * u) * 6.0]
}

/// The direction of a line at one of its points, from those within [`REACH`] on the given sides; of unit length, or zero if
/// there is none.
pub(crate) fn direction(points: &[DVec2], index: usize, before: bool, after: bool) -> DVec2 {
    let here = points[index];
    let is_far = |p: &&DVec2| p.distance(here) >= REACH;
    let back = || points[..index].iter().rev().find(is_far).or(points.first());
    let ahead = || points[index + 1..].iter().find(is_far).or(points.last());
    let from = if before { back() } else { None }.copied().unwrap_or(here);
    let to = if after { ahead() } else { None }.copied().unwrap_or(here);
    (to - from).normalize_or_zero()
}

/// The direction of a smooth line at its first point: that of the parabola through it and two more.
pub(crate) fn departure(points: &[DVec2]) -> DVec2 {
    let start = points[0];
    let at = |reach: f64| points.iter().find(|p| p.distance(start) >= reach);
    match (at(REACH), at(2.0 * REACH)) {
        (Some(&near), Some(&far)) => {
            let (s, t) = (near.distance(start), far.distance(start));
            let (a, b) = ((near - start) / s, (far - start) / t);
            ((a * t - b * s) / (t - s)).normalize_or_zero()
        }
        _ => direction(points, 0, false, true),
    }
}

/// Curves through points that turn nowhere sharply, within `tolerance`, which begin and end in the given directions of unit
/// length, both along the line.
pub(crate) fn fit(points: &[DVec2], tangents: [DVec2; 2], tolerance: f64, into: &mut Vec<Piece>) {
    let (Some(&start), Some(&end)) = (points.first(), points.last()) else { return };
    if points.len() < 2 {
        return;
    }
    if is_straight(points, tolerance.min(0.1)) {
        into.push(Piece::Line(end));
        return;
    }
    let mut parameters = along(points);
    let mut worst = points.len() / 2;
    for _ in 0..STEPS {
        let curve = handles(points, &parameters, tangents);
        let misses = points.iter().zip(&parameters).map(|(p, &u)| cubic(&curve, u).distance(*p));
        let largest = misses.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, miss)) = largest {
            if miss <= tolerance {
                into.push(Piece::Curve([curve[1], curve[2], end]));
                return;
            }
            worst = index;
            if miss > 16.0 * tolerance && miss > 1.0 {
                break;
            }
        }
        parameters = points.iter().zip(&parameters).map(|(p, &u)| nearer(&curve, *p, u)).collect();
    }
    let split = worst.clamp(1, points.len() - 2);
    if points.len() < 3 {
        let third = start.distance(end) / 3.0;
        into.push(Piece::Curve([start + tangents[0] * third, end - tangents[1] * third, end]));
        return;
    }
    let middle = direction(points, split, true, true);
    fit(&points[..=split], [tangents[0], middle], tolerance, into);
    fit(&points[split..], [middle, tangents[1]], tolerance, into);
}

/// Whether all points lie within `tolerance` of the way between the ends.
pub(crate) fn is_straight(points: &[DVec2], tolerance: f64) -> bool {
    let (start, end) = (points[0], points[points.len() - 1]);
    let way = (end - start).normalize_or_zero();
    let length = start.distance(end);
    way != DVec2::ZERO
        && points.iter().all(|p| {
            let to = *p - start;
            way.perp_dot(to).abs() <= tolerance && (-tolerance..=length + tolerance).contains(&way.dot(to))
        })
}

/// Parameters from 0 to 1 in proportion to the way along the points.
fn along(points: &[DVec2]) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = points.windows(2).map(|w| w[0].distance(w[1]));
    let mut parameters = vec![0.0];
    parameters.extend(steps.map(|step| {
        sum += step;
        sum
    }));
    parameters.iter().map(|s| s / sum.max(f64::MIN_POSITIVE)).collect()
}

/// The curve of least squares with the given directions at its ends.
fn handles(points: &[DVec2], parameters: &[f64], [first, last]: [DVec2; 2]) -> [DVec2; 4] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut c, mut x) = ([[0.0f64; 2]; 2], [0.0f64; 2]);
    for (p, &u) in points.iter().zip(parameters) {
        let v = 1.0 - u;
        let a = [first * (3.0 * v * v * u), -last * (3.0 * v * u * u)];
        let rest = *p - start * (v * v * (v + 3.0 * u)) - end * (u * u * (u + 3.0 * v));
        for i in 0..2 {
            for j in 0..2 {
                c[i][j] += a[i].dot(a[j]);
            }
            x[i] += a[i].dot(rest);
        }
    }
    let determinant = c[0][0] * c[1][1] - c[0][1] * c[1][0];
    let lengths =
        [(x[0] * c[1][1] - x[1] * c[0][1]) / determinant, (c[0][0] * x[1] - c[1][0] * x[0]) / determinant];
    // Handles that point backwards, or far beyond the other end, make loops: a third of the way is Schneider's remedy.
    let way = start.distance(end);
    let is_sound = |l: f64| l > 1e-3 * way && l < 3.0 * way;
    let [a, b] = if lengths.into_iter().all(is_sound) { lengths } else { [way / 3.0; 2] };
    [start, start + first * a, end - last * b, end]
}

/// A parameter of a point of the curve nearer to `p` than that at `u`: a step of Newton's method.
fn nearer(curve: &[DVec2; 4], p: DVec2, u: f64) -> f64 {
    let off = cubic(curve, u) - p;
    let [first, second] = derivatives(curve, u);
    let slope = first.dot(first) + off.dot(second);
    let step = if slope == 0.0 { 0.0 } else { off.dot(first) / slope };
    (u - step).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_of_a_circle_is_one_curve() {
        let points: Vec<DVec2> = (0..=60)
            .map(|i| DVec2::from_angle(f64::from(i) / 60.0 * std::f64::consts::FRAC_PI_2) * 40.0)
            .collect();
        let mut pieces = Vec::new();
        fit(&points, [DVec2::Y, DVec2::NEG_X], 0.02, &mut pieces);
        assert_eq!(pieces.len(), 1, "{pieces:?}");
        for i in 0..=100 {
            let p = pieces[0].at(points[0], f64::from(i) / 100.0);
            assert!((p.length() - 40.0).abs() < 0.02, "{p}");
        }
    }

    #[test]
    fn points_on_a_line_are_a_line() {
        let points: Vec<DVec2> = (0..20).map(|i| DVec2::new(f64::from(i), 0.5 * f64::from(i))).collect();
        let mut pieces = Vec::new();
        fit(&points, [DVec2::X; 2], 0.05, &mut pieces);
        assert_eq!(pieces, [Piece::Line(points[19])]);
    }

    #[test]
    fn what_one_curve_cannot_do_several_do() {
        let wave = |x: f64| DVec2::new(x, 8.0 * (x / 6.0).sin());
        let points: Vec<DVec2> = (0..400).map(|i| wave(f64::from(i) * 0.25)).collect();
        let mut pieces = Vec::new();
        fit(&points, [departure(&points), direction(&points, 399, true, false)], 0.05, &mut pieces);
        assert!((5..60).contains(&pieces.len()), "{}", pieces.len());
        let mut start = points[0];
        for piece in &pieces {
            for i in 0..=20 {
                let p = piece.at(start, f64::from(i) / 20.0);
                // The wave is at most 54 degrees steep.
                assert!((p.y - wave(p.x).y).abs() < 0.1, "{p}");
            }
            start = piece.end();
        }
    }
}
