//! Rendering: tiles over all cores, in passes that refine the whole picture.
//!
//! A sample is a pure function of (scene, seed, pixel, index), and the film adds in a fixed order: the picture has the
//! same bits for any number of threads. Integrators know nothing of this file.

mod adaptive;
mod crew;
mod grow;
mod layers;
mod part;
mod pass;
mod record;
mod settings;
mod shared;
mod survey;

pub use adaptive::{Adaptive, Antialias, MAX_SPLITS, SmallObjects, Splits};
pub use grow::{Growing, Sparse};
pub use part::{PartCount, scattered};
pub use record::KilledMap;
pub use settings::{Jitter, Nesting, Settings};
pub use shared::Passes;
pub use survey::Taken;

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use durer_core::{sampling::Sampler, spectrum::Carried};

use crate::{
    Contribution, ImbalanceTotals, SampleCx, Scene, Value,
    film::{self, BLOCK, Film, Tile},
    integrator::{Integrator, Output},
    probe::Counters,
};
use layers::Sums;
use pass::Eye;
use shared::Shared;

/// Edge of a tile in pixels.
const TILE: u32 = 32;

/// Someone who watches a render; called from all threads.
pub trait Progress: Sync {
    /// Another tile is done: so many steps of those that [`Job::steps`] foretells.
    fn advance(&self, steps: u64, rays: u64);
}

/// Nobody watches.
impl Progress for () {
    fn advance(&self, _: u64, _: u64) {}
}

/// A sample that was infinite or NaN; it was left out of the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadSample {
    /// Its pixel.
    pub pixel: [u32; 2],
    /// Its index within the pixel.
    pub sample: u32,
}

/// What rendering leaves behind.
#[derive(Debug)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// Samples taken.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// Counts, if they were asked for.
    pub counters: Option<Counters>,
    /// Number of infinite and NaN samples.
    pub bad_samples: u64,
    /// The first of them, by sample index, row and column.
    pub first_bad: Option<BadSample>,
    /// Rays that left transparent bodies which they were not in.
    pub imbalances: ImbalanceTotals,
    /// True if the picture is not complete.
    pub cancelled: bool,
    /// What adaptive antialiasing did; `None` if it was not asked for.
    pub splits: Option<Splits>,
}

/// Whether statistics are gathered; they cost time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gather {
    /// Nothing but rays.
    #[default]
    Rays,
    /// Everything [`Counters`] hold.
    Counters,
}

impl Gather {
    fn counters(self) -> Option<Counters> {
        (self == Self::Counters).then(Counters::default)
    }
}

/// Who looks on while a picture is rendered, and who ends it.
struct Watch<'a> {
    gather: Gather,
    progress: &'a dyn Progress,
    cancel: &'a AtomicBool,
}

/// The samples taken before the picture is looked at again.
struct Pass<'a> {
    samples: std::ops::Range<u32>,
    gather: Gather,
    cancel: &'a AtomicBool,
    /// What these samples share.
    shared: Option<Arc<Shared>>,
}

impl Pass<'_> {
    fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// A scene, an integrator and the settings of one picture.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Light transport.
    pub integrator: &'a dyn Integrator,
    /// Samples, seed, threads, crop.
    pub settings: Settings,
    /// What samples share.
    pub passes: Passes<'a>,
}

