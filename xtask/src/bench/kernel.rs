//! `cargo xtask bench kernel`: makes what `durer-benches` needs, builds it for speed, starts it.
use std::{
    env, fs,
    path::PathBuf,
    process::{Command, Stdio},
};

use anyhow::{Context, bail};
use serde_json::{Value, json};

use super::embree;
use crate::{cargo, root, target_folder};

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
    let mut command = Command::new(program()?);
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

/// The folder of test files; scenes that it lacks are left out.
fn assets() -> anyhow::Result<PathBuf> {
    match env::var_os("DURER_SHARED") {
        Some(folder) => Ok(PathBuf::from(folder).join("assets")),
        None => Ok(root()?.join("../shared/assets")),
    }
}

/// Builds the benchmark, and says where it is.
fn program() -> anyhow::Result<PathBuf> {
    eprintln!("==> cargo build --release --package durer-benches --bench kernel");
    let mut command = Command::new(cargo());
    command.args(["build", "--release", "--package", "durer-benches", "--bench", "kernel"]);
    command
        .args(["--message-format", "json-render-diagnostics"])
        .current_dir(root()?)
        .stderr(Stdio::inherit());
    let output = command.output()?;
    if !output.status.success() {
        bail!("the benchmark cannot be built");
    }
    executable(&String::from_utf8_lossy(&output.stdout)).context("cargo names no executable")
}

/// The executable of the target `kernel` in cargo's messages.
fn executable(messages: &str) -> Option<PathBuf> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mut ours = messages.filter(|message| message["target"]["name"] == "kernel");
    ours.find_map(|message| Some(PathBuf::from(message["executable"].as_str()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_executable_is_found_among_messages() {
        let messages = r#"{"reason":"compiler-artifact","target":{"name":"other"},"executable":"x"}
            {"reason":"compiler-artifact","target":{"name":"kernel"},"executable":"target/kernel-1"}
            {"reason":"build-finished","success":true}"#;
        assert_eq!(executable(messages), Some(PathBuf::from("target/kernel-1")));
        assert_eq!(executable("{}"), None);
    }
}
