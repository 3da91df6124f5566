//! Who may depend on whom.
use std::process::Command;

use serde_json::Value;

use crate::{insist, source::root};

/// The crates of the project, each with those it depends on. `ARCHITECTURE.md` draws them.
const EDGES: &[(&str, &[&str])] = &[
    ("durer-core", &[]),
    ("durer-accel", &["durer-core"]),
    ("durer-scene", &["durer-core"]),
    ("durer-model", &["durer-core", "durer-scene"]),
    ("durer-render", &["durer-core", "durer-scene", "durer-model", "durer-accel"]),
    ("durer-draw", &["durer-core", "durer-render"]),
    ("durer-io", &["durer-core", "durer-scene"]),
    (
        "durer",
        &[
            "durer-core",
            "durer-accel",
            "durer-scene",
            "durer-model",
            "durer-render",
            "durer-draw",
            "durer-io",
        ],
    ),
    ("durer-view", &["durer", "durer-page"]),
    ("durer-cli", &["durer", "durer-page", "durer-view"]),
    ("durer-page", &[]),
    ("durer-testkit", &[]),
    ("durer-tests", &["durer"]),
    ("durer-benches", &["durer"]),
    ("xtask", &["durer-io", "durer-scene"]),
];

/// What tests may depend on beyond that.
const FOR_TESTS: &[&str] = &["durer-testkit"];

/// What `cargo metadata` says about the packages of the workspace.
pub(crate) fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let words = ["metadata", "--format-version", "1", "--no-deps", "--offline"];
    let output = Command::new(cargo).args(words).current_dir(root()).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    metadata["packages"].as_array().expect("a list of packages").clone()
}

/// Names of a package's dependencies of a kind that lie in the workspace.
fn inner(package: &Value, test_only: bool) -> Vec<&str> {
    let list = package["dependencies"].as_array().expect("a list of dependencies");
    let inner = list.iter().filter(|d| !d["path"].is_null() && (d["kind"] == "dev") == test_only);
    inner.map(|d| d["name"].as_str().expect("a name")).collect()
}

fn complaints(packages: &[Value]) -> Vec<String> {
    let mut complaints = Vec::new();
    for package in packages {
        let name = package["name"].as_str().expect("a name");
        let Some((_, allowed)) = EDGES.iter().find(|(n, _)| *n == name) else {
            complaints.push(format!("{name}: a new crate; draw its edges here and in ARCHITECTURE.md"));
            continue;
        };
        let found = inner(package, false);
        for other in found.iter().filter(|d| !allowed.contains(d)) {
            complaints.push(format!("{name}: must not depend on {other}"));
        }
        for other in allowed.iter().filter(|d| !found.contains(d)) {
            complaints.push(format!("{name}: no longer depends on {other}; remove the edge"));
        }
        for other in inner(package, true).iter().filter(|d| !FOR_TESTS.contains(d)) {
            complaints.push(format!("{name}: tests must not depend on {other}"));
        }
    }
    complaints
}

#[test]
fn crates_depend_along_the_edges_only() {
    insist(complaints(&packages()));
}

#[test]
fn an_edge_too_many_or_too_few_is_seen() {
    let edge =
        |name: &str, kind: Value| serde_json::json!({ "name": name, "path": "somewhere", "kind": kind });
    let package = |name: &str, edges: &[Value]| serde_json::json!({ "name": name, "dependencies": edges });
    let upward = package("durer-core", &[edge("durer-io", Value::Null)]);
    assert_eq!(complaints(&[upward]), ["durer-core: must not depend on durer-io"]);
    let fewer = package("durer-accel", &[]);
    assert_eq!(complaints(&[fewer]).len(), 1);
    let in_tests =
        package("durer-core", &[edge("durer-io", "dev".into()), edge("durer-testkit", "dev".into())]);
    assert_eq!(complaints(&[in_tests]), ["durer-core: tests must not depend on durer-io"]);
    assert_eq!(complaints(&[package("durer-more", &[])]).len(), 1);
}
