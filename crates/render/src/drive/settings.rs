//! How a picture is taken.
use durer_core::{
    sampling::{Dim, Sampler, SamplerKind},
    spectrum::Carried,
};

use super::Antialias;
use crate::film::Tile;

/// Samples, seed, threads and crop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples per pixel.
    pub samples: u32,
    /// How sample indices become numbers.
    pub sampler: SamplerKind,
    /// How samples divide among the effects of the camera.
    pub nesting: Nesting,
    /// Changes every random number.
    pub seed: u64,
    /// Worker threads.
    pub threads: usize,
    /// The part of the picture that is rendered; the rest stays black.
    pub crop: Option<Tile>,
    /// Where the samples of a pixel lie.
    pub antialias: Antialias,
    /// Whether rays carry colours or wavelengths.
    pub carried: Carried,
    /// Whether every sample draws wavelengths of its own.
    pub wavelengths: Jitter,
}

/// Whether samples draw something, or have what lies in the middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jitter {
    /// They draw it.
    #[default]
    Drawn,
    /// They all have the same.
    Middle,
}

/// How many samples share a place and a moment. Of the `A T L` samples of a pixel `T L` in sequence go through each of its
/// `A` places, and `L` of these at each of the `T` moments; every sample has a point on the lens of its own. 0 stands for an
/// effect that is left out: everything at half exposure, everything in focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nesting {
    /// Whether places are spread over the pixel at all.
    pub place: Jitter,
    /// Moments for each place in the pixel.
    pub time: u32,
    /// Points on the lens for each moment.
    pub lens: u32,
}

impl Default for Nesting {
    /// Every sample has a place, a moment and a point on the lens of its own.
    fn default() -> Self {
        Self { place: Jitter::Drawn, time: 1, lens: 1 }
    }
}

impl Nesting {
    /// All samples are the same but for what becomes of their rays.
    pub const STILL: Self = Self { place: Jitter::Middle, time: 0, lens: 0 };

    /// The samples of each place in the pixel.
    pub fn per_place(self) -> u32 {
        self.time.max(1).saturating_mul(self.lens.max(1))
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            samples: 64,
            sampler: SamplerKind::default(),
            nesting: Nesting::default(),
            seed: 0,
            threads: 1,
            crop: None,
            antialias: Antialias::Supersample,
            carried: Carried::Rgb,
            wavelengths: Jitter::Drawn,
        }
    }
}

impl Settings {
    /// The number that chooses wavelengths.
    pub(super) fn lambda(&self, sampler: &Sampler) -> f32 {
        match self.wavelengths {
            Jitter::Drawn => sampler.d1(Dim::Lambda),
            Jitter::Middle => 0.5,
        }
    }
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
