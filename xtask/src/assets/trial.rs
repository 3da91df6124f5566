//! One model through `durer info` and `durer render`.
use std::{
    ffi::OsStr,
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, bail};
use serde_json::Value;

/// A model that takes longer is given up.
const LONGEST: Duration = Duration::from_secs(300);

/// Samples per pixel.
pub(super) const SAMPLES: u32 = 16;

/// How models are tried.
pub(super) struct Trial {
    pub(super) program: PathBuf,
    /// Where the program runs, so that it calls files by their paths in here.
    pub(super) assets: PathBuf,
    /// Where pictures go.
    pub(super) work: PathBuf,
    pub(super) width: u32,
}

/// What became of a model.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    /// A picture.
    Drawn {
        /// Shared ones as often as they are placed.
        triangles: u64,
        /// Seconds of reading and parsing.
        load: f64,
        /// Seconds of compiling and building trees.
        build: f64,
        /// Seconds of rendering.
        render: f64,
        /// What the program warned of.
        warnings: Vec<String>,
    },
    /// Why there is none.
    Refused(String),
}

impl Outcome {
    /// For the terminal.
    pub(super) fn line(&self) -> String {
        match self {
            Self::Drawn { triangles, load, build, render, warnings } => {
                let (load, build) = (1e3 * load, 1e3 * build);
                let warned = if warnings.is_empty() { "" } else { ", with warnings" };
                format!(
                    "{triangles} triangles, load {load:.0} ms, build {build:.0} ms, render {render:.2} s{warned}"
                )
            }
            Self::Refused(reason) => format!("refused: {reason}"),
        }
    }
}

