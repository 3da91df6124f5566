//! What changes between two rays side by side: the surface ends, folds, or meets another.
//!
//! The measure of depth is the width of a pixel at the place that is seen, so that scenes of any size are drawn alike. A
//! surface that turns away from the eye changes its depth fast without ending: what the tangent planes of both touches
//! explain, twice over, is no jump.
use durer_core::math::Ray;

use crate::{
    Kind,
    eye::{Spot, Touch},
};

/// Least jump in depth, in widths of a pixel.
const LEAST_JUMP: f32 = 0.75;
/// Of the tangent plane's error, in widths of a pixel, so much makes a jump possible.
const DOUBTFUL: f32 = 0.5;
/// What is said of two different things: more than of anything that one thing does.
const CERTAIN: f32 = 1e6;

/// Something that a line is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Change {
    pub(crate) kind: Kind,
    /// Depth of the jump in widths of a pixel, or angle of the fold in radians.
    pub(crate) strength: f32,
    /// The thing in front.
    pub(crate) front: [u32; 2],
}

/// How much two spots differ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judge {
    /// Angle between normals, in radians, from which on a fold is drawn.
    pub(crate) crease: f32,
}

/// Two touches in the measure of pixels.
struct Pair {
    /// Difference in depth.
    apart: f32,
    /// What the steeper of the two tangent planes explains of it.
    explained: f32,
    /// How far the worse of the two tangent planes misses the other touch.
    missed: f32,
}

impl Pair {
    /// Of spots that lie `gap` pixels apart.
    fn of((a, p): (&Spot, &Touch), (b, q): (&Spot, &Touch)) -> Self {
        let near = p.t.min(q.t);
        let gap = (a.at - b.at).length() as f32;
        let pixel = (a.ray.at(near) - b.ray.at(near)).length() / gap;
        // In front of the eye itself nothing can be measured.
        let pixel = if pixel > 0.0 { pixel } else { f32::MIN_POSITIVE };
        let (there, back) = (met(&a.ray, p, &b.ray), met(&b.ray, q, &a.ray));
        let apart = (p.t - q.t).abs() / pixel;
        let explained = (there - p.t).abs().max((back - q.t).abs()) / pixel;
        let missed = (there - q.t).abs().max((back - p.t).abs()) / pixel;
        Self { apart, explained, missed }
    }
}

/// Where `ray` meets the tangent plane of a touch of another ray; infinite if it does not.
fn met(own: &Ray, touch: &Touch, ray: &Ray) -> f32 {
    let towards = touch.n_g.dot(ray.d);
    if towards < 0.0 { touch.n_g.dot(own.at(touch.t) - ray.o) / towards } else { f32::INFINITY }
}

/// Angle between unit vectors whose cosine is given.
fn angle(cos: f32) -> f32 {
    durer_core::math::float::acos(cos)
}

impl Judge {
    /// 1 or more if there may be a line between two spots, the larger the likelier.
    pub(crate) fn suspicion(&self, a: &Spot, b: &Spot) -> f32 {
        match (&a.touch, &b.touch) {
            (None, None) => 0.0,
            (Some(p), Some(q)) if p.thing == q.thing => {
                let turn = angle(p.n_s.dot(q.n_s)) / (0.5 * self.crease);
                turn.max(Pair::of((a, p), (b, q)).missed.min(CERTAIN / 2.0) / DOUBTFUL)
            }
            _ => CERTAIN,
        }
    }

    /// What there is between two spots so close that nothing else fits between them.
    pub(crate) fn change(&self, a: &Spot, b: &Spot) -> Option<Change> {
        let (p, q) = match (&a.touch, &b.touch) {
            (None, None) => return None,
            (Some(p), Some(q)) => (p, q),
            (Some(p), None) | (None, Some(p)) => {
                return Some(Change { kind: Kind::Silhouette, strength: f32::INFINITY, front: p.thing });
            }
        };
        let front = if p.t <= q.t { p.thing } else { q.thing };
        let pair = Pair::of((a, p), (b, q));
        let jump = pair.apart - 2.0 * pair.explained;
        if jump > LEAST_JUMP {
            return Some(Change { kind: Kind::Silhouette, strength: pair.apart, front });
        }
        if p.thing != q.thing {
            return Some(Change { kind: Kind::Boundary, strength: pair.apart, front });
        }
        let turn = angle(p.n_s.dot(q.n_s));
        (turn > self.crease).then_some(Change { kind: Kind::Crease, strength: turn, front })
    }

    /// Whether a look from nearer may show a jump where [`Self::change`] sees none.
    pub(crate) fn may_jump(&self, a: &Spot, b: &Spot) -> bool {
        match (&a.touch, &b.touch) {
            (Some(p), Some(q)) => Pair::of((a, p), (b, q)).apart > LEAST_JUMP,
            _ => false,
        }
    }
}
