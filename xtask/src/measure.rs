//! Time and memory of whole processes.
use std::{
    fs,
    process::{Command, Output, Stdio},
    sync::mpsc::{self, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, bail};

/// A process that ended well.
pub(crate) struct Measured {
    /// Wall time from start to end.
    pub(crate) wall: f64,
    /// Processor time in user mode, all threads; `None` where the system does not tell.
    pub(crate) user: Option<f64>,
    /// Processor time within the system.
    pub(crate) system: Option<f64>,
    /// The most memory it held, in bytes; `None` where the system does not tell.
    pub(crate) peak_bytes: Option<u64>,
    /// What it printed.
    pub(crate) output: Output,
}

/// Runs a command to its end. Must not run beside other children of this process: their time would be counted too.
pub(crate) fn measure(command: &mut Command) -> anyhow::Result<Measured> {
    let before = ticks_of_children();
    let start = Instant::now();
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().with_context(|| format!("{command:?} cannot be started"))?;
    let status = format!("/proc/{}/status", child.id());
    let (ended, end) = mpsc::channel::<()>();
    let watcher = thread::spawn(move || {
        let mut peak = None;
        // The system keeps the maximum, but only as long as the process lives.
        while end.recv_timeout(Duration::from_millis(10)) == Err(RecvTimeoutError::Timeout) {
            peak = peak_bytes(&status).or(peak);
        }
        peak
    });
    let output = child.wait_with_output();
    let wall = start.elapsed().as_secs_f64();
    drop(ended);
    let peak_bytes = watcher.join().ok().flatten();
    let output = output.with_context(|| format!("{command:?} cannot be waited for"))?;
    let seconds = |kind: usize| {
        let ticks = ticks_of_children().zip(before).map(|(a, b)| a[kind].saturating_sub(b[kind]));
        ticks.map(|ticks| ticks as f64 / TICKS_PER_SECOND)
    };
    if !output.status.success() {
        bail!("{command:?} failed:\n{}", String::from_utf8_lossy(&output.stderr));
    }
    Ok(Measured { wall, user: seconds(0), system: seconds(1), peak_bytes, output })
}

/// `VmHWM` of Linux, in bytes.
fn peak_bytes(status: &str) -> Option<u64> {
    let status = fs::read_to_string(status).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_ascii_whitespace().next()?.parse::<u64>().ok()? * 1024)
}

/// Linux counts the time of processes in these, on x86 and ARM at least.
const TICKS_PER_SECOND: f64 = 100.0;

/// Time that children which have ended spent in user mode and in the system: `cutime` and `cstime` of Linux.
fn ticks_of_children() -> Option<[u64; 2]> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The second field is the program's name in brackets and may hold blanks; `cutime` is the 16th field.
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_ascii_whitespace().skip(13);
    Some([fields.next()?.parse().ok()?, fields.next()?.parse().ok()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_child_costs_wall_and_user_time() {
        let words = ["-c", "i=0; while [ $i -lt 200000 ]; do i=$((i + 1)); done; echo done"];
        let measured = measure(Command::new("sh").args(words)).expect("a shell");
        assert_eq!(measured.output.stdout, b"done\n");
        assert!(measured.user.is_none_or(|user| user > 0.0 && user < measured.wall + 0.02));
        assert!(measured.system.is_some() == measured.user.is_some());
        // A shell holds some hundred kilobytes at least.
        assert!(measured.peak_bytes.is_none_or(|bytes| (100_000..1_000_000_000).contains(&bytes)));
    }

    #[test]
    fn a_failure_is_told() {
        let failed = measure(Command::new("sh").args(["-c", "echo why >&2; exit 3"]));
        assert!(failed.is_err_and(|e| e.to_string().contains("why")));
    }
}
