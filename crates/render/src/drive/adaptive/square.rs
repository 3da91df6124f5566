//! The second wave: one pixel, split where its corners differ or something small lies between them.
use durer_accel::Hit;

use super::{
    Adaptive, GRID, MAX_SPLITS, add_average,
    contrast::contrast,
    eye,
    lattice::{Lattice, corner},
    spot::Spot,
    things::Things,
    value,
};
use crate::{
    Contribution,
    drive::{BadSample, Job, TileDone},
    film::Pixel,
    probe::NoProbe,
};

/// Parts that differ by more than this share of the threshold are not finished with the average of their corners.
const FINISHED: f32 = 0.25;

/// What is known of a pixel's places; one per worker, used again for every pixel.
#[derive(Default)]
pub(super) struct Canvas {
    /// The pixel's number: values with another one are of pixels before.
    stamp: u32,
    values: Vec<(u32, [f32; 3])>,
    /// First hits, of few places.
    hits: Vec<([u32; 2], Option<Hit>)>,
}

impl Canvas {
    /// Forgets all.
    fn begin(&mut self, depth: u32) {
        let side = (1 << depth) + 1;
        if self.values.len() != side * side || self.stamp == u32::MAX {
            self.values = vec![(0, [0.0; 3]); side * side];
            self.stamp = 0;
        }
        self.stamp += 1;
        self.hits.clear();
    }
}

/// A pixel that is being split.
pub(super) struct Square<'a> {
    job: &'a Job<'a>,
    how: &'a Adaptive,
    depth: u32,
    pixel: [u32; 2],
    spots: &'a [Spot],
    things: Option<&'a Things>,
    canvas: &'a mut Canvas,
    done: &'a mut TileDone,
    out: Contribution,
    /// Whether rays went through the very corners of the pixel, and not only near them.
    is_exact: bool,
    /// In the order in which they are counted, as places of the picture.
    places: Vec<[u32; 2]>,
    sum: Pixel,
}

/// A part of the pixel: its upper left corner in places of the pixel, and how often the pixel was split to get it.
#[derive(Clone, Copy)]
struct Part {
    at: [u32; 2],
    level: u32,
}

impl Part {
    fn side(self) -> u32 {
        GRID >> self.level
    }
    /// Upper left, upper right, lower left, lower right.
    fn corners(self) -> [[u32; 2]; 4] {
        let ([x, y], s) = (self.at, self.side());
        [[x, y], [x + s, y], [x, y + s], [x + s, y + s]]
    }
    fn quarters(self) -> [Self; 4] {
        let ([x, y], h, level) = (self.at, self.side() / 2, self.level + 1);
        [[x, y], [x + h, y], [x, y + h], [x + h, y + h]].map(|at| Self { at, level })
    }
    /// What a split adds: above, left, centre, right, below.
    fn middles(self) -> [[u32; 2]; 5] {
        let ([x, y], h) = (self.at, self.side() / 2);
        [[x + h, y], [x, y + h], [x + h, y + h], [x + 2 * h, y + h], [x + h, y + 2 * h]]
    }
    /// Of its edge, in pixels.
    fn length(self) -> f32 {
        self.side() as f32 / GRID as f32
    }
}

impl<'a> Square<'a> {
    /// A pixel with the small things that may lie in it.
    pub(super) fn new(
        job: &'a Job<'a>,
        how: &'a Adaptive,
        pixel: [u32; 2],
        spots: &'a [Spot],
        canvas: &'a mut Canvas,
        done: &'a mut TileDone,
    ) -> Self {
        let depth = how.depth.min(MAX_SPLITS);
        canvas.begin(depth);
        let (out, sum) = (Contribution::default(), Pixel::default());
        let (is_exact, places) = (false, Vec::new());
        Self { job, how, depth, pixel, spots, things: None, canvas, done, out, is_exact, places, sum }
    }

    /// Says what hits belong to.
    pub(super) fn seen_by(&mut self, things: Option<&'a Things>) {
        self.things = things;
    }

    /// Splits the pixel as far as it must be.
    pub(super) fn refine(&mut self, lattice: &Lattice) -> Pixel {
        let whole = Part { at: [0, 0], level: 0 };
        for (at, value) in whole.corners().into_iter().zip(lattice.around(self.pixel)) {
            self.note(at, value);
        }
        if self.depth > 0 && lattice.contrast_around(self.pixel) > self.how.neighbour_threshold() {
            self.split(whole);
        } else {
            self.part(whole);
        }
        self.sum
    }

    /// Where the samples were taken, in the order that [`Job::record`] describes.
    pub(super) fn places(self) -> Vec<[u32; 2]> {
        self.places
    }

