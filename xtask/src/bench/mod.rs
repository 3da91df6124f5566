//! `cargo xtask bench render`: durer and POV-Ray draw the same scene in turns.
//!
//! Twice: without antialiasing, and with POV-Ray's `+A0.3` beside our `--antialias adaptive`. With `--quality` it says
//! first how good these are: by the root of the mean squared difference of code values, as shares of 255, from a
//! converged picture of the same program, as the programs' pictures differ by a little more than noise.
//!
//! In turns, so that what else the machine does hits both; the medians are what to quote. durer counts its rays while
//! it is timed, as POV-Ray does.
mod built;
mod durer;
mod embree;
pub(crate) mod kernel;
mod povray;
mod quality;
mod report;
pub(crate) mod samplers;
pub(crate) mod view;

use std::fs;

use anyhow::{Context, bail};

use crate::{release_program, root, target_folder};

/// Pixels per row.
const WIDTH: u32 = 1280;
/// Rows.
const HEIGHT: u32 = 960;
/// Worker threads of both.
const THREADS: u32 = 2;

/// What was asked for.
pub(crate) struct Options {
    json: bool,
    runs: usize,
    quality: bool,
}

/// How a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// One sample per pixel.
    Plain,
    /// More where it shows.
    Antialiased,
    /// So many that more would change nothing.
    Converged,
}

impl Options {
    /// From the words after `bench render`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self { json: false, runs: 5, quality: false };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match *word {
                "--json" => options.json = true,
                "--quality" => options.quality = true,
                "--runs" => {
                    let count = words.next().and_then(|n| n.parse().ok()).filter(|n| *n > 0);
                    options.runs = count.context("--runs wants a number of at least 1")?;
                }
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        Ok(options)
    }
}

/// What one run took and did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    /// Seconds from process start to end.
    wall: f64,
    /// Processor seconds of the process in user mode.
    user: Option<f64>,
    /// Seconds that the program says it traced rays for.
    trace: f64,
    /// Eye, reflected and refracted rays.
    rays: u64,
    /// Shadow rays.
    shadow_tests: u64,
}

impl Run {
    /// The middle of each figure on its own. Of an even number it is the mean of the two in the middle.
    fn median(runs: &[Self]) -> Self {
        let of = |figure: &dyn Fn(&Self) -> f64| median(runs.iter().map(figure).collect());
        let users: Option<Vec<f64>> = runs.iter().map(|run| run.user).collect();
        Self {
            wall: of(&|run| run.wall),
            user: users.map(median),
            trace: of(&|run| run.trace),
            rays: of(&|run| run.rays as f64) as u64,
            shadow_tests: of(&|run| run.shadow_tests as f64) as u64,
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match (values.len() % 2, values.get(middle), values.get(middle.wrapping_sub(1))) {
        (0, Some(high), Some(low)) => (high + low) / 2.0,
        (_, Some(value), _) => *value,
        _ => f64::NAN,
    }
}

/// Builds, renders in turns, reports.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let target = target_folder()?;
    let program = release_program()?;
    let folder = target.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let scenes = root()?.join("benches");
    let with_povray = povray::is_installed();
    if !with_povray {
        eprintln!("povray is not installed: durer runs alone (on Debian: apt-get install povray)");
    }
    let our_run = |mode| durer::render(&program, &scenes.join("povray_spheres.pbrt"), &folder, mode);
    let their_run = |mode| povray::render(&scenes.join("povray_spheres.pov"), &folder, mode);
    let mut rmse = Vec::new();
    if options.quality {
        eprintln!("==> quality");
        rmse.push(quality::rmse(&folder.join(durer::PICTURE), our_run)?);
        if with_povray {
            rmse.push(quality::rmse(&folder.join(povray::PICTURE), their_run)?);
        }
    }
    let mut comparisons = [Comparison::of(Mode::Plain), Comparison::of(Mode::Antialiased)];
    for number in 1..=options.runs {
        eprintln!("==> run {number} of {}", options.runs);
        for comparison in &mut comparisons {
            comparison.ours.push(our_run(comparison.mode)?);
            if with_povray {
                comparison.theirs.push(their_run(comparison.mode)?);
            }
        }
    }
    report::print(&comparisons, &rmse, options.json)
}

/// The runs of both programs that are held against each other.
pub(super) struct Comparison {
    mode: Mode,
    ours: Vec<Run>,
    /// Empty where POV-Ray is not installed.
    theirs: Vec<Run>,
}

impl Comparison {
    fn of(mode: Mode) -> Self {
        Self { mode, ours: Vec::new(), theirs: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(vec![7.0]), 7.0);
    }

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--runs", "3", "--json"]).expect("good options");
        assert!(options.json && options.runs == 3 && !options.quality);
        assert!(Options::parse(&["--runs", "0"]).is_err() && Options::parse(&["--runs"]).is_err());
        assert!(Options::parse(&["--fast"]).is_err());
    }
}
