//! Sequences: names, what is left out, Ctrl-C between frames, and videos where `ffmpeg` is installed.
use std::{
    fs,
    io::{BufRead, BufReader, Write},
    path::PathBuf,
    process::{Command, Stdio},
};

use crate::run::Place;

/// A square that moves by 1 to the right in a second.
const MOVING: &str = "Film \"rgb\" \"integer xresolution\" 33 \"integer yresolution\" 20\n\
    Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]\n\
    WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 -1]\n\
    ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n\
    Shape \"polygon\" \"point3 P\" [-1 -1 1  1 -1 1  1 1 1  -1 1 1]\n";

#[test]
fn names_without_a_place_for_the_number_get_one() {
    let place = Place::new().with("x.pbrt", MOVING);
    let ran = place.done("render x.pbrt --spp 1 --frames 0..2");
    assert_eq!(ran.stdout, "x.0000.png\nx.0001.png\nx.0002.png\n");
    assert!(ran.stderr.contains("3 frames in "), "{}", ran.stderr);
    assert!(place.holds_only(&["x.0000.png", "x.0001.png", "x.0002.png", "x.pbrt"]));
}

#[test]
fn a_frame_has_the_bits_of_the_picture_of_its_time() {
    let place = Place::new().with("x.pbrt", MOVING);
    place.done("render x.pbrt --spp 2 --frames 0..6:3 --fps 8 --shutter 0.5f -o f.#.exr");
    place.done("render x.pbrt --spp 2 --time-at 0.375 --shutter 0,0.0625 -o alone.exr");
    assert_eq!(place.exr("f.3.exr").all_bits(), place.exr("alone.exr").all_bits());
    assert_ne!(place.exr("f.6.exr").all_bits(), place.exr("alone.exr").all_bits());
}

#[test]
fn frames_that_exist_can_be_left_out() {
    let place = Place::new().with("x.pbrt", MOVING);
    place.done("render x.pbrt --spp 1 --frames 0..1 -o f.#.png");
    fs::write(place.path("f.0.png"), "mine").expect("written");
    let ran = place.done("render x.pbrt --spp 1 --frames 0..3 --skip-existing -o f.#.png");
    assert_eq!(ran.stdout, "f.2.png\nf.3.png\n");
    assert_eq!(fs::read(place.path("f.0.png")).expect("a file"), b"mine");
    let ran = place.done("render x.pbrt --spp 1 --frames 0..3 --skip-existing -o f.#.png");
    assert!(ran.stdout.is_empty() && ran.stderr.contains("all frames exist"), "{}", ran.stderr);
}

#[test]
fn wrong_words_are_usage_errors() {
    let place = Place::new().with("x.pbrt", MOVING);
    for (words, said) in [
        ("--frames 5..1", "the last frame lies before the first"),
        ("--frames 1..5:0", "the step must be 1 at least"),
        ("--frames 1-5", "expected A..B or A..B:STEP"),
        ("--skip-existing", "--frames"),
        ("-o x.mp4", "a video needs frames"),
        ("--frames 0..1 -o x.avi", "pictures are not written as .avi"),
        ("--frames 0..1 --shutter 2,1f", "must open before it closes"),
    ] {
        let ran = place.run(&format!("render x.pbrt --spp 1 {words}"));
        assert!(ran.code == 2 && ran.stderr.contains(said), "{words}: {} {}", ran.code, ran.stderr);
    }
    assert!(place.holds_only(&["x.pbrt"]));
}

#[test]
#[cfg(unix)]
fn ctrl_c_leaves_whole_frames_only() {
    let place = Place::new().with("x.pbrt", MOVING);
    let mut child = place
        .command("render x.pbrt --spp 100 --threads 1 --frames 0..100000 -o f.#.png")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("durer runs");
    let mut paths = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    let first = paths.next().expect("a frame").expect("a line");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    let mut written: Vec<String> = vec![first];
    written.extend(paths.map(|line| line.expect("a line")));
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert!(written.iter().all(|name| place.size(name) == (33, 20)), "{written:?}");
    let mut left: Vec<&str> = written.iter().map(String::as_str).chain(["x.pbrt"]).collect();
    left.sort_unstable();
    assert!(place.holds_only(&left), "{written:?}");
}

#[test]
fn a_missing_ffmpeg_is_said_before_anything_is_rendered() {
    let place = Place::new().with("x.pbrt", MOVING);
    let mut command = place.command("render x.pbrt --spp 1 --frames 0..1 -o x.mp4");
    let output = command.env("PATH", place.path("nowhere")).output().expect("durer runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && said.contains("ffmpeg, which is not installed"), "{said}");
    assert!(said.contains("install it (apt install ffmpeg"), "{said}");
    assert!(place.holds_only(&["x.pbrt"]));
}

/// `ffmpeg` and `ffprobe`, or a loud word that the test did not run.
fn has_ffmpeg() -> bool {
    let runs = |name: &str| Command::new(name).arg("-version").stdout(Stdio::null()).status().is_ok();
    let has = runs("ffmpeg") && runs("ffprobe");
    if !has {
        let line = b"SKIPPED: videos: ffmpeg is not installed\n";
        std::io::stderr().write_all(line).expect("stderr");
    }
    has
}

/// What `ffprobe` counts: width, height and frames.
fn probed(file: PathBuf) -> String {
    let words = ["-v", "error", "-count_frames", "-show_entries", "stream=width,height,nb_read_frames"];
    let output = Command::new("ffprobe").args(words).args(["-of", "csv=p=0"]).arg(file).output();
    String::from_utf8_lossy(&output.expect("ffprobe runs").stdout).trim().to_owned()
}

#[test]
fn videos_hold_all_frames() {
    if !has_ffmpeg() {
        return;
    }
    let place = Place::new().with("x.pbrt", MOVING);
    for (name, size) in [("x.mp4", "34,20,5"), ("x.webm", "33,20,5"), ("x.gif", "33,20,5")] {
        let ran = place.done(&format!("render x.pbrt --spp 1 --frames 0..4 -o {name}"));
        assert_eq!(ran.stdout, format!("{name}\n"));
        assert_eq!(probed(place.path(name)), size, "{name}");
    }
    assert!(place.holds_only(&["x.gif", "x.mp4", "x.pbrt", "x.webm"]));
}
