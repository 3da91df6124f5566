//! The first wave: the corners of all pixels, each traced once.
use std::sync::{
    Mutex,
    atomic::{AtomicBool, Ordering},
};

use durer_core::sampling::{Dim, Sampler, SamplerKind};

use super::{GRID, contrast::spread, value};
use crate::{
    Contribution,
    drive::{BadSample, Gather, Job, Rendered, Splits, TILE, TileDone, Watch, crew, lock},
    film::Tile,
};

/// The corners of the pixels of a window and of the pixels around it, as a rectangle. Of a whole picture it is one more
/// than pixels along each edge.
pub(in crate::drive) fn corners(job: &Job<'_>, window: Tile) -> Tile {
    if window.area() == 0 {
        return window;
    }
    let view = &job.scene.view;
    Tile {
        x0: window.x0.saturating_sub(1),
        y0: window.y0.saturating_sub(1),
        x1: (window.x1 + 2).min(view.width + 1),
        y1: (window.y1 + 2).min(view.height + 1),
    }
}

/// Where the ray of a corner goes through: within a quarter of a pixel around it, in the picture. Exact corners lie in rows, and
/// a pattern as fine as the rows looks the same in all of them, so that nobody would see that it is there.
pub(super) fn corner(job: &Job<'_>, at: [u32; 2]) -> [u32; 2] {
    let (view, settings) = (&job.scene.view, job.settings);
    let u = Sampler::new(SamplerKind::Independent, settings.seed, at, 0, 2).d2(Dim::Pixel);
    let near = |corner: u32, u: f32, last: u32| {
        let place = (corner * GRID + (u * (GRID / 2) as f32) as u32).saturating_sub(GRID / 4);
        place.min(last * GRID)
    };
    [near(at[0], u.x, view.width), near(at[1], u.y, view.height)]
}

/// Linear RGB at the corners of pixels; NaN where there is none.
pub(super) struct Lattice {
    corners: Tile,
    values: Vec<[f32; 3]>,
}

impl Lattice {
    /// Traces the corners of all pixels of a window.
    pub(super) fn trace(job: &Job<'_>, watch: &Watch<'_>, window: Tile, rendered: &mut Rendered) -> Self {
        let corners = corners(job, window);
        let lattice = Self { corners, values: vec![[f32::NAN; 3]; corners.area() as usize] };
        let shared = Mutex::new((lattice, rendered));
        crew::share_out(
            &corners.squares(TILE),
            job.settings.threads,
            watch.cancel,
            |tile, values: &mut Vec<_>| {
                let done = trace_tile(job, watch, tile, values);
                let mut shared = lock(&shared);
                shared.0.write(tile, values);
                shared.1.take(job, &done);
                drop(shared);
                watch.progress.advance(done.samples, done.rays);
            },
        );
        shared.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).0
    }

    /// Traces the corners around one pixel.
    pub(super) fn of_pixel(job: &Job<'_>, [x, y]: [u32; 2]) -> Self {
        let corners = corners(job, Tile { x0: x, y0: y, x1: x + 1, y1: y + 1 });
        let watch = Watch { gather: Gather::Rays, progress: &(), cancel: &AtomicBool::new(false) };
        let mut values = Vec::new();
        trace_tile(job, &watch, corners, &mut values);
        Self { corners, values }
    }

    fn write(&mut self, tile: Tile, values: &[[f32; 3]]) {
        let width = (tile.x1 - tile.x0) as usize;
        // The last rows are missing if the render was given up.
        for (y, row) in (tile.y0..).zip(values.chunks_exact(width)) {
            let start = self.index([tile.x0, y]);
            self.values[start..start + width].copy_from_slice(row);
        }
    }

    fn index(&self, [x, y]: [u32; 2]) -> usize {
        let width = (self.corners.x1 - self.corners.x0) as usize;
        (y - self.corners.y0) as usize * width + (x - self.corners.x0) as usize
    }

    /// The corners of a pixel: upper left, upper right, lower left, lower right.
    pub(super) fn around(&self, [x, y]: [u32; 2]) -> [[f32; 3]; 4] {
        let (upper, lower) = (self.index([x, y]), self.index([x, y + 1]));
        [upper, upper + 1, lower, lower + 1].map(|i| self.values[i])
    }

    /// The largest difference between any corners of a pixel and of those around it.
    pub(super) fn contrast_around(&self, [x, y]: [u32; 2]) -> f32 {
        let c = self.corners;
        let columns = x.saturating_sub(1).max(c.x0)..(x + 3).min(c.x1);
        let (mut least, mut largest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for y in y.saturating_sub(1).max(c.y0)..(y + 3).min(c.y1) {
            let start = self.index([columns.start, y]);
            for value in &self.values[start..start + columns.len()] {
                for i in 0..3 {
                    least[i] = least[i].min(value[i]);
                    largest[i] = largest[i].max(value[i]);
                }
            }
        }
        spread(&least, &largest)
    }
}

fn trace_tile(job: &Job<'_>, watch: &Watch<'_>, tile: Tile, values: &mut Vec<[f32; 3]>) -> TileDone {
    let mut done = TileDone { counters: watch.gather.counters(), ..TileDone::default() };
    let (view, mut out) = (&job.scene.view, Contribution::default());
    values.clear();
    for y in tile.y0..tile.y1 {
        if watch.cancel.load(Ordering::Relaxed) {
            break;
        }
        for x in tile.x0..tile.x1 {
            // A corner that is bad is told as that of the pixel to its lower right, if there is one.
            let pixel = [x.min(view.width - 1), y.min(view.height - 1)];
            let bad = BadSample { pixel, sample: (x - pixel[0]) + 2 * (y - pixel[1]) };
            values.push(value(job, corner(job, [x, y]), &mut out, &mut done, bad));
        }
    }
    done.splits = Some(Splits { corners: done.samples, ..Splits::default() });
    done
}
