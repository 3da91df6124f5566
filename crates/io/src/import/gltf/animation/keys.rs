//! The moments at which a scene is looked at while the shutter is open.
//!
//! There is one where it opens, one where it closes, and one at each key of the curves in between, with one just before
//! it where a value jumps. Between neighbours things move straight (and turn evenly) in the picture; a stretch is halved
//! until, in its middle and at its first quarter, nothing strays from that by more than a 500th of the way that it makes
//! while the shutter is open. The middle alone would not do: that of a curve which eases in and out lies on the line.
use durer_core::math::Interval;

use super::curve::Curve;
use crate::import::gltf::{element::Checked, stance::Stance};

/// How far from the straight line, by the length of the way.
const MOST_STRAY: f64 = 1.0 / 500.0;
/// How often a stretch is halved at most.
const DEPTH: usize = 6;
/// Most moments of one picture.
const MOST: usize = 257;
/// Most places of nodes at all of them together.
const MOST_PLACES: usize = 1 << 22;

/// The scene at the moments that `shutter` needs; a single one if nothing moves.
pub(super) fn stances<'c>(
    shutter: Interval,
    curves: impl Iterator<Item = &'c Curve>,
    nodes: usize,
    at: impl Fn(f32) -> Checked<Stance>,
) -> Checked<Vec<Stance>> {
    if shutter.min >= shutter.max {
        return Ok(vec![at(shutter.min)?]);
    }
    let most = MOST.min(MOST_PLACES / nodes.max(1)).max(2);
    let mut keys = moments(shutter, curves, most).into_iter().map(&at).collect::<Checked<Vec<_>>>()?;
    let mut open = vec![true; keys.len()];
    for _ in 0..DEPTH {
        let mut middles = Vec::with_capacity(keys.len());
        for ((a, b), open) in keys.iter().zip(keys.iter().skip(1)).zip(&open) {
            let middle = a.time + (b.time - a.time) * 0.5;
            let between = *open && a.time < middle && middle < b.time;
            let quarter = a.time + (b.time - a.time) * 0.25;
            middles.push(if between { Some([at(middle)?, at(quarter)?]) } else { None });
        }
        let Some(first) = keys.first() else { break };
        let mut way = first.apart(first);
        for stance in keys.iter().chain(middles.iter().flatten().flatten()) {
            way.grow(&first.apart(stance));
        }
        let room = most.saturating_sub(keys.len());
        let (mut halved, mut opened, mut left) = (Vec::new(), Vec::new(), room);
        let mut middles = middles.into_iter();
        let mut rest = keys.into_iter().peekable();
        while let Some(stance) = rest.next() {
            let strays = match (middles.next().flatten(), rest.peek()) {
                (Some([middle, quarter]), Some(next)) if left > 0 => {
                    let exceeds = |at: &Stance, u| at.strays((&stance, next), u).exceeds(&way, MOST_STRAY);
                    (exceeds(&middle, 0.5) || exceeds(&quarter, 0.25)).then_some(middle)
                }
                _ => None,
            };
            halved.push(stance);
            opened.push(strays.is_some());
            if let Some(middle) = strays {
                halved.push(middle);
                opened.push(true);
                left -= 1;
            }
        }
        (keys, open) = (halved, opened);
        if !open.contains(&true) {
            break;
        }
    }
    let still = keys.first().is_some_and(|first| keys.iter().all(|key| key.is_like(first)));
    keys.truncate(if still { 1 } else { keys.len() });
    Ok(keys)
}

/// Where the shutter opens and closes and all keys in between; as many evenly spread moments if those are too many.
fn moments<'c>(shutter: Interval, curves: impl Iterator<Item = &'c Curve>, most: usize) -> Vec<f32> {
    let mut all = vec![shutter.min, shutter.max];
    for curve in curves {
        let inside = curve.times().iter().copied().filter(|t| shutter.min < *t && *t < shutter.max);
        for time in inside {
            all.push(time);
            if curve.jumps() && time.next_down() > shutter.min {
                all.push(time.next_down());
            }
        }
    }
    all.sort_unstable_by(f32::total_cmp);
    all.dedup();
    if all.len() <= most {
        return all;
    }
    let steps = most - 1;
    let mut even: Vec<f32> = (0..=steps).map(|i| shutter.at(i as f32 / steps as f32)).collect();
    even.dedup();
    even
}
