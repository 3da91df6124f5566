//! What benchmarks of `durer-benches` need: their programs, built for speed, and the folder of test files.
use std::{
    env,
    path::PathBuf,
    process::{Command, Stdio},
};

use anyhow::{Context, bail};
use serde_json::Value;

use crate::{cargo, root};

/// The folder of test files; it need not be there.
pub(crate) fn assets() -> anyhow::Result<PathBuf> {
    match env::var_os("DURER_SHARED") {
        Some(folder) => Ok(PathBuf::from(folder).join("assets")),
        None => Ok(root()?.join("../shared/assets")),
    }
}

/// Builds the benchmark of that name, and says where it is.
pub(super) fn program(name: &str) -> anyhow::Result<PathBuf> {
    eprintln!("==> cargo build --release --package durer-benches --bench {name}");
    let mut command = Command::new(cargo());
    command.args(["build", "--release", "--package", "durer-benches", "--bench", name]);
    command
        .args(["--message-format", "json-render-diagnostics"])
        .current_dir(root()?)
        .stderr(Stdio::inherit());
    let output = command.output()?;
    if !output.status.success() {
        bail!("the benchmark cannot be built");
    }
    executable(&String::from_utf8_lossy(&output.stdout), name).context("cargo names no executable")
}

/// The executable of a target in cargo's messages.
fn executable(messages: &str, name: &str) -> Option<PathBuf> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mut ours = messages.filter(|message| message["target"]["name"] == name);
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
        assert_eq!(executable(messages, "kernel"), Some(PathBuf::from("target/kernel-1")));
        assert_eq!(executable(messages, "view"), None);
        assert_eq!(executable("{}", "kernel"), None);
    }
}
