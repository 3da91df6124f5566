//! Where segments of a chain meet: what of one lies inside the next is no surface.
//!
//! Each segment ends in half a ball, which its neighbour swallows. From outside it is never seen, because the first way
//! into the union of both is not strictly inside either; a ray within the chain would meet it. Both neighbours apply the
//! same rule, and by less than rounding inside does not count, so nothing opens between them.
use durer_core::glam::DVec3;

use super::{Curves, bernstein::Bernstein, ray_frame::RayFrame, round::Spans};

/// Depth below the neighbour's surface, as a fraction of the radius, from which on a place counts as inside.
const DEPTH: f64 = 1e-6;
/// How far from the joint the neighbour is asked, in radii: bends of less than 120 degrees overlap no further.
const REACH: f64 = 2.0;

/// Whether the place at distance `z` on the ray, where it meets `segment`, lies inside a segment that continues it: one
/// that comes next or before in the list of segments, and begins or ends with the same ball.
pub(super) fn is_inside_neighbour(curves: &Curves, segment: u32, frame: &RayFrame, z: f64) -> bool {
    let before = segment.checked_sub(1).map(|b| (b, b, segment));
    let after = (segment as usize + 1 < curves.segments.len()).then(|| (segment + 1, segment, segment + 1));
    [before, after].into_iter().flatten().any(|(neighbour, first, second)| {
        let Some((center, r)) = joint(curves, first, second, frame) else { return false };
        let near = (center - DVec3::Z * z).length_squared() <= (REACH * r) * (REACH * r);
        near && contains(curves, neighbour, frame, z)
    })
}

/// The ball with which `first` ends and `second` begins, in the frame.
fn joint(curves: &Curves, first: u32, second: u32, frame: &RayFrame) -> Option<(DVec3, f64)> {
    let place = |segment: u32| curves.bezier_points(segment, |p| frame.project(p));
    let (a, b) = (place(first), place(second));
    let (r_a, r_b) = (curves.bezier_radii(first), curves.bezier_radii(second));
    let same = (0..3).all(|axis| a[axis][3] == b[axis][0]) && r_a[3] == r_b[0];
    same.then(|| (DVec3::new(b[0][0], b[1][0], b[2][0]), r_b[0]))
}

/// Whether a ball of the segment holds the place at distance `z`, by more than rounding.
fn contains(curves: &Curves, segment: u32, frame: &RayFrame, z: f64) -> bool {
    let mut reach = z.abs();
    let to_center = curves.bezier_points(segment, |p| {
        let projected = frame.project(p);
        reach = reach.max(projected.abs().max_element());
        projected - DVec3::Z * z
    });
    let r = Bernstein(curves.bezier_radii(segment));
    let most = r.max();
    let skin = 2.0 * most * (DEPTH * most + RayFrame::own_error(reach));
    let square = |c: &Bernstein<4>| -> Bernstein<7> { c.times(c) };
    let [x, y, z] = to_center.map(|c| square(&Bernstein(c)));
    let room = square(&r).plus(-1.0, &x).plus(-1.0, &y).plus(-1.0, &z).plus(-1.0, &Bernstein([skin; 7]));
    room.max() > 0.0 && !Spans::new(&room, &r).as_slice().is_empty()
}
