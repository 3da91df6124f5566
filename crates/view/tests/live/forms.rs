//! Forms come from the registries, and what is filled in changes the picture, or is refused with a reason.
use durer::Options;
use serde_json::{Value, json};

use crate::{
    client::{Client, serve, small},
    picture::rendered,
};

fn form<'v>(forms: &'v Value, id: &str) -> &'v Value {
    forms
        .as_array()
        .expect("a list")
        .iter()
        .find(|f| f["id"] == id)
        .unwrap_or_else(|| panic!("{id} in {forms}"))
}

fn param<'v>(form: &'v Value, name: &str) -> &'v Value {
    let params = form["params"].as_array().expect("a list");
    params.iter().find(|p| p["name"] == name).unwrap_or_else(|| panic!("{name} in {form}"))
}

#[test]
fn every_parameter_of_the_registries_is_in_a_form() {
    let live = serve("whitted", small());
    let page = Client::new(&live);
    let forms = &page.hello["forms"];
    let integrator = form(forms, "integrator");
    let entry =
        durer::integrator::INTEGRATORS.iter().find(|e| e.schema.name == "whitted").expect("registered");
    for spec in entry.schema.params {
        let shown = param(integrator, spec.name);
        assert_eq!((&shown["doc"], &shown["unit"]), (&json!(spec.doc), &json!(spec.unit)));
    }
    let kinds = integrator["kinds"].as_array().expect("a list").len();
    assert_eq!(kinds, durer::integrator::INTEGRATORS.len());
    let depth = param(integrator, "maxdepth");
    assert_eq!((&depth["type"], depth["min"].is_number()), (&json!("int"), true), "{depth}");
    for id in ["look", "film", "moment", "sampler", "camera", "material/0", "light/0"] {
        assert_eq!(form(forms, id)["changed"], false, "{id}");
    }
    assert_eq!(param(form(forms, "film"), "width")["value"], 48);
}

#[test]
fn what_is_filled_in_is_what_the_command_line_would_ask_for() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    let plain = page.finished();
    page.say(&json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": 1 }));
    let forms = page.text("forms")["forms"].clone();
    assert_eq!(param(form(&forms, "integrator"), "maxdepth")["value"], 1);
    assert_eq!(form(&forms, "integrator")["changed"], true);
    let shallow = page.finished();
    assert_ne!(shallow.rgb8, plain.rgb8);
    assert_eq!(shallow.rgb8, rendered("whitted", &Options { max_depth: Some(1), ..small() }));

    page.say(&json!({ "type": "kind", "form": "integrator", "kind": "path" }));
    let forms = page.text("forms")["forms"].clone();
    assert_eq!(param(form(&forms, "integrator"), "maxdepth")["value"], 1, "what both have is kept");
    let path = Options { integrator: Some("path".to_owned()), max_depth: Some(1), ..small() };
    assert_eq!(page.finished().rgb8, rendered("whitted", &path));

    page.say(&json!({ "type": "set", "form": "film", "param": "samples", "value": 9 }));
    page.say(&json!({ "type": "set", "form": "film", "param": "width", "value": 30 }));
    page.say(&json!({ "type": "set", "form": "film", "param": "seed", "value": 5 }));
    let other = Options { samples: Some(9), width: Some(30), seed: Some(5), ..path };
    let last = page.frame_when(|h| h["of"] == 9 && h["film"] == json!([30, 36]) && h["done"] == true);
    if last.rgb8 != rendered("whitted", &other) {
        // The seed may have come a picture later.
        assert_eq!(page.finished().rgb8, rendered("whitted", &other));
    }

    page.say(&json!({ "type": "reset", "form": null }));
    let back = page.frame_when(|h| h["film"] == json!([48, 36]) && h["done"] == true);
    assert_eq!(back.rgb8, plain.rgb8);
}

#[test]
fn the_look_changes_without_a_new_sample() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    let plain = page.finished();
    page.say(&json!({ "type": "set", "form": "look", "param": "exposure", "value": 1.5 }));
    let bright = page.frame();
    assert_eq!((bright.head["done"].clone(), bright.head["samples"].clone()), (json!(true), json!(4)));
    let sum = |rgb8: &[u8]| rgb8.iter().map(|&v| u64::from(v)).sum::<u64>();
    assert!(sum(&bright.rgb8) > sum(&plain.rgb8) * 11 / 10);
    page.say(&json!({ "type": "set", "form": "look", "param": "tonemap", "value": "agx" }));
    assert_ne!(page.frame().rgb8, bright.rgb8);
    page.say(&json!({ "type": "reset", "form": "look" }));
    assert_eq!(page.frame().rgb8, plain.rgb8);
}

