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
pub(super) use set_up::mitsuba_python;

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

/// What is the same for all scenes.
struct Bench<'a> {
    options: &'a Options,
    renderers: Vec<Renderer>,
    /// Where pictures go.
    folder: &'a Path,
    skipped: Vec<Skipped>,
}

/// Builds, renders in turns, reports.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let program = release_program()?;
    let folder = target_folder()?.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let mut bench = Bench { options, renderers: Vec::new(), folder: &folder, skipped: Vec::new() };
    if options.scenes().next().is_some() {
        let (renderers, skipped) = set_up::renderers(&program, &folder, options);
        bench.renderers = renderers;
        bench.skipped.extend(skipped);
    }
    let mut results = Vec::new();
    for scene in options.scenes() {
        match scene.put_into(&folder.join("scenes")) {
            Ok(file) => {
                let taken = bench.take_turns(scene, &file)?;
                results.push(Results::of(scene, options.samples(scene), taken)?);
            }
            Err(why) => bench.skipped.push(Skipped::new(scene.name, &format!("{why:#}"))),
        }
    }
    let spheres = match options.with_spheres() {
        true => Some(spheres::run(&program, &folder, options.runs, options.quality)?),
        false => None,
    };
    report::print(&results, spheres.as_ref(), &bench.skipped, options.json)
}

impl Skipped {
    /// Says it at once; the report says it again. Of what went wrong the last line is enough.
    fn new(what: &str, why: &str) -> Self {
        let last = why.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default().trim();
        eprintln!("skipped: {what}: {last}");
        Self { what: what.to_owned(), why: last.to_owned() }
    }
}

/// All pictures of one renderer and what they cost.
struct Taken {
    renderer: Renderer,
    version: String,
    costs: Vec<Cost>,
    pictures: Vec<Picture>,
}

impl Bench<'_> {
    /// Each renderer in its turn, as often as was asked for. Ours has to work, a peer need not.
    fn take_turns(&mut self, scene: &Scene, file: &Path) -> anyhow::Result<Vec<Taken>> {
        let untaken = |renderer: &Renderer| Taken {
            renderer: renderer.clone(),
            version: String::new(),
            costs: Vec::new(),
            pictures: Vec::new(),
        };
        let mut all: Vec<Taken> = self.renderers.iter().map(untaken).collect();
        let samples = self.options.samples(scene);
        for run in 1..=self.options.runs {
            eprintln!("==> {}, run {run} of {}", scene.name, self.options.runs);
            let job = renderer::Job { scene, file, samples, seed: run as u32, folder: self.folder };
            let mut working = Vec::new();
            for mut taken in all {
                match taken.renderer.render(&job) {
                    Ok((version, cost, picture)) => {
                        taken.version = version;
                        taken.costs.push(cost);
                        taken.pictures.push(picture);
                        working.push(taken);
                    }
                    Err(why) if taken.renderer.is_ours() => return Err(why),
                    Err(why) => {
                        let what = format!("{} of {}", taken.renderer.name, scene.name);
                        self.skipped.push(Skipped::new(&what, &format!("{why:#}")));
                    }
                }
            }
            all = working;
            // Whoever begins may find the machine in another state than the others do.
            let first = 1.min(all.len());
            all.rotate_left(first);
        }
        // As they were asked for, which has ours first.
        all.sort_by_key(|taken| self.renderers.iter().position(|r| r.name == taken.renderer.name));
        Ok(all)
    }
}

impl Results {
    fn of(scene: &'static Scene, samples: u32, all: Vec<Taken>) -> anyhow::Result<Self> {
        let means: Option<Vec<Picture>> = all.iter().map(|taken| Picture::mean(&taken.pictures)).collect();
        let means = means.context("no pictures")?;
        let mask = noise::mask(scene.bright, &means);
        let counted = mask.iter().filter(|counts| **counts).count() as f64 / mask.len().max(1) as f64;
        let mut entries: Vec<Entry> = Vec::new();
        for (Taken { renderer, version, costs, pictures }, mean) in all.into_iter().zip(means) {
            let variance = noise::relative_variance(&pictures, &mean, &mask);
            let this = (&mean, pictures.as_slice());
            let first = entries.first().map_or(this, |first| (&first.mean, first.pictures.as_slice()));
            let agreement = Agreement::of(this, first, &mask);
            entries.push(Entry { renderer, version, costs, pictures, mean, variance, agreement });
        }
        Ok(Self { scene, samples, counted, entries })
    }
}
