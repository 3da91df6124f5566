//! Drops of water by geometrical optics (Descartes 1637, Newton 1704): a ray that meets a sphere under the angle `i` is bent to `r`,
//! `sin i = n sin r`, and leaves it after `p` chords, turned by `2 i - 2 p r + (p - 1) pi`; `p = 0` is mirrored outside. Each
//! time Fresnel's share for either polarisation is mirrored. The more rays are turned alike, the brighter it is there: where the
//! angle is stationary stand the rainbows, the first one of `p = 2`, the second of `p = 3`, at other angles for each wavelength.
//!
//! The density is averaged over steps of a twentieth of a degree, in which it is even by solid angle. Directions are drawn
//! from its mean over all wavelengths. Left out are what waves do (drops below a tenth of a millimetre have paler bows, with
//! others inside) and what is bent around drops, nearly all of it by less than half a degree.
use std::f32::consts::{FRAC_PI_2, PI, TAU};

use durer_core::{
    math::{
        Guide,
        float::{acos, asin, cos, sin, sqr},
    },
    spectrum::{Basis, Color, HUES, Spectrum, index},
};

use crate::bsdf::fresnel_polarized;

/// Steps of the angle from 0 to pi.
const STEPS: usize = 3600;
/// Rays that are traced, evenly by the angle under which they meet the drop.
const RAYS: usize = 4000;
/// Chords at most: of what is mirrored inside more often, less than 0.1 % is left.
const CHORDS: usize = 8;
/// Wavelengths with a density, in nm: first, number, distance.
const FIRST: f32 = 360.0;
const WAVES: usize = 95;
const APART: f32 = 5.0;

/// Their phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Drops {
    /// Density of each step, by the mean over all wavelengths; one wavelength after the other.
    tints: Vec<f32>,
    /// Mean density of each step, 1/sr.
    mean: Vec<f32>,
    /// Probability of the steps up to each one and with it.
    upto: Vec<f32>,
    /// To these.
    guide: Guide,
}

impl Drops {
    /// Of round drops of water at 20 °C, in air.
    pub(super) fn new() -> Self {
        let mut shares: Vec<Vec<f64>> = (0..WAVES)
            .map(|wave| {
                let nm = FIRST + APART * wave as f32;
                turned_by(index("water", nm.into()).unwrap_or(1.333) as f32)
            })
            .collect();
        for share in &mut shares {
            let all: f64 = share.iter().sum();
            share.iter_mut().for_each(|s| *s /= all);
        }
        let mean: Vec<f64> = (0..STEPS)
            .map(|step| shares.iter().map(|share| share[step]).sum::<f64>() / WAVES as f64)
            .collect();
        let ratio =
            |step: usize, share: f64| if mean[step] > 0.0 { (share / mean[step]) as f32 } else { 1.0 };
        let tints = shares.iter().flat_map(|share| (0..STEPS).map(|step| ratio(step, share[step]))).collect();
        let mut sum = 0.0;
        let upto: Vec<f32> = mean
            .iter()
            .map(|share| {
                sum += share;
                sum as f32
            })
            .collect();
        let mean =
            mean.iter().enumerate().map(|(step, share)| (share / f64::from(angles(step))) as f32).collect();
        let guide = Guide::new(&upto);
        Self { tints, mean, upto, guide }
    }

