//! `cargo xtask bench render`: durer, Mitsuba and Cycles render the same files with the same film, in turns.
//!
//! What counts is processor time to equal error: `seconds * variance / target`, as the error of one picture is its variance
//! and falls as one by the number of samples. Variances come from pictures that differ in nothing but their seed; that
//! all renderers compute the same picture is checked by means. Then [`spheres`] is timed beside POV-Ray.
mod agreement;
mod noise;
mod options;
mod picture;
mod renderer;
mod report;
mod scene;
mod set_up;

use std::{fs, path::Path};

use anyhow::Context;

use super::{median, spheres};
use crate::{release_program, target_folder};
use agreement::Agreement;
pub(crate) use options::Options;
use picture::Picture;
use renderer::{Cost, Renderer};
use scene::Scene;

/// Worker threads of every renderer.
const THREADS: u32 = 2;

/// What is left out, and why.
struct Skipped {
    what: String,
    why: String,
}

/// One renderer on one scene.
struct Entry {
    renderer: Renderer,
    /// Of the program.
    version: String,
    costs: Vec<Cost>,
    pictures: Vec<Picture>,
    /// The pictures' mean.
    mean: Picture,
    /// Relative variance of one picture.
    variance: f64,
    /// With the first entry's pictures.
    agreement: Agreement,
}

impl Entry {
    /// Processor seconds of rendering: the least of all runs, as what else the machine does only adds to it.
    fn least(&self) -> f64 {
        self.costs.iter().map(|cost| cost.render).fold(f64::INFINITY, f64::min)
    }

    fn median(&self) -> f64 {
        median(self.costs.iter().map(|cost| cost.render).collect())
    }

    /// Processor seconds to the relative mean squared error `target`.
    fn seconds_to(&self, target: f64) -> f64 {
        self.least() * self.variance / target
    }

    /// The most memory of any run, in bytes.
    fn peak_bytes(&self) -> Option<u64> {
        self.costs.iter().filter_map(|cost| cost.peak_bytes).max()
    }
}

/// All renderers on one scene.
struct Results {
    scene: &'static Scene,
    samples: u32,
    /// Pixels that count, as a share of all.
    counted: f64,
    entries: Vec<Entry>,
}

/// Builds, renders in turns, reports.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let program = release_program()?;
    let folder = target_folder()?.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let mut skipped = Vec::new();
    let renderers = set_up::renderers(&program, &folder, options, &mut skipped);
    let mut results = Vec::new();
    for scene in options.scenes() {
        match scene.put_into(&folder.join("scenes")) {
            Ok(file) => results.push(compare(scene, &file, &folder, &renderers, options, &mut skipped)?),
            Err(why) => skip(&mut skipped, scene.name.to_owned(), format!("{why:#}")),
        }
    }
    let spheres = match options.with_spheres() {
        true => Some(spheres::run(&program, &folder, options.runs, options.quality)?),
        false => None,
    };
    report::print(&results, spheres.as_ref(), &skipped, options.json)
}

/// Says it at once, and again in the report.
fn skip(skipped: &mut Vec<Skipped>, what: String, why: String) {
    eprintln!("skipped: {what}: {why}");
    skipped.push(Skipped { what, why });
}

/// What a failed program complained of last.
fn last_line(text: &str) -> String {
    text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default().trim().to_owned()
}

fn compare(
    scene: &'static Scene,
    file: &Path,
    folder: &Path,
    renderers: &[Renderer],
    options: &Options,
    skipped: &mut Vec<Skipped>,
) -> anyhow::Result<Results> {
    let samples = options.samples(scene);
    let mut found: Vec<(Renderer, String, Vec<Cost>, Vec<Picture>)> = Vec::new();
    found.extend(renderers.iter().map(|r| (r.clone(), String::new(), Vec::new(), Vec::new())));
    for run in 1..=options.runs {
        eprintln!("==> {}, run {run} of {}", scene.name, options.runs);
        // Whoever begins may find the machine in another state than the others do.
        let first = run % found.len().max(1);
        found.rotate_left(first);
        let mut failed = None;
        found.retain_mut(|(renderer, version, costs, pictures)| {
            let job = renderer::Job { scene, file, samples, seed: run as u32, folder };
            match renderer.render(&job) {
                Ok((said, cost, picture)) => {
                    *version = said;
                    costs.push(cost);
                    pictures.push(picture);
                    true
                }
                // Ours has to work, a peer need not.
                Err(why) if renderer.is_ours() => {
                    failed = Some(why);
                    true
                }
                Err(why) => {
                    skip(
                        skipped,
                        format!("{} of {}", renderer.name, scene.name),
                        last_line(&format!("{why:#}")),
                    );
                    false
                }
            }
        });
        if let Some(why) = failed {
            return Err(why);
        }
    }
    // As they were asked for, which has ours first.
    found.sort_by_key(|(renderer, ..)| renderers.iter().position(|r| r.name == renderer.name));
    let means = found.iter().map(|(.., pictures)| Picture::mean(pictures)).collect::<Option<Vec<_>>>();
    let means = means.context("no pictures")?;
    let mask = noise::mask(scene.bright, &means);
    let counted = mask.iter().filter(|counts| **counts).count() as f64 / mask.len().max(1) as f64;
    let mut entries: Vec<Entry> = Vec::new();
    for ((renderer, version, costs, pictures), mean) in found.into_iter().zip(means) {
        let variance = noise::relative_variance(&pictures, &mean, &mask);
        let this = (&mean, pictures.as_slice());
        let first = entries.first().map_or(this, |first| (&first.mean, first.pictures.as_slice()));
        let agreement = Agreement::of(this, first, &mask);
        entries.push(Entry { renderer, version, costs, pictures, mean, variance, agreement });
    }
    Ok(Results { scene, samples, counted, entries })
}
