//! `cargo xtask bench kernel`: makes what `durer-benches` needs, builds it for speed, starts it.
use std::{fs, process::Command};

use anyhow::{Context, bail};
use serde_json::json;

use super::{
    built::{assets, program},
    embree,
};
use crate::target_folder;

/// Hands `words` on to the benchmark. Without Embree there is nothing to compare with: that is said, and is no failure.
pub(crate) fn run(words: &[&str]) -> anyhow::Result<()> {
    let folder = target_folder()?.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let peer = match embree::set_up(&folder) {
        Ok(peer) => peer,
        Err(reason) => {
            skip(&reason, words.contains(&"--json"));
            return Ok(());
        }
    };
    let mut command = Command::new(program("kernel")?);
    command.arg("--peer").arg(&peer.program).arg("--embree").arg(&peer.library);
    command.arg("--assets").arg(assets()?).arg("--folder").arg(&folder).args(words);
    // Builds are compared with two threads.
    let status = command.env("RAYON_NUM_THREADS", "2").status().context("the benchmark cannot be started")?;
    if !status.success() {
        bail!("the benchmark failed");
    }
    Ok(())
}

fn skip(reason: &str, as_json: bool) {
    if as_json {
        println!("{}", json!({ "skipped": reason }));
    } else {
        println!("skipped: {reason}");
    }
}
