//! Places along a ray where a volume glows, for those who weigh each of them: bidirectional walks.
//!
//! `integral of T(t) added(t) dt` by places of known density: in a grid those of ratio tracking; where the volume is the same
//! everywhere one place, drawn by what one of the lanes lets pass, `s exp(-s t) / (1 - exp(-s way))`, each lane as often
//! (one-sample balance heuristic, Veach 1997). The closed form that flights have there says nothing of places.
use durer_core::{
    math::{
        Ray,
        float::{exp, ln},
    },
    spectrum::Spectrum,
};

use super::{Draws, Flier, Volume, flight::left, volume::Local};

/// Optical depths that count as none.
const THIN: f32 = 1e-3;

/// The density at `t` of a way of this length, on which this coefficient is lost; 0 of an endless one where nothing is.
fn density(s: f32, way: f32, t: f32) -> f32 {
    match s * way {
        depth if depth > THIN => s * exp(-s * t) / (1.0 - exp(-depth)),
        _ if way.is_finite() => 1.0 / way,
        _ => 0.0,
    }
}

/// A place with that density.
fn draw(s: f32, way: f32, u: f32) -> f32 {
    match s * way {
        depth if depth > THIN => (-ln(1.0 - u * (1.0 - exp(-depth))) / s).min(way),
        _ => u * way,
    }
}

impl Volume {
    /// Looks for what it sends to the start of a ray of unit direction from its parameter `t0` to `t1`: what arrives, by the
    /// density of its place, goes to `send`, and from where.
    pub fn glimpse(
        &self,
        flier: &Flier,
        ray: &Ray,
        (t0, t1): (f32, f32),
        draws: Draws<'_>,
        mut send: impl FnMut(Spectrum, f32),
    ) {
        if !self.is_even() {
            self.ratio(flier.basis, ray, (t0, t1), draws, |added, at| send(flier.dimmed(added, at - t0), at));
            return;
        }
        let Local { sigma_a, sigma_s, added } = self.at(flier.basis, ray.o);
        let (lost, way, u) = (sigma_a + sigma_s + flier.absorption, (t1 - t0).max(0.0), draws(0));
        let lane = lost.lane(((u.y * 4.0) as usize).min(3));
        let t = draw(lane, way, u.x);
        let density = lost.map(|s| density(s, way, t)).mean();
        if density > 0.0 && t.is_finite() {
            send(added * left(lost, t) / density, t0 + t);
        }
    }
}
