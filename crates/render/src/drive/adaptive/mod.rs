//! Adaptive antialiasing (Whitted 1980, "An improved illumination model for shaded display", section on antialiasing).
//!
//! A pixel is a square with an eye ray through, or rather near, each corner ([`lattice::corner`] says why). If the four
//! look alike it is their average; else it is split into four, down to a limit, and the parts count by their areas. What
//! is small enough to lie between the rays is looked for apart ([`things`]).
//!
//! In two waves, so that the picture depends neither on tiles nor on threads: first all corners, each shared by up to four
//! pixels, as a film of its own; then every pixel by itself, from that film as it is. Places are counted in 256ths of a
//! pixel, so that a place is exact in f32 and the same from wherever it is reached; each has random numbers of its own.
//!
//! A difference counts by what it may do to the pixel. An edge passes through `1 / length` squares of that edge length;
//! each is wrong by a share of `length^2` of the difference, more or less, so that the pixel is wrong by `length^1.5`:
//! a square is split if `contrast * length^1.5 > threshold`. So bright and faint edges end with the same error, and
//! splitting ends by itself.
//!
//! Corners lie in rows, and an edge along a row is wrong by as much in each of its squares. So a square that still
//! differs a little when it is not split further gets one more ray inside, which counts as much as its four corners, at
//! heights and widths that differ from square to square. That halves the errors of such edges for a fifth of the rays
//! that another split takes.
//!
//! What is thin can pass between four corners that look alike, but seldom between all those around: a pixel is split once
//! for a difference among the corners of its neighbours, which takes half of the error. These two rules and the places of
//! corners are not Whitted's.
mod contrast;
mod lattice;
mod spot;
mod square;
mod things;

use std::{
    sync::Mutex,
    time::{Duration, Instant},
};

use durer_core::{math::Point2, sampling::Sampler};

use super::{BadSample, Job, Rendered, TILE, TileDone, Watch, crew, lock, pass, pass::Eye};
use crate::{
    Contribution,
    film::{Pixel, Tile},
    probe::Counters,
};
use contrast::contrast;
use lattice::Lattice;
use square::{Canvas, Square};
use things::{Search, Things};

pub(super) use lattice::corners;

/// Most times that a pixel can be split in half along each edge.
pub const MAX_SPLITS: u32 = 8;
/// Places along the edge of a pixel.
const GRID: u32 = 1 << MAX_SPLITS;

/// Where the samples of a pixel lie.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Antialias {
    /// As many in each pixel, spread over it at random.
    #[default]
    Supersample,
    /// At the corners of squares that are split where that shows; for light only, data pictures are supersampled.
    /// Neither the number of samples nor the sampler's places in the pixel are of account.
    Adaptive(Adaptive),
}

/// When squares are split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// How many times in a row at most, up to [`MAX_SPLITS`].
    pub depth: u32,
    /// A square is split if the largest difference between its corners, where 0 is black and 1 is white to the eye, times
    /// the length of its edge in pixels to the power of 1.5 is larger than this; a pixel also if there are 3.5 times as
    /// large differences around it. 0 splits at every difference.
    pub threshold: f32,
    /// Whether objects between the rays are looked for.
    pub small_objects: SmallObjects,
}

impl Default for Adaptive {
    fn default() -> Self {
        Self { depth: 4, threshold: 1.0 / 14.0, small_objects: SmallObjects::Found }
    }
}

impl Adaptive {
    /// What differences between the corners of neighbours may be.
    fn neighbour_threshold(&self) -> f32 {
        3.5 * self.threshold
    }
}

/// What becomes of objects so small that all rays may pass them by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SmallObjects {
    /// Squares are split until a ray meets them, or to the limit.
    #[default]
    Found,
    /// They are met by chance.
    Ignored,
}

/// What adaptive antialiasing did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Splits {
    /// Rays through corners of pixels.
    pub corners: u64,
    /// Squares that were split, by how often they had been split before.
    pub by_level: [u64; MAX_SPLITS as usize],
    /// Rays that were traced to their first hit to see whether a small object was met. They are not among
    /// [`Rendered::rays`].
    pub searches: u64,
}

