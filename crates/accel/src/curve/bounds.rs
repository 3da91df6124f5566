//! Boxes around curve segments: the exact extremes of `c(s) -+ r(s)` along each axis, a cubic each, rounded outwards.
use durer_core::math::{Bounds3, Point3};

use super::{
    Curves,
    bernstein::{Bernstein, Cubic},
};

/// The smallest box that `f32` can make around all balls of the segment; infinite where they pass the range of f32.
pub(super) fn bounds(curves: &Curves, segment: u32) -> Bounds3 {
    let r = Bernstein(curves.bezier_radii(segment));
    let mut size = 0f64;
    let points = curves.bezier_points(segment, |p| {
        size = size.max(p.abs().max_component().into());
        p.to_f64()
    });
    let axes = points.map(|c| {
        let c = Bernstein(c);
        let (lower, upper) = (c.plus(-1.0, &r), c.plus(1.0, &r));
        // Roundings of conversion and evaluation, and of the extreme's place, which counts only squared.
        let pad = 32.0 * f64::EPSILON * (size + r.max());
        let (min, max) = (least(&lower) - pad, -least(&upper.negated()) + pad);
        ((min as f32).next_down(), (max as f32).next_up())
    });
    let [x, y, z] = axes;
    Bounds3::new(Point3::new(x.0, y.0, z.0), Point3::new(x.1, y.1, z.1))
}

/// The least value on `[0, 1]`.
fn least(c: &Cubic) -> f64 {
    let slope: Bernstein<3> = c.derivative();
    let turns = slope.roots();
    turns.as_slice().iter().copied().chain([0.0, 1.0]).fold(f64::INFINITY, |a, s| a.min(c.at(s)))
}
