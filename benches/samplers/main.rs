//! The noise that each kind of sampler leaves in small pictures of six scenes, at 1 to 1024 samples per pixel, as JSON:
//! `samplers [--quick] [--chart FILE]`. `cargo xtask bench samplers` builds and starts it; `docs/samplers.md` shows what it
//! found.
#![forbid(unsafe_code)]

mod chart;
mod noise;
mod picture;

use std::{env, fs};

use anyhow::{Context, bail};
use durer::sampling::SamplerKind;
use serde_json::{Value, json};

use crate::{
    noise::Noise,
    picture::{Picture, Subject},
};

/// Kinds that are compared. Regular samples have errors without variance, so that their pictures tell less.
pub(crate) const KINDS: [SamplerKind; 6] = [
    SamplerKind::Independent,
    SamplerKind::Stratified,
    SamplerKind::Halton,
    SamplerKind::PaddedSobol,
    SamplerKind::Sobol,
    SamplerKind::ZSobol,
];

/// Samples per pixel, and how many pictures of each kind are taken with as many.
const COUNTS: [(u32, u32); 6] = [(1, 8), (4, 8), (16, 8), (64, 4), (256, 4), (1024, 2)];

/// What was measured of a kind in a scene.
pub(crate) struct Measured {
    /// The kind.
    pub(crate) kind: SamplerKind,
    /// Samples per pixel and what they leave.
    pub(crate) noise: Vec<(u32, Noise)>,
}

fn main() -> anyhow::Result<()> {
    // Cargo adds `--bench` if it starts this itself.
    let words: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    let (mut most, mut chart) = (u32::MAX, None);
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--quick" => most = 64,
            "--chart" => chart = Some(words.next().context("--chart wants a file")?),
            other => bail!("unknown option \"{other}\""),
        }
    }
    let mut scenes = Vec::new();
    for name in Subject::NAMES {
        scenes.push((name, measure(&Subject::open(name)?, most)));
    }
    println!("{:#}", report(&scenes));
    if let Some(file) = chart {
        fs::write(file, chart::svg(&scenes)).with_context(|| format!("{file} cannot be written"))?;
    }
    Ok(())
}

/// All kinds, with up to `most` samples per pixel.
fn measure(subject: &Subject, most: u32) -> Vec<Measured> {
    let counts: Vec<(u32, u32)> = COUNTS.into_iter().filter(|(count, _)| *count <= most).collect();
    let pictures = KINDS.map(|kind| {
        eprintln!("{}: {}", subject.name(), kind.word());
        let taken = |(count, seeds): &(u32, u32)| -> Vec<Picture> {
            (0..*seeds).map(|seed| subject.picture(kind, *count, seed)).collect()
        };
        counts.iter().map(taken).collect::<Vec<_>>()
    });
    let best: Vec<&Picture> = pictures.iter().filter_map(|of_kind| of_kind.last()).flatten().collect();
    let mean = Picture::mean(&best);
    let blurred = mean.blurred();
    let of_kind = |(kind, taken): (SamplerKind, &Vec<Vec<Picture>>)| Measured {
        kind,
        noise: counts
            .iter()
            .zip(taken)
            .map(|((count, _), pictures)| (*count, Noise::of(pictures, &mean, &blurred)))
            .collect(),
    };
    KINDS.into_iter().zip(&pictures).map(of_kind).collect()
}

fn report(scenes: &[(&str, Vec<Measured>)]) -> Value {
    let of_kind = |measured: &Measured| {
        let noise = |of: fn(&Noise) -> f64| measured.noise.iter().map(|(_, n)| of(n)).collect::<Vec<_>>();
        let counts: Vec<u32> = measured.noise.iter().map(|(count, _)| *count).collect();
        json!({
            "sampler": measured.kind.word(), "spp": counts,
            "relative_variance": noise(|n| n.sharp), "blurred": noise(|n| n.blurred),
        })
    };
    scenes.iter().map(|(name, kinds)| (*name, kinds.iter().map(of_kind).collect::<Value>())).collect()
}
