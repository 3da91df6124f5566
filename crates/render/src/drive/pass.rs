//! Which samples when, and the eye ray of each.
use durer_core::{
    math::{Point2, Ray},
    sampling::{Dim, Sampler},
};
use durer_model::camera::Lens;

use super::Nesting;
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

/// The eye ray of a sample of `pixel`, and its weight: spread by the filter, at a moment of the exposure, through a point
/// of the lens.
pub(super) fn eye_ray(view: &View, nesting: Nesting, pixel: [u32; 2], sampler: &Sampler) -> (Ray, f32) {
    let place = view.filter.sample(sampler.shared_by(nesting.per_place()).d2(Dim::Pixel));
    let film = [0, 1].map(|i| pixel[i] as f32 + 0.5 + place.offset[i]);
    (ray_through(view, nesting, Point2::new(film[0], film[1]), pixel[1], sampler), place.weight)
}

/// The eye ray through a point of the picture, in pixels, when the row it lies in is exposed.
pub(super) fn ray_at(view: &View, nesting: Nesting, film: Point2, sampler: &Sampler) -> Ray {
    ray_through(view, nesting, film, (film.y as u32).min(view.height.saturating_sub(1)), sampler)
}

/// The eye ray through a point of the picture, in pixels, when this row is exposed.
fn ray_through(view: &View, nesting: Nesting, film: Point2, row: u32, sampler: &Sampler) -> Ray {
    let u = match nesting.time {
        0 => 0.5,
        _ if view.shutter.is_instant() => 0.5,
        _ => sampler.shared_by(nesting.lens).d1(Dim::Time),
    };
    let lens = match nesting.lens {
        0 => Lens::CENTRE,
        _ if !view.camera.lens().is_open() => Lens::CENTRE,
        _ => sampler.d2(Dim::Lens),
    };
    view.ray(film, lens, view.shutter.moment(u, row, view.height))
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
