//! Lambert's body under a clear coat, smooth or rough: what of the light that gets through the coat comes out again.
//!
//! As the body spreads light evenly whatever the coat did to it, the random walk between the two (Guo, Hasan and Zhao 2018,
//! "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs") has a closed form. With `t(w)` the share that passes
//! the coat along `w` and what lies below it, `R` the body's albedo, `B` the share of the body's light that the coat sends
//! back down: `f = t(o) t(i) / eta² (R / pi) (1 + R B + (R B)² + ...)`, with as many terms as the walk may bounce. Between
//! coat and body light fades by `exp(-thickness / cos)`, which is pbrt-v4's model. `t` and `B` are integrals over the
//! coat's microfacets, made once for each material. What the coat itself reflects is a lobe of its own.
use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{
        Normal3, Point2, Vector3,
        float::{exp, sqr},
    },
    spectrum::{Curve, Spectrum},
};

use super::{Facets, SMOOTH, fresnel_dielectric, refract};

/// Nodes of `t` over the square root of the cosine.
const NODES: usize = 16;
/// Largest value of a node: all passes.
const WHOLE: f32 = u16::MAX as f32;
/// Points along each edge of the unit square, and over cosines, of the integrals.
const FINE: usize = 24;
/// Widths that are tabulated where roughness varies.
const WIDTHS: usize = 12;
/// Step between indices that are tabulated where the index varies, and how many steps there are at most.
const STEP: f32 = 0.1;
const MOST_STEPS: f32 = 8.0;

/// What the body is to light that the coat sends back to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Again {
    /// What it is to all light.
    Colored,
    /// White: `f = t(o) t(i) / eta² (R / pi) / (1 - B)` where nothing ends the walk.
    White,
}

/// How much passes the coat, by the cosine outside.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Passage {
    Smooth { eta: f32, thickness: f32 },
    Rough([u16; NODES]),
}

/// The body under a coat, as a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// `R (1 + R B + ...) / eta²`.
    color: Spectrum,
    /// Mean of `t`, weighted by the cosine.
    mean: f32,
    /// `t` towards the viewer.
    towards: f32,
    passage: Passage,
}

impl Body {
    /// Value without the cosine, 1/sr; the same from both sides.
    pub(super) fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        self.color * (FRAC_1_PI * self.passage.at(wo.z.abs()) * self.passage.at(wi.z.abs()))
    }
    /// Share of the light of a uniform sky that leaves towards `wo`.
    pub(super) fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        self.color * (self.passage.at(wo.z.abs()) * self.mean)
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { color: self.color * by, ..self }
    }
    /// Share of the light of a uniform sky that leaves towards the viewer.
    pub(super) fn albedo(&self) -> Spectrum {
        self.color * (self.mean * self.towards)
    }
}

impl Passage {
    fn at(&self, cos: f32) -> f32 {
        match self {
            Self::Smooth { eta, thickness } => smooth(cos.min(1.0), *eta, *thickness),
            Self::Rough(nodes) => interpolated(nodes, cos),
        }
    }
}

/// Cubic between nodes, by the slopes of their neighbours (Catmull and Rom 1974).
fn interpolated(nodes: &[u16; NODES], cos: f32) -> f32 {
    let x = cos.clamp(0.0, 1.0).sqrt() * (NODES - 1) as f32;
    let i = (x as usize).min(NODES - 2);
    let t = x - i as f32;
    let at = |j: usize| f32::from(nodes[j.min(NODES - 1)]);
    let (b, c) = (at(i), at(i + 1));
    let a = if i == 0 { 2.0 * b - c } else { at(i - 1) };
    let d = if i + 2 == NODES { 2.0 * c - b } else { at(i + 2) };
    let cubic = b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
    cubic.clamp(0.0, WHOLE) / WHOLE
}

/// What is left of light after the way from coat to body along a direction.
pub(super) fn faded(thickness: f32, w: Vector3) -> f32 {
    let cos = w.z.abs();
    if thickness == 0.0 {
        1.0
    } else if cos == 0.0 {
        0.0
    } else {
        exp(-thickness / cos)
    }
}

