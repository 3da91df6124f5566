//! Which samples when, and the eye ray of each.
use durer_core::{
    math::{Point2, Ray},
    sampling::{Dim, Sampler},
};

use super::Settings;
use crate::{View, film::BLOCK};

/// The passes of a render: a first look after one sample, then four times as many each, then block by block. No pass
/// crosses the end of a block.
pub(super) fn passes(samples: u32) -> Vec<(u32, u32)> {
    let mut passes = Vec::new();
    let mut first = 0;
    while first < samples {
        let last = match first {
            0 => 1,
            _ if first < BLOCK => (first * 4).min(BLOCK),
            _ => first + BLOCK,
        };
        passes.push((first, last.min(samples)));
        first = last;
    }
    passes
}

/// The eye ray through a pixel: jittered by the sampler, spread by the filter, at a moment of the shutter interval.
pub(super) fn eye_ray(view: &View, settings: &Settings, pixel: [u32; 2], sampler: &Sampler) -> Ray {
    let jitter = sampler.d2(Dim::Pixel);
    let film = Point2::new(pixel[0] as f32 + jitter.x, pixel[1] as f32 + jitter.y);
    ray_through(view, settings, film, sampler)
}

/// The eye ray through a point of the picture, in pixels, at a moment of the shutter interval.
pub(super) fn ray_through(view: &View, settings: &Settings, film: Point2, sampler: &Sampler) -> Ray {
    let shutter = settings.shutter;
    let time = if shutter.min == shutter.max { shutter.min } else { shutter.at(sampler.d1(Dim::Time)) };
    view.ray(film, time, sampler)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_gapless_and_end_with_blocks() {
        assert_eq!(passes(1), [(0, 1)]);
        assert_eq!(passes(100), [(0, 1), (1, 4), (4, 16), (16, 64), (64, 100)]);
        for n in 1..300 {
            let p = passes(n);
            assert!(p.windows(2).all(|w| w[0].1 == w[1].0) && p[p.len() - 1].1 == n);
            assert!((BLOCK..=n).step_by(BLOCK as usize).all(|end| p.iter().any(|w| w.1 == end)));
        }
    }
}
