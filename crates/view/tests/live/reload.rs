//! Scene files that change while somebody looks.
use std::{fs, path::Path};

use durer_view::Live;
use serde_json::json;
use tempfile::TempDir;

use crate::client::{Client, serve, small};

fn scene(color: &str, included: &str) -> String {
    format!(
        "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"diffuse\" \"rgb reflectance\" [{color}]\n{included}\n"
    )
}

fn write(file: &Path, text: &str) {
    // In one step, as editors do it.
    let new = file.with_extension("new");
    fs::write(&new, text).expect("written");
    fs::rename(&new, file).expect("in place");
}

fn opened(text: &str) -> (TempDir, Live) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("ball.pbrt"), "Shape \"sphere\"\n").expect("written");
    let file = folder.path().join("scene.pbrt");
    fs::write(&file, text).expect("written");
    let options = durer::Options { integrator: Some("path".to_owned()), ..small() };
    let live = serve(file.to_str().expect("text"), options);
    (folder, live)
}

#[test]
fn a_file_that_changes_is_opened_again_and_the_camera_stays() {
    let (folder, live) = opened(&scene("0.8 0.1 0.1", "Include \"ball.pbrt\""));
    let file = folder.path().join("scene.pbrt");
    let mut page = Client::new(&live);
    let red = page.finished();
    assert_eq!(red.head["revision"], 1);
    let camera = page.hello["camera"].clone();
    page.say(&json!({ "type": "camera", "seq": 1, "eye": [0.5, 0, -3], "forward": camera["forward"], "up": camera["up"] }));
    let moved = page.frame_when(|h| h["seq"] == 1 && h["done"] == true);
    write(&file, &scene("0.1 0.1 0.8", "Include \"ball.pbrt\""));
    let told = page.text("scene");
    assert_eq!((&told["scene"]["revision"], &told["camera"]["exact"]), (&json!(2), &json!(false)));
    let blue = page.frame_when(|h| h["revision"] == 2 && h["done"] == true);
    assert_eq!(blue.head["seq"], 1);
    let differs = |at: usize| blue.rgb8[at] != moved.rgb8[at];
    assert!(differs(3 * (18 * 48 + 20)), "the ball is of another colour");
    assert!(!differs(0), "the sky is where it was");
    // A file that is included is watched as well.
    write(&folder.path().join("ball.pbrt"), "Shape \"sphere\" \"float radius\" 0.2\n");
    let small = page.frame_when(|h| h["revision"] == 3 && h["done"] == true);
    assert_ne!(small.rgb8, blue.rgb8);
}

#[test]
fn a_file_that_is_broken_keeps_the_old_picture_and_says_why() {
    let (folder, live) = opened(&scene("0.8 0.1 0.1", "Shape \"sphere\""));
    let file = folder.path().join("scene.pbrt");
    let mut page = Client::new(&live);
    let red = page.finished();
    write(&file, &scene("0.8 0.1 0.1", "Shape \"spere\""));
    let trouble = loop {
        let status = page.text("status");
        if status["state"] == "error" {
            break status;
        }
    };
    assert!(trouble["message"].as_str().is_some_and(|m| m.contains("spere")), "{trouble}");
    // Who comes now sees the old scene, and hears of it.
    let mut late = Client::new(&live);
    assert_eq!(late.hello["status"]["state"], "error");
    assert_eq!(late.finished().rgb8, red.rgb8);
    page.say(&json!({ "type": "set", "form": "film", "param": "samples", "value": 5 }));
    assert_eq!(page.frame_when(|h| h["of"] == 5 && h["done"] == true).head["revision"], 1);
    fs::remove_file(&file).expect("removed");
    std::thread::sleep(std::time::Duration::from_millis(600));
    write(&file, &scene("0.1 0.8 0.1", "Shape \"sphere\""));
    let green = page.frame_when(|h| h["revision"].as_u64() >= Some(2) && h["done"] == true);
    assert_ne!(green.rgb8, red.rgb8);
    assert_eq!(green.head["of"], 5, "what the viewer asked for stays");
}

/// A ball of a named material under a light of its own.
fn named(color: &str, before: &str) -> String {
    format!(
        "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n{before}\
         LightSource \"point\" \"string name\" \"lamp\" \"rgb I\" [5 5 5] \"point3 from\" [0 2 -3]\n\
         MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"rgb reflectance\" [{color}]\n\
         NamedMaterial \"paint\"\nShape \"sphere\"\n"
    )
}

#[test]
fn changes_of_what_the_file_has_as_before_stay() {
    let (folder, live) = opened(&named("0.8 0.1 0.1", ""));
    let file = folder.path().join("scene.pbrt");
    let mut page = Client::new(&live);
    page.finished();
    let of = |forms: &serde_json::Value, title: &str| {
        let forms = forms.as_array().expect("a list");
        forms.iter().find(|f| f["title"] == title).unwrap_or_else(|| panic!("{title}")).clone()
    };
    let value = |form: &serde_json::Value, name: &str| {
        let params = form["params"].as_array().expect("a list");
        params.iter().find(|p| p["name"] == name).expect("a parameter")["value"].clone()
    };
    for (title, param, new) in
        [("paint", "reflectance", json!([0.1, 0.9, 0.2])), ("lamp", "I", json!([9, 9, 9]))]
    {
        let id = of(&page.hello["forms"], title)["id"].clone();
        page.say(&json!({ "type": "set", "form": id, "param": param, "value": new }));
        page.text("forms");
    }
    page.say(&json!({ "type": "set", "form": "film", "param": "seed", "value": 7 }));
    page.say(&json!({ "type": "kind", "form": "sampler", "kind": "halton" }));
    // Another material before them: numbers change, names do not; and everything stands on other lines.
    let more =
        "MakeNamedMaterial \"wax\" \"string type\" \"diffuse\"\n\nMaterial \"diffuse\"\nShape \"disk\"\n";
    write(&file, &named("0.8 0.1 0.1", more));
    let told = page.text("scene");
    let (paint, lamp) = (of(&told["forms"], "paint"), of(&told["forms"], "lamp"));
    assert_eq!(value(&paint, "reflectance"), json!([0.1, 0.9, 0.2]));
    assert_eq!((&paint["changed"], value(&lamp, "I")), (&json!(true), json!([9.0, 9.0, 9.0])));
    assert_ne!(paint["id"], of(&page.hello["forms"], "paint")["id"]);
    assert_eq!(value(&of(&told["forms"], "film"), "seed"), 7);
    assert_eq!(of(&told["forms"], "sampler")["kind"], "halton");
    page.frame_when(|h| h["revision"] == 2 && h["done"] == true);
    assert!(!page.texts.iter().any(|t| t["type"] == "error"), "{:?}", page.texts);

    // What the file has otherwise now is the file's.
    write(&file, &named("0.2 0.2 0.9", more));
    let told = page.text("scene");
    assert_eq!(value(&of(&told["forms"], "paint"), "reflectance"), json!([0.2, 0.2, 0.9]));
    assert_eq!(value(&of(&told["forms"], "lamp"), "I"), json!([9.0, 9.0, 9.0]));
    let error = page.text("error");
    let message = error["message"].as_str().expect("words");
    assert!(
        message.contains("\"paint\"") && !message.contains("lamp") && error["about"] == "scene",
        "{error}"
    );
}
