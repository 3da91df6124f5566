//! Trails to lines: what is too short or too faint is left out, the rest becomes curves.
use std::f64::consts::PI;

use durer_core::glam::DVec2;

use crate::{
    Kind, Piece,
    bezier::{departure, direction, fit},
    corner::corners,
    strand::length,
    trail::Trail,
};

/// Loose outlines shorter than this are specks, in pixels.
const SPECK: f64 = 4.0;
/// Loose folds shorter than this are edges of single triangles, in pixels.
const CHIP: f64 = 8.0;
/// A loose outline whose jump in depth nowhere reaches so many widths of a pixel is a ripple.
const RIPPLE: f32 = 2.0;
/// A loose fold that turns sharply more often than once in so many pixels follows the edges of triangles.
const ZIGZAG: f64 = 12.0;
/// Share of a fold that must be as sharp as folds are drawn.
const SHARP: f64 = 0.5;
/// Points of a line nearer together than this say more of rounding than of the line, in pixels.
const SPACING: f64 = 0.35;

/// A line of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Why it is drawn.
    pub kind: Kind,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// Where it begins, in pixels from the picture's upper left corner.
    pub start: DVec2,
    /// The way on from there.
    pub pieces: Vec<Piece>,
}

impl Line {
    /// Points along the line, each piece in `steps`.
    pub fn points(&self, steps: u32) -> Vec<DVec2> {
        let mut points = vec![self.start];
        let mut start = self.start;
        for piece in &self.pieces {
            points.extend((1..=steps).map(|i| piece.at(start, f64::from(i) / f64::from(steps))));
            start = piece.end();
        }
        points
    }
}

/// What makes lines of trails.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    /// How far a curve may pass by its points, in pixels.
    pub(crate) tolerance: f64,
    /// Angle of a fold that is drawn, in radians; parts of its line may be less sharp.
    pub(crate) crease: f32,
}

impl Pen {
    /// The line of a trail; `None` if it is not worth drawing.
    pub(crate) fn line(&self, trail: &Trail) -> Option<Line> {
        if trail.stations.len() < 2 || self.is_noise(trail) {
            return None;
        }
        let points: Vec<DVec2> = trail.stations.iter().map(|s| s.at).collect();
        let corners = corners(&points, trail.closed);
        let is_zigzag = corners.len() > 2 && length(&trail.stations) < ZIGZAG * corners.len() as f64;
        if trail.kind == Kind::Crease && trail.is_loose && is_zigzag {
            return None;
        }
        let mut line = Line { kind: trail.kind, closed: trail.closed, start: points[0], pieces: Vec::new() };
        if !trail.closed {
            let inner = corners.iter().copied();
            let ends = [(0, points[0]), (points.len() - 1, points[points.len() - 1])];
            let all: Vec<_> =
                ends[..1].iter().copied().chain(inner).chain(ends[1..].iter().copied()).collect();
            for pair in all.windows(2) {
                self.stretch(&points[pair[0].0..=pair[1].0], [pair[0].1, pair[1].1], &mut line.pieces);
            }
        } else if let Some(&(first, start)) = corners.first() {
            line.start = start;
            let mut round = points.clone();
            round.rotate_left(first);
            round.push(round[0]);
            let ends = corners.iter().map(|(i, at)| (i - first, *at)).chain([(points.len(), start)]);
            for pair in ends.collect::<Vec<_>>().windows(2) {
                self.stretch(&round[pair[0].0..=pair[1].0], [pair[0].1, pair[1].1], &mut line.pieces);
            }
        } else {
            self.ring(&points, &mut line);
        }
        (!line.pieces.is_empty()).then_some(line)
    }

    /// A line through points that turn nowhere sharply.
    pub(crate) fn stroke(&self, kind: Kind, points: &[DVec2]) -> Option<Line> {
        let (&start, &end) = (points.first()?, points.last()?);
        let mut line = Line { kind, closed: false, start, pieces: Vec::new() };
        self.stretch(points, [start, end], &mut line.pieces);
        (!line.pieces.is_empty()).then_some(line)
    }

    /// Whether a trail comes of what surfaces are made of rather than of their form.
    fn is_noise(&self, trail: &Trail) -> bool {
        let stations = &trail.stations;
        let share = |is: &dyn Fn(f32) -> bool| {
            let some = stations.iter().filter(|s| s.change.kind == trail.kind);
            let (met, all) =
                some.fold((0, 0), |(met, all), s| (met + usize::from(is(s.change.strength)), all + 1));
            met as f64 / f64::from(all.max(1u32))
        };
        let loose_below = |least: f64| trail.is_loose && length(stations) < least;
        match trail.kind {
            Kind::Silhouette => loose_below(SPECK) || trail.is_loose && share(&|jump| jump > RIPPLE) == 0.0,
            Kind::Boundary | Kind::Hatch => loose_below(SPECK),
            Kind::Crease => loose_below(CHIP) || share(&|turn| turn >= self.crease) < SHARP,
        }
    }

    /// Curves through points between two corners or ends.
    fn stretch(&self, points: &[DVec2], [start, end]: [DVec2; 2], into: &mut Vec<Piece>) {
        let mut points = points.to_vec();
        let last = points.len() - 1;
        (points[0], points[last]) = (start, end);
        let points = thinned(&points);
        let backwards: Vec<DVec2> = points.iter().rev().copied().collect();
        fit(&points, [departure(&points), -departure(&backwards)], self.tolerance, into);
    }

    /// Curves around a line without corners.
    fn ring(&self, points: &[DVec2], line: &mut Line) {
        let mut points = thinned(points);
        if points.len() < 4 {
            return;
        }
        // The direction at the seam is that of both sides.
        let half = points.len() / 2;
        let mut turned = points.clone();
        turned.rotate_left(half);
        let tangent = direction(&turned, points.len() - half, true, true);
        points.push(points[0]);
        line.start = points[0];
        fit(&points, [tangent; 2], self.tolerance, &mut line.pieces);
    }
}

/// Without points that lie close to the one before; ends stay.
fn thinned(points: &[DVec2]) -> Vec<DVec2> {
    let (start, end) = (points[0], points[points.len() - 1]);
    let mut kept = vec![start];
    for p in &points[1..points.len() - 1] {
        let last = kept[kept.len() - 1];
        if p.distance(last) >= SPACING && p.distance(end) >= SPACING {
            kept.push(*p);
        }
    }
    kept.push(end);
    kept
}

/// Degrees in radians.
pub(crate) fn radians(degrees: f64) -> f64 {
    degrees * PI / 180.0
}
