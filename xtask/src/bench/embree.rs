//! Embree 4 without a C++ build: the shared library of the Python package embreex, and a small C program that drives it.
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use crate::root;

/// Which package: any with Embree 4.4 or later.
const PACKAGE: &str = "embreex>=4.4,<5";

/// What the benchmark starts.
pub(super) struct Peer {
    /// The C program.
    pub(super) program: PathBuf,
    /// Embree's shared library.
    pub(super) library: PathBuf,
}

/// Puts library and program into `folder`; a library that is there is kept. If it cannot be done, why.
pub(super) fn set_up(folder: &Path) -> Result<Peer, String> {
    let installed = folder.join("embree");
    let library = match library_in(&installed) {
        Some(library) => library,
        None => {
            install(&installed)?;
            library_in(&installed).ok_or("the Python package embreex holds no library of Embree 4")?
        }
    };
    let peer = Peer { program: compile(folder)?, library };
    peer.try_out()?;
    Ok(peer)
}

impl Peer {
    /// The program greets once it has opened the library, and ends with its input.
    fn try_out(&self) -> Result<(), String> {
        let mut command = Command::new(&self.program);
        let output = command.arg(&self.library).stdin(Stdio::null()).output();
        let output = output.map_err(|error| format!("{}: {error}", self.program.display()))?;
        if output.stdout.starts_with(b"ok") {
            return Ok(());
        }
        Err(format!("Embree cannot be opened: {}", String::from_utf8_lossy(&output.stdout).trim()))
    }
}

/// The library among the files of an installed package.
fn library_in(folder: &Path) -> Option<PathBuf> {
    let folders = ["embreex.libs", "embreex/.dylibs"].map(|name| folder.join(name));
    let files = folders.into_iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
    let is_embree = |path: &PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libembree4"))
    };
    files.flatten().map(|file| file.path()).find(is_embree)
}

fn install(folder: &Path) -> Result<(), String> {
    eprintln!("==> pip install {PACKAGE}");
    let mut command = Command::new("python3");
    command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]);
    command.args(["--only-binary", ":all:", "--upgrade", "--target"]).arg(folder).arg(PACKAGE);
    succeed(command, "python3 -m pip")
}

fn compile(folder: &Path) -> Result<PathBuf, String> {
    let compiler = env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let source = root().map_err(|error| error.to_string())?.join("benches/embree_peer.c");
    let program = folder.join("embree_peer");
    let mut command = Command::new(&compiler);
    command.args(["-O3", "-std=gnu11", "-o"]).arg(&program).arg(source).args(["-ldl", "-lpthread"]);
    succeed(command, &compiler)?;
    Ok(program)
}

/// Runs a command; if it fails, what it complained of last.
pub(super) fn succeed(mut command: Command, name: &str) -> Result<(), String> {
    let output = command.stdin(Stdio::null()).output().map_err(|error| format!("{name}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
    Err(format!("{name} failed: {}", last.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_told_by_its_last_words() {
        let mut command = Command::new("sh");
        command.args(["-c", "echo first >&2; echo last >&2; echo >&2; exit 1"]);
        assert_eq!(succeed(command, "sh"), Err("sh failed: last".to_owned()));
        assert!(succeed(Command::new("no-such-program"), "it").is_err_and(|said| said.starts_with("it: ")));
    }

    #[test]
    fn no_library_is_found_where_none_is() {
        assert_eq!(library_in(Path::new(env!("CARGO_MANIFEST_DIR"))), None);
    }
}
