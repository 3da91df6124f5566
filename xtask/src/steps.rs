//! Commands one after another: each is announced, timed, and the first that fails ends the run with how to repeat it.
use std::{
    process::Command,
    time::{Duration, Instant},
};

use anyhow::{Context, bail};

use crate::{cargo, root};

/// A run of steps.
#[derive(Default)]
pub(crate) struct Steps {
    done: Vec<(String, Duration)>,
}

impl Steps {
    /// Runs `cargo` with these words in the workspace, with additions to the environment.
    pub(crate) fn cargo(&mut self, words: &[&str], environment: &[(&str, &str)]) -> anyhow::Result<()> {
        let shown = shown("cargo", words, environment);
        self.run_in(Command::new(cargo()).args(words).envs(environment.iter().copied()), "", shown)
    }

    /// Runs another program with these words in a folder of the workspace, with additions to the environment.
    pub(crate) fn program(
        &mut self,
        words: &[&str],
        folder: &str,
        environment: &[(&str, &str)],
    ) -> anyhow::Result<()> {
        let (program, rest) = words.split_first().context("a program")?;
        let shown = format!("(cd {folder} && {})", shown(program, rest, environment));
        let mut command = Command::new(program);
        command.args(rest).envs(environment.iter().copied());
        self.run_in(&mut command, folder, shown)
    }

    fn run_in(&mut self, command: &mut Command, folder: &str, shown: String) -> anyhow::Result<()> {
        println!("\n==> {shown}");
        let start = Instant::now();
        let status = command
            .current_dir(root()?.join(folder))
            .status()
            .with_context(|| format!("{shown} cannot be started"))?;
        let took = start.elapsed();
        if !status.success() {
            self.print();
            bail!("failed after {}; to repeat this step:\n  {shown}", seconds(took));
        }
        println!("    {} ok", seconds(took));
        self.done.push((shown, took));
        Ok(())
    }

    /// The times of all steps.
    pub(crate) fn print(&self) {
        println!("\ntimes");
        for (step, took) in &self.done {
            println!("  {:>8}  {step}", seconds(*took));
        }
        let sum = self.done.iter().map(|(_, took)| *took).sum();
        println!("  {:>8}  in all", seconds(sum));
    }
}

/// As one would type it.
fn shown(program: &str, words: &[&str], environment: &[(&str, &str)]) -> String {
    let mut shown: String = environment.iter().map(|(name, value)| format!("{name}=\"{value}\" ")).collect();
    shown.push_str(program);
    for word in words {
        shown.push(' ');
        shown.push_str(word);
    }
    shown
}

fn seconds(time: Duration) -> String {
    let whole = time.as_secs();
    match whole {
        0..60 => format!("{:.1} s", time.as_secs_f64()),
        _ => format!("{} min {:02} s", whole / 60, whole % 60),
    }
}
