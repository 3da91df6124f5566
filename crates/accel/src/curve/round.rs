//! Round curves: the union of the balls around every point of a cubic, with the radius a cubic too.
//!
//! In the frame of the ray the ball at `s` covers the stretch `z(s) -+ sqrt(g(s))` of the ray wherever
//! `g = r^2 - x^2 - y^2 >= 0`. As `s` runs through a span in which `g` is positive these stretches change continuously,
//! so together they are one stretch, from the least `z - sqrt(g)` to the largest `z + sqrt(g)`. `g` has degree 6: there
//! are at most four spans in `[0, 1]`, and the stretches of all of them are what of the ray lies inside. That is the
//! whole surface, however the curve winds or its radius changes; nothing is traced or flattened. The envelope of balls
//! is the view of Reshetov and Hart 2024, "Modeling Hair Strands with Roving Capsules"; the swept circles of others (Reshetov and
//! Luebke 2018, "Phantom Ray-Hair Intersector") make the same tube but fold over in tight bends and end in open edges.
//!
//! Both ends are half balls, so segments that share a point and a radius overlap in a ball and leave no gap; what of
//! them is inside the chain is left out ([`super::joint`]).
use durer_core::glam::DVec3;

use super::{
    CurveHit, Curves,
    bernstein::Bernstein,
    joint::is_inside_neighbour,
    lowest::{half_chord_squared, lowest},
    ray_frame::RayFrame,
    strand::Strand,
};

/// No polynomial of degree 6 is positive in more spans.
const MOST_SPANS: usize = 7;

/// Where the ray goes through the surface.
#[derive(Clone, Copy, Debug, Default)]
struct Crossing {
    s: f64,
    z: f64,
    /// `z` less that of the centre: half the chord of the ball, negative on the way in.
    depth: f64,
}

/// The least and largest distance inside, for one span of the curve.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    entry: Crossing,
    exit: Crossing,
}

/// The spans of `[0, 1]` in which the ray meets the balls.
pub(super) struct Spans {
    ends: [(f64, f64); MOST_SPANS],
    count: usize,
}

impl Spans {
    /// Where the radius is 0, `g` is not positive: no span holds radii of both signs.
    pub(super) fn new(g: &Bernstein<7>, r: &Bernstein<4>) -> Self {
        let mut spans = Self { ends: [(0.0, 0.0); MOST_SPANS], count: 0 };
        let roots = g.roots();
        let mut lo = 0.0;
        for hi in roots.as_slice().iter().copied().chain([1.0]) {
            let middle = lo + (hi - lo) * 0.5;
            if g.at(middle) > 0.0 && r.at(middle) > 0.0 && spans.count < MOST_SPANS {
                spans.ends[spans.count] = (lo, hi);
                spans.count += 1;
            }
            lo = hi;
        }
        spans
    }
    pub(super) fn as_slice(&self) -> &[(f64, f64)] {
        &self.ends[..self.count]
    }
}

/// The nearest crossing with a parameter in `[t_min, t_max]`, into or out of the solid.
pub(super) fn intersect(
    curves: &Curves,
    segment: u32,
    strand: &Strand,
    frame: &RayFrame,
    t_max: f32,
) -> Option<CurveHit> {
    let square = |c: &Bernstein<4>| -> Bernstein<7> { c.times(c) };
    let g = square(&strand.r).plus(-1.0, &square(&strand.x)).plus(-1.0, &square(&strand.y));
    if g.max() <= 0.0 {
        return None;
    }
    let spans = Spans::new(&g, &strand.r);
    let hit = |c: Crossing| {
        let t = c.t_ahead(strand, frame)?;
        (!is_inside_neighbour(curves, segment, frame, c.z)).then_some((t, c))
    };
    let first = spans
        .as_slice()
        .iter()
        .map(|(lo, hi)| Crossing::entry(strand, lowest(strand, &g, *lo, *hi)))
        .reduce(|a, b| if b.z < a.z { b } else { a })?;
    // Usually the ray begins outside and the first way in is the hit: nothing else matters then.
    let (t, crossing) = hit(first).or_else(|| beyond_first(strand, &g, &spans, hit))?;
    (t <= t_max).then(|| crossing.hit(strand, frame, t))
}

/// The same if the first way in lies before `t_min`: merges the stretches and takes their ends in turn.
fn beyond_first<T>(
    strand: &Strand,
    g: &Bernstein<7>,
    spans: &Spans,
    hit: impl Fn(Crossing) -> Option<T>,
) -> Option<T> {
    let back = strand.reversed();
    let mut stretches = [Stretch::default(); MOST_SPANS];
    for (stretch, (lo, hi)) in stretches.iter_mut().zip(spans.as_slice()) {
        *stretch = Stretch {
            entry: Crossing::entry(strand, lowest(strand, g, *lo, *hi)),
            exit: Crossing::exit(strand, lowest(&back, g, *lo, *hi)),
        };
    }
    let stretches = &mut stretches[..spans.count];
    stretches.sort_unstable_by(|a, b| a.entry.z.total_cmp(&b.entry.z));
    let (head, rest) = stretches.split_first()?;
    let mut current = *head;
    for next in rest {
        if next.entry.z > current.exit.z {
            if let Some(found) = hit(current.entry).or_else(|| hit(current.exit)) {
                return Some(found);
            }
            current = *next;
        } else if next.exit.z > current.exit.z {
            current.exit = next.exit;
        }
    }
    hit(current.entry).or_else(|| hit(current.exit))
}

impl Crossing {
    fn entry(strand: &Strand, s: f64) -> Self {
        Self::new(strand, s, -half_chord_squared(strand, s).sqrt())
    }
    fn exit(strand: &Strand, s: f64) -> Self {
        Self::new(strand, s, half_chord_squared(strand, s).sqrt())
    }
    fn new(strand: &Strand, s: f64, depth: f64) -> Self {
        Self { s, z: strand.z.at(s) + depth, depth }
    }

    fn t_ahead(&self, strand: &Strand, frame: &RayFrame) -> Option<f32> {
        let off = strand.own_error + frame.start_error();
        let (r, half) = (strand.r.at(self.s), self.depth.abs());
        // |x| and |y| are at most r: what their errors do to g, and g's to its root, as
        // |sqrt(g + e) - sqrt(g)| <= min(e / sqrt(g), sqrt(e)).
        let g_error = 6.0 * r * off + 3.0 * off * off;
        let root_error = (g_error / half).min(g_error.sqrt());
        frame.t_ahead(self.z, off + root_error)
    }

    fn hit(&self, strand: &Strand, frame: &RayFrame, t: f32) -> CurveHit {
        let center = strand.center(self.s);
        let from_center = DVec3::new(-center.x, -center.y, self.depth);
        CurveHit {
            t,
            u: strand.along(self.s) as f32,
            v: strand.side(self.s, from_center, strand.r.at(self.s)),
            n_g: frame.turn_back(from_center.normalize()),
        }
    }
}
