//! A coat that light scatters in: the walk below it meets particles between the surfaces as well.
//!
//! As in the volume below a surface (Guo, Hasan and Zhao 2018; pbrt-v4's model): flights end after an exponential way of one
//! mean free path, the share `albedo` goes on by the phase function of Henyey and Greenstein 1941,
//! `p = (1 - g²) / (4 pi (1 + g² - 2 g cos)^(3/2))` for the cosine of the deflection.
use durer_core::{
    math::{Vector3, float::ln},
    spectrum::Spectrum,
};

use super::{Dice, Layered, square_share};
use crate::{bsdf::coat::faded, medium::HenyeyGreenstein};

/// What is in a coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cloud {
    /// Share of light that goes on where it meets a particle, in `[0, 1]`; black: particles absorb.
    pub albedo: Spectrum,
    /// Asymmetry, -1 to 1: the mean cosine of the deflection.
    pub g: f32,
}

impl Cloud {
    /// Nothing that scatters.
    pub const NONE: Self = Self { albedo: Spectrum::BLACK, g: 0.0 };
    /// Asymmetries nearer to straight on or back are as sharp as these.
    const SHARPEST: f32 = 0.99;

    /// Of this albedo and asymmetry, as far as they make sense.
    pub fn new(albedo: Spectrum, g: f32) -> Self {
        Self { albedo: albedo.map(|v| v.clamp(0.0, 1.0)), g: g.clamp(-Self::SHARPEST, Self::SHARPEST) }
    }
    pub(super) fn scatters(&self) -> bool {
        !self.albedo.is_black()
    }
    fn phase(&self) -> HenyeyGreenstein {
        HenyeyGreenstein::new(self.g)
    }
}

/// A walk on its way.
struct Flight {
    /// Where it goes.
    w: Vector3,
    /// Depth below the coat's upper side, in mean free paths.
    depth: f32,
    beta: Spectrum,
}

/// The way out of the coat, walked backwards: its direction below, and its share.
type Exit = Option<(Vector3, f32)>;

impl Layered {
    /// A walk from `o` to `i` among the particles.
    pub(super) fn clouded_walk(&self, o: Vector3, i: Vector3, dice: &mut Dice) -> Spectrum {
        let Some((w, share)) = self.entered(o, dice.point()) else { return Spectrum::BLACK };
        let exit = self.entered(i, dice.point());
        let mut flight = Flight { w, depth: 0.0, beta: Spectrum::splat(share) };
        let mut sum = Spectrum::BLACK;
        for event in 0..2 * self.bounces {
            let way = -ln(1.0 - dice.unit()) * flight.w.z.abs();
            let reached = flight.depth - way * flight.w.z.signum();
            let goes_on = if reached > 0.0 && reached < self.thickness {
                flight.depth = reached;
                sum += self.met_particle(&mut flight, (i, exit), dice);
                true
            } else if flight.w.z < 0.0 {
                flight.depth = self.thickness;
                self.met_body(&mut flight, (i, exit), dice, &mut sum)
            } else {
                flight.depth = 0.0;
                self.met_coat(&mut flight, dice)
            };
            let kept = if event > 2 { (4.0 * flight.beta.max()).min(1.0) } else { 1.0 };
            if !goes_on || flight.w.z == 0.0 || (kept < 1.0 && dice.unit() >= kept) {
                break;
            }
            flight.beta = flight.beta / kept;
        }
        sum
    }

    /// What is left of light from a depth to the upper side along a direction.
    fn faded_above(&self, depth: f32, w: Vector3) -> f32 {
        if depth == 0.0 { 1.0 } else { faded(depth, w) }
    }

    /// What of a direction that was drawn with this density leaves the coat towards `i` right away, per the same weight.
    fn leaves(&self, flight: &Flight, i: Vector3, density: Option<f32>) -> Spectrum {
        if self.coat.is_smooth() || flight.w.z <= 0.0 {
            return Spectrum::BLACK;
        }
        let (value, other) = self.entering(i, -flight.w);
        let kept = density.map_or(1.0, |own| square_share(own, other));
        flight.beta * (value * self.faded_above(flight.depth, flight.w) * kept)
    }

    /// Scatters; what leaves from there towards `i`.
    fn met_particle(&self, flight: &mut Flight, (i, exit): (Vector3, Exit), dice: &mut Dice) -> Spectrum {
        flight.beta *= self.cloud.albedo;
        let mut sum = Spectrum::BLACK;
        if let Some((out, share)) = exit {
            let phase = self.cloud.phase().density(flight.w.dot(-out));
            let kept = match self.coat.is_smooth() {
                true => 1.0,
                false => square_share(self.entering(i, out).1, phase),
            };
            let passed = share / out.z.abs() * self.faded_above(flight.depth, out) * kept;
            sum += flight.beta * (phase * passed);
        }
        let before = flight.w;
        flight.w = self.cloud.phase().deflected(before, dice.point());
        sum + self.leaves(flight, i, Some(self.cloud.phase().density(before.dot(flight.w))))
    }

    /// Is reflected by the body; false if that keeps all.
    fn met_body(
        &self,
        flight: &mut Flight,
        (i, exit): (Vector3, Exit),
        dice: &mut Dice,
        sum: &mut Spectrum,
    ) -> bool {
        let from = -flight.w;
        let is_smooth = self.below.is_smooth();
        if let Some((out, share)) = exit.filter(|_| !is_smooth) {
            let kept = match self.coat.is_smooth() {
                true => 1.0,
                false => square_share(self.entering(i, out).1, self.below.density(from, -out)),
            };
            let passed = share * self.faded_above(self.thickness, out) * kept;
            *sum += flight.beta * self.below.value(from, -out) * passed;
        }
        let Some((up, weight)) = self.below.reflected(from, dice.point()) else { return false };
        flight.beta *= weight;
        flight.w = up;
        let density = (!is_smooth).then(|| self.below.density(from, up));
        *sum += self.leaves(flight, i, density);
        !flight.beta.is_black()
    }

    /// Is sent back by the coat; false if it is not.
    fn met_coat(&self, flight: &mut Flight, dice: &mut Dice) -> bool {
        let Some((back, share)) = self.sent_back(flight.w, dice.point()) else { return false };
        flight.w = back;
        flight.beta = flight.beta * share;
        true
    }
}
