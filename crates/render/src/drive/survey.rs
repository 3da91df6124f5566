//! The samples of pixels one by one, before the film sums them: what a search among them looks at.
use std::sync::{
    Mutex,
    atomic::{AtomicBool, Ordering},
};

use durer_core::math::Point2;

use super::{Gather, Job, Progress, TILE, TileDone, adaptive, crew, lock, pass, pass::Eye};
use crate::{Contribution, integrator::Output, probe::Counters};

/// A sample that was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Its index within the pixel.
    pub sample: u32,
    /// What the film would add: linear RGB, or the numbers of a data picture; `None` where those have none.
    pub rgb: Option<[f32; 3]>,
    /// What it counts in the pixel; `None` of adaptive antialiasing, where that is a matter of its neighbours.
    pub weight: Option<f32>,
    /// Where in the picture it lies, in pixels from the upper left corner.
    pub film: [f32; 2],
    /// Where on the lens it starts, in metres right of and above its centre; `None` for a pinhole.
    pub lens: Option<[f32; 2]>,
    /// Its moment, in seconds.
    pub time: f32,
    /// Its counts, if they were asked for.
    pub counters: Option<Counters>,
}

/// The beginning of a sample.
struct Start {
    eye: Eye,
    film: Point2,
    weight: Option<f32>,
}

impl Job<'_> {
    /// The beginning of a sample that is not adaptive.
    fn start(&self, pixel: [u32; 2], sample: u32) -> Start {
        let (eye, weight) = self.eye(pixel, sample);
        let (film, _) = pass::place(&self.scene.view, self.settings.nesting, pixel, &eye.ray.sampler);
        Start { eye, film, weight: Some(weight) }
    }

    fn starts(&self, pixel: [u32; 2]) -> Box<dyn Iterator<Item = Start> + '_> {
        match self.adaptive() {
            Some(how) => {
                let start = |place| Start {
                    eye: adaptive::eye(self, place),
                    film: adaptive::film_of(place),
                    weight: None,
                };
                Box::new(adaptive::places(self, &how, pixel).into_iter().map(start))
            }
            None => Box::new(
                (0..self.settings.samples)
                    .map(move |sample| self.of_pass(self.kept(sample).as_ref()).start(pixel, sample)),
            ),
        }
    }

    fn taken(&self, sample: u32, start: Start, gather: Gather) -> Taken {
        let Start { eye, film, weight } = start;
        let view = &self.scene.view;
        let lens = pass::on_lens(view, self.settings.nesting, &eye.ray.sampler);
        let mut done = TileDone { counters: gather.counters(), ..TileDone::default() };
        Taken {
            sample,
            rgb: self.take(&self.cx(&eye.ray.sampler), &eye, &mut Contribution::default(), &mut done),
            weight,
            film: [film.x, film.y],
            lens: lens.map(|u| view.on_lens(film, u)),
            time: eye.ray.ray.time,
            counters: done.counters,
        }
    }

    /// Takes the samples of a pixel, in their order, one at a time: whoever stops asking ends it.
    pub fn each_sample(&self, pixel: [u32; 2], gather: Gather) -> impl Iterator<Item = Taken> + '_ {
        (0..)
            .zip(self.starts(pixel))
            .map(move |(sample, start)| self.of_pass(self.kept(sample).as_ref()).taken(sample, start, gather))
    }

    /// Takes one sample of a pixel; `None` if the pixel does not have it.
    pub fn sample_of(&self, pixel: [u32; 2], sample: u32, gather: Gather) -> Option<Taken> {
        let start = match self.adaptive() {
            Some(_) => self.starts(pixel).nth(sample as usize)?,
            None if sample < self.settings.samples => {
                self.of_pass(self.kept(sample).as_ref()).start(pixel, sample)
            }
            None => return None,
        };
        Some(self.of_pass(self.kept(sample).as_ref()).taken(sample, start, gather))
    }

    /// Takes all samples of a pixel, in their order.
    pub fn samples_of(&self, pixel: [u32; 2], gather: Gather) -> Vec<Taken> {
        self.each_sample(pixel, gather).collect()
    }

    /// Takes all samples of all pixels of the rendered part, on all threads, and asks `each` for what is to be kept of
    /// every pixel: in rows from top to bottom, whatever the threads; `None` of those that `cancel` left out.
    pub fn survey<R: Send>(
        &self,
        gather: Gather,
        progress: &dyn Progress,
        cancel: &AtomicBool,
        each: impl Fn([u32; 2], &[Taken]) -> R + Sync,
    ) -> Vec<Option<R>> {
        let window = self.window();
        let width = window.x1 - window.x0;
        let kept: Vec<Option<R>> = std::iter::repeat_with(|| None).take(window.area() as usize).collect();
        let kept = Mutex::new(kept);
        crew::share_out(&window.squares(TILE), self.settings.threads, cancel, |tile, _: &mut ()| {
            for y in tile.y0..tile.y1 {
                for x in tile.x0..tile.x1 {
                    if cancel.load(Ordering::Relaxed) {
                        return;
                    }
                    let samples = self.samples_of([x, y], gather);
                    let found = each([x, y], &samples);
                    let index = (y - window.y0) * width + (x - window.x0);
                    lock(&kept)[index as usize] = Some(found);
                    progress.advance(samples.len() as u64, 0);
                }
            }
        });
        kept.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// A small picture of the whole, at most `largest` pixels along an edge: width, height and what the film would hold,
    /// of one sample in each quarter of each pixel.
    pub fn preview(&self, largest: u32) -> (u32, u32, Vec<Option<[f32; 3]>>) {
        let view = &self.scene.view;
        let factor = (f64::from(largest.max(1)) / f64::from(view.width.max(view.height))).min(1.0);
        let shrink = |n: u32| ((f64::from(n) * factor).round() as u32).max(1);
        let (width, height) = (shrink(view.width), shrink(view.height));
        let rows: Vec<u32> = (0..height).collect();
        let done = Mutex::new(vec![None; (width * height) as usize]);
        let never = AtomicBool::new(false);
        crew::share_out(&rows, self.settings.threads, &never, |y, row: &mut Vec<Option<[f32; 3]>>| {
            row.clear();
            row.extend((0..width).map(|x| self.quarters([x, y], [width, height])));
            let start = (y * width) as usize;
            lock(&done)[start..start + row.len()].copy_from_slice(row);
        });
        (width, height, done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner))
    }

    /// The mean of a pixel of a smaller picture of the given size; of data, which has none, the first that there is.
    fn quarters(&self, small: [u32; 2], size: [u32; 2]) -> Option<[f32; 3]> {
        let view = &self.scene.view;
        let full = [view.width, view.height];
        let mut out = Contribution::default();
        let mut found = Vec::new();
        let shared = self.kept(0);
        let job = self.of_pass(shared.as_ref());
        for [dx, dy] in [[1, 1], [3, 1], [1, 3], [3, 3]] {
            let at = |i: usize, d: u32| {
                let place = (u64::from(4 * small[i] + d) * u64::from(full[i])) / (4 * u64::from(size[i]));
                (place as u32).min(full[i] - 1)
            };
            let (eye, _) = job.eye([at(0, dx), at(1, dy)], 0);
            found.extend(job.value_of(&eye, &mut out));
        }
        let n = found.len() as f32;
        match self.integrator.facts().output {
            Output::Radiance => {
                (n > 0.0).then(|| std::array::from_fn(|i| found.iter().map(|v| v[i]).sum::<f32>() / n))
            }
            Output::Data(_) | Output::Survey(_) => found.first().copied(),
        }
    }
}
