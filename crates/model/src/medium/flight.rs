//! How far a ray gets in a volume, what it meets there and what is left of light on a way.
//!
//! Rays are followed by null scattering (Woodcock et al. 1965; Miller, Georgiev and Jarosz 2019, "A Null-Scattering Path
//! Integral Formulation of Light Transport"; Physically Based Rendering, 4th edition, section 11.2): places are drawn as
//! if the volume were as dense as its bound, and at each it is drawn whether anything is there. Absorption is weighed, not
//! drawn. Where the volume is the same everywhere places are drawn from `sigma_t exp(-sigma_t t)`, and what it sends out on
//! the way has a closed form; where nothing scatters nothing is drawn.
//!
//! Lanes that scatter differently share the path. One of them leads, each as often, and the path counts by the mean of the
//! densities with which the lanes would have drawn it (one-sample balance heuristic, Veach 1997; hero wavelengths, Wilkie et
//! al. 2014). `lanes` are these densities by their mean: how likely each lane has led so far. Drawing by that chance anew at
//! every step gives the same paths with the same densities, so that nobody needs to remember which one leads.
use durer_core::{
    math::{
        Point2, Ray,
        float::{exp, ln},
    },
    spectrum::{Basis, Spectrum},
};

use super::{Volume, volume::Local};

/// Shares below which chance ends a way to a light, and how often it does.
const LITTLE: f32 = 0.05;
const ENDED: f32 = 0.75;

/// The random numbers of a flight: the first, second, ... point of the unit square.
pub type Draws<'a> = &'a dyn Fn(u32) -> Point2;

/// Where a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At the end of the way.
    Through,
    /// At a particle, at this parameter of the ray.
    Scattered(f32),
}

/// Who flies, and what is in the way besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flier {
    /// What lanes mean.
    pub basis: Basis,
    /// The densities of the lanes so far, with mean 1.
    pub lanes: Spectrum,
    /// What the body around the volume absorbs, 1/m: it dims what is sent out on the way, and is no part of the weight.
    pub absorption: Spectrum,
}

/// What became of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Where it ended.
    pub end: End,
    /// What light that comes from there is multiplied with: what is left of it, or scattered, by the density of this end.
    pub weight: Spectrum,
    /// The density with which each lane would have drawn all this, by the mean over the lanes.
    pub lanes: Spectrum,
    /// The probability of getting so far, over all lanes; 1 where nothing is drawn.
    pub passed: f32,
    /// What the volume sends to the start of the ray.
    pub sent: Spectrum,
}

/// What of light passes on a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// The share that arrives, in the mean over the random numbers.
    pub share: Spectrum,
    /// The probability with which a ray that a lane leads gets through; 1 where nothing is drawn.
    pub passed: Spectrum,
}

/// `(1 - exp(-x)) / x`.
fn mean_of_fading(x: f32) -> f32 {
    match x {
        _ if x < 1e-3 => 1.0 - 0.5 * x,
        _ if x.is_finite() => (1.0 - exp(-x)) / x,
        _ => 0.0,
    }
}

/// What is left after a way; after an infinite one nothing, but where nothing is lost at all.
pub(super) fn left(sigma: Spectrum, way: f32) -> Spectrum {
    sigma.map(|s| if s > 0.0 { exp(-s * way) } else { 1.0 })
}

impl Flier {
    /// What is left of light that is sent out so far on the way.
    pub(super) fn dimmed(&self, sent: Spectrum, way: f32) -> Spectrum {
        if sent.is_black() || self.absorption.is_black() { sent } else { sent * left(self.absorption, way) }
    }
}

impl Volume {
    /// Follows a ray of unit direction from its parameter `t0` to `t1`.
    pub fn fly(&self, flier: &Flier, ray: &Ray, span: (f32, f32), draws: Draws<'_>) -> Flight {
        match (self.is_even(), self.scatters()) {
            (true, scatters) => {
                let beside = (!self.is_dark()).then_some(flier.absorption);
                self.at(flier.basis, ray.o).fly_evenly((scatters, beside), flier.lanes, span, draws)
            }
            (false, true) => self.fly_by_chance(flier, ray, span, draws),
            (false, false) => self.fade(flier, ray, span, draws),
        }
    }

    fn fly_by_chance(&self, flier: &Flier, ray: &Ray, span: (f32, f32), draws: Draws<'_>) -> Flight {
        let Flier { basis, mut lanes, .. } = *flier;
        let most = self.most(basis);
        let (mut weight, mut passed, mut sent) = (Spectrum::ONE, 1.0, Spectrum::BLACK);
        let mut places = Places::new(draws);
        for (from, to, density) in self.steps(ray, span) {
            let bound = most * density;
            let mut t = from;
            while let Some((at, u)) = places.next(&mut t, to, bound) {
                let here = self.at(basis, ray.at(at));
                let sigma_t = here.sigma_a + here.sigma_s;
                sent += flier.dimmed(weight * here.added / bound, at - span.0);
                let met = lanes * sigma_t;
                if u < met.mean() / bound {
                    weight = weight * here.sigma_s / met.mean();
                    lanes = met / met.mean();
                    return Flight { end: End::Scattered(at), weight, lanes, passed, sent };
                }
                let nothing = sigma_t.map(|s| (bound - s).max(0.0));
                let missed = (lanes * nothing).mean();
                if missed <= 0.0 {
                    // Rounding let it get by what fills the whole bound.
                    return Flight { end: End::Through, weight: Spectrum::BLACK, lanes, passed: 0.0, sent };
                }
                weight = weight * nothing / missed;
                lanes = lanes * nothing / missed;
                passed *= missed / bound;
            }
        }
        Flight { end: End::Through, weight, lanes, passed, sent }
    }

