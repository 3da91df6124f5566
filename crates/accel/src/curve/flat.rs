//! Flat curves: a ribbon that turns its face to every ray.
//!
//! In the frame of the ray the ribbon is the union of the lines across the projected curve: at `s` perpendicular to
//! `(x', y')`, to both sides as long as the radius. The ray, at `x = y = 0`, lies on such a line where
//! `h = x x' + y y' = 0`, a polynomial of degree 5 whose roots are all found, and meets the curve's centre at `t = z(s)`
//! if `x^2 + y^2 <= r^2` there. This is the limit that the recursive halving of Physically Based Rendering, 4th
//! edition, section 6.7, approaches.
//!
//! A ribbon that turns cannot know where a ray began on it. As in Embree, hits that are no more than two radii away from
//! the ray's origin do not count.
use durer_core::glam::DVec3;

use super::{CurveHit, bernstein::Bernstein, ray_frame::RayFrame, strand::Strand};

/// Hits nearer to the origin than this many radii are taken for the ray's own start.
const OWN_RADII: f64 = 2.0;

/// The nearest meeting with a parameter in `[t_min, t_max]`.
pub(super) fn intersect(strand: &Strand, frame: &RayFrame, t_max: f32) -> Option<CurveHit> {
    let slope = |c: &Bernstein<4>| -> Bernstein<3> { c.derivative() };
    let h_x: Bernstein<6> = strand.x.times(&slope(&strand.x));
    let h_y: Bernstein<6> = strand.y.times(&slope(&strand.y));
    let roots = h_x.plus(1.0, &h_y).roots();
    let at_ends = [0.0, 1.0].into_iter().filter(|s| is_on_edge(strand, *s));
    let (t, s) = roots
        .as_slice()
        .iter()
        .copied()
        .chain(at_ends)
        .filter_map(|s| meeting(strand, frame, s).map(|t| (t, s)))
        .reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    (t <= t_max).then(|| {
        let center = strand.center(s);
        let from_center = DVec3::new(-center.x, -center.y, 0.0);
        let heading = strand.heading(s);
        // What of the way back is perpendicular to the curve: the lines across make a surface with that normal.
        let n = heading * (heading.z / heading.length_squared()) - DVec3::Z;
        let n_g = frame.turn_back(n.try_normalize().unwrap_or(-DVec3::Z));
        CurveHit { t, u: strand.along(s) as f32, v: strand.side(s, from_center, strand.r.at(s)), n_g }
    })
}

/// Whether the ray meets the line across the end at `s` within rounding. A root just outside `[0, 1]` for this segment
/// may by rounding lie just outside for its neighbour too; this closes the seam.
fn is_on_edge(strand: &Strand, s: f64) -> bool {
    let (center, heading) = (strand.center(s), strand.heading(s));
    let length = heading.truncate().length();
    length > 0.0 && (center.x * heading.x + center.y * heading.y).abs() <= strand.own_error * length
}

/// The parameter at which the ray meets the line across the curve at `s`, if that is long enough.
fn meeting(strand: &Strand, frame: &RayFrame, s: f64) -> Option<f32> {
    let (center, r) = (strand.center(s), strand.r.at(s));
    let inside = r > 0.0 && center.x * center.x + center.y * center.y <= r * r;
    let unclear = strand.own_error + frame.start_error() + OWN_RADII * r;
    if inside { frame.t_ahead(center.z, unclear) } else { None }
}
