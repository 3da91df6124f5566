//! How a picture is taken, as options and scene say, and where both are silent.
use durer_core::{sampling::SamplerKind, spectrum::Carried};
use durer_render::{
    View,
    drive::{Jitter, Nesting, Settings},
    film::Tile,
    integrator::{EyeSamples, Output, Show},
};
use durer_scene::{Data, Diagnostics, Location, SceneDesc};

use crate::Options;

/// Samples per pixel if nobody asked for a number.
const DEFAULT_SAMPLES: u32 = 64;

/// Samples, seed, threads, crop.
pub(crate) fn settings(
    desc: &SceneDesc,
    options: &Options,
    view: &View,
    (eye, carried): (EyeSamples, Carried),
) -> Settings {
    let jitter = |off: bool| if off { Jitter::Middle } else { Jitter::Drawn };
    Settings {
        samples: eye.total,
        sampler: options.sampler.unwrap_or_else(|| sampler(desc)),
        nesting: match jitter(desc.options.disable_pixel_jitter) {
            Jitter::Middle => Nesting::STILL,
            Jitter::Drawn => Nesting { time: eye.time, lens: eye.lens, ..Nesting::default() },
        },
        seed: options.seed.or(desc.film.seed).unwrap_or(0),
        threads: options.threads.unwrap_or_else(all_cores),
        crop: options.crop.or_else(|| crop(desc, [view.width, view.height])),
        antialias: options.antialias,
        carried,
        wavelengths: jitter(desc.options.disable_wavelength_jitter),
    }
}

/// The part of the picture that the file asks for.
fn crop(desc: &SceneDesc, size: [u32; 2]) -> Option<Tile> {
    let film = &desc.film;
    let from = [film.width.unwrap_or(size[0]), film.height.unwrap_or(size[1])];
    let [x0, x1, y0, y1] = film.crop?.pixels(from, size);
    Some(Tile { x0, y0, x1, y1 })
}

/// Averages of object numbers mean nothing, and a mean depth little: data pictures take one sample unless told.
pub(crate) fn samples(
    desc: &SceneDesc,
    options: &Options,
    output: Output,
    diagnostics: &mut Diagnostics,
) -> u32 {
    let asked = options.samples.map(|n| n.max(1));
    match output {
        Output::Data(Show::Id) => {
            if asked.is_some_and(|n| n > 1) {
                diagnostics
                    .warning(Location::None, "object ids cannot be averaged: one sample per pixel is taken");
            }
            1
        }
        Output::Data(_) => asked.unwrap_or(1),
        Output::Radiance | Output::Survey(_) => asked.or(desc.film.samples).unwrap_or(DEFAULT_SAMPLES).max(1),
    }
}

fn sampler(desc: &SceneDesc) -> SamplerKind {
    match desc.sampler.as_ref().map(|n| n.kind.as_str()) {
        Some("stratified") if !is_jittered(desc) => SamplerKind::Regular,
        // pbrt's other sampler whose noise is fine-grained.
        Some("pmj02bn") => SamplerKind::ZSobol,
        word => word.and_then(SamplerKind::from_word).unwrap_or_default(),
    }
}

/// What a stratified sampler says of it; it does unless told otherwise.
fn is_jittered(desc: &SceneDesc) -> bool {
    let jitter = desc.sampler.as_ref().and_then(|node| node.params.get("jitter"));
    jitter.is_none_or(|param| param.data != Data::Bools(vec![false]))
}

fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}
