//! Slips of the fingers on the command line: each is told what is allowed or what was meant, and costs exit status 2.
use crate::run::Place;

/// A file that can be rendered.
const BALL: &str = "Camera \"perspective\"\nWorldBegin\nTranslate 0 0 3\nShape \"sphere\"\n";

#[test]
fn numbers_of_any_sign_are_told_what_is_allowed() {
    let place = Place::new();
    for (words, allowed) in [
        ("render --width -5", "expected a whole number from 1 to 65536"),
        ("render --width 99999999", "expected a whole number from 1 to 65536"),
        ("render --height 1.5", "expected a whole number from 1 to 65536"),
        ("render --spp abc", "expected a whole number from 1 to"),
        ("render --spp -4", "expected a whole number from 1 to"),
        ("render --seed -1", "expected a whole number from 0 to"),
        ("render --max-depth -1", "expected a whole number from 0 to 1000"),
        ("render --threads -1", "expected a whole number from 1 to 4096"),
        ("render --scale -2", "expected a number above 0"),
        ("render --min-contribution -1", "expected a number from 0 to 1"),
        ("render --crop -1,0,5,5", "expected X0,Y0,X1,Y1"),
        ("trace --pixel -1,-1", "expected X,Y: two whole numbers"),
        ("trace --pixel 1,1 --sample -1", "expected a whole number from 0 to"),
    ] {
        let ran = place.run(words);
        assert_eq!(ran.code, 2, "{words}: {}", ran.stderr);
        assert!(ran.stderr.contains(allowed), "{words}: {}", ran.stderr);
        assert!(!ran.stderr.contains("tip:") && !ran.stderr.contains("-- "), "{words}: {}", ran.stderr);
    }
}

#[test]
fn options_of_other_commands_and_misspelt_ones_are_recognised() {
    let place = Place::new().with("ball.pbrt", BALL);
    for (words, said) in [
        ("info ball.pbrt --width 64", "info has no --width; render, view, trace"),
        ("render --pixel 3,3", "render has no --pixel; trace and explain have"),
        ("render --smaples 4", "did you mean '--spp'?"),
        ("render -spp 4", "did you mean '--spp'?"),
        ("--width 64 render", "options follow the command: durer render --width"),
        ("ball.pbrt", "to render it: durer render ball.pbrt"),
        ("whitted", "to render it: durer render whitted"),
        ("render ball.pbrt ball.pbrt", "render takes one scene"),
    ] {
        let ran = place.run(words);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{words}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{words}: {}", ran.stderr);
    }
}

#[test]
fn samples_is_another_word_for_spp() {
    let place = Place::new().with("ball.pbrt", BALL);
    let stats = place.done("render ball.pbrt --width 4 --height 4 --samples 3 --stats=json").json();
    assert_eq!(stats["spp"], 3);
}

#[test]
fn a_camera_that_the_scene_lacks_is_wrong_usage_and_a_bad_scene_is_not() {
    let place = Place::new().with("ball.pbrt", BALL).with("bad.pbrt", &BALL.replace("sphere", "spere"));
    for command in ["render", "info", "trace --pixel 0,0"] {
        assert_eq!(place.run(&format!("{command} ball.pbrt --camera side")).code, 2, "{command}");
        assert_eq!(place.run(&format!("{command} ball.pbrt --camera 7")).code, 2, "{command}");
        assert_eq!(place.run(&format!("{command} bad.pbrt --camera 0")).code, 1, "{command}");
    }
    assert_eq!(place.run("render ball.pbrt --camera 0 --scale 0.01 --spp 1").code, 0);
}

#[test]
fn scenes_that_do_not_exist_lead_to_those_that_do() {
    let place = Place::new().with("ball.pbrt", BALL);
    std::fs::create_dir(place.path("models")).expect("a folder");
    std::fs::copy(place.path("ball.pbrt"), place.path("models/room.pbrt")).expect("a copy");
    for (scene, said) in [
        ("bal.pbrt", "did you mean ball.pbrt?"),
        ("ball.glb", "did you mean ball.pbrt?"),
        ("ball", "did you mean ball.pbrt?"),
        ("models/rom.pbrt", "did you mean models/room.pbrt?"),
        ("models", "is a folder; name a scene file in it"),
        ("models", "room.pbrt"),
        ("nowhere/x.glb", "there is no such folder either"),
        ("unheard-of.glb", "scene files here: ball.pbrt"),
        ("whited", "did you mean \"whitted\"?"),
    ] {
        let ran = place.run(&format!("render {scene}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{scene}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{scene}: {}", ran.stderr);
    }
}

#[test]
fn a_crop_beyond_the_picture_is_cut_with_a_warning() {
    let place = Place::new().with("ball.pbrt", BALL);
    let words = "render ball.pbrt --width 8 --height 6 --spp 1 --crop";
    let warned = place.done(&format!("{words} 2,1,9999,9999")).stderr;
    assert!(warned.contains("reaches beyond the picture of 8 x 6 pixels: 2,1,8,6 is rendered"), "{warned}");
    assert!(!place.done(&format!("{words} 2,1,8,6")).stderr.contains("warning"));
    assert_eq!(place.run(&format!("{words} 9,9,10,10")).code, 2);
}

#[test]
fn advice_stands_on_a_line_of_its_own_that_begins_alike() {
    let place = Place::new().with("bad.pbrt", "WorldBegin\nShape \"spere\"\n");
    for words in ["render bad.pbrt", "render nothing.glb --lenint", "rendr", "render -o x", "render whited"] {
        let said = place.run(words).stderr;
        assert!(said.lines().any(|line| line.starts_with("  help: ")), "{words}: {said}");
        assert!(!said.contains("Help:") && !said.contains("tip:"), "{words}: {said}");
    }
}
