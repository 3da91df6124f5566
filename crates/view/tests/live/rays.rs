//! Questions about pixels: what is there, and which rays made it.
use durer::{
    Options, prepare,
    probe::{Clock, Detail},
    tree::{Subject, Surroundings},
};
use serde_json::{Value, json};

use crate::client::{Client, serve, small};

/// The document of `durer trace --json` without what the page leaves out: nulls and times.
fn lean(value: &Value) -> Value {
    match value {
        Value::Object(map) => {
            let kept = map.iter().filter(|(k, v)| !v.is_null() && *k != "ns" && *k != "walk");
            Value::Object(kept.map(|(k, v)| (k.clone(), lean(v))).collect())
        }
        Value::Array(list) => list.iter().map(lean).collect(),
        other => other.clone(),
    }
}

/// What `durer trace --json` prints.
fn traced(scene: &str, options: &Options, pixel: [u32; 2], sample: u32) -> Value {
    let prepared = prepare(&mut durer::open(scene), options).expect("a sound scene");
    let subject = Subject { name: scene, prepared: &prepared };
    let detail = Detail { walks: 0, clock: Clock::Off, rays: 1 << 20 };
    let page = subject.page(pixel, &[sample], Surroundings::None, detail);
    serde_json::from_str(&page.json().expect("JSON")).expect("JSON")
}

#[test]
fn a_click_shows_the_numbers_of_trace() {
    for (scene, integrator) in [("whitted", "whitted"), ("cook", "distributed"), ("cornell", "path")] {
        let options = Options { integrator: Some(integrator.to_owned()), ..small() };
        let live = serve(scene, options.clone());
        let mut page = Client::new(&live);
        for (id, [x, y], sample) in [(1, [20, 15], 0), (2, [24, 30], 3), (3, [47, 35], 1)] {
            page.say(&json!({ "type": "trace", "id": id, "x": x, "y": y, "sample": sample }));
            let answer = page.text("trace");
            assert_eq!(answer["id"], id);
            let tree = lean(&answer["page"]["trees"][0]);
            let expected = lean(&traced(scene, &options, [x, y], sample));
            // Lists of nothing and zeros may be left out too: what is there is the same.
            same(&tree, &expected, scene);
            assert_eq!(tree["nodes"].as_array().map(Vec::len), expected["nodes"].as_array().map(Vec::len));
        }
    }
}

/// Every number and word of the page's document is that of the other one.
fn same(a: &Value, b: &Value, place: &str) {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            a.iter().for_each(|(k, v)| same(v, b.get(k).unwrap_or(&Value::Null), &format!("{place}.{k}")));
        }
        (Value::Array(a), Value::Array(b)) => {
            assert_eq!(a.len(), b.len(), "{place}");
            a.iter().zip(b).enumerate().for_each(|(i, (a, b))| same(a, b, &format!("{place}[{i}]")));
        }
        (a, b) => assert_eq!(a, b, "{place}"),
    }
}

#[test]
fn trees_follow_the_settings_and_samples_come_along() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": 2 }));
    page.say(&json!({ "type": "trace", "id": 1, "x": 20, "y": 15, "samples": true }));
    let shallow = page.text("trace");
    let expected = traced("whitted", &Options { max_depth: Some(2), ..small() }, [20, 15], 0);
    same(&lean(&shallow["page"]["trees"][0]), &lean(&expected), "depth 2");
    assert_eq!(shallow["page"]["values"].as_array().map(Vec::len), Some(4));
    assert_eq!(shallow["page"]["trees"].as_array().map(Vec::len), Some(4));
    page.say(&json!({ "type": "trace", "id": 2, "x": 20, "y": 15, "sample": "brightest" }));
    assert!(page.text("trace")["page"]["trees"][0]["sample"].is_number());
}

#[test]
fn light_transport_is_compared() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "trace", "id": 1, "x": 20, "y": 15, "diff": { "params": { "maxdepth": 1 } } }));
    let answer = page.text("trace");
    let other = &answer["page"]["other"];
    assert_eq!(other["options"], "maxdepth 1");
    let expected = traced("whitted", &Options { max_depth: Some(1), ..small() }, [20, 15], 0);
    same(&lean(&other["trees"][0]), &lean(&expected), "the other");
    assert!(other["diff"]["summary"].as_str().is_some_and(|s| !s.is_empty()), "{other}");
    page.say(&json!({ "type": "trace", "id": 2, "x": 20, "y": 15, "diff": { "kind": "path" } }));
    assert_eq!(page.text("trace")["page"]["other"]["trees"][0]["integrator"], "path");
    for diff in [
        json!({ "kind": "pathh" }),
        json!({ "params": { "maxdepth": "x" } }),
        json!({ "params": { "a": 1 } }),
    ] {
        page.say(&json!({ "type": "trace", "id": 3, "x": 20, "y": 15, "diff": diff }));
        assert_eq!(page.text("error")["id"], 3, "{diff}");
    }
}

#[test]
fn pixels_and_samples_that_are_none_are_refused() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    for (x, y, sample) in [
        (48, 0, json!(0)),
        (0, 36, json!(0)),
        (u32::MAX, 0, json!(0)),
        (0, 0, json!(4)),
        (0, 0, json!("worst")),
    ] {
        page.say(&json!({ "type": "trace", "id": 9, "x": x, "y": y, "sample": sample }));
        assert_eq!(page.text("error")["id"], 9);
    }
    page.say(&json!({ "type": "pick", "id": 10, "x": 48, "y": 0 }));
    assert_eq!(page.text("error")["id"], 10);
}

#[test]
fn picking_says_what_is_there() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.finished();
    let mut found = 0;
    for [x, y] in [[24, 18], [20, 15], [10, 33], [40, 33]] {
        page.say(&json!({ "type": "pick", "id": 1, "x": x, "y": y }));
        let pick = page.text("pick");
        assert_eq!(pick["samples"], 4);
        assert_eq!(pick["rgb"].as_array().map(Vec::len), Some(3));
        if pick["object"].is_null() {
            continue;
        }
        found += 1;
        let form = pick["form"].as_str().expect("a form").to_owned();
        page.say(&json!({ "type": "forms", "ids": [form] }));
        let forms = page.text("forms");
        assert_eq!(forms["forms"][0]["title"], pick["material"]);
        // Further along the ray than along the axis.
        assert!(pick["t"].as_f64() >= pick["depth"].as_f64(), "{pick}");
    }
    assert!(found >= 2, "{found}");
}

#[test]
fn picking_a_light_names_its_form() {
    let live = serve("cornell", small());
    let mut page = Client::new(&live);
    // The light in the ceiling is seen somewhere in the upper half of the middle column.
    let lights: Vec<Value> = (0..18)
        .map(|y| {
            page.say(&json!({ "type": "pick", "id": y, "x": 24, "y": y }));
            page.text("pick")["light"].clone()
        })
        .filter(|light| !light.is_null())
        .collect();
    let light = lights.first().expect("the light");
    let forms = page.hello["forms"].as_array().expect("a list");
    assert!(forms.iter().any(|f| f["id"] == *light && f["family"] == "area light"), "{light}");
}

#[test]
fn the_scene_around_the_rays_is_that_of_the_offline_page() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "ghost", "id": 4 }));
    let ghost = page.text("ghost");
    assert_eq!((&ghost["id"], &ghost["revision"]), (&json!(4), &json!(1)));
    let objects = ghost["scene"]["objects"].as_array().expect("a list");
    assert!(objects.len() >= 3 && ghost["scene"]["camera"]["fov_x"].is_number());
}
