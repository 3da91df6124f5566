//! Polygons to triangles by clipping ears (Meisters 1975), in the plane that the polygon is nearest to.
//!
//! Newell's normal gives the plane's side; the axis along which it is longest is dropped, which changes no orientation
//! test and rounds nothing. A corner is an ear if it turns left and no corner that does not lies in its triangle; those
//! are looked up in the cells of a grid that the triangle touches. Corners wait in a queue, to whose end the neighbours
//! of an ear go: so ears are found in a few rounds, also where one uncovers the next, as in spirals. Holes that are tied
//! to the outline by a pair of coincident edges come out right. Polygons that cross themselves give some triangles
//! between their corners. The number of tests is limited: beyond it the rest becomes a fan.
use std::collections::VecDeque;

use durer_core::glam::{DVec2, DVec3};

use super::polygon_grid::Grid;

/// Tests of a corner against an ear that a piece of a file may cost at least; see [`Triangulator::new`].
const FREE_TESTS: u64 = 1 << 28;
/// Tests for each corner.
const TESTS: u64 = 512;

/// Splits polygons; keeps its memory between them.
#[derive(Debug)]
pub(crate) struct Triangulator {
    tests: u64,
    /// Polygons of which a part became a fan because there were no tests left.
    pub(crate) hasty: usize,
    flat: Vec<DVec2>,
    before: Vec<usize>,
    after: Vec<usize>,
    /// Corners that do not turn left.
    reflex: Grid,
    queue: VecDeque<usize>,
    /// How often each corner stands in the queue: the last time counts. None for those that are clipped.
    waiting: Vec<Option<u32>>,
}

impl Triangulator {
    /// For polygons of `corners` corners in all: what is tested grows with their number, so that no file takes long.
    pub(crate) fn new(corners: usize) -> Self {
        Self {
            tests: FREE_TESTS + TESTS * corners as u64,
            hasty: 0,
            flat: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            reflex: Grid::default(),
            queue: VecDeque::new(),
            waiting: Vec::new(),
        }
    }

    /// Appends the triangles between `corners`, as indices of corners, turning the same way as they do. One that is
    /// convex gives a fan around corner 0; a quadrangle is split along the diagonal that lies inside.
    pub(crate) fn split(&mut self, corners: &[DVec3], out: &mut Vec<[usize; 3]>) {
        match *corners {
            [_, _, _] => out.push([0, 1, 2]),
            [a, b, c, d] => {
                let n = newell(corners);
                let left = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(n) > 0.0;
                let first = left(a, b, c) && left(a, c, d);
                if !first && left(b, c, d) && left(b, d, a) {
                    out.extend([[1, 2, 3], [1, 3, 0]]);
                } else {
                    out.extend([[0, 1, 2], [0, 2, 3]]);
                }
            }
            [_, _, ..] if corners.len() > 4 => self.clip(corners, out),
            _ => {}
        }
    }

    fn clip(&mut self, corners: &[DVec3], out: &mut Vec<[usize; 3]>) {
        let count = corners.len();
        flatten(corners, &mut self.flat);
        self.before = (0..count).map(|i| if i == 0 { count - 1 } else { i - 1 }).collect();
        self.after = (0..count).map(|i| if i + 1 == count { 0 } else { i + 1 }).collect();
        let reflex: Vec<usize> = (0..count).filter(|&i| self.turn(i) <= 0.0).collect();
        if reflex.is_empty() {
            out.extend((2..count).map(|i| [0, i - 1, i]));
            return;
        }
        self.reflex.fill(&self.flat, &reflex);
        self.waiting = vec![Some(1); count];
        self.queue = (0..count).collect();
        let (mut left, mut found, mut at) = (count, false, 0);
        while left > 3 && self.tests > 0 {
            let forced = match self.queue.pop_front() {
                Some(corner) if !self.is_due(corner) => continue,
                Some(corner) => {
                    at = corner;
                    false
                }
                // Ears that were covered may lie open now.
                None if found => {
                    found = false;
                    self.wait_all(at);
                    continue;
                }
                // No ear all around: the polygon crosses itself or is degenerate, so that any corner will do.
                None => true,
            };
            let (a, c) = (self.prev(at), self.next(at));
            if !forced && !self.is_ear(a, at, c) {
                continue;
            }
            found |= !forced;
            out.push([a, at, c]);
            self.cut(a, at, c);
            left -= 1;
            at = c;
        }
        if left > 3 {
            self.hasty += 1;
        }
        while left >= 3 {
            let (a, c) = (self.prev(at), self.next(at));
            out.push([a, at, c]);
            self.unlink(a, c);
            (left, at) = (left - 1, c);
        }
    }

