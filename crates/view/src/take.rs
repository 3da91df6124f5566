//! A picture while it is taken: coarse looks first, each finer than the one before, then sample after sample.
use std::{
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use durer::{
    Job, Output,
    drive::{Growing, Sparse},
    film::{Developed, Pixel, develop, develop_data, develop_survey},
    image::{Packing, encode_png},
};

use crate::settings::Look;

/// The first look shall not take longer.
const FIRST_LOOK: Duration = Duration::from_millis(25);
/// Edges of the squares that a look takes one sample of, in pixels.
const EDGES: [u32; 5] = [16, 8, 4, 2, 1];

/// Seconds that a sample takes on all threads together, as far as is known.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace(Option<f64>);

impl Pace {
    fn learn(&mut self, samples: u64, time: Duration) {
        if samples > 0 {
            let new = time.as_secs_f64() / samples as f64;
            self.0 = Some(self.0.map_or(new, |old| 0.5 * (old + new)));
        }
    }

    /// The finest squares of which a look at so many pixels takes a moment.
    fn first_edge(self, pixels: u64) -> u32 {
        let Some(pace) = self.0 else { return EDGES[0] };
        let fits =
            |edge: &&u32| pace * pixels as f64 / f64::from(**edge * **edge) <= FIRST_LOOK.as_secs_f64();
        EDGES[1..4].iter().rev().find(fits).copied().unwrap_or(EDGES[0])
    }
}

/// A picture being taken.
#[derive(Debug)]
pub(crate) struct Take {
    /// When it was asked for.
    pub(crate) begun: Instant,
    /// The squares of the next look; `None` once samples are taken of all pixels.
    edge: Option<u32>,
    /// The last one, and the one that is going on.
    sparse: Option<(u32, Sparse)>,
    looking: Option<Sparse>,
    growing: Option<Growing>,
    /// Counts what there was to see.
    pub(crate) news: u64,
    /// Rays of the coarse looks are not counted.
    busy: Duration,
}

/// A picture for the page.
pub(crate) struct Shown {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) png: Vec<u8>,
    /// Nearest and farthest depth.
    pub(crate) range: Option<[f32; 2]>,
    /// Tests, rays or noise of a white pixel.
    pub(crate) white: Option<f32>,
}

impl Take {
    /// Nothing yet.
    pub(crate) fn new(job: &Job<'_>, pace: Pace) -> Self {
        let pixels = u64::from(job.scene.view.width) * u64::from(job.scene.view.height);
        Self {
            begun: Instant::now(),
            edge: Some(pace.first_edge(pixels)),
            sparse: None,
            looking: None,
            growing: None,
            news: 0,
            busy: Duration::ZERO,
        }
    }

    /// Whether it is finished.
    pub(crate) fn is_done(&self, job: &Job<'_>) -> bool {
        self.growing.as_ref().is_some_and(|growing| growing.is_done(job))
    }

    /// Whether only some pixels were looked at.
    pub(crate) fn is_coarse(&self) -> bool {
        self.growing.is_none()
    }

    /// Samples that every pixel has.
    pub(crate) fn samples(&self) -> u32 {
        self.growing.as_ref().map_or(0, Growing::samples)
    }

    /// Rays per second of rendering.
    pub(crate) fn rays_per_second(&self) -> Option<f64> {
        let rays = self.growing.as_ref()?.rendered().rays as f64;
        (!self.busy.is_zero()).then(|| rays / self.busy.as_secs_f64())
    }

    /// The film's pixels; `None` before the first samples.
    pub(crate) fn pixels(&self) -> Option<Vec<Pixel>> {
        Some(self.growing.as_ref()?.rendered().film.pixels())
    }

    /// The mean of one of them so far.
    pub(crate) fn mean(&self, [x, y]: [u32; 2]) -> Option<[f32; 3]> {
        let film = &self.growing.as_ref()?.rendered().film;
        let pixel = film.pixel(x, y)?;
        (pixel.weight != 0.0).then(|| pixel.mean())
    }

    /// Time spent rendering.
    pub(crate) fn busy(&self) -> Duration {
        self.busy
    }

    /// Works on it until `enough`, or until there is something to see.
    pub(crate) fn advance(
        &mut self,
        job: &Job<'_>,
        pace: &mut Pace,
        enough: &(dyn Fn() -> bool + Sync),
        cancel: &AtomicBool,
    ) {
        let start = Instant::now();
        match self.edge {
            Some(edge) => {
                let looking = self.looking.get_or_insert_with(|| Sparse::new(job, edge));
                let samples = looking.look(job, enough, cancel);
                if cancel.load(Ordering::Relaxed) {
                    return;
                }
                pace.learn(samples, start.elapsed());
                // Whoever asks something, or waits for a turn, does not wait for the rest of it.
                if !looking.is_done() {
                    return;
                }
                self.sparse = self.looking.take().map(|sparse| (edge, sparse));
                self.edge = EDGES.iter().copied().find(|&e| e < edge && e > 1);
            }
            None => {
                let growing = self.growing.get_or_insert_with(|| Growing::new(job));
                let before = growing.rendered().samples;
                growing.grow(job, enough, cancel);
                if cancel.load(Ordering::Relaxed) {
                    return;
                }
                self.busy += start.elapsed();
                pace.learn(growing.rendered().samples - before, start.elapsed());
            }
        }
        self.news += 1;
    }

    /// The picture as it is, in colours; `None` before there is anything.
    pub(crate) fn shown(&self, job: &Job<'_>, look: Look, integrator: &str) -> Option<Shown> {
        let (width, height, values) = match &self.growing {
            None => {
                let (_, sparse) = self.sparse.as_ref()?;
                (sparse.width, sparse.height, sparse.values.clone())
            }
            Some(growing) => (job.scene.view.width, job.scene.view.height, self.values(growing)),
        };
        let (developed, range, white) = match job.integrator.facts().output {
            Output::Data(show) => {
                let data = develop_data(show, width, height, &values);
                (data.picture, data.depth.map(|d| [d.near, d.far]), data.white_tests)
            }
            Output::Survey(survey) => {
                let (picture, white) = develop_survey(survey, width, height, &values);
                (picture, None, Some(white))
            }
            Output::Radiance => {
                let rgb: Vec<[f32; 3]> = values.into_iter().map(Option::unwrap_or_default).collect();
                (develop(width, height, &rgb, look.exposure, look.tonemap(integrator)), None, None)
            }
        };
        let Developed { width, height, rgb8 } = developed;
        let png = encode_png(width, height, &rgb8, Packing::Quick).ok()?;
        Some(Shown { width, height, png, range, white })
    }

    /// What the film holds; of pixels that are still to come in the first pass the last look.
    fn values(&self, growing: &Growing) -> Vec<Option<[f32; 3]>> {
        let film = &growing.rendered().film;
        let mean = |p: &Pixel| (p.weight != 0.0).then(|| p.mean());
        let mut values: Vec<_> = film.pixels().iter().map(mean).collect();
        if let (0, Some((edge, sparse))) = (growing.samples(), &self.sparse) {
            for (index, value) in values.iter_mut().enumerate().filter(|(_, value)| value.is_none()) {
                let (x, y) = (index as u32 % film.width / edge, index as u32 / film.width / edge);
                *value = sparse.values.get((y * sparse.width + x) as usize).copied().flatten();
            }
        }
        values
    }
}
