//! What the steps need on the machine. What is missing is installed where that is simple, else said with its cure.
use std::process::{Command, Stdio};

use anyhow::bail;

use crate::cargo;

/// A tool that a step runs.
struct Need {
    /// What it is called.
    name: &'static str,
    /// A command that succeeds if it is there.
    probe: &'static [&'static str],
    /// The command that installs it.
    cure: &'static [&'static str],
    /// Only root can run the cure.
    root: bool,
    /// Only the full run needs it.
    full: bool,
    /// Tests that need it say that they are skipped where it is not there.
    optional: bool,
}

const NEEDS: &[Need] = &[
    // Rust links through the C compiler's driver. A program that runs this was linked by one, so it can be missing
    // only if it went since; `.ci/run` looks before cargo does.
    Need {
        name: "a C compiler, `cc`, for linking",
        probe: &["cc", "--version"],
        cure: &["apt-get", "install", "-y", "--no-install-recommends", "gcc", "libc6-dev"],
        root: true,
        full: false,
        optional: false,
    },
    Need {
        name: "rustfmt",
        probe: &["cargo", "fmt", "--version"],
        cure: &["rustup", "component", "add", "rustfmt"],
        root: false,
        full: false,
        optional: false,
    },
    Need {
        name: "clippy",
        probe: &["cargo", "clippy", "--version"],
        cure: &["rustup", "component", "add", "clippy"],
        root: false,
        full: true,
        optional: false,
    },
    Need {
        name: "Node 18.19 or newer with npm, for the HTML page",
        probe: &["npm", "--version"],
        cure: &["apt-get", "install", "-y", "--no-install-recommends", "nodejs", "npm"],
        root: true,
        full: false,
        optional: true,
    },
    Need {
        name: "Chromium, for the HTML page's tests",
        probe: &["chromium", "--version"],
        cure: &["apt-get", "install", "-y", "--no-install-recommends", "chromium", "fonts-dejavu-core"],
        root: true,
        full: true,
        optional: true,
    },
    Need {
        name: "valgrind, for counting instructions",
        probe: &["valgrind", "--version"],
        cure: &["apt-get", "install", "-y", "--no-install-recommends", "valgrind"],
        root: true,
        full: false,
        optional: true,
    },
];

/// Sees to it that all is there that a run needs.
pub(crate) fn check(full: bool) -> anyhow::Result<()> {
    let needs: Vec<&Need> = NEEDS.iter().filter(|need| full || !need.full).collect();
    let (optional, missing): (Vec<&Need>, Vec<&Need>) =
        needs.into_iter().filter(|need| !need.obtain()).partition(|need| need.optional);
    for need in optional {
        println!("warning: missing, so that tests will be skipped:\n{}", need.complaint());
    }
    if missing.is_empty() {
        return Ok(());
    }
    let lines: Vec<String> = missing.iter().map(|need| need.complaint()).collect();
    bail!("tools are missing:\n{}", lines.join("\n"));
}

impl Need {
    /// Installs it if it is missing. True if it is there then.
    fn obtain(&self) -> bool {
        if succeeds(self.probe) {
            return true;
        }
        if self.root && !is_root() {
            return false;
        }
        println!("==> installing {}: {}", self.name, self.cure.join(" "));
        if self.cure.first() == Some(&"apt-get") {
            // A bare system has no package lists; if they cannot be had, installing says so.
            succeeds(&["apt-get", "update"]);
        }
        succeeds(self.cure) && succeeds(self.probe)
    }

    fn complaint(&self) -> String {
        let sudo = if self.root && !is_root() { "sudo " } else { "" };
        format!("  {}: install it with `{sudo}{}`", self.name, self.cure.join(" "))
    }
}

fn succeeds(words: &[&str]) -> bool {
    let [program, arguments @ ..] = words else {
        return false;
    };
    let program = if *program == "cargo" { cargo() } else { (*program).to_owned() };
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null());
    if words.last() == Some(&"--version") {
        command.stderr(Stdio::null());
    }
    command.status().is_ok_and(|status| status.success())
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