impl Splits {
    pub(super) fn merge(&mut self, o: &Self) {
        self.corners += o.corners;
        self.by_level.iter_mut().zip(o.by_level).for_each(|(all, more)| *all += more);
        self.searches += o.searches;
    }
}

/// The eye ray through a place of the picture.
pub(super) fn eye(job: &Job<'_>, place: [u32; 2]) -> Eye {
    let sampler = Sampler::new(job.settings.sampler, job.settings.seed, place, 0, 1);
    pass::eye_at(&job.scene.view, job.settings.nesting, film_of(place), &sampler)
}

/// A place in pixels.
pub(super) fn film_of(place: [u32; 2]) -> Point2 {
    Point2::new(place[0] as f32 / GRID as f32, place[1] as f32 / GRID as f32)
}

/// Linear RGB of a place; NaN, and noted as `bad`, if it is infinite or NaN.
fn value(
    job: &Job<'_>,
    place: [u32; 2],
    out: &mut Contribution,
    done: &mut TileDone,
    bad: BadSample,
) -> [f32; 3] {
    let eye = eye(job, place);
    let cx = job.cx(&eye.ray.sampler);
    let value = job.take(&cx, &eye, out, done).unwrap_or_default();
    job.splat(&cx, out, done, bad);
    if value.iter().all(|v| v.is_finite()) {
        return value;
    }
    done.bad(bad);
    [f32::NAN; 3]
}

/// Adds the average of a square's corners, without those that have no value.
fn add_average(pixel: &mut Pixel, corners: &[[f32; 3]; 4], area: f32) {
    let [a, b, c, d] = corners;
    let sum: [f32; 3] = std::array::from_fn(|i| (a[i] + b[i]) + (c[i] + d[i]));
    if sum.iter().all(|s| !s.is_nan()) {
        return pixel.add(sum.map(|s| 0.25 * s), area);
    }
    let good: Vec<_> = corners.iter().filter(|v| !v[0].is_nan()).collect();
    for value in &good {
        pixel.add(**value, area / good.len() as f32);
    }
}

/// Renders both waves, or what `watch` leaves time for: then pixels show the average of those corners that are there.
pub(super) fn render(job: &Job<'_>, how: &Adaptive, watch: &Watch<'_>, rendered: &mut Rendered) {
    let window = job.window();
    rendered.splits = Some(Splits::default());
    let lattice = Lattice::trace(job, watch, window, rendered);
    let things = (how.small_objects == SmallObjects::Found).then(|| Things::of(job)).flatten();
    let shared = Mutex::new(rendered);
    crew::share_out(
        &window.squares(TILE),
        job.settings.threads,
        watch.cancel,
        |tile, canvas: &mut Canvas| {
            let refine = Refine { job, how, lattice: &lattice, things: things.as_ref() };
            let (pixels, done) = refine.tile(tile, watch, canvas);
            let mut shared = lock(&shared);
            shared.film.write(tile, &pixels);
            shared.take(job, &done);
            drop(shared);
            watch.progress.advance(tile.area(), done.rays);
        },
    );
    let rendered = lock(&shared);
    finish(rendered, watch, &lattice, window);
}

/// Puts the first wave where the second did not come.
fn finish(
    mut rendered: std::sync::MutexGuard<'_, &mut Rendered>,
    watch: &Watch<'_>,
    lattice: &Lattice,
    window: Tile,
) {
    rendered.cancelled = watch.cancel.load(std::sync::atomic::Ordering::Relaxed);
    if !rendered.cancelled {
        return;
    }
    let mut pixels = Vec::new();
    rendered.film.read(window, &mut pixels);
    let places = (window.y0..window.y1).flat_map(|y| (window.x0..window.x1).map(move |x| [x, y]));
    for (pixel, place) in pixels.iter_mut().zip(places) {
        if pixel.weight == 0.0 {
            add_average(pixel, &lattice.around(place), 1.0);
        }
    }
    rendered.film.write(window, &pixels);
}

