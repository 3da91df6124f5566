//! Files: how long, how they begin, what they are called.
use crate::{
    insist,
    source::{self, Source},
};

/// Most lines of a source file.
const MOST_LINES: usize = 400;

/// Files that may be longer: path, since when, why.
const LONGER: &[(&str, &str, &str)] = &[];

/// Names that say nothing about what is inside.
const EMPTY_NAMES: &[&str] =
    &["base", "common", "helper", "helpers", "manager", "misc", "stuff", "util", "utils"];

fn too_long(file: &Source) -> Option<String> {
    let lines = file.text.lines().count();
    let excused = LONGER.iter().any(|(path, _, _)| *path == file.path);
    let long = lines > MOST_LINES && !excused;
    long.then(|| format!("{}: {lines} lines, more than {MOST_LINES}: split it by subject", file.path))
}

fn headless(file: &Source) -> Option<String> {
    let begin = if file.is_script() { "// " } else { "//! " };
    let head = file.text.starts_with(begin);
    (!head).then(|| format!("{}: must begin with `{begin}` and say what it is about", file.path))
}

/// The name in `mod name;`, whoever may see it.
fn declared_module(code: &str) -> Option<&str> {
    let code = code.trim_start();
    let unseen = match code.strip_prefix("pub") {
        Some(rest) => rest.trim_start_matches(|c| c != ' ').trim_start(),
        None => code,
    };
    Some(unseen.strip_prefix("mod ")?.trim_end_matches([' ', ';', '{', '}']))
}

/// Complaints about folders, the file and the modules it declares.
fn badly_named(file: &Source) -> Vec<String> {
    let mut names: Vec<&str> =
        file.path.split('/').map(|part| part.split('.').next().unwrap_or(part)).collect();
    names.extend(file.code().filter_map(|(_, code)| declared_module(code)));
    let bad = names.into_iter().filter(|name| EMPTY_NAMES.contains(name));
    bad.map(|name| format!("{}: \"{name}\" says nothing; name the subject", file.path)).collect()
}

fn code() -> Vec<Source> {
    source::all().into_iter().filter(|file| file.is_rust() || file.is_script()).collect()
}

#[test]
fn files_are_short() {
    insist(code().iter().filter_map(too_long).collect());
}

#[test]
fn files_say_what_they_are_about() {
    insist(code().iter().filter_map(headless).collect());
}

#[test]
fn names_say_what_is_inside() {
    insist(code().iter().flat_map(badly_named).collect());
}

#[test]
fn excuses_are_dated_and_needed() {
    let files = code();
    for (path, since, why) in LONGER {
        assert!(since.len() == "2026-01-31".len() && !why.is_empty(), "{path}: since when, and why?");
        let lines = files.iter().find(|f| f.path == *path).map_or(0, |f| f.text.lines().count());
        assert!(lines > MOST_LINES, "{path}: needs no excuse any more");
    }
}

#[test]
fn broken_rules_are_seen() {
    assert!(too_long(&Source::new("long.rs", &"\n".repeat(MOST_LINES + 1))).is_some());
    assert!(too_long(&Source::new("short.rs", &"\n".repeat(MOST_LINES))).is_none());
    assert!(headless(&Source::new("mute.rs", "// A comment.\n")).is_some());
    assert!(headless(&Source::new("told.rs", "//! A head.\n")).is_none());
    assert_eq!(badly_named(&Source::new("crates/common/src/utils.rs", "pub(crate) mod misc;")).len(), 3);
    assert!(badly_named(&Source::new("a/modern.rs", "mod utilisation; // mod utils;")).is_empty());
}
