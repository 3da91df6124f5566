//! Processes kept on cores, so that competitors share caches and clocks: by `taskset`, where it is installed.
use std::{
    fs,
    process::{Command, Stdio},
};

/// Cores that this process may use; none where the system does not tell.
pub fn cores() -> Vec<usize> {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    list.map(parse).unwrap_or_default()
}

/// "0-2,5" is 0, 1, 2, 5.
fn parse(list: &str) -> Vec<usize> {
    let range = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let ends = (first.trim().parse().ok()?, last.trim().parse().ok()?);
        Some(ends.0..=ends.1)
    };
    list.split(',').filter_map(range).flatten().collect()
}

/// Keeps all threads of a process on `cores`. False if that cannot be done: then it runs where it wants.
pub fn pin(process: u32, cores: &[usize]) -> bool {
    let list: Vec<String> = cores.iter().map(usize::to_string).collect();
    let mut command = Command::new("taskset");
    command.args(["--all-tasks", "--pid", "--cpu-list", &list.join(","), &process.to_string()]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    !cores.is_empty() && command.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_cores_are_read() {
        assert_eq!(parse("\t0-2,5"), [0, 1, 2, 5]);
        assert_eq!(parse("7"), [7]);
        assert!(parse("").is_empty());
        assert!(!pin(std::process::id(), &[]));
    }

    #[test]
    fn a_process_is_kept_on_a_core() {
        let Some(&core) = cores().last() else { return };
        let mut child = Command::new("sleep").arg("60").spawn().expect("sleep");
        let pinned = pin(child.id(), &[core]);
        let path = format!("/proc/{}/status", child.id());
        let status = fs::read_to_string(path).expect("a process that runs");
        child.kill().and_then(|()| child.wait()).expect("our own child");
        assert!(!pinned || status.contains(&format!("Cpus_allowed_list:\t{core}\n")), "{status}");
    }
}
