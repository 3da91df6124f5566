//! Ctrl-C.
use std::{
    io::{BufRead, BufReader, Read},
    process::{Command, Stdio},
};

use crate::run::Place;

#[test]
#[cfg(unix)]
fn an_interrupted_render_leaves_the_picture_so_far() {
    let place = Place::new();
    let mut child = place
        .command("render --scale 0.1 --spp 100000000 -v -o x.png -o x.exr")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("durer runs");
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut line = String::new();
    while !line.starts_with("rendering ") {
        line.clear();
        assert_ne!(stderr.read_line(&mut line).expect("a line"), 0, "it ended before it rendered");
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).expect("the rest");
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(130), "{rest}");
    assert!(rest.contains("interrupted"), "{rest}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "x.png\nx.exr\n");
    assert_eq!(place.size("x.png"), (128, 72));
    let bytes = std::fs::read(place.path("x.exr")).expect("a picture");
    assert!(String::from_utf8_lossy(&bytes).contains("durer.interrupted"));
}
