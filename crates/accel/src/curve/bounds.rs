//! Boxes around curve segments: the exact extremes of `c(s) -+ r(s)` along each axis, a cubic each, rounded outwards.
//!
//! One box around a long segment that runs askew is mostly empty. Trees hold such a segment several times, in boxes around
//! its parts, each of which stands for the whole: a ray that enters one is tested against the segment.
use durer_core::math::{Bounds3, Point3};

use super::{
    Curves,
    bernstein::{Bernstein, Cubic},
};
use crate::slab::{extent, grown};

/// Most parts of a segment, each half as long as those of half as many.
const PARTS_MAX: u32 = 4;
/// Parts are halved while that leaves less than this part of the area of their boxes, which is what they cost.
const WORTH: f32 = 0.7;

/// The smallest box that `f32` can make around all balls of the segment; infinite where they pass the range of f32.
pub(super) fn bounds(curves: &Curves, segment: u32) -> Bounds3 {
    Segment::new(curves, segment).bounds(0.0, 1.0)
}

/// Boxes around the parts of a segment in `own`, its box with the slack of box tests, that they have too: only that box
/// if it is not much larger than those.
pub(crate) fn parts(curves: &Curves, segment: u32, own: &Bounds3) -> Vec<Bounds3> {
    let cubics = Segment::new(curves, segment);
    let area = |boxes: &[Bounds3]| boxes.iter().map(Bounds3::half_area).sum::<f32>();
    let mut best = vec![*own];
    let mut count = 1;
    while count < PARTS_MAX {
        count *= 2;
        let at = |i: u32| f64::from(i) / f64::from(count);
        // A part's hits are rounded like those of the whole.
        let part = |i: u32| grown(&cubics.bounds(at(i), at(i + 1)), extent(own));
        let within = |b: Bounds3| Bounds3 {
            min: b.min.max(own.min).min(own.max),
            max: b.max.min(own.max).max(own.min),
        };
        let boxes: Vec<Bounds3> = (0..count).map(|i| within(part(i))).collect();
        if area(&boxes) >= WORTH * area(&best) {
            break;
        }
        best = boxes;
    }
    best
}

/// A segment's cubics.
struct Segment {
    points: [Cubic; 3],
    r: Cubic,
    /// Bound on roundings.
    pad: f64,
}

impl Segment {
    fn new(curves: &Curves, segment: u32) -> Self {
        let r = Bernstein(curves.bezier_radii(segment));
        let mut size = 0f64;
        let points = curves.bezier_points(segment, |p| {
            size = size.max(p.abs().max_component().into());
            p.to_f64()
        });
        // Roundings of conversion and evaluation, and of the extreme's place, which counts only squared.
        Self { points: points.map(Bernstein), r, pad: 32.0 * f64::EPSILON * (size + r.max()) }
    }

    /// The box around all balls between two parameters.
    fn bounds(&self, from: f64, to: f64) -> Bounds3 {
        let of = |c: &Cubic| if (from, to) == (0.0, 1.0) { *c } else { c.part(from, to) };
        let r = of(&self.r);
        let [x, y, z] = self.points.map(|c| {
            let c = of(&c);
            let (lower, upper) = (c.plus(-1.0, &r), c.plus(1.0, &r));
            let (min, max) = (least(&lower) - self.pad, -least(&upper.negated()) + self.pad);
            ((min as f32).next_down(), (max as f32).next_up())
        });
        Bounds3::new(Point3::new(x.0, y.0, z.0), Point3::new(x.1, y.1, z.1))
    }
}

/// The least value on `[0, 1]`.
fn least(c: &Cubic) -> f64 {
    let slope: Bernstein<3> = c.derivative();
    let turns = slope.roots();
    turns.as_slice().iter().copied().chain([0.0, 1.0]).fold(f64::INFINITY, |a, s| a.min(c.at(s)))
}