    /// The mean cosine of the deflection.
    pub(super) fn mean_cos(&self) -> f32 {
        let part = |step: usize| {
            f64::from(self.mean[step] * angles(step)) * 0.5 * f64::from(edge(step) + edge(step + 1))
        };
        (0..STEPS).map(part).sum::<f64>() as f32
    }
    /// The density of a deflection, 1/sr.
    pub(super) fn density(&self, cos: f32) -> f32 {
        self.mean[step_of(cos)]
    }
    /// The density for each lane, by that.
    pub(super) fn tint(&self, basis: &Basis, cos: f32) -> Spectrum {
        let step = step_of(cos);
        match basis {
            Basis::Rgb => {
                let [r, g, b] = HUES.map(|nm| self.of_wave(step, nm as f32));
                basis.reflectance(Color::new(r, g, b))
            }
            Basis::Spectral(wavelengths) => wavelengths.map(Spectrum::ONE, |nm, _| self.of_wave(step, nm)),
        }
    }
    fn of_wave(&self, step: usize, nm: f32) -> f32 {
        let place = ((nm - FIRST) / APART).clamp(0.0, (WAVES - 1) as f32);
        let before = (place as usize).min(WAVES - 2);
        let [a, b] = [before, before + 1].map(|wave| self.tints[wave * STEPS + step]);
        a + (b - a) * (place - before as f32)
    }
    /// The cosine of a deflection, drawn by `u` in `[0, 1)`.
    pub(super) fn cos(&self, u: f32) -> f32 {
        let step = self.guide.upto(u, STEPS - 1, |i| self.upto[i]);
        let before = if step > 0 { self.upto[step - 1] } else { 0.0 };
        let within = self.upto[step] - before;
        let share = if within > 0.0 { ((u - before) / within).clamp(0.0, 1.0) } else { 0.5 };
        edge(step) + (edge(step + 1) - edge(step)) * share
    }
}

/// The cosine where a step begins.
fn edge(step: usize) -> f32 {
    // Behind a right angle, where cosines of small angles are exact, from the other side.
    match step * 2 > STEPS {
        true => -cos(PI * (STEPS - step) as f32 / STEPS as f32),
        false => cos(PI * step as f32 / STEPS as f32),
    }
}

/// The solid angle of a step.
fn angles(step: usize) -> f32 {
    let middle = sin(PI * (step as f32 + 0.5) / STEPS as f32);
    2.0 * TAU * middle * sin(0.5 * PI / STEPS as f32)
}

fn step_of(cos: f32) -> usize {
    ((acos(cos.clamp(-1.0, 1.0)) * (STEPS as f32 / PI)) as usize).min(STEPS - 1)
}

/// Which share of light drops of this index turn by each step of angles.
fn turned_by(n: f32) -> Vec<f64> {
    let mut shares = vec![0.0; STEPS];
    // Where a ray is turned to, for each number of chords, by the angle of incidence.
    let turns = |i: f32| -> [f32; CHORDS + 1] {
        let r = asin(sin(i) / n);
        std::array::from_fn(|p| 2.0 * i - 2.0 * p as f32 * r + (p as f32 - 1.0) * PI)
    };
    let mut before = turns(0.0);
    for ray in 0..RAYS {
        let [from, middle, to] = [0.0, 0.5, 1.0].map(|part| FRAC_PI_2 * (ray as f32 + part) / RAYS as f32);
        let after = turns(to);
        // Light that meets the drop between two angles.
        let light = f64::from(sqr(sin(to))) - f64::from(sqr(sin(from)));
        let (s, p) = fresnel_polarized(cos(middle), n);
        for (chords, ends) in before.into_iter().zip(after).enumerate() {
            let left = |mirrored: f32| match chords {
                0 => mirrored,
                _ => sqr(1.0 - mirrored) * mirrored.powi(chords as i32 - 1),
            };
            add(&mut shares, light * f64::from(0.5 * (left(s) + left(p))), ends);
        }
        before = after;
    }
    shares
}

/// Spreads a share evenly over the angles from one to the other, in radians, which may go round.
fn add(shares: &mut [f64], share: f64, (a, b): (f32, f32)) {
    let [low, high] =
        [a.min(b), a.max(b)].map(|angle| f64::from(angle) * STEPS as f64 / std::f64::consts::PI);
    // As narrow as rounding makes it, it is a point.
    let width = (high - low).max(1e-3);
    let mut from = low;
    while from < low + width {
        let to = (from.floor() + 1.0).min(low + width);
        // Turned by 200 degrees is turned by 160 to the other side.
        let around = (from.floor() as i64).rem_euclid(2 * STEPS as i64);
        let step = around.min(2 * STEPS as i64 - 1 - around) as usize;
        shares[step] += share * (to - from) / width;
        from = to;
    }
}

#[cfg(test)]
mod tests;