impl<'a> Job<'a> {
    /// The context of a sample of which this is the first sampler.
    #[inline]
    fn cx(&self, sampler: &Sampler) -> SampleCx<'a> {
        let own = || self.settings.carried.basis(|| self.settings.lambda(sampler));
        SampleCx { scene: self.scene, basis: self.passes.basis().unwrap_or_else(own) }
    }

    /// The eye ray of a sample, and what the sample counts in the pixel.
    fn eye(&self, pixel: [u32; 2], sample: u32) -> (Eye, f32) {
        self.eye_of(pixel, &self.sampler(pixel).numbered(sample))
    }
    /// The same by the sample's sampler.
    #[inline]
    fn eye_of(&self, pixel: [u32; 2], sampler: &Sampler) -> (Eye, f32) {
        pass::eye_ray((&self.scene.view, self.settings.nesting), pixel, sampler, self.passes.sampler())
    }
    /// The sampler of a pixel's first sample. PERF: where the pixel lies among all is looked up once (bench render).
    fn sampler(&self, pixel: [u32; 2]) -> Sampler {
        let s = &self.settings;
        Sampler::new(s.sampler, s.seed, pixel, 0, s.samples)
    }

    /// Traces an eye ray; what the film stores of it, `None` if it has no value, as data where nothing was hit.
    fn value_of(&self, eye: &Eye, out: &mut Contribution) -> Option<[f32; 3]> {
        let value = self.trace(&self.cx(&eye.ray.sampler), eye, out);
        out.splats.clear();
        value
    }

    /// The same; what the sample has for other places of the picture stays in `out`.
    fn trace(&self, cx: &SampleCx<'_>, eye: &Eye, out: &mut Contribution) -> Option<[f32; 3]> {
        if self.is_blocked(eye) {
            *out = Contribution::default();
            return Some([0.0; 3]);
        }
        self.integrator.sample(cx, &eye.ray, out);
        film_value(cx, out, eye.gain)
    }

    /// Whether the camera lets no light through along a ray: there is nothing to trace then.
    fn is_blocked(&self, eye: &Eye) -> bool {
        eye.gain == 0.0 && self.integrator.facts().output == Output::Radiance
    }

    /// How the picture is antialiased adaptively, if it is. Data cannot be averaged by what the eye sees of it, four
    /// wavelengths are no colour that could be compared, all places would share the photons of one pass, and layers are
    /// sums of samples.
    fn adaptive(&self) -> Option<Adaptive> {
        match (self.settings.antialias, self.integrator.facts().output) {
            _ if self.settings.carried == Carried::Wavelengths => None,
            _ if self.integrator.facts().gathering.is_some() || self.scene.view.layers.is_some() => None,
            (Antialias::Adaptive(how), Output::Radiance) => Some(how),
            _ => None,
        }
    }

    /// Samples of a pixel: [`Settings::samples`], or as many as adaptive antialiasing takes there, which are counted by
    /// taking them.
    pub fn sample_count(&self, pixel: [u32; 2]) -> u32 {
        self.adaptive().map_or(self.settings.samples, |how| adaptive::places(self, &how, pixel).len() as u32)
    }

    /// Steps that a [`Progress`] is told of in all: samples, or of adaptive antialiasing corners and pixels.
    pub fn steps(&self) -> u64 {
        let window = self.window();
        match self.adaptive() {
            None => window.area() * u64::from(self.settings.samples),
            Some(_) => adaptive::corners(self, window).area() + window.area(),
        }
    }

    /// The rendered part of the picture.
    fn window(&self) -> Tile {
        self.settings.window(self.scene.view.width, self.scene.view.height)
    }

    /// Renders until done or until `cancel` is set.
    pub fn render(&self, gather: Gather, progress: &dyn Progress, cancel: &AtomicBool) -> Rendered {
        let mut rendered = Rendered::new(self, gather);
        if let Some(how) = self.adaptive() {
            adaptive::render(self, &how, &Watch { gather, progress, cancel }, &mut rendered);
            return rendered;
        }
        let tiles = self.window().squares(TILE);
        let at_once = if self.integrator.facts().gathering.is_some() { 1 } else { BLOCK };
        for (first, last) in pass::passes(self.settings.samples, at_once) {
            let shared = self.share(first, cancel);
            rendered.rays += shared.as_ref().map_or(0, |shared| shared.rays);
            let pass = Pass { samples: first..last, gather, cancel, shared };
            let finished = |_, done: &TileDone| progress.advance(done.samples, done.rays);
            self.pass(&pass, (&tiles, cancel), &mut rendered, finished);
            if cancel.load(Ordering::Relaxed) {
                rendered.cancelled = true;
                break;
            }
            if last % BLOCK == 0 {
                rendered.film.finish_block();
            }
        }
        rendered
    }

    /// Takes the samples of a range in these tiles, until it is `enough`. The tiles of a pass are disjoint: their order does
    /// not matter.
    fn pass(
        &self,
        pass: &Pass<'_>,
        (tiles, enough): (&[Tile], &AtomicBool),
        rendered: &mut Rendered,
        finished: impl Fn(Tile, &TileDone) + Sync,
    ) {
        let shared = Mutex::new(rendered);
        crew::share_out(tiles, self.settings.threads, enough, |tile, sums: &mut Sums| {
            let taken = lock(&shared);
            taken.film.read(tile, &mut sums.pixels);
            taken.film.read_layers(tile, &mut sums.layers);
            drop(taken);
            let done = self.of_pass(pass.shared.as_ref()).tile(pass, tile, sums);
            let mut shared = lock(&shared);
            shared.film.write(tile, &sums.pixels);
            shared.film.write_layers(tile, &sums.layers);
            shared.take(self, &done);
            drop(shared);
            finished(tile, &done);
        });
    }

    fn tile(&self, pass: &Pass<'_>, tile: Tile, sums: &mut Sums) -> TileDone {
        let mut done = TileDone { counters: pass.gather.counters(), ..TileDone::default() };
        let mut out = Contribution::default();
        let width = (tile.x1 - tile.x0) as usize;
        let Sums { pixels, layers } = sums;
        let mut layers = self.pixels_of(layers);
        for (y, row) in (tile.y0..).zip(pixels.chunks_exact_mut(width)) {
            for (x, pixel) in (tile.x0..).zip(row) {
                let mut beside = layers.next();
                if pass.is_cancelled() {
                    return done;
                }
                let sampler = self.sampler([x, y]);
                for sample in pass.samples.clone() {
                    let (eye, weight) = self.eye_of([x, y], &sampler.numbered(sample));
                    let cx = self.cx(&eye.ray.sampler);
                    match self.take(&cx, &eye, &mut out, &mut done) {
                        Some(value) if value.iter().all(|v| v.is_finite()) => {
                            pixel.add(value, weight);
                            if let Some(beside) = &mut beside {
                                self.keep(&cx, (&eye, &out), (value, weight), beside);
                            }
                        }
                        Some(_) => done.bad(BadSample { pixel: [x, y], sample }),
                        None => {}
                    }
                    self.splat(&cx, &mut out, &mut done, BadSample { pixel: [x, y], sample });
                }
            }
        }
        done
    }

    /// Takes a sample and counts it.
    fn take(
        &self,
        cx: &SampleCx<'_>,
        eye: &Eye,
        out: &mut Contribution,
        done: &mut TileDone,
    ) -> Option<[f32; 3]> {
        let value = match &mut done.counters {
            Some(counters) if !self.is_blocked(eye) => {
                self.integrator.count(cx, &eye.ray, out, counters);
                film_value(cx, out, eye.gain)
            }
            _ => self.trace(cx, eye, out),
        };
        done.samples += 1;
        done.rays += out.rays;
        done.imbalances.add(&out.imbalances);
        value
    }
}

