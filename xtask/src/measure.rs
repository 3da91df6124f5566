//! Time of whole processes.
use std::{
    fs,
    process::{Command, Output},
    time::Instant,
};

use anyhow::{Context, bail};

/// A process that ended well.
pub(crate) struct Measured {
    /// Wall time from start to end.
    pub(crate) wall: f64,
    /// Processor time in user mode, all threads; `None` where the system does not tell.
    pub(crate) user: Option<f64>,
    /// What it printed.
    pub(crate) output: Output,
}

/// Runs a command to its end. Must not run beside other children of this process: their time would be counted too.
pub(crate) fn measure(command: &mut Command) -> anyhow::Result<Measured> {
    let before = user_ticks_of_children();
    let start = Instant::now();
    let output = command.output().with_context(|| format!("{command:?} cannot be started"))?;
    let wall = start.elapsed().as_secs_f64();
    let ticks = user_ticks_of_children().zip(before).map(|(after, before)| after.saturating_sub(before));
    let user = ticks.map(|ticks| ticks as f64 / TICKS_PER_SECOND);
    if !output.status.success() {
        bail!("{command:?} failed:\n{}", String::from_utf8_lossy(&output.stderr));
    }
    Ok(Measured { wall, user, output })
}

/// Linux counts the time of processes in these, on x86 and ARM at least.
const TICKS_PER_SECOND: f64 = 100.0;

/// Time that children which have ended spent in user mode: `cutime` of Linux.
fn user_ticks_of_children() -> Option<u64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The second field is the program's name in brackets and may hold blanks; `cutime` is the 16th field.
    let (_, after_name) = stat.rsplit_once(')')?;
    after_name.split_ascii_whitespace().nth(13)?.parse().ok()
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
    }

    #[test]
    fn a_failure_is_told() {
        let failed = measure(Command::new("sh").args(["-c", "echo why >&2; exit 3"]));
        assert!(failed.is_err_and(|e| e.to_string().contains("why")));
    }
}
