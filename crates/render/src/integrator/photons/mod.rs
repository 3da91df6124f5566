//! Photons: what the samples of one index share where light is gathered (Jensen 1996, "Global Illumination using Photon
//! Maps").
//!
//! Pass `i` gathers within `r_i`, with `r_{i+1}² = r_i² (i + a) / (i + 1)` and `a = 2/3`: the mean of passes that know
//! nothing of each other converges as that of progressive photon mapping does (Knaus and Zwicker 2011, "Progressive Photon
//! Mapping: A Probabilistic Approach", section 3). What a pass shares is a pure function of (scene, seed, index).
mod map;
mod send;

use durer_core::math::Point2;
use durer_model::camera::Lens;

use crate::{SampleCx, View, probe::NoProbe};

pub use map::{Photon, Photons};
pub use send::{Sent, send};

/// How fast discs shrink: of the variance of a pass, less is more.
const ALPHA: f64 = 2.0 / 3.0;
/// The first disc's radius in pixels, if nothing is said.
const PIXELS: f32 = 3.0;
/// Eye rays per row and column that look how wide pixels are.
const LOOKS: u32 = 16;
/// Bytes that the photons of a pass may take.
pub(super) const MOST_BYTES: u64 = 4 << 30;

/// What an integrator asks of the photons of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathering {
    /// Particles of a pass; `None`: as many as the picture has pixels, if they fit.
    pub particles: Option<u32>,
    /// Radius of the discs of the first pass, in metres; `None`: that of some pixels.
    pub radius: Option<f32>,
    /// Surfaces that light is scattered by at most, between light and eye.
    pub max_depth: u32,
    /// Of those, before chance may end the way of a particle.
    pub roulette_depth: u32,
    /// Changes the numbers of photons, and of nothing else.
    pub seed: u32,
}

impl Gathering {
    /// Bytes that so many particles may take if none of them ends early.
    pub fn bytes(&self, particles: u32) -> u64 {
        // The first hit is direct light and kept by nobody.
        let kept = u64::from(self.max_depth.saturating_sub(1));
        u64::from(particles).saturating_mul(kept).saturating_mul(Photons::BYTES)
    }

    /// Particles of each pass for a picture.
    pub fn particles(&self, view: &View) -> u32 {
        let pixels = u64::from(view.width) * u64::from(view.height);
        let fit = (MOST_BYTES / self.bytes(1).max(1)).min(u64::from(u32::MAX));
        self.particles.unwrap_or(pixels.clamp(1, fit) as u32)
    }

    /// Radius of the discs of pass `index`, in metres.
    pub fn radius(&self, cx: &SampleCx<'_>, index: u32) -> f32 {
        let first = self.radius.unwrap_or_else(|| of_pixels(cx));
        let squared: f64 = (1..=index).map(f64::from).map(|i| (i + ALPHA) / (i + 1.0)).product();
        (f64::from(first) * squared.sqrt()) as f32
    }
}

/// The width of some pixels where eye rays meet the scene: in the middle of all of them.
fn of_pixels(cx: &SampleCx<'_>) -> f32 {
    let view = &cx.scene.view;
    let time = view.shutter.moment(0.5, view.height / 2, view.height);
    let mut widths: Vec<f32> = (0..LOOKS * LOOKS)
        .filter_map(|i| {
            let part = |i: u32, size: u32| (i as f32 + 0.5) / LOOKS as f32 * size as f32;
            let film = Point2::new(part(i % LOOKS, view.width), part(i / LOOKS, view.height));
            let ray = view.ray(film, Lens::CENTRE, time);
            let t = cx.scene.closest(cx, &ray, &mut NoProbe, ())?.t;
            let beside = view.ray(Point2::new(film.x + 1.0, film.y), Lens::CENTRE, time);
            Some((beside.at(t) - ray.at(t)).length()).filter(|width| width.is_normal())
        })
        .collect();
    widths.sort_by(f32::total_cmp);
    match widths.get(widths.len() / 2) {
        Some(width) => PIXELS * width,
        // The camera looks away: whatever is chosen is not seen.
        None => (0.01 * cx.scene.extent.radius).max(f32::MIN_POSITIVE.sqrt()),
    }
}