    /// Follows a ray through what does not scatter.
    fn fade(&self, flier: &Flier, ray: &Ray, span: (f32, f32), draws: Draws<'_>) -> Flight {
        let mut sent = Spectrum::BLACK;
        let weight = self.ratio(flier.basis, ray, span, draws, |added, at| {
            sent += flier.dimmed(added, at - span.0);
        });
        Flight { end: End::Through, weight, lanes: flier.lanes, passed: 1.0, sent }
    }

    /// What of light passes from parameter `t0` to `t1` of a ray of unit direction.
    pub fn pass(&self, basis: Basis, ray: &Ray, (t0, t1): (f32, f32), draws: Draws<'_>) -> Passage {
        let share = match self.is_even() {
            true => {
                let here = self.at(basis, ray.o);
                left(here.sigma_a + here.sigma_s, (t1 - t0).max(0.0))
            }
            false => self.ratio(basis, ray, (t0, t1), draws, |_, _| {}),
        };
        Passage { share, passed: if self.scatters() { share } else { Spectrum::ONE } }
    }

    /// Ratio tracking (Novak, Selle and Jarosz 2014): at each place that is drawn the share is left which the bound has to
    /// spare. What is sent out along the way goes to `send`, and from where.
    pub(super) fn ratio(
        &self,
        basis: Basis,
        ray: &Ray,
        span: (f32, f32),
        draws: Draws<'_>,
        mut send: impl FnMut(Spectrum, f32),
    ) -> Spectrum {
        let most = self.most(basis);
        let mut share = Spectrum::ONE;
        let mut places = Places::new(draws);
        for (from, to, density) in self.steps(ray, span) {
            let bound = most * density;
            let mut t = from;
            while let Some((at, u)) = places.next(&mut t, to, bound) {
                let here = self.at(basis, ray.at(at));
                send(share * here.added / bound, at);
                share *= (here.sigma_a + here.sigma_s).map(|s| (1.0 - s / bound).max(0.0));
                if share.max() < LITTLE {
                    if u < ENDED || share.is_black() {
                        return Spectrum::BLACK;
                    }
                    share = share / (1.0 - ENDED);
                }
            }
        }
        share
    }
}

impl Local {
    /// Follows a ray where everything is as here, which `scatters` or not, and glows if it is known what a body absorbs
    /// `beside` it.
    pub(super) fn fly_evenly(
        &self,
        (scatters, beside): (bool, Option<Spectrum>),
        lanes: Spectrum,
        (t0, t1): (f32, f32),
        draws: Draws<'_>,
    ) -> Flight {
        let sigma_t = self.sigma_a + self.sigma_s;
        let way = (t1 - t0).max(0.0);
        let sent = match beside.map(|absorption| sigma_t + absorption) {
            None => Spectrum::BLACK,
            // After an infinite way exp(-x) / x counts as 0, and 1 / sigma is left.
            Some(lost) if way.is_finite() => self.added * lost.map(|s| way * mean_of_fading(s * way)),
            Some(lost) => self.added.zip(lost, |added, s| if s > 0.0 { added / s } else { 0.0 }),
        };
        if !scatters {
            return Flight { end: End::Through, weight: left(sigma_t, way), lanes, passed: 1.0, sent };
        }
        let u = draws(0);
        let t = -ln(1.0 - u.x) / lead(sigma_t, lanes, u.y);
        if t < way {
            let density = left(sigma_t, t) * sigma_t * lanes;
            let weight = left(sigma_t, t) * self.sigma_s / density.mean();
            let lanes = density / density.mean();
            return Flight { end: End::Scattered(t0 + t), weight, lanes, passed: 1.0, sent };
        }
        let left = left(sigma_t, way);
        let density = left * lanes;
        let passed = density.mean();
        Flight { end: End::Through, weight: left / passed, lanes: density / passed, passed, sent }
    }
}

/// The coefficient of the lane that leads, chosen by `u` with the chances that the lanes have led so far.
fn lead(sigma: Spectrum, lanes: Spectrum, u: f32) -> f32 {
    let mut rest = u * 4.0 * lanes.mean();
    let mut chosen = 0.0;
    for lane in 0..4 {
        if lanes.lane(lane) > 0.0 {
            chosen = sigma.lane(lane);
            rest -= lanes.lane(lane);
            if rest < 0.0 {
                break;
            }
        }
    }
    chosen
}

/// Places along a ray, drawn as if particles were as dense as the bounds.
struct Places<'a> {
    draws: Draws<'a>,
    count: u32,
    /// Optical depth to the next place.
    depth: f32,
    /// The second random number of that place.
    u: f32,
}

impl<'a> Places<'a> {
    fn new(draws: Draws<'a>) -> Self {
        let mut places = Self { draws, count: 0, depth: 0.0, u: 0.0 };
        places.draw();
        places
    }
    fn draw(&mut self) {
        let u = (self.draws)(self.count);
        (self.depth, self.u) = (-ln(1.0 - u.x), u.y);
        self.count += 1;
    }
    /// The next place behind `t` and before `to`, with a number in `[0, 1)`; `t` goes there, or to the end.
    fn next(&mut self, t: &mut f32, to: f32, bound: f32) -> Option<(f32, f32)> {
        let at = *t + self.depth / bound;
        if at < to {
            *t = at;
            let found = (at, self.u);
            self.draw();
            return Some(found);
        }
        // What is infinite or NaN where there is nothing is not counted.
        let counted = (to - *t) * bound;
        self.depth = if counted > 0.0 { (self.depth - counted).max(0.0) } else { self.depth };
        None
    }
}
