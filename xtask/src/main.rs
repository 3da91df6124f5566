//! Project tasks: `cargo xtask help`.
#![forbid(unsafe_code)]

mod assets;
mod bench;
mod fuzz;
mod measure;
mod needs;
mod page;
mod steps;
mod test;

use std::{
    env,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use anyhow::{Context, bail};

const HELP: &str = "\
Tasks of the durer project.

  cargo xtask test [--quick]
      Checks that the tools are there, then runs: formatting, lints, all tests, documentation, release build.
      --quick leaves out lints, documentation, the release build and the page's tests in a browser. Without Node the
      page is left out, without Chromium its tests in a browser; both are said loudly.

  cargo xtask page
      Builds the HTML page from page/ (npm ci, vite build) and puts it into crates/page/dist/, where the next build of
      durer finds it. Needs Node 18.19 or newer and npm. A published crate holds the built page.

  cargo xtask bench render [--json] [--scene a,b] [--renderer a,b] [--runs N] [--spp N] [--quick] [--quality]
      Renders cornell, atrium, sphere8, classroom, coffee and veach-ajar with durer, Mitsuba and Cycles in turns, N times
      (default 3), and prints samples per processor second, noise, processor seconds to equal error, memory, and whether
      the pictures agree (docs/benchmarks.md). Installs the others from PyPI into target/bench/; skips what cannot be
      had. Then renders povray_spheres at 1280 x 960 in turns with POV-Ray, if `povray` is installed, without
      antialiasing and adaptively (povray +A0.3); --quality adds how far those are from converged pictures of the
      same program. --renderer takes beginnings of names: durer,mitsuba-llvm. --quick: a quarter of the samples, twice.

  cargo xtask bench kernel [--json] [--quick] [--runs N] [--scenes a,b] [--isa avx512,avx2,portable]
      Traces the same rays with our kernel, Embree 4 and obvhs in turns and prints how much faster ours is, with --json as
      JSON (docs/benchmarks.md). Puts Embree, from the Python package embreex, into target/bench/; skips where that
      or a C compiler cannot be had. --quick traces a quarter of the rays 3 times instead of 5. Scenes: atrium,
      sponza, sphere8, dragon, buddha (of the test files) and terrain (generated). To measure less:
      --mode fast or robust, --threads 1 or 2, --without-builds.

  cargo xtask bench view [--json] [--runs N] [--without-browser]
      How long recording ray trees takes, for each of 50 pixels of `whitted` and of the dragon of the test files, and
      `durer trace` as a whole, N times (default 3); how large its pages are; how fast pages of 10,000 rays are in
      Chromium (docs/benchmarks.md). What is missing is said and left out.

  cargo xtask bench load [--json] [--runs N]
      How long scenes take from their files to a tree that can be rendered, N times (default 3, the least counts): a
      million generated triangles as OBJ, PLY, STL, pbrt and GLB, and scenes of the test files; beside Mitsuba, from PyPI,
      and pbrt-v4, if `pbrt` is installed (docs/benchmarks.md).

  cargo xtask bench samplers [--json] [--quick] [--chart]
      The noise that each sampler leaves in small pictures at 1 to 1024 samples per pixel, and how many times less that
      is than of independent ones, as they are and blurred (docs/samplers.md); --quick ends at 64 samples, --chart draws
      docs/samplers.svg anew.

  cargo xtask assets [--folder F] [--formats gltf,obj,ply,stl] [--width 320]
      Opens and renders every model of these formats in the folder of test files (F, else the assets/ in DURER_SHARED,
      else ../shared/assets); writes docs/assets.md with a thumbnail, counts and times of each and says which were
      refused and why; puts contact sheets into target/assets/, and the page too if formats are left out. `pbrt` is
      a format too.

  cargo xtask fuzz [--seconds N] [TARGET..]
      Makes hostile files of small sound ones and lets every reader read them, each target of fuzz/ for N processor seconds
      (default 1200), one after another; needs cargo-fuzz (cargo install cargo-fuzz). What they try lies in
      target/fuzz/corpus/, what was found in target/fuzz/found/ (docs/TESTING.md).

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
        ["page"] => page::run(),
        ["assets", options @ ..] => assets::run(&assets::Options::parse(options)?),
        ["fuzz", options @ ..] => fuzz::run(&fuzz::Options::parse(options)?),
        ["bench", "kernel", options @ ..] => bench::kernel::run(options),
        ["bench", "view", options @ ..] => bench::view::run(&bench::view::Options::parse(options)?),
        ["bench", "load", options @ ..] => bench::load::run(&bench::load::Options::parse(options)?),
        ["bench", "samplers", options @ ..] => {
            bench::samplers::run(bench::samplers::Options::parse(options)?)
        }
        ["bench", "render", options @ ..] => bench::render::run(&bench::render::Options::parse(options)?),
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

/// Where cargo puts what it builds.
fn target_folder() -> anyhow::Result<PathBuf> {
    let words = ["metadata", "--format-version", "1", "--no-deps", "--offline"];
    let output = Command::new(cargo()).args(words).current_dir(root()?).output()?;
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).context("cargo metadata")?;
    let folder = metadata["target_directory"].as_str().context("cargo metadata names no target folder")?;
    Ok(Path::new(folder).to_path_buf())
}

/// Builds the program for speed, and says where it is.
fn release_program() -> anyhow::Result<PathBuf> {
    eprintln!("==> cargo build --release");
    let built = Command::new(cargo()).args(["build", "--release"]).current_dir(root()?).status()?;
    if !built.success() {
        bail!("durer cannot be built");
    }
    Ok(target_folder()?.join("release").join(format!("durer{}", env::consts::EXE_SUFFIX)))
}
