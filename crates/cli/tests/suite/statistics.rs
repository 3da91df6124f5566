//! `--stats` and `durer info`.
use serde_json::Value;

use crate::run::Place;

fn count(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("no count: {value}"))
}

#[test]
fn statistics_add_up() {
    let stats = Place::new().done("render --scale 0.05 --spp 2 --stats=json").json();
    let keys = "version durer scene integrator width height spp seed threads outputs interrupted samples bad_samples \
                first_bad seconds rays stops tests max_depth build";
    keys.split_whitespace().for_each(|key| assert!(stats.get(key).is_some(), "{key}"));
    assert_eq!((&stats["version"], &stats["width"], &stats["height"]), (&1.into(), &64.into(), &36.into()));
    assert_eq!(stats["outputs"], serde_json::json!(["whitted.png"]));
    assert_eq!(count(&stats["samples"]), 64 * 36 * 2);
    let kinds = stats["rays"]["by_kind"].as_object().expect("kinds");
    assert_eq!(kinds.values().map(count).sum::<u64>(), count(&stats["rays"]["all"]));
    assert_eq!(count(&kinds["eye"]), count(&stats["samples"]));
    assert!(count(&stats["tests"]["boxes"]) > 0 && count(&stats["tests"]["primitives"]) > 0);
}

#[test]
fn brute_force_tests_every_primitive_with_every_ray() {
    let stats = Place::new().done("render --scale 0.02 --spp 1 --accel none --stats=json").json();
    let primitives = count(&stats["build"]["shapes"]) + count(&stats["build"]["triangles"]);
    assert_eq!(count(&stats["tests"]["primitives"]), primitives * count(&stats["rays"]["all"]));
    assert_eq!(count(&stats["build"]["nodes"]), 0);
}

#[test]
fn the_table_goes_to_stderr_and_the_path_to_stdout() {
    let ran = Place::new().done("render --scale 0.02 --spp 1 --stats");
    assert_eq!(ran.stdout, "whitted.png\n");
    for word in ["rays, shadow", "stops, missed-scene", "box tests per ray", "time, build", "bad samples"] {
        assert!(ran.stderr.contains(word), "{word} in {}", ran.stderr);
    }
}

#[test]
fn info_counts_and_names() {
    let place = Place::new();
    let info = place.done("info whitted --json").json();
    let keys = "version scene format counts bounds cameras lights materials film integrator memory seconds doctor \
                diagnostics";
    keys.split_whitespace().for_each(|key| assert!(info.get(key).is_some(), "{key}"));
    assert_eq!(count(&info["counts"]["shapes"]), 4);
    assert_eq!(info["lights"][1], serde_json::json!({"name": "sun", "kind": "distant"}));
    assert_eq!(info["doctor"], serde_json::json!([]));
    let ran = place.done("info");
    for word in ["1280 x 720", "sky (gradientsky)", "nothing odd was found", "bounds"] {
        assert!(ran.stdout.contains(word), "{word} in {}", ran.stdout);
    }
}

#[test]
fn the_doctor_sees_what_makes_pictures_black() {
    let away = crate::pictures::SPHERE.replace("0 0 -4  0 0 0", "0 0 -4  0 0 -9");
    let inside = crate::pictures::SPHERE.replace("0 0 -4  0 0 0", "0 0 0  0 0 1");
    let place =
        Place::new().with("away.pbrt", &away).with("inside.pbrt", &inside).with("empty.pbrt", "WorldBegin");
    for (scene, finding) in [
        ("away", "look past everything"),
        ("away", "no light"),
        ("inside", "100 % of what the camera sees is seen from its inside"),
        ("empty", "no shapes"),
        ("empty", "no camera"),
    ] {
        let ran = place.done(&format!("info {scene}.pbrt"));
        assert!(ran.stdout.contains(finding), "{scene}: {finding} in\n{}", ran.stdout);
    }
}

#[test]
fn info_of_a_bad_scene_fails_and_its_json_says_why() {
    let place = Place::new().with("bad.pbrt", "WorldBegin\nShape \"spere\"\n");
    let ran = place.run("info bad.pbrt --json");
    assert_eq!(ran.code, 1);
    let complaint = &ran.json()["diagnostics"][0];
    assert_eq!(
        (&complaint["severity"], &complaint["line"], &complaint["column"]),
        (&"error".into(), &2.into(), &7.into())
    );
    assert!(ran.stderr.contains("bad.pbrt:2:7"));
}