    /// Adds a part to the sum.
    fn part(&mut self, part: Part) {
        let corners = part.corners().map(|at| self.canvas.values[self.index(at)].1);
        // An edge through the pixel passes through 1 / length squares, whose errors are of length^2 each and of both signs.
        let error = contrast(&corners) * part.length() * part.length().sqrt();
        if part.level < self.depth && (error > self.how.threshold || self.hides_something(part)) {
            return self.split(part);
        }
        let area = part.length() * part.length();
        if error <= self.how.threshold * FINISHED || part.side() == 1 {
            return add_average(&mut self.sum, &corners, area);
        }
        let inside = self.inside(part);
        let value = self.sample(inside);
        self.places.push(self.place(inside));
        if value[0].is_nan() {
            return add_average(&mut self.sum, &corners, area);
        }
        add_average(&mut self.sum, &corners, 0.5 * area);
        self.sum.add(value, 0.5 * area);
    }

    fn split(&mut self, part: Part) {
        self.done.splits.get_or_insert_default().by_level[part.level as usize] += 1;
        if !self.is_exact && !self.spots.is_empty() {
            // What is small is met between exact corners, not between rays near them.
            self.is_exact = true;
            self.canvas.hits.clear();
            for at in part.corners() {
                let value = self.sample(at);
                self.note(at, value);
            }
        }
        part.middles().into_iter().for_each(|at| self.trace(at));
        part.quarters().into_iter().for_each(|quarter| self.part(quarter));
    }

    /// Somewhere in a part. Along a row of equal parts all heights are as frequent, along a column all distances from the
    /// left: the bits of the other coordinate reversed, and turned over by a hash of the row and of the column.
    fn inside(&self, part: Part) -> [u32; 2] {
        let [x, y] = part.at;
        let [px, py] = self.pixel.map(u64::from);
        let reversed = |v: u32| (v.reverse_bits() >> (32 - MAX_SPLITS)) << (MAX_SPLITS - part.level);
        let hash = |axis: u64, v: u32| {
            let key = (px << 32 | py) ^ (u64::from(v) << 1 | axis).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            (key ^ key >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> (64 - MAX_SPLITS)
        };
        let within = |bits: u32, hash: u64| (((bits ^ hash as u32) & (GRID - 1)) * part.side()) >> MAX_SPLITS;
        [x + within(reversed(y), hash(0, x)), y + within(reversed(x), hash(1, y))]
    }

    /// Whether something small may lie in a part that no corner's ray meets, though it is not behind what they meet.
    fn hides_something(&mut self, part: Part) -> bool {
        let Some(things) = self.things.filter(|_| !self.spots.is_empty()) else { return false };
        let scale = 1.0 / GRID as f32;
        let (at, side) = (part.at.map(|x| x as f32 * scale), part.length());
        let spots = self.spots;
        spots.iter().filter(|spot| spot.may_hide_in(at, side)).any(|spot| {
            let hits = part.corners().map(|at| self.hit(at));
            let is_met = hits.iter().flatten().any(|hit| things.of_hit(hit) == spot.thing);
            let is_behind = hits.iter().all(|hit| hit.is_some_and(|hit| hit.t < spot.nearest));
            !is_met && !is_behind
        })
    }

    /// What the ray through a place meets first.
    fn hit(&mut self, at: [u32; 2]) -> Option<Hit> {
        if let Some((_, hit)) = self.canvas.hits.iter().find(|(known, _)| *known == at) {
            return *hit;
        }
        self.done.splits.get_or_insert_default().searches += 1;
        let path = eye(self.job, self.place(at)).ray;
        let hit = self.job.scene.closest(&self.job.cx(&path.sampler), &path.ray, &mut NoProbe, ());
        self.canvas.hits.push((at, hit));
        hit
    }

    /// Traces a place, unless that was done.
    fn trace(&mut self, at: [u32; 2]) {
        if self.canvas.values[self.index(at)].0 == self.canvas.stamp {
            return;
        }
        let value = self.sample(at);
        self.note(at, value);
    }

    /// Linear RGB of a place, which must be noted next.
    fn sample(&mut self, at: [u32; 2]) -> [f32; 3] {
        let bad = BadSample { pixel: self.pixel, sample: self.places.len() as u32 };
        value(self.job, self.place(at), &mut self.out, self.done, bad)
    }

    fn note(&mut self, at: [u32; 2], value: [f32; 3]) {
        let index = self.index(at);
        self.canvas.values[index] = (self.canvas.stamp, value);
        self.places.push(self.place(at));
    }

    fn place(&self, at: [u32; 2]) -> [u32; 2] {
        let [x, y] = self.pixel;
        if !self.is_exact && at.iter().all(|v| v % GRID == 0) {
            return corner(self.job, [x + at[0] / GRID, y + at[1] / GRID]);
        }
        [x * GRID + at[0], y * GRID + at[1]]
    }

    fn index(&self, at: [u32; 2]) -> usize {
        let [x, y] = at.map(|v| (v >> (MAX_SPLITS - self.depth)) as usize);
        y * ((1 << self.depth) + 1) + x
    }
}
