//! `durer explain` as a program: text, JSON with the documented keys, and complaints.
use std::{collections::BTreeSet, ffi::OsString, fs, path::PathBuf, time::Duration};

use durer_tests::program::{Allowance, Ran, program, root, run};
use serde_json::Value;

fn durer(words: &str) -> Ran {
    static PROGRAM: std::sync::OnceLock<PathBuf> = std::sync::OnceLock::new();
    let folder = tempfile::tempdir().expect("a folder");
    let words: Vec<OsString> = words.split_whitespace().map(OsString::from).collect();
    let allowance = Allowance { time: Duration::from_secs(60), memory: None };
    run(PROGRAM.get_or_init(program), &words, folder.path(), allowance).expect("it runs")
}

const SMALL: &str = "--width 64 --height 36 --spp 2";

#[test]
fn text_is_for_people_in_lines_that_fit() {
    let ran = durer(&format!("explain {SMALL} --pixel 24,20"));
    assert_eq!((ran.code, ran.stderr.as_str()), (Some(0), ""));
    assert!(ran.stdout.starts_with("Pixel 24,20 of whitted (whitted) is "), "{}", ran.stdout);
    assert!(ran.stdout.contains("The eye ray meets the outside of \"mirror ball\""), "{}", ran.stdout);
    assert!(ran.stdout.lines().all(|l| l.chars().count() <= 100), "{}", ran.stdout);
    let more = durer(&format!("explain {SMALL} --pixel 24,20 -v")).stdout;
    assert!(more.len() > ran.stdout.len() && more.contains("none breaks any"), "{more}");
}

/// All keys of objects in a document, at any depth.
fn keys(value: &Value, all: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| {
            all.insert(key.clone());
            keys(value, all);
        }),
        Value::Array(list) => list.iter().for_each(|value| keys(value, all)),
        _ => {}
    }
}

#[test]
fn json_has_the_documented_keys_and_the_pixel_of_trace() {
    let ran = durer(&format!("explain {SMALL} --pixel 24,20 --json"));
    let json: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!((&json["version"], &json["pixel"]), (&1.into(), &serde_json::json!([24, 20])));
    assert_eq!(json["findings"], serde_json::json!([]));
    let docs = fs::read_to_string(root().join("docs/explain.md")).expect("a document");
    let mut all = BTreeSet::new();
    keys(&json, &mut all);
    assert!(all.len() > 15, "{all:?}");
    for key in &all {
        assert!(docs.contains(&format!("`{key}`")), "{key} is not in docs/explain.md");
    }
    let trace = durer(&format!("trace {SMALL} --pixel 24,20 --sample all")).stdout;
    let last: Vec<f64> = trace
        .lines()
        .last()
        .and_then(|line| line.strip_prefix("pixel "))
        .expect("a last line")
        .split(' ')
        .map(|v| v.parse().expect("a number"))
        .collect();
    for (channel, traced) in last.iter().enumerate() {
        let sum: f64 = json["parts"]
            .as_array()
            .expect("parts")
            .iter()
            .map(|part| part["rgb"][channel].as_f64().expect("a number"))
            .sum();
        assert!((sum - traced).abs() < 1e-6, "{sum} {traced}");
    }
}

#[test]
fn complaints_are_those_of_trace() {
    for (words, complaint) in [
        ("--pixel 64,0", "pixel 64,0 lies outside the picture of 64 x 36 pixels"),
        ("--pixel 1,1 --sample 2", "there is no sample 2: a pixel has 2"),
        ("--pixel 1", "--pixel"),
        ("", "--pixel"),
    ] {
        let ran = durer(&format!("explain {SMALL} {words}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (Some(2), ""), "{words}");
        assert!(ran.stderr.contains(complaint), "{words}: {}", ran.stderr);
    }
    let ran = durer("explain no-such-scene --pixel 1,1");
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
}

#[test]
fn help_has_examples() {
    let ran = durer("explain --help");
    assert_eq!(ran.code, Some(0));
    for words in
        ["Examples:", "durer explain --pixel 640,360", "--sample", "--json", "--max-depth", "docs/explain.md"]
    {
        assert!(ran.stdout.contains(words), "{words}");
    }
}
