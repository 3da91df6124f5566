//! The picture: coarse at first, in the end that of `durer render`, and another after each change.
use std::sync::atomic::AtomicBool;

use durer::{
    Gather, Options,
    film::Pixel,
    picture::{Look, Picture},
    prepare,
};
use serde_json::json;

use crate::client::{Client, serve, small};

/// What `durer render` makes of it.
pub(crate) fn rendered(scene: &str, options: &Options) -> Vec<u8> {
    let mut imported = durer::open(scene);
    let prepared = prepare(&mut imported, options).expect("a sound scene");
    let rendered = prepared.job().render(Gather::Rays, &(), &AtomicBool::new(false));
    let pixels: Vec<Pixel> = rendered.film.pixels();
    let tonemap = Look::usual_tonemap(&prepared.integrator_name);
    let picture = Picture {
        scene,
        prepared: &prepared,
        pixels,
        layers: Vec::new(),
        render: Default::default(),
        interrupted: false,
    };
    picture.develop(Look { exposure: 0.0, tonemap }).rgb8
}

#[test]
fn it_refines_to_the_very_picture_that_render_makes() {
    for (scene, integrator, samples) in
        [("whitted", "whitted", 4), ("cornell", "path", 70), ("cook", "distributed", 3)]
    {
        let options = Options { integrator: Some(integrator.to_owned()), samples: Some(samples), ..small() };
        let live = serve(scene, options.clone());
        let mut page = Client::new(&live);
        let first = page.frame();
        assert_eq!(first.head["samples"], 0, "{scene}");
        assert!(first.width < 48 && first.head["film"] == json!([48, 36]), "{}", first.head);
        let mut last = first;
        while last.head["done"] != true {
            let next = page.frame();
            let count = |f: &crate::client::Frame| f.head["samples"].as_u64().expect("a number");
            assert!(count(&next) >= count(&last) && next.width >= last.width);
            assert!(next.head["frame"].as_u64() > last.head["frame"].as_u64());
            last = next;
        }
        assert_eq!(last.head["samples"], samples);
        assert_eq!(last.rgb8, rendered(scene, &options), "{scene}");
        let status = page.text("status");
        assert!(status["viewers"] == 1, "{status}");
    }
}

#[test]
fn moving_the_camera_starts_anew_and_going_back_gives_the_same_bits() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    let before = page.finished();
    let camera = page.hello["camera"].clone();
    assert_eq!(camera["exact"], true);
    let eye: Vec<f64> = serde_json::from_value(camera["eye"].clone()).expect("numbers");
    let moved = json!([eye[0] + 0.3, eye[1] + 0.2, eye[2]]);
    page.say(&json!({ "type": "camera", "seq": 7, "eye": moved, "forward": camera["forward"], "up": camera["up"] }));
    let first = page.frame_when(|head| head["seq"] == 7);
    assert_eq!(first.head["samples"], 0, "coarse again");
    let after = page.frame_when(|head| head["seq"] == 7 && head["done"] == true);
    assert_ne!(after.rgb8, before.rgb8);
    page.say(&json!({ "type": "camera", "seq": 8, "name": null }));
    assert_eq!(page.text("camera")["exact"], true);
    let back = page.frame_when(|head| head["seq"] == 8 && head["done"] == true);
    assert_eq!(back.rgb8, before.rgb8);
    // To the same place by a pose: the same picture but for rounding.
    page.say(&json!({ "type": "camera", "seq": 9, "eye": camera["eye"], "forward": camera["forward"], "up": camera["up"] }));
    let same = page.frame_when(|head| head["seq"] == 9 && head["done"] == true);
    let differing = same.rgb8.iter().zip(&before.rgb8).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(differing * 50 < same.rgb8.len(), "{differing} of {}", same.rgb8.len());
}

#[test]
fn many_moves_end_at_the_last() {
    let live = serve("cornell", Options { samples: Some(2), ..small() });
    let mut page = Client::new(&live);
    let camera = page.hello["camera"].clone();
    let eye: Vec<f64> = serde_json::from_value(camera["eye"].clone()).expect("numbers");
    for seq in 1..=60 {
        let moved = json!([eye[0] + 0.01 * f64::from(seq), eye[1], eye[2]]);
        page.say(&json!({ "type": "camera", "seq": seq, "eye": moved, "forward": camera["forward"], "up": camera["up"] }));
    }
    let last = page.finished();
    assert_eq!(last.head["seq"], 60);
}

#[test]
fn poses_that_say_nothing_are_refused_and_change_nothing() {
    let live = serve("mirrors", small());
    let mut page = Client::new(&live);
    let before = page.finished();
    for pose in [
        json!({ "type": "camera", "seq": 1, "eye": [0, 0, 0], "forward": [0, 0, 0], "up": [0, 1, 0] }),
        json!({ "type": "camera", "seq": 1, "eye": [0, 0, 0], "forward": [0, 1, 0], "up": [0, 1, 0] }),
        json!({ "type": "camera", "seq": 1, "eye": [1e300, 0, 0], "forward": [0, 1, 0], "up": [0, 0, 1] }),
        json!({ "type": "camera", "seq": 1, "eye": [0, 0, 0] }),
        json!({ "type": "camera", "seq": 1, "name": "nobody" }),
    ] {
        page.say(&pose);
        assert_eq!(page.text("error")["about"], "camera", "{pose}");
        assert_eq!(page.finished().rgb8, before.rgb8);
    }
}

#[test]
fn layers_show_what_casting_rays_shows() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    let layers = page.hello["layers"].clone();
    for layer in layers
        .as_array()
        .expect("a list")
        .iter()
        .filter(|l| durer::Show::from_word(l.as_str().unwrap_or_default()).is_some())
    {
        page.say(&json!({ "type": "layer", "layer": layer }));
        let frame = page.frame_when(|head| head["layer"] == *layer && head["done"] == true);
        let show = durer::Show::from_word(layer.as_str().expect("a word"));
        let options = Options { integrator: Some("cast".to_owned()), show, samples: None, ..small() };
        assert_eq!(frame.rgb8, rendered("whitted", &options), "{layer}");
        assert_eq!(frame.head["range"].is_array(), layer == "depth", "{}", frame.head);
        assert_eq!(frame.head["white"].is_number(), layer == "cost", "{}", frame.head);
    }
    page.say(&json!({ "type": "layer", "layer": "xray" }));
    assert_eq!(page.text("error")["about"], "layer");
    page.say(&json!({ "type": "layer", "layer": "beauty" }));
    assert_eq!(
        page.frame_when(|h| h["layer"] == "beauty" && h["done"] == true).rgb8,
        rendered("whitted", &small())
    );
}

#[test]
fn a_pause_stops_the_picture_until_it_is_over() {
    let live = serve("cornell", Options { samples: Some(5000), ..small() });
    let mut page = Client::new(&live);
    page.frame();
    page.say(&json!({ "type": "pause", "paused": true }));
    let paused = loop {
        let status = page.text("status");
        if status["paused"] == true {
            break status;
        }
    };
    page.say(&json!({ "type": "forms", "ids": ["look"] }));
    page.text("forms");
    page.say(&json!({ "type": "pick", "id": 3, "x": 1, "y": 1 }));
    let pick = page.text("pick");
    assert_eq!(pick["samples"], paused["samples"], "none was taken since");
    page.say(&json!({ "type": "pause", "paused": false }));
    page.frame_when(|head| head["samples"].as_u64() > paused["samples"].as_u64());
}
