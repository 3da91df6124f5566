//! `durer render` and the files it writes.
use crate::run::Place;

#[test]
fn without_a_scene_the_built_in_one_goes_to_its_png() {
    let place = Place::new();
    let ran = place.done("render --width 64 --height 48 --spp 1");
    assert_eq!(ran.stdout, "whitted.png\n");
    assert_eq!(place.size("whitted.png"), (64, 48));
    assert!(place.holds_only(&["whitted.png"]));
}

#[test]
fn a_file_names_its_picture_and_scale_keeps_the_aspect() {
    let place = Place::new().with("my.room.pbrt", SPHERE);
    assert_eq!(place.done("render my.room.pbrt --scale 0.5 --spp 1").stdout, "my.room.png\n");
    assert_eq!(place.size("my.room.png"), (16, 12));
    place.done("render my.room.pbrt --width 64 --spp 1 -o wide.png");
    assert_eq!(place.size("wide.png"), (64, 48));
}

#[test]
fn one_render_may_go_to_several_files() {
    let place = Place::new();
    let ran = place.done("render --scale 0.02 --spp 1 -o a.PNG -o b.exr");
    assert_eq!(ran.stdout, "a.PNG\nb.exr\n");
    assert_eq!(place.size("a.PNG"), place.size("b.exr"));
    assert_eq!(place.exr("b.exr").names(), ["B", "G", "R"]);
}

#[test]
fn a_pipe_gets_a_summary_and_no_bar_and_quiet_gets_nothing() {
    let place = Place::new();
    let ran = place.done("render --scale 0.02 --spp 2");
    assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
    for word in ["26 x 14", "2 spp", "whitted", "load", "build", "render", "Mrays/s"] {
        assert!(ran.stderr.contains(word), "{word} in {}", ran.stderr);
    }
    assert!(!ran.stderr.contains('\r') && !ran.stderr.contains('\x1b'));
    assert_eq!(place.done("render --scale 0.02 --spp 2 --quiet").stderr, "");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let place = Place::new();
    place.done("render --scale 0.08 --spp 5 --threads 1 -o one.exr");
    place.done("render --scale 0.08 --spp 5 --threads 4 -o four.exr");
    assert_eq!(place.exr("one.exr").all_bits(), place.exr("four.exr").all_bits());
    place.done("render --scale 0.08 --spp 5 --seed 1 -o seed.exr");
    assert_ne!(place.exr("one.exr").all_bits(), place.exr("seed.exr").all_bits());
}

#[test]
fn how_hits_are_found_changes_no_bit() {
    let place = Place::new();
    place.done("render --scale 0.04 --spp 1 -o default.exr");
    for how in ["none", "fast", "balanced", "high", "bvh"] {
        place.done(&format!("render --scale 0.04 --spp 1 --accel {how} -o {how}.exr"));
        let bits = place.exr(&format!("{how}.exr")).all_bits();
        assert_eq!(place.exr("default.exr").all_bits(), bits, "{how}");
    }
}

#[test]
fn exposure_and_tone_map_are_for_8_bits_only() {
    let place = Place::new();
    place.done("render --scale 0.03 --spp 1 -o plain.exr -o plain.png");
    place.done("render --scale 0.03 --spp 1 --exposure -2.5 --tonemap agx -o looks.exr -o looks.png");
    assert_eq!(place.exr("plain.exr").all_bits(), place.exr("looks.exr").all_bits());
    let bytes = |name| std::fs::read(place.path(name)).expect("a picture");
    assert_ne!(bytes("plain.png"), bytes("looks.png"));
}

#[test]
fn a_crop_leaves_the_rest_black_and_its_inside_as_it_was() {
    let place = Place::new();
    place.done("render --width 40 --height 30 --spp 2 -o whole.exr");
    place.done("render --width 40 --height 30 --spp 2 --crop 10,12,20,18 -o part.exr");
    let (whole, part) = (place.exr("whole.exr"), place.exr("part.exr"));
    assert_eq!(whole.bits(["R", "G", "B"], [19, 17]), part.bits(["R", "G", "B"], [19, 17]));
    assert_eq!(part.bits(["R", "G", "B"], [20, 17]), [0; 3]);
    assert_ne!(whole.bits(["R", "G", "B"], [20, 17]), [0; 3]);
}

