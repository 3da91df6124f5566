//! What is rendered, and pictures as numbers.
use std::sync::atomic::AtomicBool;

use anyhow::Context;
use durer::{
    Gather, Imported, Options, Prepared, Settings, builtin, import::pbrt, model::filter::Filter, prepare,
    sampling::SamplerKind, scene::Limits,
};

/// Pixels per row.
const WIDTH: u32 = 32;
/// Rows.
const HEIGHT: u32 = 24;

/// A scene under the integrator `path`.
pub(crate) struct Subject {
    name: &'static str,
    prepared: Prepared,
}

impl Subject {
    /// What there is: soft shadows, an interior, a wide lens, motion, all of these, a landscape under the sky, and a smooth
    /// body under the same sky, which every direction but those of the body's edge sees.
    pub(crate) const NAMES: [&'static str; 7] =
        ["penumbra", "cornell", "bokeh", "shutter", "cook", "sky", "ball"];

    /// By one of these names.
    pub(crate) fn open(name: &'static str) -> anyhow::Result<Self> {
        let mut imported = match name {
            "sky" => described(include_str!("sky.pbrt")),
            "ball" => described(include_str!("ball.pbrt")),
            name => builtin::find(name).context("no built-in scene")?.import(),
        };
        let (width, height) = (Some(WIDTH), Some(HEIGHT));
        let integrator = Some("path".to_owned());
        let options = Options { integrator, width, height, ..Options::default() };
        let mut prepared =
            prepare(&mut imported, &options).with_context(|| format!("{name} is not sound"))?;
        // Weights of a filter would add noise of their own.
        prepared.scene.view.filter = Filter::pixel();
        Ok(Self { name, prepared })
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// One picture.
    pub(crate) fn picture(&self, kind: SamplerKind, samples: u32, seed: u32) -> Picture {
        let seed = u64::from(seed) << 32 | u64::from(samples);
        let mut job = self.prepared.job();
        job.settings = Settings { sampler: kind, samples, seed, ..job.settings };
        let film = job.render(Gather::default(), &(), &AtomicBool::new(false)).film;
        let values = film.pixels().iter().flat_map(|pixel| pixel.mean().map(f64::from)).collect();
        Picture { values }
    }
}

fn described(text: &str) -> Imported {
    let mut imported = Imported::new("".into(), Limits::default());
    pbrt::read_text("scene.pbrt", text, &mut imported);
    imported
}

/// Red, green and blue of all pixels, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    values: Vec<f64>,
}

impl Picture {
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(crate) fn mean(pictures: &[&Self]) -> Self {
        let n = pictures.len() as f64;
        let length = pictures.first().map_or(0, |picture| picture.values.len());
        let of = |i: usize| pictures.iter().map(|picture| picture.values[i]).sum::<f64>() / n;
        Self { values: (0..length).map(of).collect() }
    }

    /// After a Gaussian blur with a standard deviation of a pixel; beyond its edges the picture goes on as at them.
    pub(crate) fn blurred(&self) -> Self {
        let across = self.blurred_along(|x, y, step| [clamped(x, step, WIDTH), y]);
        across.blurred_along(|x, y, step| [x, clamped(y, step, HEIGHT)])
    }

    fn blurred_along(&self, neighbour: impl Fn(u32, u32, i32) -> [u32; 2]) -> Self {
        let weights: Vec<(i32, f64)> = (-4..=4).map(|d: i32| (d, (-0.5 * f64::from(d * d)).exp())).collect();
        let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
        let value = |i: usize| {
            let (pixel, channel) = (i as u32 / 3, i % 3);
            let of = |(step, weight): &(i32, f64)| {
                let [x, y] = neighbour(pixel % WIDTH, pixel / WIDTH, *step);
                weight * self.values[(y * WIDTH + x) as usize * 3 + channel]
            };
            weights.iter().map(of).sum::<f64>() / total
        };
        Self { values: (0..self.values.len()).map(value).collect() }
    }
}

fn clamped(at: u32, step: i32, size: u32) -> u32 {
    at.saturating_add_signed(step).min(size - 1)
}
