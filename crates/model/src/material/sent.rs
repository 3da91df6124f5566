//! How bright a surface can be, from how bright all is that it sees.
//!
//! What leaves a surface is `L <= own + (1 - k) scattered + k B` for some `k` up to `followed`, where `B` is the radiance
//! of the rays that are followed from it. If every ray of a scene is to be at most `B`, so must this: `B >= scattered`
//! where `own` is 0, else `B >= own / (1 - followed) + scattered`, and there is no bound where `followed` is 1.
use std::f32::consts::{E, PI};

use durer_core::math::float::sqr;

use crate::bsdf::Distribution;

/// How bright it is around a surface, at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arriving {
    /// Radiance of the sky, and of the ambient term.
    pub sky: f32,
    /// Radiance of lights with extent.
    pub lamps: f32,
    /// Irradiance of all lights without extent together on a surface that faces them, divided by pi: what a white matte
    /// surface makes of it.
    pub facing: f32,
    /// How reflections that spread are seen.
    pub gloss: GlossRays,
}

/// How integrators see reflections that spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlossRays {
    /// By a ray in the main direction, as far as they are sharp enough.
    Main,
    /// By rays about it.
    Drawn,
}

impl Arriving {
    /// From everywhere.
    pub(super) fn all(&self) -> f32 {
        self.sky + self.lamps + self.facing
    }
    /// A highlight of lights without extent: `gain` is the largest `pi f cos`.
    pub(super) fn highlight(&self, gain: f32) -> f32 {
        if self.facing == 0.0 { 0.0 } else { self.facing * gain }
    }
}

/// What a surface can send at most: see this file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sent {
    /// Radiance beside what it shares out. Infinite if it has no bound.
    pub own: f32,
    /// Radiance that it makes of what arrives if it follows no ray.
    pub scattered: f32,
    /// The largest sum of the weights of rays that are followed, 0 to 1.
    pub followed: f32,
}

impl Sent {
    /// Nothing is known.
    pub const UNBOUNDED: Self = Self { own: f32::INFINITY, scattered: 0.0, followed: 0.0 };

    /// The largest radiance in a scene whose other surfaces send no more; infinite if there is none.
    pub fn bound(&self) -> f32 {
        match self.own {
            own if own <= 0.0 => self.scattered,
            own if self.followed < 1.0 => own / (1.0 - self.followed) + self.scattered,
            _ => f32::INFINITY,
        }
    }
}

/// The largest `pi f cos` of what microfacets reflect. Of GGX `D <= 1 / (pi alpha²)` and `V cos <= 1 / (2 alpha)`, of Beckmann
/// up to alpha = 1 `D <= 4 / (pi e alpha²)` and `V cos <= sqrt(pi) / (2 alpha)`.
pub(super) fn facet_gain(alpha: f32, like: Distribution) -> f32 {
    let cubed = sqr(alpha) * alpha;
    match like {
        Distribution::Ggx => 1.0 / (2.0 * cubed),
        Distribution::Beckmann => 2.0 * PI.sqrt() / (E * cubed),
    }
}

/// The largest `pi f cos` of a lobe with the density `(n + 1) / (2 pi) cos^n`, of which a part may be turned onto another.
pub(super) fn cosine_gain(exponent: f32) -> f32 {
    2.0 * PI * (exponent + 1.0) / (2.0 * PI)
}
