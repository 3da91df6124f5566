//! `durer convert`: its words, what it writes, what it refuses.
use std::fs;

use crate::run::Place;

const BALL: &str = "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n\
                    LightSource \"infinite\"\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"paint.png\"\n\
                    Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n";

fn place() -> Place {
    let place = Place::new().with("ball.pbrt", BALL);
    let png =
        durer::image::encode_png(1, 1, &[200, 100, 50], durer::image::Packing::Quick).expect("a picture");
    fs::write(place.path("paint.png"), png).expect("written");
    place
}

#[test]
fn both_formats_are_written_with_their_files_and_named_on_stdout() {
    let place = place();
    fs::create_dir(place.path("out")).expect("made");
    let ran = place.done("convert ball.pbrt out/copy.pbrt");
    assert_eq!(ran.stdout.lines().collect::<Vec<_>>(), ["out/copy.pbrt", "out/copy-files"]);
    assert_eq!(fs::read(place.path("out/copy-files/paint.png")).ok(), fs::read(place.path("paint.png")).ok());
    for scene in ["ball.pbrt", "out/copy.pbrt"] {
        place.done(&format!("render {scene} -o {scene}.png --width 20 --height 20 --spp 4 --quiet"));
    }
    let picture = |name: &str| fs::read(place.path(name)).expect("a picture");
    assert_eq!(picture("ball.pbrt.png"), picture("out/copy.pbrt.png"));

    let ran = place.done("convert ball.pbrt -o ball.glb");
    assert_eq!(ran.stdout, "ball.glb\n");
    assert!(ran.stderr.contains("\"infinite\" is left out"), "{}", ran.stderr);
    assert!(!place.done("convert ball.pbrt ball.glb --force --quiet").stderr.contains("warning"), "quiet");
    place.done("render ball.glb --width 20 --height 20 --spp 1 -o b.png --quiet");
    // Options are what is written.
    place.done("convert cornell wide.pbrt --width 123 --spp 7 --integrator direct --quiet");
    let text = fs::read_to_string(place.path("wide.pbrt")).expect("text");
    for word in ["\"integer xresolution\" [ 123 ]", "\"integer pixelsamples\" [ 7 ]", "Integrator \"direct\""]
    {
        assert!(text.contains(word), "{word}\n{text}");
    }
}

#[test]
fn nothing_is_written_over_unasked() {
    let place = place().with("there.pbrt", "# mine\n").with("there.glb", "mine");
    for file in ["there.pbrt", "there.glb"] {
        let ran = place.run(&format!("convert ball.pbrt {file}"));
        assert_eq!(ran.code, 1, "{}", ran.stderr);
        assert!(ran.stderr.contains("is there already") && ran.stderr.contains("--force"), "{}", ran.stderr);
    }
    assert_eq!(fs::read_to_string(place.path("there.pbrt")).expect("text"), "# mine\n");
    fs::create_dir(place.path("new-files")).expect("made");
    fs::write(place.path("new-files/mine.png"), "mine").expect("written");
    let ran = place.run("convert ball.pbrt new.pbrt");
    assert!(ran.code == 1 && ran.stderr.contains("new-files"), "{}", ran.stderr);
    assert!(!place.path("new.pbrt").exists());
    place.done("convert ball.pbrt there.pbrt --force");
    // Not even with it over the scene itself, whose files it would lose.
    let ran = place.run("convert ball.pbrt ./ball.pbrt --force");
    assert!(ran.code == 2 && ran.stderr.contains("the scene itself"), "{} {}", ran.code, ran.stderr);
    assert_eq!(fs::read_to_string(place.path("ball.pbrt")).expect("text"), BALL);
}

#[test]
fn what_cannot_be_converted_is_refused_in_words() {
    let place = place()
        .with("broken.pbrt", "WorldBegin Shape \"spere\"")
        .with("cut.glb", "glTF")
        .with("notes.txt", "hm");
    for (words, code, said) in [
        ("convert ball.pbrt ball.usd", 2, ".usd"),
        ("convert ball.pbrt ball.pbt", 2, "did you mean .pbrt?"),
        ("convert ball.pbrt ball", 2, "does not say which format"),
        ("convert ball.pbrt", 2, "OUT"),
        ("convert ball.pbrt a.pbrt -o b.pbrt", 2, "cannot be used"),
        ("convert ball.pbrt none/ball.pbrt", 1, "there is no folder"),
        ("convert bal.pbrt x.pbrt", 1, "did you mean ball.pbrt?"),
        ("convert broken.pbrt x.pbrt", 1, "did you mean \"sphere\"?"),
        ("convert cut.glb x.pbrt", 1, "cut.glb"),
        ("convert notes.txt x.glb", 1, "notes.txt"),
        ("convert ball.pbrt x.pbrt --camera side", 2, "side"),
    ] {
        let ran = place.run(words);
        assert!(ran.stderr.contains(said), "{words}: {}", ran.stderr);
        assert_eq!(ran.code, code, "{words}: {}", ran.stderr);
        assert!(!place.path("x.pbrt").exists() && !place.path("x.glb").exists(), "{words}");
    }
}
