//! `durer trace`: its files, `--sample` by word, `--find` and `--diff`.
use serde_json::Value;

use crate::run::Place;

const WORDS: &str = "trace --width 64 --height 36 --spp 4";

#[test]
fn each_suffix_writes_a_file_of_its_kind_and_several_may_be_asked_for() {
    let place = Place::new();
    let files = "-o a.json -o A.SVG -o a.dot -o a.glb -o a.csv -o a.md -o a.page.json";
    let ran = place.done(&format!("{WORDS} --pixel 37,20 {files}"));
    assert_eq!(ran.stderr.matches("wrote ").count(), 7, "{}", ran.stderr);
    let text =
        |name: &str| String::from_utf8(std::fs::read(place.path(name)).expect("a file")).expect("UTF-8");
    assert!(text("A.SVG").starts_with("<svg ") && text("A.SVG").ends_with("</svg>\n"));
    assert!(text("a.dot").starts_with("digraph "));
    assert!(text("a.csv").starts_with("sample,id,parent,") && text("a.md").starts_with("## whitted"));
    assert_eq!(std::fs::read(place.path("a.glb")).expect("a file").get(..4), Some(b"glTF".as_slice()));
    let tree: Value = serde_json::from_str(&text("a.json")).expect("JSON");
    let page: Value = serde_json::from_str(&text("a.page.json")).expect("JSON");
    assert_eq!((tree["sample"].as_u64(), tree["samples"].as_u64()), (Some(0), Some(4)));
    assert!(tree["nodes"][0]["ns"].is_null(), "times are never the same twice");
    assert_eq!(page["trees"].as_array().map(Vec::len), Some(4));
    assert_eq!(page["trees"][0]["nodes"][3]["point"], tree["nodes"][3]["point"]);
    assert!(page["scene"]["objects"].as_array().is_some_and(|o| o.len() == 4));
}

#[test]
fn all_samples_end_with_the_pixel_of_the_picture() {
    let place = Place::new();
    place.done("render --width 64 --height 36 --spp 4 -o x.exr");
    let all = place.done(&format!("{WORDS} --pixel 40,20 --sample all"));
    assert_eq!(all.pixel().map(f32::to_bits), place.exr("x.exr").bits(["R", "G", "B"], [40, 20]));
    assert_eq!(all.stdout.matches(" of 4\n").count(), 4);
    let json = place.done(&format!("{WORDS} --pixel 40,20 --sample all --json")).json();
    let trees = json["trees"].as_array().expect("trees");
    assert_eq!(trees.len(), 4);
    let light = |tree: &Value| {
        let v: Vec<f64> = (0..3).map(|i| tree["rgb"][i].as_f64().expect("a number")).collect();
        0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]
    };
    let brightest = place.done(&format!("{WORDS} --pixel 40,20 --sample brightest --json")).json();
    assert!(trees.iter().all(|t| light(t) <= light(&brightest)));
    assert!(json["values"].as_array().is_some_and(|v| v.len() == 4) && json.get("scene").is_none());
}

#[test]
fn a_bad_sample_is_found_and_one_that_is_not_there_is_an_error() {
    let light = r#"LightSource "point" "rgb I" [3e38 3e38 3e38] "float scale" 1e10 "point3 from" [0 3 -3]"#;
    let place = Place::new().with("bad.pbrt", &format!("{}{light}", crate::pictures::SPHERE));
    let found = place.done("trace bad.pbrt --spp 2 --seed 7 --find nan");
    let line = found.stderr.lines().find_map(|l| l.trim().strip_prefix("durer ")).expect("a line to replay");
    assert!(found.stderr.starts_with("nan: pixel ") && line.contains("--seed 7"), "{}", found.stderr);
    assert_eq!(place.done(line).stdout, found.stdout);
    assert!(found.stdout.contains("[nan-rejected]"), "{}", found.stdout);
    let rendered = place.done("render bad.pbrt --spp 2 --seed 7");
    let replay = rendered.stderr.lines().find_map(|l| l.trim().strip_prefix("durer ")).expect("a line");
    assert_eq!(replay, line, "the same sample as a render reports");
    for words in ["--pixel 3,3 --sample nan", "--find nan"] {
        let ran = Place::new().run(&format!("{WORDS} {words}"));
        assert_eq!(ran.code, 1);
        assert!(ran.stderr.contains("infinite or NaN"), "{}", ran.stderr);
    }
}

#[test]
fn the_deepest_sample_is_opened() {
    let place = Place::new();
    let ran = place.done("trace mirrors --width 24 --spp 1 --find deepest --json --threads 2");
    let tree = ran.json();
    let given_up = ["depth-limit", "contribution-below-cutoff"];
    let traced = |n: &&Value| {
        // Rays to lights are no bounces.
        n["kind"] != "shadow" && !given_up.contains(&n["stop"].as_str().unwrap_or_default())
    };
    let depth = tree["nodes"].as_array().expect("nodes").iter().filter(traced);
    let depth = depth.map(|n| n["depth"].as_u64().expect("a number")).max().expect("a node");
    assert!(ran.stderr.contains(&format!(": {depth} bounces")), "{depth}: {}", ran.stderr);
}

