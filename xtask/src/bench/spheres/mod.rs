//! The scene `povray_spheres` of `cargo xtask bench render`: durer and POV-Ray draw it in turns.
//!
//! Twice: without antialiasing, and with POV-Ray's `+A0.3` beside our `--antialias adaptive`. With `--quality` it says
//! first how good these are: by the root of the mean squared difference of code values, as shares of 255, from a
//! converged picture of the same program, as the programs' pictures differ by a little more than noise.
//!
//! In turns, so that what else the machine does hits both; the medians are what to quote. durer counts its rays while
//! it is timed, as POV-Ray does.
mod durer;
mod povray;
mod quality;
mod report;

use std::path::Path;

use crate::root;

use super::median;

pub(super) use report::{as_values, print};

/// Pixels per row.
const WIDTH: u32 = 1280;
/// Rows.
const HEIGHT: u32 = 960;
/// Worker threads of both.
const THREADS: u32 = 2;

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

/// What all runs took, and how good the antialiased pictures are.
pub(super) struct Spheres {
    comparisons: [Comparison; 2],
    /// None, ours, or ours and theirs.
    rmse: Vec<f64>,
}

/// Renders in turns; pictures go into `folder`.
pub(super) fn run(program: &Path, folder: &Path, runs: usize, with_quality: bool) -> anyhow::Result<Spheres> {
    let scenes = root()?.join("benches");
    let with_povray = povray::is_installed();
    if !with_povray {
        eprintln!("povray is not installed: durer runs alone (on Debian: apt-get install povray)");
    }
    let our_run = |mode| durer::render(program, &scenes.join("povray_spheres.pbrt"), folder, mode);
    let their_run = |mode| povray::render(&scenes.join("povray_spheres.pov"), folder, mode);
    let mut rmse = Vec::new();
    if with_quality {
        eprintln!("==> quality");
        rmse.push(quality::rmse(&folder.join(durer::PICTURE), our_run)?);
        if with_povray {
            rmse.push(quality::rmse(&folder.join(povray::PICTURE), their_run)?);
        }
    }
    let mut comparisons = [Comparison::of(Mode::Plain), Comparison::of(Mode::Antialiased)];
    for number in 1..=runs {
        eprintln!("==> povray_spheres, run {number} of {runs}");
        for comparison in &mut comparisons {
            comparison.ours.push(our_run(comparison.mode)?);
            if with_povray {
                comparison.theirs.push(their_run(comparison.mode)?);
            }
        }
    }
    Ok(Spheres { comparisons, rmse })
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
