//! Licences, lints and bans that every crate must have.
use std::fs;

use crate::{edges::packages, insist, source::root};

/// What every package says.
const LICENCE: &str = "MIT OR Apache-2.0";

/// Functions whose results differ between systems: `durer_core::math::float` replaces them.
const BANNED: &[&str] = &[
    "f32::sin",
    "f32::cos",
    "f32::tan",
    "f32::acos",
    "f32::asin",
    "f32::atan2",
    "f32::exp",
    "f32::ln",
    "f32::powf",
];

/// Lints of the workspace that must not be weaker than this.
const DENIED: &[&str] = &[
    "unsafe_op_in_unsafe_fn",
    "undocumented_unsafe_blocks",
    "disallowed_methods",
    "dbg_macro",
    "todo",
    "unimplemented",
];

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn not_banned(clippy: &str) -> Vec<String> {
    let missing = BANNED.iter().filter(|name| !clippy.contains(&format!("path = \"{name}\"")));
    missing.map(|name| format!("clippy.toml: ban {name}, its bits differ between systems")).collect()
}

fn not_denied(manifest: &str) -> Vec<String> {
    let has = |lint: &str| manifest.lines().any(|line| line == format!("{lint} = \"deny\""));
    let missing = DENIED.iter().filter(|lint| !has(lint));
    missing.map(|lint| format!("Cargo.toml: deny the lint {lint}")).collect()
}

fn without_lints(name: &str, manifest: &str) -> Option<String> {
    let inherits = manifest.contains("[lints]\nworkspace = true");
    (!inherits).then(|| format!("{name}: does not take the workspace's lints"))
}

#[test]
fn both_licences_are_here_and_every_package_names_them() {
    assert!(read("LICENSE-MIT").contains("Permission is hereby granted, free of charge"));
    let apache = read("LICENSE-APACHE");
    assert!(apache.contains("Version 2.0, January 2004") && apache.contains("9. Accepting Warranty"));
    let packages = packages();
    let others = packages.iter().filter(|p| p["license"] != LICENCE);
    insist(others.map(|p| format!("{}: licence {}, not {LICENCE}", p["name"], p["license"])).collect());
}

#[test]
fn bans_and_lints_hold_everywhere() {
    insist(not_banned(&read("clippy.toml")));
    insist(not_denied(&read("Cargo.toml")));
    let manifests = packages().into_iter().filter_map(|package| {
        let path = package["manifest_path"].as_str()?;
        without_lints(package["name"].as_str()?, &fs::read_to_string(path).ok()?)
    });
    insist(manifests.collect());
}

#[test]
fn broken_rules_are_seen() {
    assert_eq!(not_banned("").len(), BANNED.len());
    assert_eq!(not_denied("todo = \"warn\"\ndbg_macro = \"deny\"").len(), DENIED.len() - 1);
    assert!(
        without_lints("x", "[lints]\n").is_some()
            && without_lints("x", "[lints]\nworkspace = true\n").is_none()
    );
}
