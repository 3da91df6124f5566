//! Scenes that are animated, seen at one moment and another.
use std::fs;

use serde_json::{Value, json};

use crate::client::{Client, serve, small};

/// A square that goes from the left to the right in a second, and its numbers.
fn animated() -> (Value, Vec<u8>) {
    let floats: [f32; 20] =
        [-1., -1., 0., 1., -1., 0., 1., 1., 0., -1., 1., 0., 0., 1., -2., 0., 0., 2., 0., 0.];
    let mut bytes: Vec<u8> = floats.iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0u32, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()));
    let view =
        |offset: usize, length: usize| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let document = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 6]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 3}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"},
            {"bufferView": 3, "componentType": 5125, "count": 6, "type": "SCALAR"}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": 2}]}],
        "bufferViews": [view(0, 48), view(48, 8), view(56, 24), view(80, 24)],
        "buffers": [{"uri": "square.bin", "byteLength": bytes.len()}],
    });
    (document, bytes)
}

/// Pixels across.
const WIDTH: usize = 48;

/// The column in the middle of what is not the sky, which changes little along a row.
fn place(rgb8: &[u8]) -> f64 {
    let far = |a: &[u8], b: &[u8]| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 24);
    let of_row = |row: &[u8]| -> Vec<usize> {
        let pixels = row.chunks(3).enumerate();
        pixels.filter(|(_, pixel)| far(pixel, &row[..3])).map(|(column, _)| column).collect()
    };
    let columns: Vec<usize> = rgb8.chunks(3 * WIDTH).flat_map(of_row).collect();
    columns.iter().sum::<usize>() as f64 / columns.len() as f64
}

#[test]
fn an_animated_scene_follows_the_moment_of_each_viewer() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("square.gltf");
    let (document, bytes) = animated();
    fs::write(&file, document.to_string()).expect("written");
    fs::write(folder.path().join("square.bin"), bytes).expect("written");
    let options = durer::Options {
        time: 0.25,
        play: durer::import::Play::First,
        integrator: Some("cast".to_owned()),
        ..small()
    };
    let live = serve(file.to_str().expect("text"), options);
    let mut page = Client::new(&live);
    assert_eq!(page.hello["scene"]["time"], json!([0.0, 1.0]));
    let first = page.finished();
    let at = |page: &mut Client, time: f64| {
        page.say(&json!({ "type": "set", "form": "moment", "param": "time", "value": time }));
        let told = page.text("scene");
        assert_eq!(told["scene"]["revision"], 1);
        page.finished().rgb8
    };
    let right = at(&mut page, 1.0);
    let middle = at(&mut page, 0.5);
    let [a, b, c] = [&first.rgb8, &middle, &right].map(|picture| place(picture));
    assert!(a + 2.0 < b && b + 2.0 < c, "{a} {b} {c}");
    // Who comes now sees it as it was opened.
    let mut late = Client::new(&live);
    assert_eq!(late.finished().rgb8, first.rgb8);
    // Back as it was asked for.
    page.say(&json!({ "type": "reset", "form": "moment" }));
    page.text("scene");
    assert_eq!(page.finished().rgb8, first.rgb8);
}
