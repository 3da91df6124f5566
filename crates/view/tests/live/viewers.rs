//! Several pages at once, slow ones, sleepy ones.
use durer::Options;
use serde_json::json;

use crate::client::{Client, serve, small};

#[test]
fn every_viewer_has_his_own_camera_and_settings() {
    let live = serve("whitted", small());
    let (mut one, mut two) = (Client::new(&live), Client::new(&live));
    assert_ne!(one.session(), two.session());
    let plain = one.finished();
    assert_eq!(two.finished().rgb8, plain.rgb8);
    two.say(&json!({ "type": "kind", "form": "integrator", "kind": "path" }));
    let other = two.finished();
    assert_ne!(other.rgb8, plain.rgb8);
    one.say(&json!({ "type": "set", "form": "film", "param": "seed", "value": 0 }));
    assert_eq!(one.finished().rgb8, plain.rgb8, "the first one sees nothing of it");
    let mut status = one.text("status");
    while status["viewers"] != 2 {
        status = one.text("status");
    }
}

#[test]
fn a_viewer_that_never_draws_slows_nobody() {
    let live = serve("cornell", Options { samples: Some(200), ..small() });
    let mut slow = Client::new(&live);
    slow.acks = false;
    let first = slow.frame();
    let mut quick = Client::new(&live);
    quick.finished();
    // The slow one has got no second frame; once it draws the newest comes, and not all in between.
    slow.acks = true;
    slow.say(&json!({ "type": "ack", "frame": first.head["frame"] }));
    let next = slow.frame();
    assert_eq!(next.head["frame"].as_u64(), first.head["frame"].as_u64().map(|n| n + 1));
    assert!(next.head["samples"].as_u64() > Some(0), "{}", next.head);
}

#[test]
fn a_viewer_that_slept_finds_everything_as_it_was() {
    let live = serve("whitted", small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": 1 }));
    page.text("forms");
    let before = page.finished();
    let session = page.session();
    drop(page);
    let mut again = Client::with(&live, &format!("&session={session}"));
    assert_eq!((again.hello["resumed"].clone(), again.session()), (json!(true), session));
    let frame = again.frame();
    assert_eq!(frame.head["done"], true, "the film was kept: {}", frame.head);
    assert_eq!(frame.rgb8, before.rgb8);
    let forms = again.hello["forms"].as_array().expect("a list");
    assert!(forms.iter().any(|f| f["id"] == "integrator" && f["changed"] == true));
    let strange = Client::with(&live, "&session=unknown");
    assert_eq!(strange.hello["resumed"], false);
}

#[test]
fn a_session_has_one_page() {
    let live = serve("mirrors", small());
    let mut one = Client::new(&live);
    let two = Client::with(&live, &format!("&session={}", one.session()));
    assert_eq!(two.hello["resumed"], true);
    assert_eq!(one.closed(), Some(1008));
}

#[test]
fn a_copy_begins_where_the_other_is() {
    let live = serve("whitted", small());
    let mut one = Client::new(&live);
    one.say(&json!({ "type": "set", "form": "integrator", "param": "maxdepth", "value": 0 }));
    one.text("forms");
    let dark = one.finished();
    let mut two = Client::with(&live, &format!("&from={}", one.session()));
    assert_eq!(two.hello["resumed"], false);
    assert_ne!(two.session(), one.session());
    assert_eq!(two.finished().rgb8, dark.rgb8);
}

#[test]
fn old_sessions_make_room_for_new_ones() {
    let live = serve("mirrors", small());
    let first = Client::new(&live).session();
    // Sixteen are kept: of those that nobody looks at the oldest goes.
    for _ in 0..20 {
        drop(Client::new(&live));
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let page = Client::with(&live, &format!("&session={first}"));
    assert_eq!(page.hello["resumed"], false);
}
