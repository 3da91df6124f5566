//! Where a line crosses the way between two rays, by halving.
use durer_core::glam::DVec2;

use crate::{
    Kind,
    change::{Change, Judge},
    eye::{Eye, Spot},
};

/// A crossing is known to half of this, in pixels.
const EXACT: f64 = 1.0 / 64.0;
/// A jump in depth is looked for as near as this, in pixels; beyond, rounding blurs.
const NEAREST: f64 = 1.0 / 4096.0;
/// Second lines on a way are looked for in parts of at least this length, in pixels.
const SEPARATE: f64 = 1.0 / 8.0;

/// A place where a line of the drawing passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// In pixels.
    pub(crate) at: DVec2,
    pub(crate) change: Change,
}

/// What was found on a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) crossing: Crossing,
    /// There are more.
    pub(crate) many: bool,
}

/// Looks for lines.
pub(crate) struct Searcher<'a> {
    pub(crate) eye: &'a Eye<'a>,
    pub(crate) judge: Judge,
}

impl Searcher<'_> {
    /// A line between two spots, if there is one.
    pub(crate) fn between(&self, a: Spot, b: Spot) -> Option<Found> {
        if self.judge.suspicion(&a, &b) < 1.0 {
            return None;
        }
        let (mut a, mut b) = (a, b);
        let mut others = Vec::new();
        while a.at.distance(b.at) > EXACT {
            let middle = self.eye.look(0.5 * (a.at + b.at));
            let (left, right) = (self.judge.suspicion(&a, &middle), self.judge.suspicion(&middle, &b));
            let is_left = left >= right;
            let other = if is_left { (middle, b) } else { (a, middle) };
            if left.min(right) >= 1.0 && other.0.at.distance(other.1.at) >= SEPARATE {
                others.push(other);
            }
            if left.max(right) < 1.0 {
                break;
            }
            if is_left { b = middle } else { a = middle }
        }
        let first = self.look_closely(a, b);
        let more = others.into_iter().find_map(|(a, b)| self.between(a, b));
        match (first, more) {
            (Some(crossing), more) => Some(Found { crossing, many: more.is_some() }),
            (None, more) => more,
        }
    }

    /// What lies between two spots at most [`EXACT`] apart; nothing if they are farther.
    fn look_closely(&self, mut a: Spot, mut b: Spot) -> Option<Crossing> {
        if a.at.distance(b.at) > EXACT {
            return None;
        }
        let mut seen = None;
        loop {
            let at = 0.5 * (a.at + b.at);
            let change = self.judge.change(&a, &b);
            if let Some(change) = change {
                let is_new = seen.is_none() || change.kind == Kind::Silhouette;
                seen = if is_new { Some(Crossing { at, change }) } else { seen };
            }
            let is_jump = change.is_some_and(|change| change.kind == Kind::Silhouette);
            if is_jump || !self.judge.may_jump(&a, &b) || a.at.distance(b.at) <= NEAREST {
                return seen;
            }
            let middle = self.eye.look(at);
            let is_left = self.judge.suspicion(&a, &middle) >= self.judge.suspicion(&middle, &b);
            if is_left { b = middle } else { a = middle }
        }
    }
}
