//! Where a ray enters the balls of a span of a curve: the least of `e(s) = z(s) - sqrt(g(s))`.
//!
//! `g = r^2 - x^2 - y^2` is the squared half chord of the ball at `s`. Branch and bound: the coefficients of `z` and `g`
//! on a part of the span bound `e` from below, and those of their derivatives tell parts where `e` only falls, only
//! rises, or is convex. `e' = (2 z' sqrt(g) - g') / (2 sqrt(g))`, and because
//! `(-sqrt(g))'' = (g'^2 - 2 g g'') / (4 g^(3/2)) >= -g'' / (2 sqrt(g))`, `e` is convex where
//! `z'' - g'' / (2 sqrt(g)) >= 0`. Thin strands seen from the side are convex at once.
use super::{
    bernstein::{Bernstein, Cubic},
    bracket::bracketed,
    strand::Strand,
};

/// How often a part that is none of the three is halved; what is left then is taken to have one dip. Of 300 000 random
/// spans three halvings got one wrong, four none.
const HALVINGS: u32 = 7;

/// A part of the span with its own coefficients.
struct Part {
    lo: f64,
    hi: f64,
    g: Bernstein<7>,
    z: Cubic,
}

/// What is known of `e` on a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Falls or rises all the way: an end is lowest.
    Monotone,
    Convex,
    Unknown,
}

struct Search<'a> {
    strand: &'a Strand,
    s: f64,
    value: f64,
}

/// The `s` in `[lo, hi]` whose ball the ray enters first, where `g`, the polynomial of `[0, 1]`, is positive in between.
pub(super) fn lowest(strand: &Strand, g: &Bernstein<7>, lo: f64, hi: f64) -> f64 {
    let mut search = Search { strand, s: lo, value: entry(strand, lo) };
    search.offer(hi);
    search.visit(&Part { lo, hi, g: g.part(lo, hi), z: strand.z.part(lo, hi) }, HALVINGS);
    search.s
}

/// Squared half chord of the ball at `s`.
pub(super) fn half_chord_squared(strand: &Strand, s: f64) -> f64 {
    let (x, y, r) = (strand.x.at(s), strand.y.at(s), strand.r.at(s));
    (r * r - x * x - y * y).max(0.0)
}

fn entry(strand: &Strand, s: f64) -> f64 {
    strand.z.at(s) - half_chord_squared(strand, s).sqrt()
}

impl Search<'_> {
    fn offer(&mut self, s: f64) {
        let value = entry(self.strand, s);
        if value < self.value {
            (self.s, self.value) = (s, value);
        }
    }

    /// Both ends of the part were offered before.
    fn visit(&mut self, part: &Part, halvings: u32) {
        if part.bound() >= self.value {
            return;
        }
        match part.shape() {
            Shape::Monotone => {}
            Shape::Unknown if halvings > 0 => {
                let (below, above) = part.halves();
                self.offer(below.hi);
                let above_first = above.bound() < below.bound();
                let (first, second) = if above_first { (above, below) } else { (below, above) };
                self.visit(&first, halvings - 1);
                self.visit(&second, halvings - 1);
            }
            Shape::Convex | Shape::Unknown => {
                if slope(self.strand, part.lo).0 < 0.0 && slope(self.strand, part.hi).0 > 0.0 {
                    self.offer(bracketed(part.lo, part.hi, true, |s| slope(self.strand, s)));
                }
            }
        }
    }
}

/// `2 sqrt(g) e'`, which has the sign of `e'` and is finite where `g` is 0, and its derivative.
fn slope(strand: &Strand, s: f64) -> (f64, f64) {
    let (x, y, z, r) = (strand.x.jet(s), strand.y.jet(s), strand.z.jet(s), strand.r.jet(s));
    let root = (r[0] * r[0] - x[0] * x[0] - y[0] * y[0]).max(0.0).sqrt();
    let g1 = 2.0 * (r[0] * r[1] - x[0] * x[1] - y[0] * y[1]);
    let squares = r[1] * r[1] - x[1] * x[1] - y[1] * y[1];
    let g2 = 2.0 * (squares + r[0] * r[2] - x[0] * x[2] - y[0] * y[2]);
    (2.0 * z[1] * root - g1, 2.0 * z[2] * root + z[1] * g1 / root - g2)
}

