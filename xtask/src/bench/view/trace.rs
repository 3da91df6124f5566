//! `durer trace` as a whole: how long it takes, and how large its pages are.
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::Context;
use serde_json::{Value, json};

use crate::{bench::median, measure::measure};

/// Name and options of the pages that are measured; the pixel lies on the glass ball.
const PAGES: &[(&str, &str)] = &[
    ("whitted-16", "--width 640 --height 360 --pixel 370,200 --spp 16"),
    // As many trees of other samples as there is room for.
    ("whitted-filled", "--width 640 --height 360 --pixel 320,200 --spp 512"),
    // One tree of 10 428 rays. The small picture beside it is drawn with the same options: a larger one takes minutes.
    ("whitted-deep", "--width 64 --height 36 --pixel 32,20 --spp 1 --min-contribution 0 --max-depth 16"),
];

/// A page on disk.
pub(super) struct Page {
    pub(super) name: &'static str,
    pub(super) path: PathBuf,
    pub(super) bytes: u64,
}

/// What runs the program.
pub(super) struct Tracer {
    pub(super) durer: PathBuf,
    /// Where pages go.
    pub(super) folder: PathBuf,
    /// How often commands are timed.
    pub(super) runs: usize,
}

impl Tracer {
    fn command(&self, scene: &Path) -> Command {
        let mut command = Command::new(&self.durer);
        command.arg("trace").arg(scene).arg("--quiet");
        command
    }

    /// Whether this durer has the page.
    pub(super) fn writes_pages(&self) -> anyhow::Result<bool> {
        let path = self.folder.join("probe.html");
        let mut command = self.command(Path::new("whitted"));
        command.args(["--pixel", "0,0", "--width", "8", "--height", "8", "--spp", "1", "-o"]).arg(&path);
        let output =
            command.output().with_context(|| format!("{} cannot be started", self.durer.display()))?;
        Ok(output.status.success())
    }

    /// Times of the command with its two most used outputs, loading included: 1280 x 720 pixels, the middle one.
    pub(super) fn commands(&self, name: &str, scene: &Path, page: bool) -> anyhow::Result<Vec<Value>> {
        let path = self.folder.join("view.html");
        let mut figures = Vec::new();
        for to_page in [false, true].into_iter().take(1 + usize::from(page)) {
            let output = if to_page { "-o tree.html" } else { "--json" };
            eprintln!("==> durer trace, {name}, {output}");
            let mut times = Vec::new();
            for _ in 0..self.runs {
                let mut command = self.command(scene);
                command.args(["--width", "1280", "--height", "720", "--spp", "16", "--pixel", "640,360"]);
                if to_page {
                    command.arg("-o").arg(&path);
                } else {
                    command.arg("--json");
                }
                times.push(measure(&mut command)?.wall);
            }
            figures.push(
                json!({ "scene": name, "output": output, "runs": times, "median": median(times.clone()) }),
            );
        }
        Ok(figures)
    }

    /// Writes all pages.
    pub(super) fn pages(&self) -> anyhow::Result<Vec<Page>> {
        let write = |&(name, words): &(&'static str, &str)| {
            eprintln!("==> page {name}");
            let path = self.folder.join(format!("{name}.html"));
            let mut command = self.command(Path::new("whitted"));
            command.args(words.split(' ')).arg("-o").arg(&path);
            measure(&mut command)?;
            let bytes = fs::metadata(&path).with_context(|| path.display().to_string())?.len();
            Ok(Page { name, path, bytes })
        };
        PAGES.iter().map(write).collect()
    }
}
