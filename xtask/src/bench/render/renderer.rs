//! One picture by one renderer, and what it cost.
use std::{
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::Context;
use serde_json::Value;

use super::{THREADS, picture::Picture, scene::Scene};
use crate::measure::{Measured, measure};

/// A program and how it is started.
#[derive(Clone, Debug)]
pub(super) struct Renderer {
    pub(super) name: &'static str,
    pub(super) how: How,
}

#[derive(Clone, Debug)]
pub(super) enum How {
    /// Our program.
    Durer(PathBuf),
    /// A script of `benches/render`, started by the Python of an environment in which its renderer is.
    Script { python: PathBuf, script: PathBuf, words: &'static [&'static str], llvm: Option<PathBuf> },
}

/// What is rendered.
pub(super) struct Job<'a> {
    pub(super) scene: &'a Scene,
    pub(super) file: &'a Path,
    /// Per pixel.
    pub(super) samples: u32,
    pub(super) seed: u32,
    /// Where the picture goes.
    pub(super) folder: &'a Path,
}

/// What a picture cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    /// Processor seconds, in user mode and in the system, of rendering alone.
    pub(super) render: f64,
    /// Wall seconds of the process, loading and all.
    pub(super) wall: f64,
    /// The most memory.
    pub(super) peak_bytes: Option<u64>,
}

impl Renderer {
    /// Whether it is the program of this project.
    pub(super) fn is_ours(&self) -> bool {
        matches!(self.how, How::Durer(_))
    }

    /// The program's version, the cost and the picture.
    pub(super) fn render(&self, job: &Job<'_>) -> anyhow::Result<(String, Cost, Picture)> {
        let out = job.folder.join(format!("{}-{}-{}.exr", job.scene.name, self.name, job.seed));
        let (version, cost) = match &self.how {
            How::Durer(program) => durer(program, job, &out)?,
            How::Script { python, script, words, llvm } => {
                let mut command = Command::new(python);
                command.arg(script).arg(job.file).arg(&out).args(*words).args(film(job));
                command.args(["--seed", &job.seed.to_string()]).env("PYTHONDONTWRITEBYTECODE", "1");
                if let Some(library) = llvm {
                    command.env("DRJIT_LIBLLVM_PATH", library);
                }
                told(&measure(&mut command)?)?
            }
        };
        Ok((version, cost, Picture::read(&out)?))
    }
}

/// Options that all renderers have.
fn film(job: &Job<'_>) -> Vec<String> {
    let numbers = [
        ("--width", job.scene.width),
        ("--height", job.scene.height),
        ("--spp", job.samples),
        ("--threads", THREADS),
    ];
    numbers.into_iter().flat_map(|(name, number)| [name.to_owned(), number.to_string()]).collect()
}

/// Loading is what a picture of one pixel with one sample takes.
fn durer(program: &Path, job: &Job<'_>, out: &Path) -> anyhow::Result<(String, Cost)> {
    let start = |words: &[&str]| {
        let mut command = Command::new(program);
        command.arg("render").arg(job.file).args(film(job)).args(["--quiet", "-o"]).arg(out).args(words);
        measure(&mut command)
    };
    let loading = {
        let mut command = Command::new(program);
        command
            .arg("render")
            .arg(job.file)
            .args(["--crop", "0,0,1,1", "--spp", "1", "--quiet", "-o"])
            .arg(out);
        measure(command.args(["--threads", &THREADS.to_string()]))?
    };
    let whole = start(&["--seed", &job.seed.to_string()])?;
    let render = seconds(&whole)? - seconds(&loading)?;
    let version = measure(Command::new(program).arg("--version"))?;
    let version = String::from_utf8_lossy(&version.output.stdout);
    let version = version.split_whitespace().nth(1).unwrap_or_default().to_owned();
    Ok((version, Cost { render, wall: whole.wall, peak_bytes: whole.peak_bytes }))
}

/// Processor seconds of a process.
fn seconds(measured: &Measured) -> anyhow::Result<f64> {
    let both = measured.user.zip(measured.system).map(|(user, system)| user + system);
    both.context("the system does not tell processor time")
}

/// What a script says in its last line that is an object.
fn told(measured: &Measured) -> anyhow::Result<(String, Cost)> {
    let text = String::from_utf8_lossy(&measured.output.stdout);
    let objects = text.lines().rev().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let said = objects.into_iter().find(Value::is_object).context("the script says nothing")?;
    let render = said["render_cpu"].as_f64().context("the script tells no time")?;
    let version = said["version"].as_str().unwrap_or_default().to_owned();
    Ok((version, Cost { render, wall: measured.wall, peak_bytes: measured.peak_bytes }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_understood_among_what_else_it_prints() {
        let text = "Saved: x.exr\n{\"version\": \"5.0.1\", \"render_cpu\": 1.5}\nTime: 1\n";
        let measured = measure(Command::new("printf").args(["%s", text])).expect("printf");
        let (version, cost) = told(&measured).expect("an object");
        assert_eq!((version.as_str(), cost.render), ("5.0.1", 1.5));
        assert!(told(&measure(Command::new("echo").arg("3")).expect("echo")).is_err());
    }
}
