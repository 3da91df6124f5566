//! Files to keep.
use durer::Options;
use serde_json::json;

use crate::{
    client::{Client, get, serve, small, token, unpacked},
    picture::rendered,
};

fn save(live: &durer_view::Live, page: &Client, format: &str) -> (u16, String, Vec<u8>) {
    get(live, &format!("/save?token={}&session={}&format={format}", token(live), page.session()))
}

#[test]
fn the_saved_picture_is_that_of_render() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.finished();
    let (code, head, png) = save(&live, &page, "png");
    assert_eq!(code, 200, "{head}");
    let lower = head.to_lowercase();
    assert!(lower.contains("content-disposition: attachment; filename=\"whitted.png\""), "{head}");
    assert_eq!(unpacked(&png), (48, 36, rendered("whitted", &small())));

    let (code, _, exr) = save(&live, &page, "exr");
    assert_eq!(code, 200);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("saved.exr");
    std::fs::write(&file, exr).expect("written");
    let channels = durer::image::read_exr_channels(
        &std::fs::read(&file).expect("read"),
        "saved.exr",
        Default::default(),
    );
    let (width, height, channels) = channels.map(|c| (c.0, c.1, c.2)).expect("an EXR");
    assert_eq!((width, height), (48, 36));
    let mut imported = durer::open("whitted");
    let prepared = durer::prepare(&mut imported, &small()).expect("a sound scene");
    let film = prepared.job().render(Default::default(), &(), &Default::default()).film;
    let red = channels.iter().find(|c| c.name == "R").expect("red");
    let bits = |v: f32| v.to_bits();
    assert!(red.values.iter().zip(film.pixels()).all(|(saved, pixel)| bits(*saved) == bits(pixel.mean()[0])));
}

#[test]
fn the_layer_that_is_shown_is_what_is_saved() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "layer", "layer": "normal" }));
    let shown = page.frame_when(|h| h["layer"] == "normal" && h["done"] == true);
    let (code, _, png) = save(&live, &page, "png");
    assert_eq!((code, unpacked(&png).2), (200, shown.rgb8));
}

#[test]
fn pictures_in_the_making_can_be_saved_too() {
    let live = serve("cornell", Options { samples: Some(100_000), ..small() });
    let mut page = Client::new(&live);
    page.frame_when(|head| head["samples"].as_u64() > Some(0));
    assert_eq!(save(&live, &page, "png").0, 200);
}

/// Saves the scene, reads it again, and renders it.
fn again(live: &durer_view::Live, page: &Client, beside: &std::path::Path) -> (String, Vec<u8>) {
    let (code, head, text) = save(live, page, "pbrt");
    let text = String::from_utf8(text).expect("text");
    assert_eq!(code, 200, "{head}\n{text}");
    let file = beside.join("saved-again.pbrt");
    std::fs::write(&file, &text).expect("written");
    let options = Options { threads: Some(2), ..Options::default() };
    let rgb8 = rendered(file.to_str().expect("text"), &options);
    std::fs::remove_file(&file).expect("removed");
    (text, rgb8)
}

/// Pixels that are not alike.
fn differing(a: &[u8], b: &[u8]) -> usize {
    assert_eq!(a.len(), b.len());
    a.chunks(3).zip(b.chunks(3)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1)).count()
}

#[test]
fn the_saved_scene_is_read_again_as_the_same_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    for builtin in durer::builtin::SCENES {
        let live = serve(builtin.name, small());
        let mut page = Client::new(&live);
        let shown = page.finished();
        let (text, read) = again(&live, &page, folder.path());
        // The camera's place may differ in the last bit.
        let differing = differing(&shown.rgb8, &read);
        assert!(differing <= 3, "{}: {differing} pixels\n{text}", builtin.name);
    }
}

#[test]
fn changes_and_moves_are_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let live = serve("cornell", Options { integrator: Some("path".to_owned()), ..small() });
    let mut page = Client::new(&live);
    let plain = page.finished();
    let camera = page.hello["camera"].clone();
    let eye: Vec<f64> = serde_json::from_value(camera["eye"].clone()).expect("numbers");
    let has = |f: &&serde_json::Value| {
        f["params"].as_array().expect("a list").iter().any(|p| p["name"] == "reflectance")
    };
    let forms = page.hello["forms"].clone();
    let red = forms.as_array().expect("a list").iter().find(has).expect("a matte material")["id"].clone();
    page.say(&json!({ "type": "set", "form": red, "param": "reflectance", "value": [0.9, 0.2, 0.1] }));
    page.say(&json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": 2 }));
    page.say(&json!({ "type": "set", "form": "film", "param": "width", "value": 40 }));
    page.say(&json!({
        "type": "camera", "seq": 3, "eye": [eye[0] * 0.9, eye[1], eye[2] * 0.95], "forward": camera["forward"], "up": camera["up"],
    }));
    let changed = page.frame_when(|h| h["seq"] == 3 && h["film"] == json!([40, 36]) && h["done"] == true);
    let (_, read) = again(&live, &page, folder.path());
    assert!(differing(&changed.rgb8, &read) * 20 < 40 * 36, "{} pixels", differing(&changed.rgb8, &read));
    assert_ne!(read.len(), plain.rgb8.len());
}

#[test]
fn keys_and_what_corners_have_come_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let turning = "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float shutterclose\" 2\nWorldBegin\n\
                   LightSource \"infinite\"\nAttributeBegin\n\
                   TransformKeys \"float times\" [0 1 2] \"point3 translate\" [0 0 0  1 0 0  0 1 0]\n\
                   Shape \"sphere\" \"float radius\" 0.4\nAttributeEnd\n";
    let leaf = include_str!("scenes/leaf.gltf");
    let of_leaf = [
        "\"float handedness\" [ -1 -1 -1 ]",
        "\"vector3 S\" [ 1 0 0 1 0 0 1 0 0 ]",
        // glTF counts v downwards, the language upwards.
        "\"point2 uv2\" [ 0 0 1 0 0.5 1 ]",
        "\"float colors\" [ 1 0.2 0.1 1 0.1 1 0.2 1 0.2 0.1 1 1 ]",
    ];
    for (name, scene, words) in
        [("turning.pbrt", turning, &["\"float matrices\""][..]), ("leaf.gltf", leaf, &of_leaf)]
    {
        let file = folder.path().join(name);
        std::fs::write(&file, scene).expect("written");
        let live = serve(file.to_str().expect("text"), small());
        let mut page = Client::new(&live);
        let shown = page.finished();
        let (text, read) = again(&live, &page, folder.path());
        for word in words {
            assert!(text.contains(word), "{word}: {text}");
        }
        assert!(shown.rgb8.iter().any(|v| *v != shown.rgb8[0]), "{name}: an empty picture");
        let differing = differing(&shown.rgb8, &read);
        assert!(differing <= 3, "{name}: {differing} pixels\n{text}");
    }
}
