//! The first wave: the corners of all pixels, each traced once.
use std::sync::Mutex;

use super::{GRID, value};
use crate::{
    Contribution,
    drive::{BadSample, Job, Rendered, Splits, TILE, TileDone, Watch, crew, lock},
    film::Tile,
};

/// The corners of the pixels of a window, as a rectangle: one more than pixels along each edge.
pub(in crate::drive) fn corners(window: Tile) -> Tile {
    // Of no pixels there are no corners.
    let more = u32::from(window.area() > 0);
    Tile { x1: window.x1 + more, y1: window.y1 + more, ..window }
}

/// Linear RGB at the corners of pixels; NaN where there is none.
pub(super) struct Lattice {
    corners: Tile,
    values: Vec<[f32; 3]>,
}

impl Lattice {
    /// Traces the corners of all pixels of a window.
    pub(super) fn trace(job: &Job<'_>, watch: &Watch<'_>, window: Tile, rendered: &mut Rendered) -> Self {
        let corners = corners(window);
        let lattice = Self { corners, values: vec![[f32::NAN; 3]; corners.area() as usize] };
        let shared = Mutex::new((lattice, rendered));
        crew::share_out(
            &corners.squares(TILE),
            job.settings.threads,
            watch.cancel,
            |tile, values: &mut Vec<_>| {
                let done = trace_tile(job, watch, window, tile, values);
                let mut shared = lock(&shared);
                shared.0.write(tile, values);
                shared.1.take(&done);
                drop(shared);
                watch.progress.advance(done.samples, done.rays);
            },
        );
        shared.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).0
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
}

fn trace_tile(
    job: &Job<'_>,
    watch: &Watch<'_>,
    window: Tile,
    tile: Tile,
    values: &mut Vec<[f32; 3]>,
) -> TileDone {
    let mut done = TileDone { counters: watch.gather.counters(), ..TileDone::default() };
    let mut out = Contribution::default();
    values.clear();
    for y in tile.y0..tile.y1 {
        if watch.cancel.load(std::sync::atomic::Ordering::Relaxed) {
            break;
        }
        for x in tile.x0..tile.x1 {
            // A corner that is bad is told as that of the pixel to its lower right, if there is one.
            let pixel = [x.min(window.x1 - 1), y.min(window.y1 - 1)];
            let bad = BadSample { pixel, sample: (x - pixel[0]) + 2 * (y - pixel[1]) };
            values.push(value(job, [x * GRID, y * GRID], &mut out, &mut done, bad));
        }
    }
    done.splits = Some(Splits { corners: done.samples, ..Splits::default() });
    done
}
