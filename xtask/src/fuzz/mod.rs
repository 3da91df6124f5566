//! `cargo xtask fuzz`: hostile files for every reader, made by libFuzzer from small sound ones. The targets are in `fuzz/`.
mod seeds;
mod target;

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, bail};

use self::target::{TARGETS, Target};
use crate::{cargo, measure::measure, root, target_folder};

/// Processor seconds that each target runs if nobody says how long.
const USUAL: u64 = 1200;

/// What every file must keep to: 10 seconds, 2 GiB.
const BOUNDS: [&str; 4] = ["-timeout=10", "-rss_limit_mb=2048", "-detect_leaks=0", "-print_final_stats=1"];

/// Coverage needs what is not stable yet. One thread is followed better than several, and its time is that of the process.
const ENVIRONMENT: [(&str, &str); 3] =
    [("RUSTC_BOOTSTRAP", "1"), ("RAYON_NUM_THREADS", "1"), ("ASAN_OPTIONS", "quarantine_size_mb=64")];

/// What was asked for.
#[derive(Debug)]
pub(crate) struct Options {
    seconds: u64,
    targets: Vec<&'static Target>,
}

impl Options {
    /// From the words after `fuzz`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self { seconds: USUAL, targets: Vec::new() };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            if *word == "--seconds" {
                let seconds = words.next().and_then(|n| n.parse().ok()).filter(|n| *n > 0);
                options.seconds = seconds.context("--seconds wants a number of at least 1")?;
                continue;
            }
            let known = || TARGETS.iter().map(|t| t.name).collect::<Vec<_>>().join(", ");
            let found = TARGETS.iter().find(|t| t.name == *word);
            options
                .targets
                .push(found.with_context(|| format!("no target \"{word}\"; there are {}", known()))?);
        }
        if options.targets.is_empty() {
            options.targets = TARGETS.iter().collect();
        }
        Ok(options)
    }
}

/// Where targets are built, what they try, and what they find.
struct Place {
    folder: PathBuf,
}

impl Place {
    fn cargo_fuzz(&self, task: &str) -> anyhow::Result<Command> {
        let mut command = Command::new(cargo());
        command.args(["fuzz", task, "--fuzz-dir", "fuzz", "--target-dir"]).arg(self.folder.join("build"));
        command.current_dir(root()?).envs(ENVIRONMENT);
        Ok(command)
    }

    /// Runs a target until it has had its time; says what it did at last.
    fn run(&self, target: &Target, seconds: u64, assets: Option<&Path>) -> anyhow::Result<String> {
        let corpus = self.folder.join("corpus").join(target.name);
        let words = self.folder.join(format!("{}.dict", target.name));
        let count = seeds::gather(target, assets, &corpus, &words)?;
        let found = self.folder.join("found").join(target.name);
        std::fs::create_dir_all(&found)?;
        eprintln!("==> {}: from {count} files, {seconds} s", target.name);
        // Targets put their files there, and are ended without a chance to take them away.
        let files = self.folder.join("files");
        std::fs::create_dir_all(&files)?;
        let (mut left, mut last) = (seconds as f64, String::new());
        while left > 0.0 {
            let mut command = self.cargo_fuzz("run")?;
            command.arg(target.name).arg(&corpus).arg("--").args(BOUNDS);
            if target.is_wordy {
                command.arg(format!("-dict={}", words.display()));
            }
            command.arg(format!("-artifact_prefix={}/", found.display()));
            command.arg(format!("-max_len={}", target.longest));
            command.arg(format!("-max_total_time={}", left.ceil()));
            let run = measure(command.env("TMPDIR", &files));
            std::fs::remove_dir_all(&files).and_then(|()| std::fs::create_dir(&files))?;
            let run = run?;
            // Where the system does not tell, wall time must do.
            left -= run.user.zip(run.system).map_or(run.wall, |(user, system)| user + system).max(1.0);
            let said = String::from_utf8_lossy(&run.output.stderr).into_owned();
            last = said.lines().rfind(|line| line.contains("DONE")).unwrap_or_default().to_owned();
        }
        Ok(last)
    }
}

/// The last lines of what a target said: a run of minutes says thousands before.
fn end_of(said: &str) -> String {
    const LINES: usize = 40;
    let lines: Vec<&str> = said.lines().collect();
    lines.get(lines.len().saturating_sub(LINES)..).unwrap_or_default().join("\n")
}

/// Builds all targets, runs those that were asked for one after another, and says which found something.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let place = Place { folder: target_folder()?.join("fuzz") };
    let there = Command::new(cargo()).args(["fuzz", "--version"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        bail!("cargo-fuzz is missing: cargo install cargo-fuzz");
    }
    if !place.cargo_fuzz("build")?.status()?.success() {
        bail!("the targets cannot be built");
    }
    let assets = crate::bench::assets().ok();
    if assets.is_none() {
        eprintln!("the test files are missing (DURER_SHARED names their folder): seeds are few");
    }
    let mut findings = Vec::new();
    for target in &options.targets {
        match place.run(target, options.seconds, assets.as_deref()) {
            Ok(last) => println!("{:<12} nothing found  {last}", target.name),
            Err(error) => {
                println!("{:<12} FOUND", target.name);
                findings.push(format!("{}:\n{}", target.name, end_of(&error.to_string())));
            }
        }
    }
    if !findings.is_empty() {
        bail!(
            "{} of {} targets found something:\n{}",
            findings.len(),
            options.targets.len(),
            findings.join("\n\n")
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_report_the_end_is_told() {
        let long: String = (0..1000).map(|i| format!("{i}\n")).collect();
        let end = end_of(&long);
        assert!(end.starts_with("960\n") && end.ends_with("999") && end_of("a") == "a");
    }

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--seconds", "5", "ply", "exr"]).expect("good options");
        assert_eq!((options.seconds, options.targets.len()), (5, 2));
        assert_eq!(Options::parse(&[]).expect("none").targets.len(), TARGETS.len());
        let wrong = Options::parse(&["plx"]).expect_err("no such target");
        assert!(wrong.to_string().contains("there are pbrt, mitsuba"));
        assert!(Options::parse(&["--seconds", "0"]).is_err());
    }
}