    /// Takes `b` out from between `a` and `c`, which are looked at again after all others.
    fn cut(&mut self, a: usize, b: usize, c: usize) {
        self.unlink(a, c);
        self.tests = self.tests.saturating_sub(self.reflex.forget(b, self.point(b)));
        if let Some(waiting) = self.waiting.get_mut(b) {
            *waiting = None;
        }
        for i in [c, a] {
            if self.turn(i) > 0.0 {
                self.tests = self.tests.saturating_sub(self.reflex.forget(i, self.point(i)));
            }
            self.wait(i);
        }
    }
    fn wait(&mut self, corner: usize) {
        if let Some(Some(times)) = self.waiting.get_mut(corner) {
            *times += 1;
            self.queue.push_back(corner);
        }
    }
    /// All corners that are left, from `first` on.
    fn wait_all(&mut self, first: usize) {
        let mut at = first;
        loop {
            self.wait(at);
            at = self.next(at);
            if at == first {
                break;
            }
        }
    }
    /// True for a corner that is left and does not come again in the queue.
    fn is_due(&mut self, corner: usize) -> bool {
        match self.waiting.get_mut(corner) {
            Some(Some(times)) => {
                *times -= 1;
                *times == 0
            }
            _ => false,
        }
    }

    fn point(&self, i: usize) -> DVec2 {
        self.flat.get(i).copied().unwrap_or_default()
    }
    fn prev(&self, i: usize) -> usize {
        self.before.get(i).copied().unwrap_or_default()
    }
    fn next(&self, i: usize) -> usize {
        self.after.get(i).copied().unwrap_or_default()
    }
    fn unlink(&mut self, a: usize, c: usize) {
        if let (Some(after), Some(before)) = (self.after.get_mut(a), self.before.get_mut(c)) {
            (*after, *before) = (c, a);
        }
    }
    fn turn(&self, i: usize) -> f64 {
        area(self.point(self.prev(i)), self.point(i), self.point(self.next(i)))
    }
    fn is_ear(&mut self, a: usize, b: usize, c: usize) -> bool {
        let [p, q, r] = [a, b, c].map(|i| self.point(i));
        if area(p, q, r) <= 0.0 {
            self.tests = self.tests.saturating_sub(1);
            return false;
        }
        let flat = &self.flat;
        let inside = |i: usize| {
            let x = flat.get(i).copied().unwrap_or_default();
            let own = x == p || x == q || x == r;
            !own && area(p, q, x) >= 0.0 && area(q, r, x) >= 0.0 && area(r, p, x) >= 0.0
        };
        let (hit, tests) = self.reflex.any([p, q, r], inside);
        self.tests = self.tests.saturating_sub(1 + tests);
        !hit
    }
}

/// Twice the signed area of a triangle.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Newell's normal: twice the vector area, exact for planar polygons.
pub(crate) fn newell(corners: &[DVec3]) -> DVec3 {
    let Some(&origin) = corners.first() else {
        return DVec3::ZERO;
    };
    let pairs = corners.iter().zip(corners.iter().skip(1));
    pairs.map(|(&a, &b)| (a - origin).cross(b - origin)).sum()
}

/// Drops the axis along which the polygon is seen largest, so that it turns left.
fn flatten(corners: &[DVec3], flat: &mut Vec<DVec2>) {
    let n = newell(corners);
    let size = n.abs();
    let project = |p: &DVec3| match size {
        s if s.z >= s.x && s.z >= s.y => DVec2::new(p.x, p.y * n.z.signum()),
        s if s.x >= s.y => DVec2::new(p.y, p.z * n.x.signum()),
        _ => DVec2::new(p.z, p.x * n.y.signum()),
    };
    flat.clear();
    flat.extend(corners.iter().map(project));
}

