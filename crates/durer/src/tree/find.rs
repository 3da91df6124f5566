//! A search among all samples of a picture for the one worth a look.
use std::sync::atomic::AtomicBool;

use crate::{
    Prepared, Progress,
    drive::{Gather, Taken},
    spectrum::luminance,
};

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Find {
    /// The sample whose luminance lies farthest above the brightest mean among the pixels around it, its own pixel's
    /// mean without it included: 3 x 3 pixels. One bright sample in a dark place wins over a place that is bright.
    Firefly,
    /// The first sample that is infinite or NaN: by sample, row and column, as a render reports it.
    Nan,
    /// The sample whose rays bounce most often; of equal ones that of most rays.
    Deepest,
    /// The sample that takes most tests of boxes and primitives.
    Costliest,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Its pixel.
    pub pixel: [u32; 2],
    /// Its index within the pixel.
    pub sample: u32,
    /// What makes it special, in words and numbers.
    pub why: String,
}

/// What is kept of a pixel: its own best sample.
struct Candidate {
    pixel: [u32; 2],
    sample: u32,
    /// The larger, the better.
    score: [f64; 2],
    /// Of finite luminances: sum and number.
    sum: f64,
    count: u32,
    /// How many of its samples are infinite or NaN.
    bad: u64,
}

impl Find {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Firefly, Self::Nan, Self::Deepest, Self::Costliest];
    /// The words for them.
    pub const WORDS: [&'static str; 4] = ["firefly", "nan", "deepest", "costliest"];

    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
    /// From its word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.word() == word)
    }

    /// Takes all samples of the rendered part of the picture; `None` if there is no such sample. Does not depend on
    /// threads. Of a search that was cancelled the best so far.
    pub fn search(self, prepared: &Prepared, progress: &dyn Progress, cancel: &AtomicBool) -> Option<Found> {
        let gather = match self {
            Self::Firefly | Self::Nan => Gather::Rays,
            Self::Deepest | Self::Costliest => Gather::Counters,
        };
        let each = |pixel, samples: &[Taken]| self.candidate(pixel, samples);
        let pixels = prepared.job().survey(gather, progress, cancel, each);
        match self {
            Self::Firefly => firefly(&pixels, (prepared.window().x1 - prepared.window().x0) as usize),
            _ => self.best(&pixels),
        }
    }

    fn candidate(self, pixel: [u32; 2], samples: &[Taken]) -> Candidate {
        let (mut sum, mut count, mut bad) = (0.0, 0, 0);
        let mut best: Option<(u32, [f64; 2])> = None;
        for taken in samples {
            let light = light(taken);
            if light.is_finite() {
                sum += light;
                count += 1;
            } else {
                bad += 1;
            }
            if let Some(score) = self.score(taken, light)
                && best.is_none_or(|(_, known)| score > known)
            {
                best = Some((taken.sample, score));
            }
        }
        let (sample, score) = best.unwrap_or((0, [f64::NEG_INFINITY; 2]));
        Candidate { pixel, sample, score, sum, count, bad }
    }

    fn score(self, taken: &Taken, light: f64) -> Option<[f64; 2]> {
        let counters = taken.counters.as_ref();
        match self {
            Self::Firefly => light.is_finite().then_some([light, 0.0]),
            Self::Nan => (!light.is_finite()).then(|| [-f64::from(taken.sample), 0.0]),
            Self::Deepest => counters.map(|c| [f64::from(c.max_depth), c.all_rays() as f64]),
            Self::Costliest => {
                counters.map(|c| [(c.node_tests + c.primitive_tests) as f64, c.all_rays() as f64])
            }
        }
    }

    /// The best of all, the first of equal ones.
    fn best(self, pixels: &[Option<Candidate>]) -> Option<Found> {
        let sound = pixels.iter().flatten().filter(|c| c.score[0] > f64::NEG_INFINITY);
        let best = sound.reduce(|best, c| if c.score > best.score { c } else { best })?;
        let [first, rays] = best.score;
        let why = match self {
            Self::Nan => {
                let bad: u64 = pixels.iter().flatten().map(|c| c.bad).sum();
                match bad {
                    1 => "the only sample that is infinite or NaN".to_owned(),
                    n => format!("the first of {n} samples that are infinite or NaN"),
                }
            }
            Self::Deepest => format!("{first} bounces, {rays} rays"),
            Self::Costliest => format!("{first} tests of boxes and primitives, {rays} rays"),
            Self::Firefly => String::new(),
        };
        Some(Found { pixel: best.pixel, sample: best.sample, why })
    }
}

/// The sample that lies farthest above the brightest mean around it.
fn firefly(pixels: &[Option<Candidate>], width: usize) -> Option<Found> {
    let mut best: Option<(f64, f64, &Candidate)> = None;
    for (index, candidate) in pixels.iter().enumerate() {
        let Some(candidate) = candidate else { continue };
        if candidate.count == 0 {
            continue;
        }
        let light = candidate.score[0];
        let around = around(pixels, width, index);
        let others = (candidate.count > 1).then(|| (candidate.sum - light) / f64::from(candidate.count - 1));
        let brightest = around.chain(others).fold(f64::NEG_INFINITY, f64::max);
        let brightest = if brightest.is_finite() { brightest } else { 0.0 };
        if best.is_none_or(|(excess, ..)| light - brightest > excess) {
            best = Some((light - brightest, brightest, candidate));
        }
    }
    let (_, brightest, candidate) = best?;
    let why = format!("luminance {:.4}, the brightest mean around it {brightest:.4}", candidate.score[0]);
    Some(Found { pixel: candidate.pixel, sample: candidate.sample, why })
}

/// Means of the pixels around one.
fn around(pixels: &[Option<Candidate>], width: usize, index: usize) -> impl Iterator<Item = f64> {
    let (x, y) = ((index % width) as isize, (index / width) as isize);
    let offsets = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).filter(|o| *o != (0, 0));
    offsets.filter_map(move |(dx, dy)| {
        let (x, y) = (x + dx, y + dy);
        if x < 0 || y < 0 || x >= width as isize {
            return None;
        }
        let near = pixels.get(y as usize * width + x as usize)?.as_ref()?;
        (near.count > 0).then(|| near.sum / f64::from(near.count))
    })
}

/// Of a sample's value; 0 where data has none.
fn light(taken: &Taken) -> f64 {
    luminance(taken.rgb.unwrap_or_default().map(f64::from))
}
