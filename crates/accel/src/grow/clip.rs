//! A triangle cut by an axis-aligned plane: the boxes of its two parts, never too small.
use durer_core::math::{Bounds3, Point3};

/// The boxes of the parts of a triangle inside `within` with coordinates of `axis` up to `at` and from `at` on. A part
/// on the plane belongs to both sides. A side without any part is empty.
///
/// Where an edge meets the plane is computed in f64 and moved outwards by more than its error, so the boxes contain the
/// parts; on `axis` they end at `at` exactly.
pub(crate) fn clip(triangle: &[Point3; 3], within: &Bounds3, axis: usize, at: f32) -> [Bounds3; 2] {
    let mut parts = [Bounds3::EMPTY; 2];
    for (i, a) in triangle.iter().enumerate() {
        let b = &triangle[(i + 1) % 3];
        if a[axis] <= at {
            parts[0] = parts[0].with(*a);
        }
        if a[axis] >= at {
            parts[1] = parts[1].with(*a);
        }
        if (a[axis] < at && at < b[axis]) || (b[axis] < at && at < a[axis]) {
            let meeting = meeting(a, b, axis, at);
            parts = [parts[0].union(meeting), parts[1].union(meeting)];
        }
    }
    let common = |part: Bounds3| {
        let common = Bounds3 { min: part.min.max(within.min), max: part.max.min(within.max) };
        if common.is_empty() { Bounds3::EMPTY } else { common }
    };
    [common(parts[0]), common(parts[1])]
}

/// A box that contains the point where an edge meets the plane.
fn meeting(a: &Point3, b: &Point3, axis: usize, at: f32) -> Bounds3 {
    let (from, to) = (f64::from(a[axis]), f64::from(b[axis]));
    let t = (f64::from(at) - from) / (to - from);
    let range = |i: usize| {
        if i == axis {
            return (at, at);
        }
        let (from, to) = (f64::from(a[i]), f64::from(b[i]));
        let value = from + (to - from) * t;
        // Fewer than 8 roundings of numbers no larger than this sum.
        let error = (from.abs() + to.abs()) * (4.0 * f64::EPSILON);
        (
            ((value - error) as f32).next_down().max(a[i].min(b[i])),
            ((value + error) as f32).next_up().min(a[i].max(b[i])),
        )
    };
    let (x, y, z) = (range(0), range(1), range(2));
    Bounds3 { min: Point3::new(x.0, y.0, z.0), max: Point3::new(x.1, y.1, z.1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_cut_along_an_edge_between_vertices() {
        let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 2.0]].map(Point3::from);
        let [left, right] = clip(&triangle, &Bounds3::UNBOUNDED, 0, 1.0);
        assert_eq!(left, Bounds3::new(Point3::ZERO, Point3::new(1.0, 4.0, 2.0)));
        let near = |a: f32, b: f32| b <= a && a <= b + 1e-6;
        assert_eq!((right.min, right.max.x), (Point3::new(1.0, 0.0, 0.0), 4.0));
        assert!(near(right.max.y, 3.0) && near(right.max.z, 1.5), "{right:?}");
    }

    #[test]
    fn planes_outside_and_on_vertices_leave_it_whole() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
        let whole = Bounds3::around(triangle);
        let everywhere = Bounds3::UNBOUNDED;
        assert_eq!(clip(&triangle, &everywhere, 0, 2.0), [whole, Bounds3::EMPTY]);
        assert_eq!(clip(&triangle, &everywhere, 0, -2.0), [Bounds3::EMPTY, whole]);
        let edge = Bounds3::new(Point3::ZERO, Point3::new(0.0, 1.0, 0.0));
        assert_eq!(clip(&triangle, &everywhere, 0, 0.0), [edge, whole]);
        assert_eq!(clip(&triangle, &everywhere, 2, 0.0), [whole, whole], "in the plane");
    }

    #[test]
    fn nothing_reaches_out_of_the_box_it_is_within() {
        let triangle = [[-5.0, -5.0, 0.0], [5.0, 0.0, 1.0], [0.0, 5.0, 2.0]].map(Point3::from);
        let within = Bounds3::new(Point3::splat(-1.0), Point3::splat(1.0));
        for (axis, at) in [(0, 0.5), (1, -0.3), (2, 0.9)] {
            for part in clip(&triangle, &within, axis, at) {
                assert_eq!(within.union(part), within);
            }
        }
        let beside = Bounds3::new(Point3::splat(7.0), Point3::splat(8.0));
        assert_eq!(clip(&triangle, &beside, 0, 7.5), [Bounds3::EMPTY; 2]);
    }

    #[test]
    fn every_point_lies_in_a_part_at_any_scale() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        };
        for (scale, round) in [1e-30, 1.0, 1e30].into_iter().flat_map(|s| (0..300).map(move |r| (s, r))) {
            let triangle: [Point3; 3] = std::array::from_fn(|_| {
                Point3::new(random() * scale, random() * scale * 1e-3, random() * scale)
            });
            let (axis, at) = (round % 3, random() * scale);
            let parts = clip(&triangle, &Bounds3::UNBOUNDED, axis, at);
            for (i, j) in (0..=20).flat_map(|i| (0..=20 - i).map(move |j| (i, j))) {
                let weights = [f64::from(i), f64::from(j), f64::from(20 - i - j)].map(|w| w / 20.0);
                let point = (0..3).fold(Point3::ZERO.to_f64(), |p, k| p + triangle[k].to_f64() * weights[k]);
                let in_part = |b: &Bounds3| {
                    (0..3).all(|a| {
                        f64::from(b.min[a]) - 1e-15 * f64::from(scale) <= point[a]
                            && point[a] <= f64::from(b.max[a]) + 1e-15 * f64::from(scale)
                    })
                };
                assert!(parts.iter().any(in_part), "{triangle:?} {axis} {at}: {point} not in {parts:?}");
            }
        }
    }
}