/// What a process left.
struct Left {
    /// Exit status; `None` if it was killed.
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Trial {
    /// What became of a model, and its picture if it was drawn.
    ///
    /// # Errors
    /// If the program behaves as no program of ours may: it crashes, or prints something else than it should.
    pub(super) fn run(&self, file: &str) -> anyhow::Result<(Outcome, Option<PathBuf>)> {
        // Messages about a whole file begin with its name, which the table has already.
        let refused = |reason: String| {
            let reason = reason.strip_prefix(&format!("{file}: ")).unwrap_or(&reason);
            Ok((Outcome::Refused(reason.to_owned()), None))
        };
        let info = self.durer(["info", file, "--json"])?;
        if let Some(reason) = refusal(&info).with_context(|| format!("durer info \"{file}\""))? {
            return refused(reason);
        }
        let facts: Value = serde_json::from_str(&info.stdout).context("what info prints is no JSON")?;
        let picture = self.work.join(format!("{}.png", file.replace(['/', ' '], "-")));
        let (width, samples) = (self.width.to_string(), SAMPLES.to_string());
        let words: [&OsStr; 10] = [
            "render".as_ref(),
            file.as_ref(),
            "--width".as_ref(),
            width.as_ref(),
            "--spp".as_ref(),
            samples.as_ref(),
            "--stats=json".as_ref(),
            "--quiet".as_ref(),
            "-o".as_ref(),
            picture.as_os_str(),
        ];
        let rendered = self.durer(words)?;
        if let Some(reason) = refusal(&rendered).with_context(|| format!("durer render \"{file}\""))? {
            return refused(reason);
        }
        let stats: Value = serde_json::from_str(&rendered.stdout).context("what render prints is no JSON")?;
        let number = |value: &Value, pointer: &str| {
            value.pointer(pointer).and_then(Value::as_f64).with_context(|| format!("{file}: no {pointer}"))
        };
        let drawn = Outcome::Drawn {
            triangles: number(&facts, "/counts/triangles_placed")? as u64,
            load: number(&facts, "/seconds/load")?,
            build: number(&facts, "/seconds/build")?,
            render: number(&stats, "/seconds/render")?,
            warnings: messages(&facts, "warning"),
        };
        Ok((drawn, Some(picture)))
    }

    fn durer<W: AsRef<OsStr>>(&self, words: impl IntoIterator<Item = W>) -> anyhow::Result<Left> {
        let [stdout, stderr] = ["stdout", "stderr"].map(|name| self.work.join(name));
        let mut command = Command::new(&self.program);
        command.args(words).current_dir(&self.assets).stdin(Stdio::null());
        command.stdout(File::create(&stdout)?).stderr(File::create(&stderr)?);
        let start = Instant::now();
        let mut child = command.spawn().with_context(|| format!("{command:?} cannot be started"))?;
        let code = loop {
            if let Some(status) = child.try_wait()? {
                break status.code();
            }
            if start.elapsed() > LONGEST {
                child.kill()?;
                child.wait()?;
                break None;
            }
            thread::sleep(Duration::from_millis(2));
        };
        let read = |path: &Path| fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let left = Left { code, stdout: read(&stdout)?, stderr: read(&stderr)? };
        fs::remove_file(&stdout)?;
        fs::remove_file(&stderr)?;
        Ok(left)
    }
}

/// Why a run failed, in the program's words; `None` if it did not.
fn refusal(left: &Left) -> anyhow::Result<Option<String>> {
    match left.code {
        Some(0) => Ok(None),
        Some(1) if !left.stderr.contains("panicked") => {
            let facts = serde_json::from_str(&left.stdout).unwrap_or_default();
            let told = messages(&facts, "error").into_iter().next();
            let said =
                || left.stderr.lines().find_map(|line| line.strip_prefix("error: ")).map(str::to_owned);
            let reason = told.or_else(said).context("it fails without saying why")?;
            Ok(Some(reason))
        }
        Some(code) => bail!("it ends with exit status {code}:\n{}", left.stderr),
        None => {
            bail!("it was killed after {} s at most, or by a signal:\n{}", LONGEST.as_secs(), left.stderr)
        }
    }
}

/// The messages of this severity that `durer info --json` lists, each with its place and its hint.
fn messages(facts: &Value, severity: &str) -> Vec<String> {
    let list = facts["diagnostics"].as_array().map_or(&[][..], Vec::as_slice);
    let one = |d: &Value| {
        let text = |key: &str| d[key].as_str().filter(|text| !text.is_empty());
        let place = match (text("pointer"), d["line"].as_u64()) {
            (Some(pointer), _) => format!("{pointer}: "),
            (None, Some(line)) => format!("line {line}: "),
            (None, None) => String::new(),
        };
        let hint = text("hint").map(|hint| format!(" ({hint})")).unwrap_or_default();
        format!("{place}{}{hint}", text("message").unwrap_or_default())
    };
    list.iter().filter(|d| d["severity"] == severity).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left(code: Option<i32>, stdout: &str, stderr: &str) -> Left {
        Left { code, stdout: stdout.to_owned(), stderr: stderr.to_owned() }
    }

    #[test]
    fn refusals_carry_the_programs_words() {
        let json = r#"{"diagnostics": [
            {"severity": "warning", "message": "odd"},
            {"severity": "error", "message": "too short", "hint": "look", "line": 3, "pointer": null},
            {"severity": "error", "message": "more"}]}"#;
        assert_eq!(refusal(&left(Some(0), json, "")).expect("fine"), None);
        let told = refusal(&left(Some(1), json, "")).expect("refused");
        assert_eq!(told.as_deref(), Some("line 3: too short (look)"));
        let said = refusal(&left(Some(1), "", "warning: x\nerror: nothing to draw\n")).expect("refused");
        assert_eq!(said.as_deref(), Some("nothing to draw"));
    }

    #[test]
    fn crashes_are_no_refusals() {
        for crash in [
            left(None, "", ""),
            left(Some(101), "", "thread 'main' panicked"),
            left(Some(1), "", "error: thread 'x' panicked"),
            left(Some(1), "", ""),
        ] {
            assert!(refusal(&crash).is_err());
        }
    }
}
