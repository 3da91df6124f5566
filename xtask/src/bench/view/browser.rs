//! Pages in Chromium, steered by the page's own test tools.
use std::{
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use anyhow::{Context, bail};
use serde_json::Value;

use crate::{page, root};

/// What is missing for it, or that it is not wanted.
pub(super) fn missing(wanted: bool) -> Option<String> {
    if !wanted {
        return Some("--without-browser".to_owned());
    }
    if let Some(complaint) = page::missing() {
        return Some(complaint);
    }
    if !page::has_chromium() {
        return Some("no Chromium (apt-get install chromium)".to_owned());
    }
    let installed = root().is_ok_and(|root| script_runner(&root).is_file());
    (!installed).then(|| "the page's tools are not installed (cargo xtask page does it)".to_owned())
}

/// Runs TypeScript; comes with the page's test tools.
fn script_runner(root: &Path) -> PathBuf {
    root.join("page/node_modules/vite-node/vite-node.mjs")
}

/// Figures of each page, and of one with 10 000 rays that is made for it.
pub(super) fn measure<'a>(pages: impl Iterator<Item = &'a Path>) -> anyhow::Result<Vec<Value>> {
    eprintln!("==> pages in Chromium");
    let root = root()?;
    let mut command = Command::new("node");
    command.arg(script_runner(&root)).args(["tests/support/measure.ts"]).args(pages).arg("synthetic.html");
    let output = command.current_dir(root.join("page")).stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        bail!("measuring pages in a browser failed");
    }
    serde_json::from_slice(&output.stdout).context("figures of pages")
}
