//! Help, lists, completions and manual pages.
use std::process::Stdio;

use crate::run::{Place, Ran};

const COMMANDS: [&str; 8] = ["render", "trace", "cost", "convert", "info", "scenes", "completions", "man"];

#[test]
fn every_help_has_examples() {
    let place = Place::new();
    assert!(place.done("--help").stdout.contains("Examples:"));
    for command in COMMANDS {
        for flag in ["-h", "--help"] {
            let help = place.done(&format!("{command} {flag}")).stdout;
            assert!(help.contains("Examples:\n  durer "), "{command}: {help}");
        }
    }
}

#[test]
fn render_helps_with_the_words_of_the_contract() {
    let help = Place::new().done("render --help").stdout;
    let words = "--integrator --show --width --height --scale --spp --max-depth --min-contribution --accel --camera \
                 --env --exposure --crop --time-at --shutter --tonemap --stats --lenient --seed --threads --quiet -v -o";
    words.split_whitespace().for_each(|word| assert!(help.contains(word), "{word}"));
}

#[test]
fn scenes_are_listed_with_a_line_each() {
    let place = Place::new();
    let list = place.done("scenes --json").json();
    let names: Vec<&str> =
        list.as_array().expect("a list").iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names.first(), Some(&"whitted"));
    let lines = place.done("scenes").stdout;
    assert_eq!(lines.lines().count(), names.len());
    for (line, name) in lines.lines().zip(names) {
        assert!(line.starts_with(name) && line.len() > name.len() + 10, "{line}");
    }
}

#[test]
fn shells_get_completions_and_readers_manual_pages() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = place.done(&format!("completions {shell}")).stdout;
        assert!(script.contains("min-contribution") && script.contains("whitted"), "{shell}");
    }
    assert!(place.done("man").stdout.contains(".TH durer 1"));
    place.done("man --dir pages");
    for command in COMMANDS {
        assert!(place.path("pages").join(format!("durer-{command}.1")).is_file(), "{command}");
    }
}

#[test]
fn usage_without_a_command_is_wrong_and_version_is_right() {
    let place = Place::new();
    assert_eq!(place.run("").code, 2);
    assert_eq!(place.run("nonsense").code, 2);
    assert!(place.done("--version").stdout.starts_with("durer "));
}

#[test]
fn a_reader_who_leaves_early_is_no_error() {
    let place = Place::new();
    for words in ["man", "scenes", "completions bash", "info", "trace --pixel 3,3 --spp 1"] {
        let mut child =
            place.command(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("durer runs");
        drop(child.stdout.take());
        let ran = Ran::of(child.wait_with_output().expect("an end"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{words}");
    }
}
