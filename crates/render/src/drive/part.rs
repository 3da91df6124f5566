//! A part of a picture, counted: what the whole will cost.
use std::{
    sync::{Mutex, atomic::AtomicBool},
    time::{Duration, Instant},
};

use super::{Job, adaptive::Sounding, crew, lock};
use crate::{Contribution, film::Tile, probe::Counters};

/// What some pixels took.
#[derive(Clone, Debug, Default)]
pub struct PartCount {
    /// Pixels that were rendered.
    pub pixels: u64,
    /// Samples of them.
    pub samples: u64,
    /// Rays, stops and tests.
    pub counters: Counters,
    /// Time that all threads together spent, counting included.
    pub busy: Duration,
}

/// One pixel of every square of `edge` pixels in `window`, at another place in each: never all on one grid line.
pub fn scattered(window: Tile, edge: u32) -> Vec<[u32; 2]> {
    let edge = edge.max(1);
    let squares = (window.y0..window.y1)
        .step_by(edge as usize)
        .flat_map(|y| (window.x0..window.x1).step_by(edge as usize).map(move |x| [x, y]));
    squares
        .map(|[x, y]| {
            let hash = (x.wrapping_mul(0x9E37_79B9) ^ y.wrapping_mul(0x85EB_CA6B)).wrapping_mul(0xC2B2_AE35);
            let (right, bottom) = ((x + edge).min(window.x1), (y + edge).min(window.y1));
            [x + (hash >> 8) % (right - x), y + (hash >> 20) % (bottom - y)]
        })
        .collect()
}

impl Job<'_> {
    /// Takes all samples of these pixels, of adaptive antialiasing a pixel's share of them, and counts; the picture is
    /// thrown away. Sums do not depend on threads.
    pub fn count(&self, pixels: &[[u32; 2]], cancel: &AtomicBool) -> PartCount {
        let all = Mutex::new(PartCount::default());
        let sounding = self.adaptive().map(|how| Sounding::new(self, how));
        crew::share_out(pixels, self.settings.threads, cancel, |pixel, out: &mut Contribution| {
            let own = match &sounding {
                Some(sounding) => {
                    let (done, busy) = sounding.pixel(pixel);
                    let counters = done.counters.unwrap_or_default();
                    PartCount { pixels: 1, samples: done.samples, counters, busy }
                }
                None => self.count_pixel(pixel, out),
            };
            lock(&all).merge(&own);
        });
        all.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn count_pixel(&self, pixel: [u32; 2], out: &mut Contribution) -> PartCount {
        let mut own = PartCount { pixels: 1, samples: self.settings.samples.into(), ..PartCount::default() };
        let start = Instant::now();
        for sample in 0..self.settings.samples {
            let shared = self.kept(sample);
            let job = self.of_pass(shared.as_ref());
            let (eye, _) = job.eye(pixel, sample);
            if !job.is_blocked(&eye) {
                job.integrator.count(&job.cx(&eye.ray.sampler), &eye.ray, out, &mut own.counters);
            }
        }
        own.busy = start.elapsed();
        own
    }
}

impl PartCount {
    fn merge(&mut self, o: &Self) {
        self.pixels += o.pixels;
        self.samples += o.samples;
        self.counters.merge(&o.counters);
        self.busy += o.busy;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundredth_is_scattered_over_the_window() {
        let window = Tile { x0: 3, y0: 5, x1: 203, y1: 118 };
        let pixels = scattered(window, 10);
        assert_eq!(pixels.len(), 20 * 12);
        for &[x, y] in &pixels {
            assert!((window.x0..window.x1).contains(&x) && (window.y0..window.y1).contains(&y));
        }
        let column: std::collections::HashSet<u32> = pixels.iter().map(|p| (p[0] - 3) % 10).collect();
        let row: std::collections::HashSet<u32> = pixels.iter().map(|p| (p[1] - 5) % 10).collect();
        assert!(column.len() == 10 && row.len() == 10);
        assert_eq!(scattered(window, 1).len(), 200 * 113);
    }
}
