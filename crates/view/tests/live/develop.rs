//! Pictures to compare with, and layers of what samples are like.
use durer::{
    film::{ToneMap, develop},
    image::{ExrPicture, NamedChannel, encode_exr},
};
use serde_json::json;

use crate::client::{Client, parts, raw, serve, small, token, unpacked};

/// What a file is developed to, or why not.
fn developed(live: &durer_view::Live, session: &str, body: &[u8]) -> (u16, Vec<u8>) {
    let at = live.address();
    let mut request = format!(
        "POST /develop?token={}&session={session} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
        token(live),
        body.len()
    )
    .into_bytes();
    request.extend(body);
    let (code, _, body) = parts(&raw(at, &request));
    (code, body)
}

#[test]
fn light_is_developed_as_the_session_shows_its_own() {
    let (width, height) = (3, 2);
    let light: Vec<[f32; 3]> = (0..6).map(|i| [0.1 * i as f32, 2.0 - 0.3 * i as f32, 0.05]).collect();
    let channel = |(index, name): (usize, &str)| NamedChannel {
        name: name.to_owned(),
        values: light.iter().map(|c| c[index]).collect(),
    };
    let channels = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    let exr = encode_exr(&ExrPicture { width, height, channels, attributes: Vec::new() }).expect("a file");
    let live = serve("cornell", durer::Options { integrator: Some("path".to_owned()), ..small() });
    let mut page = Client::new(&live);
    let session = page.session();
    let (code, png) = developed(&live, &session, &exr);
    let expected = develop(width, height, &light, 0.0, ToneMap::Agx).rgb8;
    assert_eq!((code, unpacked(&png)), (200, (width, height, expected)));
    page.say(&json!({ "type": "set", "form": "look", "param": "exposure", "value": -1.5 }));
    page.say(&json!({ "type": "set", "form": "look", "param": "tonemap", "value": "reinhard" }));
    page.text("forms");
    page.text("forms");
    let (_, png) = developed(&live, &session, &exr);
    assert_eq!(unpacked(&png).2, develop(width, height, &light, -1.5, ToneMap::Reinhard).rgb8);
    // What the browser reads itself is shown as it is here, too.
    let (code, again) = developed(&live, &session, &png);
    assert_eq!((code, unpacked(&again)), (200, unpacked(&png)));
}

#[test]
fn what_is_no_picture_is_refused_in_words() {
    let live = serve("whitted", small());
    let page = Client::new(&live);
    let session = page.session();
    let mut bomb = b"PF\n100000 100000\n-1.0\n".to_vec();
    bomb.extend([0; 64]);
    for (body, word) in [(&b"hello"[..], "not an image"), (&b""[..], "empty"), (&bomb, "pixels")] {
        let (code, why) = developed(&live, &session, body);
        let why = String::from_utf8_lossy(&why).into_owned();
        assert!(code == 415 && why.contains(word), "{code} {why}");
    }
    assert_eq!(developed(&live, "nobody", b"").0, 404);
    // A body that is announced and far too long ends at once.
    let at = live.address();
    let request = format!(
        "POST /develop?token={}&session={session} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\nContent-Length: 999999999999\r\n\r\n",
        token(&live)
    );
    let (code, _, why) = parts(&raw(at, request.as_bytes()));
    assert_eq!(code, 415, "{}", String::from_utf8_lossy(&why));
}

#[test]
fn rays_and_noise_of_samples_are_layers() {
    let live = serve("whitted", durer::Options { samples: Some(8), ..small() });
    let mut page = Client::new(&live);
    assert!(
        ["rays", "noise"]
            .iter()
            .all(|l| page.hello["layers"].as_array().expect("a list").contains(&json!(l)))
    );
    for (layer, sky) in [("rays", [1.0, 0.0, 0.0]), ("noise", [1.0, 0.0, 0.0])] {
        page.say(&json!({ "type": "layer", "layer": layer }));
        let shown = page.frame_when(|h| h["layer"] == layer && h["done"] == true);
        assert!(shown.head["samples"] == 8 && shown.head["white"].as_f64() > Some(0.0), "{}", shown.head);
        assert!(shown.rgb8.iter().any(|v| *v > 200), "{layer}: nothing is white");
        // Nothing is there: one ray, and all samples alike.
        page.say(&json!({ "type": "pick", "id": 5, "x": 2, "y": 1 }));
        let found = page.text("pick");
        let numbers: Vec<f64> = serde_json::from_value(found["rgb"].clone()).expect("numbers");
        assert_eq!(numbers[0], sky[0], "{layer}: {found}");
        assert!((numbers[2] - numbers[1] * numbers[1]).abs() < 1e-4, "{layer}: {found}");
    }
}
