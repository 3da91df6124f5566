//! Other renderers that load the same scenes, with two threads.
use std::{
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::{Value, json};

use crate::{
    bench::{embree::succeed, render::mitsuba_python},
    measure::measure,
    root,
};

/// Those that can be had.
pub(super) struct Peers {
    mitsuba: Option<PathBuf>,
    has_pbrt: bool,
    folder: PathBuf,
    /// Those that cannot, and why.
    pub(super) skipped: Vec<String>,
}

impl Peers {
    /// Installs Mitsuba into `folder`, looks for pbrt-v4 among the commands.
    pub(super) fn find(folder: &Path) -> Self {
        let mut skipped = Vec::new();
        let mitsuba = mitsuba_python(folder).map_err(|why| skipped.push(format!("mitsuba: {why}"))).ok();
        let mut command = Command::new("pbrt");
        command.arg("--help");
        let has_pbrt =
            succeed(command, "pbrt").map_err(|why| skipped.push(format!("pbrt-v4: {why}"))).is_ok();
        Self { mitsuba, has_pbrt, folder: folder.to_owned(), skipped }
    }

    /// Processor and wall seconds that `peer` takes for `file`; `None` if it is not there.
    pub(super) fn load(&self, peer: &str, file: &Path) -> Option<Result<Value, String>> {
        match peer {
            "mitsuba" => self.mitsuba.as_ref().map(|python| mitsuba(python, file)),
            _ => self.has_pbrt.then(|| self.pbrt(file)),
        }
    }

    /// pbrt tells no time of loading: that of a picture of one pixel with one sample stands for it.
    fn pbrt(&self, file: &Path) -> Result<Value, String> {
        let mut command = Command::new("pbrt");
        command.args(["--quiet", "--nthreads", "2", "--spp", "1", "--pixelbounds", "0,1,0,1", "--outfile"]);
        command.arg(self.folder.join("load-pbrt.exr")).arg(file);
        let run = measure(&mut command).map_err(last_words)?;
        let cpu = run.user.zip(run.system).map(|(user, system)| user + system);
        Ok(json!({ "cpu": cpu, "wall": run.wall }))
    }
}

fn mitsuba(python: &Path, file: &Path) -> Result<Value, String> {
    let script = root().map_err(last_words)?.join("benches/load/mitsuba_peer.py");
    let mut command = Command::new(python);
    command.arg(script).arg(file).arg("2").env("PYTHONDONTWRITEBYTECODE", "1");
    let run = measure(&mut command).map_err(last_words)?;
    let text = String::from_utf8_lossy(&run.output.stdout);
    let mut objects = text.lines().rev().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    objects.find(Value::is_object).ok_or_else(|| "the script says nothing".to_owned())
}

fn last_words(error: anyhow::Error) -> String {
    let said = error.to_string();
    said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given").trim().to_owned()
}
