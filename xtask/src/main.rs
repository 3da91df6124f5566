//! Project tasks: `cargo xtask help`.
#![forbid(unsafe_code)]

mod bench;
mod measure;
mod needs;
mod steps;
mod test;

use std::{env, path::PathBuf, process::ExitCode};

use anyhow::{Context, bail};

const HELP: &str = "\
Tasks of the durer project.

  cargo xtask test [--quick]
      Checks that the tools are there, then runs: formatting, lints, all tests, documentation, release build.
      --quick leaves out lints, documentation and the release build.

  cargo xtask bench render [--json] [--runs N]
      Renders benches/povray_spheres.pbrt at 1280 x 960 with 2 threads N times (default 5), in turns with POV-Ray on
      the twin scene if `povray` is installed; prints each run, medians and ratios, with --json as JSON.

  cargo xtask help
      This text.";

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match run(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nerror: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(words: &[&str]) -> anyhow::Result<()> {
    match words {
        ["test"] => test::run(test::Extent::Full),
        ["test", "--quick"] => test::run(test::Extent::Quick),
        ["bench", "render", options @ ..] => bench::run(&bench::Options::parse(options)?),
        [] | ["help" | "--help" | "-h"] => {
            println!("{HELP}");
            Ok(())
        }
        _ => bail!("unknown task \"{}\"; see `cargo xtask help`", words.join(" ")),
    }
}

/// The workspace's folder.
fn root() -> anyhow::Result<PathBuf> {
    let xtask = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let root = xtask.parent().context("xtask lies in the workspace")?;
    Ok(root.to_path_buf())
}

/// The cargo that runs this.
fn cargo() -> String {
    env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned())
}
