//! `durer cost`: the table, the JSON, and the exact prediction where trees are full.
use serde_json::Value;

use crate::run::Place;

/// A ball-shaped room of mirrors, from inside: each hit has one mirrored ray and one to the lamp. Another ball, around it,
/// is never met.
const ROOM: &str = r#"
Film "rgb" "integer xresolution" 40 "integer yresolution" 30
Camera "perspective"
Integrator "whitted" "integer maxdepth" 4 "float mincontribution" 0
WorldBegin
LightSource "point" "point3 from" [0.2 0.3 0.1]
Material "classic" "rgb diffuse" [0.4 0.4 0.4] "rgb reflection" [0.5 0.5 0.5]
Shape "sphere" "float radius" 2
Shape "sphere" "float radius" 3
"#;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn the_table_shows_all_factors_predicted_and_measured() {
    let place = Place::new().with("room.pbrt", ROOM);
    let ran = place.done("cost room.pbrt --spp 2 --accel none");
    // However wide the columns are.
    let said = ran.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "room.pbrt: 40 x 30, 2 samples a pixel, whitted, 2 primitives of which every ray is tested against all",
        "all trees are full, 1 branch at each hit, 4 bounces, 1 ray to lights",
        "x ray tree size 5 5",
        "x shadow rays 2 2",
        "exact",
        "x intersection cost",
        "time of one thread",
        "--accel bvh",
        "cut first: ray tree size",
    ] {
        assert!(said.contains(words), "{words} in\n{}", ran.stdout);
    }
    assert_eq!(ran.stderr, "");
    let predicted = place.done("cost room.pbrt --spp 2 --predict").stdout;
    assert!(predicted.contains("predicted from 1200 pixels of the picture"), "{predicted}");
    assert!(!predicted.contains("measured") && !predicted.contains("exact"), "{predicted}");
}

#[test]
fn json_has_the_keys_of_the_help_and_its_factors_multiply_to_the_tests() {
    let place = Place::new().with("room.pbrt", ROOM);
    let bill = place.done("cost room.pbrt --spp 3 --accel none --json").json();
    let keys = |value: &Value, keys: &str| {
        let mut found: Vec<&str> = value.as_object().expect("an object").keys().map(String::as_str).collect();
        let mut expected: Vec<&str> = keys.split_whitespace().collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
    };
    keys(
        &bill,
        "version scene integrator width height samples accel primitives predicted measured alternatives cut_first",
    );
    keys(&bill["predicted"], "method primitive_tests box_tests rays seconds factors");
    keys(&bill["measured"], "primitive_tests box_tests rays seconds factors");
    let factors = "height width primitives intersection_ns tree shadow supersamples gloss temporal focal";
    keys(&bill["measured"]["factors"], factors);
    keys(&bill["alternatives"][0], "accel sampling rays primitive_tests box_tests seconds");
    keys(&bill["cut_first"][0], "factor saves how");
    // 40 x 30 pixels, 3 samples, 5 rays and as many to the lamp, 2 spheres.
    assert_eq!(bill["predicted"]["method"], "parameters");
    for sum in [&bill["predicted"], &bill["measured"]] {
        assert_eq!(sum["rays"], 40 * 30 * 3 * 5 * 2);
        assert_eq!(sum["primitive_tests"], 40 * 30 * 3 * 5 * 2 * 2);
        assert_eq!(sum["box_tests"], 0);
        let counts = factors.split_whitespace().filter(|name| *name != "intersection_ns");
        let product: f64 = counts.map(|name| number(&sum["factors"][name])).product();
        assert!((product / number(&sum["primitive_tests"]) - 1.0).abs() < 1e-12);
        let seconds = product * number(&sum["factors"]["intersection_ns"]) * 1e-9;
        assert!((seconds / number(&sum["seconds"]) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn advice_is_sorted_and_ways_are_those_the_integrator_knows() {
    let place = Place::new();
    let words =
        "cost cook --width 40 --spp 2 --sampling nested --shadow-rays 3 --time-samples 2 --predict --json";
    let bill = place.done(words).json();
    assert_eq!((&bill["measured"], &bill["predicted"]["method"]), (&Value::Null, &"probe".into()));
    let saves: Vec<f64> =
        bill["cut_first"].as_array().expect("a list").iter().map(|a| number(&a["saves"])).collect();
    assert!(saves.len() >= 3 && saves.is_sorted_by(|a, b| a >= b), "{saves:?}");
    assert!(saves.iter().all(|s| (0.0..1.0).contains(s)), "{saves:?}");
    let ways = bill["alternatives"].as_array().expect("a list").iter();
    let ways: Vec<_> = ways.map(|a| (a["accel"].as_str(), a["sampling"].as_str())).collect();
    let [bvh, none, shared, nested] = ["bvh", "none", "shared", "nested"].map(Some);
    assert_eq!(ways, [(bvh, shared), (none, shared), (bvh, nested), (none, nested)]);
    let whitted = place.done("cost whitted --width 40 --spp 1 --predict --json").json();
    assert_eq!(whitted["alternatives"].as_array().map(Vec::len), Some(2));
    assert_eq!(whitted["alternatives"][0]["sampling"], Value::Null);
}

#[test]
fn wrong_scenes_and_crops_cost_nothing() {
    let place = Place::new().with("bad.pbrt", "WorldBegin\nShape \"spere\"\n");
    assert_eq!(place.run("cost bad.pbrt").code, 1);
    let ran = place.run("cost whitted --width 40 --crop 900,0,901,1");
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{}", ran.stderr);
    assert!(ran.stderr.contains("outside the picture"), "{}", ran.stderr);
}

#[test]
fn every_key_of_a_bill_is_documented() {
    let page = include_str!("../../../../docs/json.md");
    let bill = Place::new().done("cost cook --width 20 --spp 1 --json").json();
    let (_, section) = page.split_once("## `durer cost --json`").expect("a section");
    let objects = [
        &bill,
        &bill["predicted"],
        &bill["predicted"]["factors"],
        &bill["alternatives"][0],
        &bill["cut_first"][0],
    ];
    for key in objects.into_iter().flat_map(|o| o.as_object().expect("an object").keys()) {
        let written = [format!("`{key}`"), format!(".{key}`"), format!("`{key}[]")];
        assert!(written.iter().any(|w| section.contains(w)), "docs/json.md does not mention {key}");
    }
}