/// `t` of a smooth coat.
fn smooth(cos: f32, eta: f32, thickness: f32) -> f32 {
    let below = refract(at_cosine(cos), Normal3::new(0.0, 0.0, 1.0), 1.0 / eta);
    below.map_or(0.0, |d| (1.0 - fresnel_dielectric(cos, eta)) * faded(thickness, d))
}

fn at_cosine(cos: f32) -> Vector3 {
    Vector3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// One width of the coat.
#[derive(Clone, Copy, Debug)]
struct Row {
    passage: Passage,
    /// `(1 - B) eta²`: without what fades it is the mean, and between indices no light is lost.
    out: f32,
    mean: f32,
}

/// A coat of one index.
#[derive(Clone, Debug)]
struct Widths {
    smooth: Row,
    /// By the square root of the width, evenly; a single one where the width is the same everywhere.
    rough: Vec<Row>,
}

/// What a material's coat does to the body's light, for all its indices and all widths of its microfacets.
#[derive(Clone, Debug)]
pub struct Coat {
    /// The smallest and the largest index.
    ends: [f32; 2],
    /// Evenly between these; a single one where they are the same.
    of: Vec<Widths>,
}

impl Coat {
    /// Of an index relative to the outside, or all indices of a curve, and a thickness in units of the mean free path of what
    /// absorbs below the coat. `alpha` is the width of its facets, if that is the same everywhere, and some that are like them but
    /// for that. Widths that differ along and across are taken to be their mean: it blurs `t` a little.
    pub fn new(eta: (f32, Option<&Curve>), thickness: f32, alpha: (Option<f32>, Facets)) -> Self {
        let ends = eta.1.map_or([eta.0; 2], Curve::ends);
        let [low, high] = ends;
        let steps = ((high - low) / STEP).ceil().min(MOST_STEPS);
        let of = |i: usize| Widths::new(low + (high - low) * (i as f32 / steps.max(1.0)), thickness, alpha);
        Self { ends, of: (0..=steps as usize).map(of).collect() }
    }

    /// The body of this albedo below facets of an index, seen under a cosine, for walks that meet it this often at most.
    pub fn body(
        &self,
        (albedo, again): (Spectrum, Again),
        (eta, facets): (f32, &Facets),
        bounces: u32,
        cos: f32,
    ) -> Body {
        let [low, high] = self.ends;
        let x = if high > low { (eta - low) / (high - low) * (self.of.len() - 1) as f32 } else { 0.0 };
        let row = between(&self.of, x, |of| of.row(facets), Row::mixed);
        let scale = 1.0 / sqr(eta);
        let color = albedo.map(|r| {
            let color = if again == Again::White { 1.0 } else { r };
            let back = color * (1.0 - row.out * scale);
            r * scale * (1.0 - powi(back, bounces)) / (1.0 - back)
        });
        Body { color, mean: row.mean, towards: row.passage.at(cos), passage: row.passage }
    }
}

/// Of what belongs to evenly spaced items, that of the place `x` between them, in steps.
fn between<T>(all: &[T], x: f32, of: impl Fn(&T) -> Row, mix: impl Fn(&Row, &Row, f32) -> Row) -> Row {
    let x = x.clamp(0.0, (all.len() - 1) as f32);
    let i = x as usize;
    let first = of(&all[i]);
    match all.get(i + 1) {
        Some(next) if x > i as f32 => mix(&first, &of(next), x - i as f32),
        _ => first,
    }
}

impl Widths {
    fn new(eta: f32, thickness: f32, (alpha, like): (Option<f32>, Facets)) -> Self {
        let row = |alpha: f32| Row::new(eta, thickness, &like.of_widths(alpha, alpha));
        let rough = match alpha {
            Some(alpha) if alpha < SMOOTH => Vec::new(),
            Some(alpha) => vec![row(alpha)],
            None => (0..WIDTHS).map(|i| row(sqr(i as f32 / (WIDTHS - 1) as f32).max(SMOOTH))).collect(),
        };
        Self { smooth: row(0.0), rough }
    }

    fn row(&self, facets: &Facets) -> Row {
        if facets.is_smooth() || self.rough.is_empty() {
            return self.smooth;
        }
        let x = facets.alpha().sqrt() * (self.rough.len() - 1) as f32;
        between(&self.rough, x, |row| *row, Row::mixed)
    }
}

fn powi(x: f32, n: u32) -> f32 {
    (0..n.min(64)).fold(1.0, |product, _| product * x)
}

impl Row {
    fn new(eta: f32, thickness: f32, facets: &Facets) -> Self {
        let passes = |cos: f32| match facets.is_smooth() {
            true => smooth(cos, eta, thickness),
            false => over_facets(facets, cos, |o, h| {
                let down = refract(o, Normal3::from(h), 1.0 / eta).filter(|d| d.z < 0.0)?;
                Some((
                    down,
                    (1.0 - fresnel_dielectric(o.dot(h).clamp(0.0, 1.0), eta)) * faded(thickness, down),
                ))
            }),
        };
        let sent_back = |cos: f32| match facets.is_smooth() {
            true => fresnel_dielectric(cos, 1.0 / eta) * faded(2.0 * thickness, at_cosine(cos)),
            false => {
                let reflected = over_facets(facets, cos, |o, h| {
                    let up = h * (2.0 * o.dot(h)) - o;
                    let f = fresnel_dielectric(o.dot(h).clamp(0.0, 1.0), 1.0 / eta);
                    (up.z > 0.0).then(|| (up, f * faded(thickness, up)))
                });
                reflected * faded(thickness, at_cosine(cos))
            }
        };
        let passage = match facets.is_smooth() {
            true => Passage::Smooth { eta, thickness },
            false => Passage::Rough(std::array::from_fn(|i| {
                let cos = sqr(i as f32 / (NODES - 1) as f32).max(1e-5);
                (passes(cos) * WHOLE + 0.5) as u16
            })),
        };
        Self {
            passage,
            out: (1.0 - over_cosines(sent_back)) * sqr(eta),
            mean: over_cosines(|cos| passage.at(cos)),
        }
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        let lerp = |a: f32, b: f32| a + (b - a) * t;
        let passage = match (self.passage, other.passage) {
            (Passage::Rough(a), Passage::Rough(b)) => {
                Passage::Rough(std::array::from_fn(|i| (lerp(a[i].into(), b[i].into()) + 0.5) as u16))
            }
            (Passage::Smooth { eta, thickness }, Passage::Smooth { eta: other, .. }) => {
                Passage::Smooth { eta: lerp(eta, other), thickness }
            }
            (own, _) => own,
        };
        Self { passage, out: lerp(self.out, other.out), mean: lerp(self.mean, other.mean) }
    }
}

/// Mean over the facets seen under a cosine of what `of` gives for `o` and the normal, which light leaves towards a
/// direction with a share, times what other facets leave of it.
fn over_facets(facets: &Facets, cos: f32, of: impl Fn(Vector3, Vector3) -> Option<(Vector3, f32)>) -> f32 {
    let o = at_cosine(cos);
    let place = |i: usize| (i as f32 + 0.5) / FINE as f32;
    let mut sum = 0.0;
    for x in 0..FINE {
        for y in 0..FINE {
            let h = facets.visible_normal(o, Point2::new(place(x), place(y)));
            if let Some((w, share)) = of(o, h) {
                sum += share * facets.seen_by_both(o, w);
            }
        }
    }
    sum / (FINE * FINE) as f32
}

/// `2 integral of f(cos) cos dcos`.
fn over_cosines(f: impl Fn(f32) -> f32) -> f32 {
    const STEPS: usize = 4 * FINE;
    let at = |i: usize| ((i as f32 + 0.5) / STEPS as f32).sqrt();
    (0..STEPS).map(|i| f(at(i))).sum::<f32>() / STEPS as f32
}
