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
