//! `cargo xtask bench view`: recording ray trees, the pages that show them, and the live page's server. Figures only: nothing is asserted.
mod browser;
mod live;
mod report;
mod trace;

use std::{fs, path::PathBuf, process::Command};

use anyhow::{Context, bail};
use serde_json::{Value, json};

use super::built;
use crate::{release_program, target_folder};

/// A model of 871 414 triangles, below the folder of test files.
const DRAGON: &str = "ply/dragon_vrip.ply.gz";
/// Light transport that has ray trees.
const INTEGRATORS: [&str; 2] = ["whitted", "distributed"];
/// Light transport that is watched live.
const LIVE_INTEGRATORS: [&str; 2] = ["whitted", "path"];

/// What was asked for.
pub(crate) struct Options {
    json: bool,
    runs: usize,
    browser: bool,
}

impl Options {
    /// From the words after `bench view`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self { json: false, runs: 3, browser: true };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match *word {
                "--json" => options.json = true,
                "--without-browser" => options.browser = false,
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

/// All figures, and what could not be measured.
#[derive(Default)]
struct Figures {
    recordings: Vec<Value>,
    commands: Vec<Value>,
    pages: Vec<Value>,
    browser: Vec<Value>,
    live: Vec<Value>,
    skipped: Vec<String>,
}

impl Figures {
    fn skip(&mut self, reason: String) {
        eprintln!("\n==> SKIPPED: {reason}\n");
        self.skipped.push(reason);
    }

    fn as_value(&self) -> Value {
        json!({
            "version": 1, "recordings": self.recordings, "commands": self.commands, "pages": self.pages,
            "browser": self.browser, "live": self.live, "skipped": self.skipped,
        })
    }
}

/// Builds, measures, reports.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let (durer, recorder) = (release_program()?, built::program("view")?);
    let folder = target_folder()?.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let mut figures = Figures::default();
    let scenes = scenes(&mut figures)?;
    for (name, scene) in &scenes {
        for integrator in INTEGRATORS {
            eprintln!("==> recording {name}, {integrator}");
            figures.recordings.push(record(&recorder, name, scene, integrator)?);
        }
    }
    for (name, scene) in &scenes {
        for integrator in LIVE_INTEGRATORS {
            figures.live.push(live::measure(&durer, name, scene, integrator)?);
        }
    }
    let tracer = trace::Tracer { durer, folder, runs: options.runs };
    let writes_pages = tracer.writes_pages()?;
    if !writes_pages {
        figures.skip("pages: durer was built without the page (cargo xtask page builds it)".to_owned());
    }
    for (name, scene) in &scenes {
        figures.commands.extend(tracer.commands(name, scene, writes_pages)?);
    }
    if writes_pages {
        let pages = tracer.pages()?;
        figures.pages = pages.iter().map(|page| json!({ "page": page.name, "bytes": page.bytes })).collect();
        match browser::missing(options.browser) {
            Some(reason) => figures.skip(format!("pages in a browser: {reason}")),
            None => figures.browser = browser::measure(pages.iter().map(|page| page.path.as_path()))?,
        }
    }
    if options.json {
        println!("{}", serde_json::to_string_pretty(&figures.as_value())?);
    } else {
        print!("{}", report::as_tables(&figures));
    }
    Ok(())
}

/// Names and files, or built-in scenes.
fn scenes(figures: &mut Figures) -> anyhow::Result<Vec<(&'static str, PathBuf)>> {
    let mut scenes = vec![("whitted", PathBuf::from("whitted"))];
    let dragon = built::assets()?.join(DRAGON);
    if dragon.is_file() {
        scenes.push(("dragon", dragon));
    } else {
        figures
            .skip(format!("the dragon: {} is not there (DURER_SHARED names its folder)", dragon.display()));
    }
    Ok(scenes)
}

/// Times of recording, within a process.
fn record(recorder: &PathBuf, name: &str, scene: &PathBuf, integrator: &str) -> anyhow::Result<Value> {
    let output = Command::new(recorder).arg(scene).arg(integrator).output()?;
    if !output.status.success() {
        bail!("recording {name} failed: {}", String::from_utf8_lossy(&output.stderr));
    }
    let mut figures: Value = serde_json::from_slice(&output.stdout).context("times of recording")?;
    figures["scene"] = name.into();
    figures["integrator"] = integrator.into();
    Ok(figures)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--runs", "2", "--json", "--without-browser"]).expect("good options");
        assert!(options.json && options.runs == 2 && !options.browser);
        assert!(Options::parse(&["--runs", "0"]).is_err() && Options::parse(&["--slow"]).is_err());
    }
}
