//! Wrong scenes, wrong files, wrong words: what is said, and with which exit status.
use crate::run::Place;

#[test]
fn every_error_of_a_scene_has_its_place_and_a_caret() {
    let text = "WorldBegin\nMaterial \"difuse\"\n  Shape \"sphere\" \"float raduis\" 1\nShape \"spere\"\n";
    let place = Place::new().with("bad.pbrt", text);
    let ran = place.run("render bad.pbrt");
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    for word in [
        "bad.pbrt:2:10",
        "bad.pbrt:3:18",
        "bad.pbrt:4:7",
        "did you mean \"diffuse\"?",
        "\"radius\"",
        "\"sphere\"",
    ] {
        assert!(ran.stderr.contains(word), "{word} in\n{}", ran.stderr);
    }
    let lines: Vec<&str> = ran.stderr.lines().collect();
    let text = lines.iter().position(|l| l.contains("Material \"difuse\"")).expect("the offending line");
    let column = lines[text].find("\"difuse\"");
    assert_eq!(lines[text + 1].find('^'), column, "the caret is below\n{}", ran.stderr);
    assert_eq!(lines.last(), Some(&"3 errors"));
    assert!(!ran.stderr.contains('\x1b'), "no colour in a pipe");
    assert!(place.holds_only(&["bad.pbrt"]));
}

#[test]
fn texts_that_end_early_or_hold_other_letters_do_not_break_the_report() {
    for text in [
        "",
        "WorldBegin\nShape \"sph\u{e4}re\"",
        "WorldBegin Shape",
        "\u{feff}WorldBegin\n\tShape \"",
        "\0\u{1}",
    ] {
        let place = Place::new().with("x.pbrt", text);
        let ran = place.run("render x.pbrt --scale 0.01 --spp 1");
        assert!(ran.code == 1 || text.is_empty(), "{text:?}: {}", ran.stderr);
        assert!(!ran.stderr.contains("panicked"), "{text:?}: {}", ran.stderr);
    }
}

#[test]
fn what_a_file_holds_cannot_command_the_terminal() {
    let gltf = r#"{"asset": {"version": "2.0"}, "materials": [{"name": "a\u001b[2Jb", "\u001b[31m": {}}],
        "meshes": [{"\u001b]0;x\u0007": 0, "primitives": 3}]}"#;
    let pbrt = "WorldBegin\nMakeNamedMaterial \"a\u{1b}[2Jb\" \"string type\" \"diffuse\"\nShape \"\u{1b}[31msphere\u{9b}\"\n";
    let fine =
        "WorldBegin\nMakeNamedMaterial \"a\u{1b}[2Jb\" \"string type\" \"diffuse\"\nShape \"sphere\"\n";
    let place = Place::new().with("a.gltf", gltf).with("b.pbrt", pbrt).with("c.pbrt", fine);
    for scene in ["a.gltf", "b.pbrt", "c.pbrt"] {
        let ran = place.run(&format!("info {scene}"));
        let said = format!("{}{}", ran.stdout, ran.stderr);
        assert!(
            said.len() > 20 && !said.contains(|c: char| c.is_control() && c != '\n'),
            "{scene}: {said:?}"
        );
    }
    assert!(place.done("info c.pbrt").stdout.contains("a?[2Jb"));
    let bad = place.run("info b.pbrt").stderr;
    let lines: Vec<&str> = bad.lines().collect();
    let text = lines.iter().position(|l| l.contains("Shape \"?[31msphere??\"")).expect("the offending line");
    assert_eq!(lines[text + 1].find('^'), lines[text].find("\"?[31m"), "the caret is below\n{bad}");
}

#[test]
fn missing_files_are_named_once() {
    let place = Place::new();
    for name in ["nothing.pbrt", "nothing.glb", "nothing.gltf"] {
        let ran = place.run(&format!("info {name}"));
        assert_eq!(ran.code, 1);
        assert_eq!(ran.stderr.matches(name).count(), 1, "{}", ran.stderr);
    }
}

