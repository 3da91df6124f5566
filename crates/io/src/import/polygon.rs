//! Polygons to triangles by clipping ears (Meisters 1975), in the plane that the polygon is nearest to.
//!
//! Newell's normal gives the plane's side; the axis along which it is longest is dropped, which changes no orientation
//! test and rounds nothing. A corner is an ear if it turns left and no corner that does not lies in its triangle. Holes
//! that are tied to the outline by a pair of coincident edges come out right. Polygons that cross themselves give some
//! triangles between their corners. The number of tests is limited: beyond it the rest becomes a fan.
use durer_core::glam::{DVec2, DVec3};

/// Tests of a corner against an ear that a piece of a file may cost at least; see [`Triangulator::new`].
const FREE_TESTS: u64 = 1 << 26;

/// Splits polygons; keeps its memory between them.
#[derive(Debug)]
pub(crate) struct Triangulator {
    tests: u64,
    /// Polygons of which a part became a fan because there were no tests left.
    pub(crate) hasty: usize,
    flat: Vec<DVec2>,
    before: Vec<usize>,
    after: Vec<usize>,
    reflex: Vec<usize>,
}

impl Triangulator {
    /// For polygons of `corners` corners in all: what is tested grows with their number, so that no file takes long.
    pub(crate) fn new(corners: usize) -> Self {
        let tests = FREE_TESTS + 256 * corners as u64;
        Self { tests, hasty: 0, flat: Vec::new(), before: Vec::new(), after: Vec::new(), reflex: Vec::new() }
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
        self.reflex = (0..count).filter(|&i| self.turn(i) <= 0.0).collect();
        if self.reflex.is_empty() {
            out.extend((2..count).map(|i| [0, i - 1, i]));
            return;
        }
        let (mut at, mut left, mut refused) = (0, count, 0);
        let mut hasty = false;
        while left > 3 {
            let (a, c) = (self.prev(at), self.next(at));
            // No ear all around: the polygon crosses itself or is degenerate, so that any corner will do.
            if refused > left || hasty || self.is_ear(a, at, c) {
                out.push([a, at, c]);
                self.unlink(a, c);
                (left, refused) = (left - 1, 0);
                self.forget(at);
                for i in [a, c] {
                    if self.turn(i) > 0.0 {
                        self.forget(i);
                    }
                }
                at = if hasty { c } else { self.next(c) };
            } else {
                refused += 1;
                at = c;
            }
            if !hasty && self.tests == 0 {
                hasty = true;
                self.hasty += 1;
                self.reflex.clear();
            }
        }
        out.push([self.prev(at), at, self.next(at)]);
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
    /// Takes a corner off the list of those that may lie in ears.
    fn forget(&mut self, corner: usize) {
        if let Ok(place) = self.reflex.binary_search(&corner) {
            self.reflex.remove(place);
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
        self.tests = self.tests.saturating_sub(1 + self.reflex.len() as u64);
        let inside = |i: usize| {
            let x = self.point(i);
            let own = x == p || x == q || x == r;
            !own && area(p, q, x) >= 0.0 && area(q, r, x) >= 0.0 && area(r, p, x) >= 0.0
        };
        !self.reflex.iter().any(|&i| inside(i))
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
        let huge = spiral(30_000);
        let (triangles, hasty) = split(&huge);
        assert_eq!((triangles.len(), hasty), (huge.len() - 2, 1));
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
        assert!(spent(60_000) <= FREE_TESTS + 256 * 8 * 60_000);
    }

    #[test]
    fn corners_in_one_place_or_line_do_no_harm() {
        for corners in [vec![DVec3::ONE; 7], (0..9).map(|i| DVec3::splat(f64::from(i))).collect()] {
            assert_eq!(split(&corners).0.len(), corners.len() - 2);
        }
        assert!(split(&[DVec3::ONE; 2]).0.is_empty());
    }
}