impl Part {
    fn bound(&self) -> f64 {
        self.z.min() - self.g.max().max(0.0).sqrt()
    }

    fn halves(&self) -> (Self, Self) {
        let middle = self.lo + (self.hi - self.lo) * 0.5;
        let ((g0, g1), (z0, z1)) = (self.g.split(0.5), self.z.split(0.5));
        (Self { lo: self.lo, hi: middle, g: g0, z: z0 }, Self { lo: middle, hi: self.hi, g: g1, z: z1 })
    }

    fn shape(&self) -> Shape {
        let root = |g: f64| g.max(0.0).sqrt();
        let (least, most) = (root(self.g.min()), root(self.g.max()));
        let g1: Bernstein<6> = self.g.derivative();
        let z1: Bernstein<3> = self.z.derivative();
        // Bounds of 2 z' sqrt(g).
        let (z1_min, z1_max) = (z1.min(), z1.max());
        let rise = 2.0 * z1_min * if z1_min >= 0.0 { least } else { most };
        let fall = 2.0 * z1_max * if z1_max >= 0.0 { most } else { least };
        if rise >= g1.max() || fall <= g1.min() {
            return Shape::Monotone;
        }
        let g2: Bernstein<5> = g1.derivative();
        let z2: Bernstein<2> = z1.derivative();
        let (bend, dent) = (-g2.max(), z2.min());
        let convex = bend >= 0.0 && (dent >= 0.0 || 2.0 * dent * most + bend >= 0.0);
        if convex { Shape::Convex } else { Shape::Unknown }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{CurveBasis, CurveKind, Curves, RayFrame};
    use durer_core::math::{Point3, Ray, Vector3};

    /// A strand that winds along the ray with radii up to `thickness`, and what becomes of it.
    fn strand(seed: &mut u64, thickness: f32) -> Option<Strand> {
        let mut unit = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 40) as f32 / (1 << 24) as f32
        };
        let points = (0..4).map(|_| Point3::new(unit() - 0.5, unit() - 0.5, 4.0 * unit())).collect();
        let radii = (0..4).map(|_| thickness * unit()).collect();
        let (normals, segments) = (Vec::new(), vec![0]);
        let curves =
            Curves { kind: CurveKind::Round, basis: CurveBasis::Bezier, points, radii, normals, segments };
        let ray = Ray::new(Point3::new(0.0, 0.0, -1.0), Vector3::new(0.0, 0.0, 1.0));
        Strand::near(&curves, 0, &RayFrame::new(&ray)?, f32::INFINITY)
    }

    #[test]
    fn nothing_sampled_is_lower() {
        let (mut seed, mut spans) = (1, 0);
        for i in 0..6000 {
            let Some(strand) = strand(&mut seed, [0.2, 1.0, 4.0][i % 3]) else { continue };
            let square = |c: &Cubic| -> Bernstein<7> { c.times(c) };
            let g = square(&strand.r).plus(-1.0, &square(&strand.x)).plus(-1.0, &square(&strand.y));
            let roots = g.roots();
            let mut lo = 0.0;
            for hi in roots.as_slice().iter().copied().chain([1.0]) {
                if g.at(0.5 * (lo + hi)) > 0.0 {
                    spans += 1;
                    let s = lowest(&strand, &g, lo, hi);
                    assert!((lo..=hi).contains(&s));
                    let least = (0..=500)
                        .map(|k| entry(&strand, lo + (hi - lo) * f64::from(k) / 500.0))
                        .fold(f64::INFINITY, f64::min);
                    let found = entry(&strand, s);
                    assert!(found <= least + 1e-12, "{strand:?} [{lo}, {hi}]: {found} at {s}, {least}");
                }
                lo = hi;
            }
        }
        assert!(spans > 3000, "{spans}");
    }
}