#[test]
fn a_depth_picture_tells_its_range_and_holds_both_depths() {
    let place = Place::new().with("ball.pbrt", SPHERE);
    let ran = place.done("render ball.pbrt --integrator cast --show depth -o d.png -o d.exr");
    assert!(ran.stderr.contains("m (nearest) to") && ran.stderr.contains("m (farthest)"), "{}", ran.stderr);
    let exr = place.exr("d.exr");
    let (axis, length) = (exr.channel("depth.Z"), exr.channel("depth.length"));
    assert!(axis.iter().zip(length).all(|(a, l)| *a <= *l * 1.000_001));
    let nearest = axis.iter().copied().filter(|d| *d > 0.0).fold(f32::INFINITY, f32::min);
    assert!((nearest - 3.0).abs() < 0.01, "a ball of radius 1 seen from 4 m: {nearest}");
    assert_eq!(axis[0], 0.0, "nothing is hit in the corner");
}

#[test]
fn data_pictures_name_their_channels() {
    let place = Place::new();
    let shows = [
        ("normal", vec!["normal.X", "normal.Y", "normal.Z"]),
        ("uv", vec!["uv.U", "uv.V"]),
        ("id", vec!["id"]),
        ("albedo", vec!["B", "G", "R"]),
        ("shading", vec!["B", "G", "R"]),
    ];
    for (show, names) in shows {
        place.done(&format!("render --scale 0.02 --spp 1 --integrator cast --show {show} -o x.exr -o x.png"));
        assert_eq!(place.exr("x.exr").names(), names);
    }
}

#[test]
fn a_picture_tells_how_it_was_made() {
    let place = Place::new();
    place.done("render --scale 0.02 --spp 3 --seed 18446744073709551615 -o x.exr");
    let bytes = std::fs::read(place.path("x.exr")).expect("a picture");
    let header = String::from_utf8_lossy(&bytes);
    for key in ["version", "scene", "integrator", "spp", "seed", "seconds", "world_from_camera"] {
        assert!(header.contains(&format!("durer.{key}")), "{key}");
    }
    assert!(header.contains("18446744073709551615") && !header.contains("durer.interrupted"));
}

#[test]
fn an_integrator_that_stands_in_is_named_as_what_it_is() {
    for (word, said, ours) in
        [("simplevolpath", "surfaces, at which", "volpath"), ("mlt", "without mutations", "bdpt")]
    {
        let place = Place::new().with("a.pbrt", &format!("Integrator \"{word}\"\n{SPHERE}"));
        let ran = place.done("render a.pbrt --spp 1");
        let named = ran.stderr.contains(&format!("1 spp, {ours};"));
        assert!(ran.stderr.contains(said) && named, "{}", ran.stderr);
    }
}

/// A ball of radius 1 before a camera 4 m away, without a light.
pub(crate) const SPHERE: &str = r#"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
Material "diffuse"
Shape "sphere" "string name" "ball"
"#;

#[test]
fn a_picture_too_bright_to_see_anything_comes_with_the_exposure_that_helps() {
    let bright = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\nWorldBegin\n\
                  LightSource \"infinite\" \"rgb L\" [184.32 184.32 184.32]\nShape \"sphere\"\n";
    let place = Place::new().with("b.pbrt", bright);
    let said = place.done("render b.pbrt --spp 1").stderr;
    assert!(said.contains("too bright to see anything\n  try --exposure -1"), "{said}");
    for words in ["--exposure -10", "-o b.exr", "--quiet", "--integrator cast --show depth"] {
        let said = place.done(&format!("render b.pbrt --spp 1 {words}")).stderr;
        assert!(!said.contains("try --exposure"), "{words}: {said}");
    }
    let said = place.done("render b.pbrt --spp 1 --exposure -30").stderr;
    assert!(said.contains("too dark to see anything\n  try --exposure -1"), "{said}");
}

#[test]
fn a_black_picture_says_why() {
    let boxed = "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\nLookAt 0 1 -4  0 0 0  0 1 0\n\
                 Camera \"perspective\"\nWorldBegin\nLightSource \"point\" \"string name\" \"lamp\"\n\
                 Shape \"sphere\" \"string name\" \"shade\"\n";
    let place = Place::new().with("b.pbrt", boxed);
    let said = place.done("render b.pbrt --spp 1").stderr;
    let why = "warning: the light \"lamp\" stands behind all surfaces that are seen\n  move it to the side";
    assert!(said.contains(why), "{said}");
    assert_eq!(place.done("render b.pbrt --spp 1 --quiet").stderr, "");
}
