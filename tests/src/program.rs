//! The program itself, run as a process: with a limit on its time and its memory.
use std::{
    ffi::OsString,
    fs::{self, File},
    io,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::atomic::{AtomicUsize, Ordering},
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the project")
}

/// Builds `durer` like this test was built, and says where it is.
///
/// # Panics
/// If it cannot be built.
pub fn program() -> PathBuf {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "--package", "durer-cli", "--message-format", "json"]).current_dir(root());
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    let output = command.output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let messages = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    messages.find_map(|message| message["executable"].as_str().map(PathBuf::from)).expect("a program")
}

/// What a process may take.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// Wall time; then it is killed.
    pub time: Duration,
    /// Address space in bytes, on Linux only.
    pub memory: Option<u64>,
}

/// What became of a process.
#[derive(Clone, Debug)]
pub struct Ran {
    /// Exit status; `None` if it was killed, by us for its time or by a signal.
    pub code: Option<i32>,
    /// What it printed.
    pub stdout: String,
    /// What it said.
    pub stderr: String,
    /// How long it ran.
    pub wall: Duration,
}

/// Runs a program in `folder`, which must be its own: what it prints is kept in files there.
///
/// # Errors
/// If it cannot be started or watched.
pub fn run(program: &Path, words: &[OsString], folder: &Path, allowance: Allowance) -> io::Result<Ran> {
    let mut command = match allowance.memory {
        Some(bytes) if cfg!(target_os = "linux") => {
            let mut shell = Command::new("sh");
            shell.arg("-c").arg(format!("ulimit -v {}; exec \"$0\" \"$@\"", bytes / 1024)).arg(program);
            shell
        }
        _ => Command::new(program),
    };
    let [stdout, stderr] = ["stdout", "stderr"].map(|name| folder.join(name));
    command.args(words).current_dir(folder).env_remove("RUST_BACKTRACE").stdin(Stdio::null());
    command.stdout(File::create(&stdout)?).stderr(File::create(&stderr)?);
    let start = Instant::now();
    let mut child = command.spawn()?;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if start.elapsed() > allowance.time {
            child.kill()?;
            child.wait()?;
            break None;
        }
        thread::sleep(Duration::from_millis(2));
    };
    let wall = start.elapsed();
    let text = |path: &Path| fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    Ok(Ran { code: status.and_then(|s| s.code()), stdout: text(&stdout)?, stderr: text(&stderr)?, wall })
}

/// Does `work` with each of `items`, several at a time; complaints in the order of the items.
///
/// # Panics
/// If `work` does.
pub fn each<T: Sync>(items: &[T], work: impl Fn(&T) -> Vec<String> + Sync) -> Vec<String> {
    let next = AtomicUsize::new(0);
    let threads = thread::available_parallelism().map_or(2, |n| n.get().clamp(2, 8));
    let share = || {
        let mut said = Vec::new();
        while let Some((index, item)) = Some(next.fetch_add(1, Ordering::Relaxed))
            .and_then(|index| items.get(index).map(|item| (index, item)))
        {
            said.extend(work(item).into_iter().map(|complaint| (index, complaint)));
        }
        said
    };
    let mut said: Vec<(usize, String)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(share)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("work does not panic")).collect()
    });
    said.sort();
    said.into_iter().map(|(_, complaint)| complaint).collect()
}

/// All files below a folder, in order.
///
/// # Panics
/// If a folder cannot be read.
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a readable folder").flatten() {
            let path = entry.path();
            if path.is_dir() { folders.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    found
}