/// What is said when [`Triangulator::hasty`] is `count`.
pub(crate) fn hasty(count: usize) -> String {
    format!("{count} concave polygons have so many corners that they were not split faithfully")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(corners: &[DVec3]) -> (Vec<[usize; 3]>, usize) {
        let mut triangulator = Triangulator::new(corners.len());
        let mut out = Vec::new();
        triangulator.split(corners, &mut out);
        (out, triangulator.hasty)
    }

    fn area_of(corners: &[DVec3], triangles: &[[usize; 3]]) -> f64 {
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| corners.get(i).copied().unwrap_or_default());
            (b - a).cross(c - a).length() / 2.0
        };
        triangles.iter().map(area).sum()
    }

    /// A strip of width 1 that winds up: `turns` turns of a square spiral.
    fn spiral(turns: usize) -> Vec<DVec3> {
        let side = |offset: f64| {
            (0..4 * turns).map(move |i| {
                let reach = 2.0 * (i / 4) as f64 + 2.0 + offset;
                let last = if i % 4 == 3 { 2.0 } else { 0.0 };
                let (x, y) = [(reach, -reach), (reach, reach), (-reach, reach), (-reach, -reach - last)]
                    .get(i % 4)
                    .copied()
                    .unwrap_or_default();
                DVec3::new(x, y, 1.0)
            })
        };
        side(0.0).chain(side(1.0).collect::<Vec<_>>().into_iter().rev()).collect()
    }

    #[test]
    fn a_hole_tied_to_the_outline_stays_open() {
        // A square of 4 by 4 with a hole of 2 by 2, from whose corner an edge leads to the outline and back.
        let outline = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)];
        let corners: Vec<DVec3> =
            outline.iter().map(|&(x, y)| DVec3::new(f64::from(x), 0.0, f64::from(y))).collect();
        let (triangles, _) = split(&corners);
        assert_eq!(triangles.len(), corners.len() - 2);
        assert_eq!(area_of(&corners, &triangles), 12.0);
    }

    #[test]
    fn spirals_keep_their_area_and_huge_ones_end() {
        let small = spiral(20);
        let (triangles, hasty) = split(&small);
        let exact = newell(&small).length() / 2.0;
        assert!((area_of(&small, &triangles) - exact).abs() < 1e-6 * exact);
        assert_eq!((triangles.len(), hasty), (small.len() - 2, 0));
        let large = spiral(2_000);
        let (triangles, hasty) = split(&large);
        assert_eq!((triangles.len(), hasty), (large.len() - 2, 0));
        let exact = newell(&large).length() / 2.0;
        assert!((area_of(&large, &triangles) - exact).abs() < 1e-6 * exact);
        let huge = spiral(30_000);
        assert_eq!(split(&huge).0.len(), huge.len() - 2);
    }

    /// Spikes around a disc: each is an ear, and as long as all others.
    #[test]
    fn stars_of_many_spikes_keep_their_area() {
        let corners: Vec<DVec3> = (0..60_000)
            .map(|i| {
                let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 60_000.0).sin_cos();
                let radius = if i % 2 == 0 { 2.0 } else { 1.0 };
                DVec3::new(radius * cos, radius * sin, 0.0)
            })
            .collect();
        let (triangles, hasty) = split(&corners);
        let exact = newell(&corners).length() / 2.0;
        assert!((area_of(&corners, &triangles) - exact).abs() < 1e-9 * exact);
        assert_eq!((triangles.len(), hasty), (corners.len() - 2, 0));
    }

    /// Corners in no order: the outline crosses itself everywhere.
    #[test]
    fn tangles_end_and_say_so() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 40) as f64
        };
        let corners: Vec<DVec3> = (0..200_000).map(|_| DVec3::new(next(), next(), 0.0)).collect();
        let (triangles, hasty) = split(&corners);
        assert_eq!(triangles.len(), corners.len() - 2);
        assert!(hasty <= 1);
    }

    #[test]
    fn what_is_tested_grows_with_the_corners_and_not_with_their_square() {
        let spent = |turns: usize| {
            let corners = spiral(turns);
            let mut triangulator = Triangulator::new(corners.len());
            let all = triangulator.tests;
            triangulator.split(&corners, &mut Vec::new());
            all - triangulator.tests
        };
        assert!(spent(60_000) <= FREE_TESTS + TESTS * 8 * 60_000);
    }

    #[test]
    fn corners_in_one_place_or_line_do_no_harm() {
        for corners in [vec![DVec3::ONE; 7], (0..9).map(|i| DVec3::splat(f64::from(i))).collect()] {
            assert_eq!(split(&corners).0.len(), corners.len() - 2);
        }
        assert!(split(&[DVec3::ONE; 2]).0.is_empty());
    }
}
