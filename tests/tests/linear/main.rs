//! Twice the file takes twice the work: `durer info` executes less than [`MOST`] times as many instructions for a scene
//! of double size, for every format and for everything that a scene may hold many of.
//!
//! Instructions are counted by valgrind's `cachegrind`, so that the result does not depend on the machine or on what
//! else it does; those of an almost empty scene of the same format are taken off both counts. A step that compares all with
//! all makes the ratio go towards 4.
mod document;
mod model;
mod text;

use std::{
    collections::HashMap,
    ffi::OsString,
    fs,
    path::Path,
    process::{Command, Stdio},
    sync::{Mutex, MutexGuard},
    time::Duration,
};

use durer::FORMATS;
use durer_tests::program::{Allowance, each, program, run};

/// Most that the work may grow by when the size doubles. Sorting and trees cost `n log n`, which is below 2.2 at these sizes.
const MOST: f64 = 2.3;

/// Of each run, which valgrind makes about fifty times slower.
const ALLOWANCE: Allowance = Allowance { time: Duration::from_secs(300), memory: None };

/// A scene file, and others that it refers to by these names.
pub(crate) type Files = (Vec<u8>, Vec<(String, Vec<u8>)>);

/// A kind of scene of any size.
pub(crate) struct Case {
    /// What it holds many of.
    name: &'static str,
    /// Suffix of its file.
    suffix: &'static str,
    /// How many of these the smaller scene holds.
    size: usize,
    /// Makes the scene.
    write: fn(usize) -> Files,
}

/// A file that refers to no other.
pub(crate) fn alone(text: impl Into<Vec<u8>>) -> Files {
    (text.into(), Vec::new())
}

/// Instructions that `durer info` executes for a scene of this size; what it says if it fails.
fn instructions(durer: &Path, case: &Case, size: usize) -> Result<f64, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join(format!("scene.{}", case.suffix));
    let (bytes, others) = (case.write)(size);
    fs::write(&scene, bytes).expect("a file");
    others.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).expect("a file"));
    // One worker: idle ones look for work, which are instructions too.
    let mut words: Vec<OsString> =
        ["RAYON_NUM_THREADS=1", "valgrind", "--tool=cachegrind"].map(Into::into).into();
    words.extend(["--cache-sim=no", "--cachegrind-out-file=/dev/null"].map(Into::into));
    words.extend([durer.into(), "info".into(), scene.into()]);
    let ran = run(Path::new("env"), &words, folder.path(), ALLOWANCE).map_err(|e| e.to_string())?;
    if ran.code != Some(0) {
        return Err(format!("exit status {:?}:\n{}", ran.code, ran.stderr));
    }
    // ==123== I refs:        1,234,567
    let line =
        ran.stderr.lines().find_map(|line| line.split_once("I refs:").or(line.split_once("I   refs:")));
    let digits = line.map(|(_, number)| number.chars().filter(char::is_ascii_digit).collect::<String>());
    digits.and_then(|digits| digits.parse().ok()).ok_or_else(|| format!("no count in\n{}", ran.stderr))
}

fn has_valgrind() -> bool {
    let probe =
        Command::new("valgrind").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    probe.is_ok_and(|status| status.success())
}

/// The cases whose format is read.
fn cases() -> Vec<Case> {
    let all = [document::cases(), text::cases(), model::cases()].into_iter().flatten();
    let (read, unread): (Vec<_>, Vec<_>) =
        all.partition(|case| FORMATS.iter().any(|format| format.suffixes.contains(&case.suffix)));
    unread.iter().for_each(|case| eprintln!("SKIPPED: {}: .{} is not read", case.name, case.suffix));
    read
}

#[test]
fn twice_the_size_takes_twice_the_work() {
    if !has_valgrind() {
        eprintln!("SKIPPED: twice_the_size_takes_twice_the_work: valgrind is not installed");
        return;
    }
    let durer = program();
    let cases = cases();
    let mut smallest: Vec<&Case> = cases.iter().collect();
    smallest.dedup_by_key(|case| case.suffix);
    // What the program does for a scene of this format that holds next to nothing.
    let rests = Mutex::new(HashMap::new());
    let failed = each(&smallest, |case| match instructions(&durer, case, 1) {
        Ok(count) => {
            locked(&rests).insert(case.suffix, count);
            Vec::new()
        }
        Err(error) => vec![format!("{}: {error}", case.name)],
    });
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    let complaints = each(&cases, |case| {
        let rest = locked(&rests).get(case.suffix).copied().unwrap_or_default();
        let counted: Result<Vec<f64>, String> =
            [1, 2].map(|factor| instructions(&durer, case, factor * case.size)).into_iter().collect();
        let (once, twice) = match counted.as_deref() {
            Ok([once, twice]) => (once - rest, twice - rest),
            Ok(_) => return vec![format!("{}: not counted", case.name)],
            Err(error) => return vec![format!("{}: {error}", case.name)],
        };
        let (ratio, each) = (twice / once, once / case.size as f64);
        let told = format!("{}: {ratio:.2} times the work, {each:.0} instructions each", case.name);
        println!("{told}");
        // The rest, which does not grow, must not hide what does.
        let blunt = once < 0.5 * rest;
        let blunt = blunt.then(|| format!("{}: too small to tell: {once} beside {rest}", case.name));
        let steep = (ratio > MOST).then_some(told);
        blunt.into_iter().chain(steep).collect()
    });
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().expect("no thread panicked")
}
