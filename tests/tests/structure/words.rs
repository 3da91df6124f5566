//! Words that must not stand somewhere: in code, in `durer-core`, in any text.
use crate::{
    insist,
    source::{self, Source},
};

/// The only folder with unsafe code.
const UNSAFE_FOLDER: &str = "crates/accel/src/simd/";

/// What is left over from work, as [`Source::code`] sees it. (Cut in two, so that this file does not complain of itself.)
const LEFT_OVER: &[&str] = &[concat!("to", "do!"), concat!("unimpl", "emented!"), concat!("db", "g!")];

/// State that no argument names.
const GLOBALS: &[&str] = &[concat!("static", " mut "), concat!("thread", "_local!")];

/// What mathematics needs not: files, threads, clocks, the environment, the terminal.
const OUTSIDE_WORLD: &[&str] = &[
    "std::env",
    "std::fs",
    "std::io",
    "std::net",
    "std::process",
    "std::thread",
    "std::time",
    "println!",
    "eprint",
];

/// How paths of one machine begin; each half harmless.
const MACHINE_PATHS: &[(&str, &str)] =
    &[("/ho", "me/"), ("/ro", "ot/"), ("/wo", "rk/"), ("/Us", "ers/"), ("/tm", "p/"), (":\\Us", "ers\\")];

/// True if `word` stands in `text`, and not as the end or beginning of a longer word.
fn holds_word(text: &str, word: &str) -> bool {
    let inner = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + word.len()..]);
        let joined_before = word.starts_with(inner) && before.ends_with(inner);
        let joined_after = word.ends_with(inner) && after.starts_with(inner);
        !joined_before && !joined_after
    })
}

fn one_of(words: &[&str], why: &str) -> impl Fn(&str) -> Option<String> {
    move |code| words.iter().find(|word| holds_word(code, word)).map(|word| format!("`{word}`: {why}"))
}

fn unsafe_outside_its_folder(file: &Source) -> Vec<String> {
    if file.path.starts_with(UNSAFE_FOLDER) {
        return Vec::new();
    }
    file.complain(one_of(&[concat!("un", "safe")], "belongs into the kernel's SIMD folder"))
}

/// Roots of crates must forbid unsafe code; the kernel may merely deny it once it has its SIMD folder.
fn not_forbidding(file: &Source, kernel_has_simd: bool) -> Option<String> {
    let root = file.path.ends_with("src/lib.rs") || file.path.ends_with("src/main.rs");
    let is_kernel = file.path.starts_with("crates/accel/");
    let lint = if is_kernel && kernel_has_simd { "#![deny(unsafe_code)]" } else { "#![forbid(unsafe_code)]" };
    let missing = root && !file.text.lines().any(|line| line == lint);
    missing.then(|| format!("{}: must say {lint}", file.path))
}

/// Lines with a path that only one machine has. A part of a longer path or of an address does not count.
fn machine_paths(file: &Source) -> Vec<String> {
    let starts: Vec<String> = MACHINE_PATHS.iter().map(|(a, b)| format!("{a}{b}")).collect();
    let is_bad = |line: &str| {
        starts.iter().any(|start| {
            line.match_indices(start).any(|(at, _)| {
                !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-~}$/".contains(c))
                    || start.starts_with(':')
            })
        })
    };
    let bad = file.text.lines().enumerate().filter(|(_, line)| is_bad(line));
    bad.map(|(i, line)| format!("{}:{}: a path of one machine: {}", file.path, i + 1, line.trim())).collect()
}

fn rust() -> Vec<Source> {
    source::all().into_iter().filter(Source::is_rust).collect()
}

#[test]
fn only_the_simd_folder_holds_unsafe_code() {
    let files = rust();
    insist(files.iter().flat_map(unsafe_outside_its_folder).collect());
    let kernel_has_simd = files.iter().any(|f| f.path.starts_with(UNSAFE_FOLDER));
    let crates = files.iter().filter(|f| f.path.starts_with("crates/") || f.path.starts_with("xtask/"));
    insist(crates.filter_map(|f| not_forbidding(f, kernel_has_simd)).collect());
}

#[test]
fn nothing_is_left_over_and_nothing_global_changes() {
    let files = rust();
    let left = files.iter().flat_map(|f| f.complain(one_of(LEFT_OVER, "finish it or take it out")));
    let global = files.iter().flat_map(|f| f.complain(one_of(GLOBALS, "state belongs into arguments")));
    insist(left.chain(global).collect());
}

#[test]
fn core_does_not_touch_the_outside_world() {
    let core: Vec<Source> = rust().into_iter().filter(|f| f.path.starts_with("crates/core/src/")).collect();
    assert!(!core.is_empty());
    insist(core.iter().flat_map(|f| f.complain(one_of(OUTSIDE_WORLD, "durer-core only computes"))).collect());
}

#[test]
fn no_text_names_a_path_of_one_machine() {
    insist(source::all().iter().flat_map(machine_paths).collect());
}

#[test]
fn broken_rules_are_seen() {
    let code = |text: &str| Source::new("crates/core/src/x.rs", text);
    let block = concat!("let x = un", "safe { y };");
    assert_eq!(unsafe_outside_its_folder(&code(block)).len(), 1);
    assert!(unsafe_outside_its_folder(&code("// not safe: unsafe\n#![forbid(unsafe_code)]")).is_empty());
    assert!(unsafe_outside_its_folder(&Source::new("crates/accel/src/simd/avx2.rs", block)).is_empty());

    let kernel = Source::new("crates/accel/src/lib.rs", "#![deny(unsafe_code)]");
    assert!(not_forbidding(&kernel, true).is_none() && not_forbidding(&kernel, false).is_some());
    assert!(not_forbidding(&Source::new("crates/core/src/lib.rs", "//! Head."), true).is_some());

    let left = code(concat!("fn later() { to", "do!() }"));
    assert_eq!(left.complain(one_of(LEFT_OVER, "")).len(), 1);
    assert_eq!(code("use std::time::Instant;").complain(one_of(OUTSIDE_WORLD, "")).len(), 1);

    let path = |text: &str| machine_paths(&Source::new("README.md", text)).len();
    assert_eq!(path(concat!("see /ho", "me/me/scene.glb")), 1);
    assert_eq!(path(concat!("(C:\\Us", "ers\\me)")), 1);
    assert_eq!(path(concat!("https://example.org/ho", "me/scene.glb, ./wo", "rk/x")), 0);
}