#[test]
fn a_difference_is_told_in_a_sentence_and_in_json() {
    let place = Place::new();
    let words = "trace --width 64 --height 36 --spp 1 --pixel 37,20";
    let mut command = place.command(words);
    let ran = crate::run::Ran::of(command.args(["--diff", "--max-depth 2"]).output().expect("durer runs"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let line = ran.stdout.lines().find(|l| l.starts_with("depth limit 2 removes ")).expect("a sentence");
    assert!(line.contains(" % of this pixel: "), "{line}");
    let mut command = place.command(&format!("{words} --json"));
    let page =
        crate::run::Ran::of(command.args(["--diff", "--max-depth 2"]).output().expect("durer runs")).json();
    let json = &page["trees"][0];
    let limited = place.done(&format!("{words} --max-depth 2 --json")).json();
    assert_eq!(json["diff"]["after"], limited["rgb"]);
    assert_eq!(json["diff"]["summary"].as_str(), Some(line));
    assert_eq!(page["other"]["trees"][0]["nodes"], limited["nodes"]);
    let kept =
        json["nodes"].as_array().map_or(0, Vec::len) - json["diff"]["removed"].as_array().map_or(0, Vec::len);
    let cut =
        limited["nodes"].as_array().expect("nodes").iter().filter(|n| n["stop"] == "depth-limit").count();
    let both = limited["nodes"].as_array().map_or(0, Vec::len);
    assert!(kept <= both && both - kept <= cut, "{kept} {both} {cut}");
}

#[test]
fn what_is_no_light_is_not_compared_as_light() {
    let place = Place::new();
    let diff = |words: &str, other: &str| {
        let mut command =
            place.command(&format!("trace --width 32 --height 18 --spp 1 --pixel 16,9 {words}"));
        crate::run::Ran::of(command.args(["--diff", other]).output().expect("durer runs"))
    };
    let depth = "--integrator cast --show depth";
    for (words, other, said) in [
        ("", depth, "(the one is light, the other depth)"),
        (depth, "--integrator whitted", "(the one is depth, the other light)"),
        (depth, "--show normal", "(the one is depth, the other normal)"),
    ] {
        let text = diff(words, other).stdout;
        assert!(text.contains(said) && !text.contains(" % of this"), "{words}, {other}: {text}");
        let json = diff(&format!("{words} --json"), other).json();
        assert!(json["other"]["diff"]["relative"].is_null(), "{words}, {other}");
        assert!(json["other"]["diff"]["summary"].as_str().is_some_and(|s| s.contains(said)));
    }
    let same = diff(depth, "snell").stdout;
    assert!(same.contains("(it is depth, not light)"), "{same}");
    let light = diff("--json", "--max-depth 0").json();
    assert!(
        light["other"]["diff"]["relative"].is_number()
            && light["values"].as_array().is_some_and(|v| v.len() == 1)
    );
}

#[test]
fn another_scene_and_another_integrator_can_be_compared() {
    let place = Place::new();
    for (words, sign) in [
        ("snell", "snell"),
        ("--integrator cast", "integrator cast"),
        ("--scale 1 whitted", "changes nothing"),
    ] {
        let mut command = place.command("trace --width 32 --height 18 --spp 1 --pixel 16,9");
        let ran = crate::run::Ran::of(command.args(["--diff", words]).output().expect("durer runs"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert!(ran.stdout.contains(sign), "{words}: {}", ran.stdout);
    }
    let mut command = place.command("trace --width 32 --height 18 --spp 1 --pixel 16,9");
    let ran = crate::run::Ran::of(command.args(["--diff", "--width 8"]).output().expect("durer runs"));
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("outside its picture"), "{}", ran.stderr);
}

#[test]
fn files_that_cannot_be_written_are_told_before_the_work() {
    let place = Place::new();
    let ran = place.run(&format!("{WORDS} --pixel 3,3 -o nowhere/tree.svg"));
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert!(ran.stderr.contains("there is no folder nowhere"), "{}", ran.stderr);
    let ran = place.run(&format!("{WORDS} --pixel 3,3 -o ."));
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("is a folder: name a file in it"), "{}", ran.stderr);
}

#[test]
fn the_page_is_written_or_it_is_said_what_is_missing() {
    let place = Place::new();
    let ran = place.run(&format!("{WORDS} --pixel 37,20 -o tree.html"));
    let written = std::fs::read_to_string(place.path("tree.html"));
    if ran.code == 1 {
        assert!(ran.stderr.contains("cargo xtask page") && ran.stdout.is_empty(), "{}", ran.stderr);
        assert!(written.is_err());
        return;
    }
    let html = written.expect("a page");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    // What gzip's first bytes are in base64.
    let (_, data) = html.split_once("id=\"durer-data\"").expect("the element of the data");
    assert!(data.split_once('>').is_some_and(|(_, data)| data.trim_start().starts_with("H4sI")));
    assert!(html.len() < 2_000_000, "{}", html.len());
}
