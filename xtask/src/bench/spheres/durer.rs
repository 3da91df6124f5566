//! One run of durer.
use std::{path::Path, process::Command};

use anyhow::Context;
use serde_json::Value;

use super::{HEIGHT, Mode, Run, THREADS, WIDTH};
use crate::measure::measure;

/// The file's name.
pub(super) const PICTURE: &str = "durer.png";

/// Leaves [`PICTURE`] in the folder.
pub(super) fn render(program: &Path, scene: &Path, folder: &Path, mode: Mode) -> anyhow::Result<Run> {
    let mut command = Command::new(program);
    command.arg("render").arg(scene).current_dir(folder);
    command.args(["-o", PICTURE, "--stats=json", "--quiet"]);
    command.args(match mode {
        Mode::Plain => ["--spp", "1"],
        Mode::Antialiased => ["--antialias", "adaptive"],
        Mode::Converged => ["--spp", "256"],
    });
    command.args(["--width", &WIDTH.to_string(), "--height", &HEIGHT.to_string()]);
    command.args(["--threads", &THREADS.to_string()]);
    let measured = measure(&mut command)?;
    let stats: Value = serde_json::from_slice(&measured.output.stdout).context("durer's statistics")?;
    let rays = |kind: &str| {
        let number = stats.pointer(&format!("/rays/by_kind/{kind}")).and_then(Value::as_u64);
        number.with_context(|| format!("durer's statistics count no {kind} rays"))
    };
    Ok(Run {
        wall: measured.wall,
        user: measured.user,
        trace: stats
            .pointer("/seconds/render")
            .and_then(Value::as_f64)
            .context("durer tells no trace time")?,
        rays: rays("eye")? + rays("reflection")? + rays("refraction")?,
        shadow_tests: rays("shadow")?,
    })
}