/// The second wave.
struct Refine<'a> {
    job: &'a Job<'a>,
    how: &'a Adaptive,
    lattice: &'a Lattice,
    things: Option<&'a Things>,
}

impl Refine<'_> {
    fn tile(&self, tile: Tile, watch: &Watch<'_>, canvas: &mut Canvas) -> (Vec<Pixel>, TileDone) {
        let mut done = TileDone {
            counters: watch.gather.counters(),
            splits: Some(Splits::default()),
            ..TileDone::default()
        };
        let mut pixels = vec![Pixel::default(); tile.area() as usize];
        let search = self.things.map(|things| Search::new(things, self.job, tile));
        let width = (tile.x1 - tile.x0) as usize;
        for (y, row) in (tile.y0..).zip(pixels.chunks_exact_mut(width)) {
            if watch.cancel.load(std::sync::atomic::Ordering::Relaxed) {
                break;
            }
            for (x, pixel) in (tile.x0..).zip(row) {
                let corners = self.lattice.around([x, y]);
                let spots = search.as_ref().map_or_else(Vec::new, |s| s.spots([x, y]));
                // PERF: most pixels are of one colour and need no canvas (bench render).
                let is_plain = contrast(&corners) <= self.how.threshold
                    && self.lattice.contrast_around([x, y]) <= self.how.neighbour_threshold();
                if spots.is_empty() && is_plain {
                    add_average(pixel, &corners, 1.0);
                    continue;
                }
                let mut square = Square::new(self.job, self.how, [x, y], &spots, canvas, &mut done);
                square.seen_by(self.things);
                *pixel = square.refine(self.lattice);
            }
        }
        (pixels, done)
    }
}

/// What single pixels take, for those who want to know what a picture will.
pub(super) struct Sounding<'a> {
    job: &'a Job<'a>,
    how: Adaptive,
    things: Option<Things>,
}

impl<'a> Sounding<'a> {
    pub(super) fn new(job: &'a Job<'a>, how: Adaptive) -> Self {
        let things = (how.small_objects == SmallObjects::Found).then(|| Things::of(job)).flatten();
        Self { job, how, things }
    }

    /// Counts the samples inside a pixel and one of its corners: a picture has as many corners as pixels but for a column
    /// and a row. Then the time that it took, without that of the other corners.
    pub(super) fn pixel(&self, [x, y]: [u32; 2]) -> (TileDone, Duration) {
        let tile = Tile { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        let lattice = Lattice::of_pixel(self.job, [x, y]);
        let start = Instant::now();
        let mut done = TileDone { counters: Some(Counters::default()), ..TileDone::default() };
        let bad = BadSample { pixel: [x, y], sample: 0 };
        value(self.job, lattice::corner(self.job, [x, y]), &mut Contribution::default(), &mut done, bad);
        let search = self.things.as_ref().map(|things| Search::new(things, self.job, tile));
        let spots = search.map_or_else(Vec::new, |search| search.spots([x, y]));
        let mut canvas = Canvas::default();
        let mut square = Square::new(self.job, &self.how, [x, y], &spots, &mut canvas, &mut done);
        square.seen_by(self.things.as_ref());
        square.refine(&lattice);
        (done, start.elapsed())
    }
}

/// The places of a pixel's samples, as [`Job::record`] counts them.
pub(super) fn places(job: &Job<'_>, how: &Adaptive, pixel: [u32; 2]) -> Vec<[u32; 2]> {
    let tile = Tile { x0: pixel[0], y0: pixel[1], x1: pixel[0] + 1, y1: pixel[1] + 1 };
    let things = (how.small_objects == SmallObjects::Found).then(|| Things::of(job)).flatten();
    let spots = things.as_ref().map_or_else(Vec::new, |things| Search::new(things, job, tile).spots(pixel));
    let (mut canvas, mut done) = (Canvas::default(), TileDone::default());
    let mut square = Square::new(job, how, pixel, &spots, &mut canvas, &mut done);
    square.seen_by(things.as_ref());
    square.refine(&Lattice::of_pixel(job, pixel));
    square.places()
}
