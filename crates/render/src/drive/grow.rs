//! Pictures that somebody watches while they grow: a look at few pixels first, then sample after sample of all of them, for as
//! long as the caller likes at a time.
//!
//! In the end the film has the bits of [`Job::render`]: passes of other lengths add the same samples in the same order.
use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use super::{Gather, Job, Pass, Rendered, TILE, TileDone, crew, lock, shared::Shared};
use crate::{
    Contribution,
    film::{BLOCK, Tile},
};

/// Most samples per pixel between two looks at the clock: a tile of paths then takes some hundredths of a second.
const MOST_AT_ONCE: u32 = 4;

/// A picture of which part of the samples were taken. Samples of a pixel are spread evenly: adaptive antialiasing is for
/// pictures that are taken at once.
#[derive(Debug)]
pub struct Growing {
    rendered: Rendered,
    /// The samples being taken.
    first: u32,
    last: u32,
    /// Tiles that lack them.
    left: Vec<Tile>,
    /// What they share.
    shared: Option<Arc<Shared>>,
}

/// A look at the whole picture by one sample in the middle of each square of so many pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Sparse {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What the film would hold of one sample in the middle of each square; `None` of data where there are none.
    pub values: Vec<Option<[f32; 3]>>,
    /// Of the squares.
    edge: u32,
    /// Rows that were not looked at yet.
    left: Vec<u32>,
}

impl Growing {
    /// Nothing yet of a picture.
    pub fn new(job: &Job<'_>) -> Self {
        let mut new = Self {
            rendered: Rendered::new(job, Gather::Rays),
            first: 0,
            last: 0,
            left: Vec::new(),
            shared: None,
        };
        new.begin_pass(job);
        new
    }

    /// What there is.
    pub fn rendered(&self) -> &Rendered {
        &self.rendered
    }

    /// Samples that every pixel has.
    pub fn samples(&self) -> u32 {
        if self.left.is_empty() { self.last } else { self.first }
    }

    /// Whether all samples were taken.
    pub fn is_done(&self, job: &Job<'_>) -> bool {
        self.samples() >= job.settings.samples
    }

    /// The next samples: one, one, two, then a few at once; never beyond a block.
    fn begin_pass(&mut self, job: &Job<'_>) {
        let most = if job.integrator.facts().gathering.is_some() { 1 } else { MOST_AT_ONCE };
        let step = self.last.clamp(1, most);
        let end_of_block = (self.last / BLOCK + 1) * BLOCK;
        self.first = self.last;
        self.last = (self.first + step).min(end_of_block).min(job.settings.samples);
        if self.last > self.first {
            self.left = job.window().squares(TILE);
            self.shared = None;
        }
    }

    /// Takes samples until `enough` says so, which is asked after each tile by all threads, or until all are taken; at
    /// least a tile each time. Of the same job each time. Once `cancel` is set it returns within the time of a sample and
    /// leaves a film that is of no use.
    pub fn grow(&mut self, job: &Job<'_>, enough: &(dyn Fn() -> bool + Sync), cancel: &AtomicBool) {
        while !self.is_done(job) {
            if self.left.is_empty() {
                self.begin_pass(job);
            }
            if self.shared.is_none() {
                self.shared = job.share(self.first, cancel);
                self.rendered.rays += self.shared.as_ref().map_or(0, |shared| shared.rays);
            }
            let stop = AtomicBool::new(false);
            let done = Mutex::new(Vec::new());
            let (samples, shared) = (self.first..self.last, self.shared.clone());
            let pass = Pass { samples, gather: Gather::Rays, cancel, shared };
            job.pass(&pass, (&self.left, &stop), &mut self.rendered, |tile, _: &TileDone| {
                lock(&done).push(tile);
                if enough() || cancel.load(Ordering::Relaxed) {
                    stop.store(true, Ordering::Relaxed);
                }
            });
            let done = lock(&done);
            if done.len() == self.left.len() {
                self.left.clear();
            } else {
                self.left.retain(|tile| !done.contains(tile));
            }
            if cancel.load(Ordering::Relaxed) {
                self.rendered.cancelled = true;
                return;
            }
            if self.left.is_empty() && self.last.is_multiple_of(BLOCK) {
                self.rendered.film.finish_block();
            }
            if stop.load(Ordering::Relaxed) {
                return;
            }
        }
    }
}

impl Sparse {
    /// Nothing yet of a look with squares of `edge` pixels.
    pub fn new(job: &Job<'_>, edge: u32) -> Self {
        let (view, edge) = (&job.scene.view, edge.max(1));
        let (width, height) = (view.width.div_ceil(edge), view.height.div_ceil(edge));
        let values = vec![None; width as usize * height as usize];
        Self { width, height, values, edge, left: (0..height).collect() }
    }

    /// Whether all squares were looked at.
    pub fn is_done(&self) -> bool {
        self.left.is_empty()
    }

    /// Looks at squares until `enough` says so, which is asked after each row by all threads, or until all are done. Of the
    /// same job each time. Returns how many samples that took. Once `cancel` is set the look is of no use.
    pub fn look(&mut self, job: &Job<'_>, enough: &(dyn Fn() -> bool + Sync), cancel: &AtomicBool) -> u64 {
        let (width, edge) = (self.width, self.edge);
        let (stop, done) = (AtomicBool::new(false), Mutex::new(Vec::new()));
        let all = Mutex::new(&mut self.values);
        crew::share_out(&self.left, job.settings.threads, &stop, |y, row: &mut Vec<Option<[f32; 3]>>| {
            if !job.look_at_row(y, (width, edge), row, cancel) {
                stop.store(true, Ordering::Relaxed);
                return;
            }
            let start = y as usize * width as usize;
            lock(&all)[start..start + row.len()].copy_from_slice(row);
            lock(&done).push(y);
            if enough() {
                stop.store(true, Ordering::Relaxed);
            }
        });
        let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        done.sort_unstable();
        self.left.retain(|y| done.binary_search(y).is_err());
        done.len() as u64 * u64::from(width)
    }
}

impl Job<'_> {
    /// One sample in the middle of each square of a row of so many; false once `cancel` is set.
    fn look_at_row(
        &self,
        y: u32,
        (width, edge): (u32, u32),
        row: &mut Vec<Option<[f32; 3]>>,
        cancel: &AtomicBool,
    ) -> bool {
        row.clear();
        let (view, window) = (&self.scene.view, self.window());
        let mut out = Contribution::default();
        let shared = self.kept(0);
        let job = self.of_pass(shared.as_ref());
        for x in 0..width {
            if cancel.load(Ordering::Relaxed) {
                return false;
            }
            let middle = |i: u32, end: u32| (i * edge + edge / 2).min(end - 1);
            let [px, py] = [middle(x, view.width), middle(y, view.height)];
            let inside = (window.x0..window.x1).contains(&px) && (window.y0..window.y1).contains(&py);
            row.push(inside.then(|| job.value_of(&job.eye([px, py], 0).0, &mut out)).flatten());
        }
        true
    }
}