/// What the film stores of a sample of which the camera makes `gain` times its radiance; `None` if it has no value, as data
/// where nothing was hit.
fn film_value(cx: &SampleCx<'_>, out: &Contribution, gain: f32) -> Option<[f32; 3]> {
    match out.value {
        Value::Radiance(radiance) => {
            Some(cx.scene.view.sensor.held(cx.basis.to_rgb(radiance).map(|v| v * gain)))
        }
        Value::Data(data) => data,
    }
}

/// A worker that panicked has already ended the render: what it held is not looked at again.
fn lock<'m, T>(mutex: &'m Mutex<T>) -> std::sync::MutexGuard<'m, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

#[derive(Default)]
struct TileDone {
    samples: u64,
    rays: u64,
    counters: Option<Counters>,
    bad_samples: u64,
    first_bad: Option<BadSample>,
    imbalances: ImbalanceTotals,
    splits: Option<Splits>,
    splats: Vec<film::Splat>,
    /// What each of them brings to layers, if there are some.
    lanes: Vec<[(usize, f32); 4]>,
}

impl TileDone {
    fn bad(&mut self, sample: BadSample) {
        self.bad_samples += 1;
        self.first_bad = first(self.first_bad, Some(sample));
    }
}

impl Rendered {
    /// Nothing yet.
    fn new(job: &Job<'_>, gather: Gather) -> Self {
        Self {
            film: Film::new(job.scene.view.width, job.scene.view.height).with(job.scene.view.layers),
            samples: 0,
            rays: 0,
            counters: gather.counters(),
            bad_samples: 0,
            first_bad: None,
            imbalances: ImbalanceTotals::default(),
            cancelled: false,
            splits: None,
        }
    }

    fn take(&mut self, job: &Job<'_>, done: &TileDone) {
        self.film.splat(done.samples, &done.splats, &job.scene.view.filter, job.window());
        self.film.splat_layers(&done.splats, &done.lanes, &job.scene.view.filter, job.window());
        self.samples += done.samples;
        self.rays += done.rays;
        self.bad_samples += done.bad_samples;
        self.imbalances.merge(&done.imbalances);
        if let (Some(all), Some(counters)) = (&mut self.counters, &done.counters) {
            all.merge(counters);
        }
        self.first_bad = first(self.first_bad, done.first_bad);
        if let Some(splits) = &done.splits {
            self.splits.get_or_insert_default().merge(splits);
        }
    }
}

/// The one with the smaller (sample, row, column): the same whatever thread found it first.
fn first(a: Option<BadSample>, b: Option<BadSample>) -> Option<BadSample> {
    [a, b].into_iter().flatten().min_by_key(|b| (b.sample, b.pixel[1], b.pixel[0]))
}
