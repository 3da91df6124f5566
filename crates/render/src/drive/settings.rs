//! How a picture is taken.
use durer_core::{math::Interval, sampling::SamplerKind};

use super::Antialias;
use crate::film::Tile;

/// Samples, seed, threads, shutter and crop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples per pixel.
    pub samples: u32,
    /// How sample indices become numbers.
    pub sampler: SamplerKind,
    /// Changes every random number.
    pub seed: u64,
    /// Worker threads.
    pub threads: usize,
    /// Seconds from which each sample's moment is drawn.
    pub shutter: Interval,
    /// The part of the picture that is rendered; the rest stays black.
    pub crop: Option<Tile>,
    /// Where the samples of a pixel lie.
    pub antialias: Antialias,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            samples: 64,
            sampler: SamplerKind::default(),
            seed: 0,
            threads: 1,
            shutter: Interval::point(0.0),
            crop: None,
            antialias: Antialias::Supersample,
        }
    }
}

impl Settings {
    /// The rendered part of a picture of this size.
    pub fn window(&self, width: u32, height: u32) -> Tile {
        let all = Tile { x0: 0, y0: 0, x1: width, y1: height };
        self.crop.map_or(all, |c| Tile {
            x0: c.x0.min(width),
            y0: c.y0.min(height),
            x1: c.x1.clamp(c.x0.min(width), width),
            y1: c.y1.clamp(c.y0.min(height), height),
        })
    }
}