#[test]
fn materials_lights_and_cameras_can_be_changed() {
    let live = serve("cornell", Options { integrator: Some("path".to_owned()), ..small() });
    let mut page = Client::new(&live);
    let plain = page.finished();
    let forms = page.hello["forms"].clone();
    let with = |family: &str, name: &str| {
        let named = |f: &&Value| f["params"].as_array().expect("a list").iter().any(|p| p["name"] == name);
        let has = |f: &&Value| f["family"] == family && named(f);
        let all = forms.as_array().expect("a list").iter();
        all.filter(has).map(|f| f["id"].as_str().expect("an id").to_owned()).next().expect("a form")
    };
    let changes = [
        (with("material", "reflectance"), "reflectance", json!([0.9, 0.1, 0.1])),
        (with("area light", "L"), "L", json!({ "blackbody": 2000 })),
        ("camera".to_owned(), "fov", json!(20)),
    ];
    for (id, name, value) in changes {
        page.say(&json!({ "type": "set", "form": id, "param": name, "value": value }));
        let forms = page.text("forms")["forms"].clone();
        let shown = &param(form(&forms, &id), name)["value"];
        let same = *shown == value || shown == &json!(20.0) || shown == &json!({ "blackbody": 2000.0 });
        assert!(same, "{id} {name}: {shown}");
        assert_ne!(page.finished().rgb8, plain.rgb8, "{id}");
        page.say(&json!({ "type": "reset", "form": id }));
        assert_eq!(form(&page.text("forms")["forms"], &id)["changed"], false);
        assert_eq!(page.finished().rgb8, plain.rgb8, "{id} as it was");
    }
}

#[test]
fn a_material_that_gets_holes_is_seen_through() {
    // Whether rays ask a surface for holes is known to the hierarchy, which has to be built anew.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("card.pbrt");
    let scene = "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n\
                 LightSource \"infinite\" \"rgb L\" [1 1 1]\n\
                 MakeNamedMaterial \"card\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 0]\nNamedMaterial \"card\"\n\
                 Shape \"trianglemesh\" \"point3 P\" [-9 -9 0  9 -9 0  0 9 0]\n";
    std::fs::write(&file, scene).expect("written");
    let name = file.to_str().expect("text");
    let options = Options { integrator: Some("path".to_owned()), ..small() };
    let live = serve(name, options);
    let mut page = Client::new(&live);
    let middle = |rgb8: &[u8]| rgb8[3 * (18 * 48 + 24)];
    assert_eq!(middle(&page.finished().rgb8), 0);
    page.say(&json!({ "type": "kind", "form": "material/0", "kind": "interface" }));
    page.text("forms");
    assert!(middle(&page.finished().rgb8) > 200, "the sky behind");
    page.say(&json!({ "type": "reset", "form": "material/0" }));
    assert_eq!(middle(&page.finished().rgb8), 0);
}

#[test]
fn what_makes_no_sense_is_refused_with_a_reason_and_changes_nothing() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    let plain = page.finished();
    let cases = [
        json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": "deep" }),
        json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": -1 }),
        json!({ "type": "set", "form": "integrator", "param": "maxdept", "value": 1 }),
        json!({ "type": "set", "form": "film", "param": "width", "value": 0 }),
        json!({ "type": "set", "form": "film", "param": "width", "value": 1e9 }),
        json!({ "type": "set", "form": "look", "param": "tonemap", "value": "aggx" }),
        json!({ "type": "set", "form": "look", "param": "colour", "value": 1 }),
        json!({ "type": "set", "form": "material/0", "param": "reflectance", "value": { "texture": "nothing" } }),
        json!({ "type": "set", "form": "material/99", "param": "reflectance", "value": [1, 1, 1] }),
        json!({ "type": "set", "form": "light/99", "param": "L", "value": [1, 1, 1] }),
        json!({ "type": "set", "form": "arealight/99999", "param": "L", "value": [1, 1, 1] }),
        json!({ "type": "set", "form": "soup", "param": "salt", "value": 1 }),
        json!({ "type": "kind", "form": "integrator", "kind": "pathh" }),
        json!({ "type": "kind", "form": "look", "kind": "good" }),
        json!({ "type": "reset", "form": "material/99" }),
    ];
    for case in cases {
        page.texts.clear();
        page.say(&case);
        let error = page.text("error");
        assert!(!error["message"].as_str().unwrap_or_default().is_empty(), "{case}: {error}");
        assert_eq!(error["about"], case["form"], "{error}");
        if case["form"] != "look" {
            assert_eq!(page.finished().rgb8, plain.rgb8, "{case}");
        }
    }
    page.say(&json!({ "type": "set", "form": "look", "param": "tonemap", "value": "aggx" }));
    assert_eq!(page.text("error")["hint"], "did you mean \"agx\"?");
}

#[test]
fn files_are_named_by_the_scene_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, outside) = (folder.path().join("sky.pbrt"), folder.path().join("secret.png"));
    std::fs::write(&outside, b"no picture").expect("written");
    std::fs::write(
        &file,
        "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\nShape \"sphere\"\n",
    )
    .expect("written");
    let live = serve(file.to_str().expect("text"), small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "set", "form": "light/0", "param": "filename", "value": outside.to_str() }));
    let error = page.text("error");
    assert!(error["message"].as_str().is_some_and(|m| m.contains("only the scene file")), "{error}");
}