#[test]
fn what_the_kernel_refuses_is_named() {
    let far = "WorldBegin\nShape \"sphere\"\nScale 1e38 1e38 1e38\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 9 0]\n";
    let camera = "Camera \"perspective\"\n";
    let place = Place::new().with("far.pbrt", &format!("{camera}{far}"));
    let ran = place.run("render far.pbrt --width 8 --spp 1");
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert!(
        ran.stderr.contains("trianglemesh 1: vertex 2 has a coordinate that is infinite"),
        "{}",
        ran.stderr
    );
}

#[test]
fn near_words_are_offered() {
    let place = Place::new();
    for (words, code, near) in [
        ("render --integrator wited", 2, "'whitted'"),
        ("render --integrator cast --show norml", 2, "'normal'"),
        ("render --tonemap axg", 2, "agx"),
        ("render --acel none", 2, "'--accel'"),
        ("rendr", 2, "'render'"),
        ("render whited", 1, "\"whitted\""),
        ("render scene.blend", 1, ".pbrt"),
    ] {
        let ran = place.run(words);
        assert_eq!(ran.code, code, "{words}");
        assert!(ran.stderr.contains(near), "{words}: {}", ran.stderr);
    }
}

#[test]
fn nonsense_numbers_are_wrong_usage() {
    let place = Place::new();
    for words in [
        "--width 0",
        "--spp 0",
        "--scale -1",
        "--scale nan",
        "--crop 5,5,5,9",
        "--crop 1,2,3",
        "--crop 9000,0,9001,1",
        "--shutter 2,1",
        "--min-contribution 2",
        "--threads 0",
        "--exposure inf",
        "--max-depth 1001",
    ] {
        let ran = place.run(&format!("render {words}"));
        assert_eq!(ran.code, 2, "{words}: {}", ran.stderr);
    }
    assert!(place.holds_only(&[]));
}

#[test]
fn a_bad_destination_is_found_before_the_work() {
    // The scene does not exist either: that would be the complaint if the scene were read first.
    let place = Place::new();
    for (file, code, why) in [
        ("x.tiff", 2, "x.tiff: pictures are not written as .tiff"),
        ("x.pgn", 2, "did you mean .png?"),
        ("x", 2, "add .png or .exr to the name"),
        ("nowhere/x.png", 1, "nowhere"),
        (".", 1, "is a folder: name the picture, such as ./nothing.png"),
    ] {
        let ran = place.run(&format!("render nothing.glb -o ok.png -o {file}"));
        assert_eq!(ran.code, code, "{file}: {}", ran.stderr);
        assert!(ran.stderr.contains(why) && !ran.stderr.contains("nothing.glb"), "{file}: {}", ran.stderr);
    }
    std::fs::create_dir(place.path("folder.png")).expect("a folder");
    let ran = place.run("render -o folder.png");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("folder.png is a folder: name the picture"), "{}", ran.stderr);
    let ran = place.run("trace --pixel 0,0 -o folder.png");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("is a folder"), "{}", ran.stderr);
}

#[test]
fn notes_are_for_those_who_ask() {
    let place = Place::new().with("ball.pbrt", crate::pictures::SPHERE);
    let plain = place.done("render ball.pbrt --spp 1");
    let verbose = place.done("render ball.pbrt --spp 1 -v");
    assert!(!plain.stderr.contains("no light") && verbose.stderr.contains("no light"), "{}", verbose.stderr);
    let warned = place.done("render ball.pbrt --spp 1 --show depth");
    assert!(
        warned.stderr.contains("warning:") && warned.stderr.contains("--integrator cast"),
        "{}",
        warned.stderr
    );
    assert_eq!(place.done("render ball.pbrt --spp 1 --show depth --quiet").stderr, "");
}

#[test]
fn what_a_decoder_panics_of_is_no_message() {
    // Found by fuzzing: its pixels make the decoder's sums overflow, where they are checked.
    let place = Place::new().with(
        "scene.pbrt",
        "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"damaged.ktx2\"\n\
         Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
    );
    std::fs::write(place.path("damaged.ktx2"), include_bytes!("../files/damaged.ktx2")).expect("a file");
    let told = place.run("info scene.pbrt").stderr;
    assert!(!told.contains("panicked"), "{told}");
    assert_eq!(told.contains("its pixel data cannot be decoded"), cfg!(debug_assertions), "{told}");
}
