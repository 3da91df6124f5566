//! `--env`: pictures that surround a scene.
use crate::run::{Place, Ran};

/// A mirror in front of the camera, which looks along -z in a right-handed world.
const MIRROR: &str = "Scale -1 1 1
LookAt 0 0 5 0 0 0 0 1 0
Camera \"perspective\" \"float fov\" 20
WorldBegin
LightSource \"infinite\" \"rgb L\" [9 9 9]
LightSource \"distant\" \"point3 from\" [0 0 2] \"rgb L\" [0.5 0.5 0.5]
Material \"mirror\"
Shape \"disk\" \"float radius\" 0.1
";

/// A portable float map, rows from top to bottom.
fn pfm(width: usize, rows: &[&[[f32; 3]]]) -> Vec<u8> {
    let mut file = format!("PF\n{width} {}\n-1\n", rows.len()).into_bytes();
    let values = rows.iter().rev().flat_map(|row| row.iter().flatten());
    file.extend(values.flat_map(|v| v.to_le_bytes()));
    file
}

fn with_bytes(place: Place, name: &str, bytes: &[u8]) -> Place {
    std::fs::write(place.path(name), bytes).expect("a file");
    place
}

/// Four columns of colours above, black below.
fn quarters() -> Vec<u8> {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
    let wide = |row: [[f32; 3]; 4]| row.iter().flat_map(|c| [*c; 16]).collect::<Vec<_>>();
    let (above, below) = (wide(columns), wide([[0.0; 3]; 4]));
    let rows: Vec<&[[f32; 3]]> =
        (0..32).map(|i| if i < 24 { above.as_slice() } else { below.as_slice() }).collect();
    pfm(64, &rows)
}

fn pixel(place: &Place, scene: &str, x: u32, y: u32) -> [f32; 3] {
    let words = format!("trace {scene} --env sky.pfm --width 100 --height 100 --spp 1 --pixel {x},{y}");
    place.done(&words).pixel()
}

#[test]
fn the_middle_of_the_picture_is_plus_x_and_its_right_half_begins_with_plus_z() {
    // Columns: u 0 to 1/4 is -x by -z, 1/4 to 1/2 -z by +x, 1/2 to 3/4 +x by +z, the last +z by -x.
    let place = with_bytes(Place::new().with("m.pbrt", MIRROR), "sky.pfm", &quarters());
    assert_eq!(pixel(&place, "m.pbrt", 10, 20), [1.0, 0.0, 0.0], "left of -z");
    assert_eq!(pixel(&place, "m.pbrt", 90, 20), [0.0, 1.0, 0.0], "right of -z");
    // Another eye looks back along +z: +x is at its left.
    let back = MIRROR.replace("LookAt 0 0 5 0 0 0", "LookAt 0 0 5 0 0 9");
    let place = place.with("b.pbrt", &back);
    assert_eq!(pixel(&place, "b.pbrt", 10, 20), [0.0, 0.0, 1.0]);
    assert_eq!(pixel(&place, "b.pbrt", 90, 20), [1.0, 1.0, 0.0]);
    // A left-handed world sees the same picture, not its mirror image: turning right means going right in the picture.
    let left_handed = MIRROR.replace("Scale -1 1 1\n", "");
    let place = place.with("l.pbrt", &left_handed);
    let (left, right) = (pixel(&place, "l.pbrt", 10, 20), pixel(&place, "l.pbrt", 90, 20));
    assert_eq!((left, right), ([0.0, 0.0, 1.0], [1.0, 1.0, 0.0]), "-z is half a turn away there");
}

#[test]
fn the_picture_replaces_the_sky_and_leaves_the_other_lights() {
    let matte = MIRROR.replace("mirror", "diffuse").replace("0.1", "1");
    let place = with_bytes(Place::new().with("m.pbrt", &matte), "sky.pfm", &pfm(1, &[&[[0.0; 3]]]));
    let [r, _, _] = pixel(&place, "m.pbrt", 50, 50);
    // The distant light alone: 0.5 reflectance * 0.5 / pi.
    assert!((r - 0.25 / std::f32::consts::PI).abs() < 1e-4, "{r}");
    let json = place.done("info m.pbrt --env sky.pfm --json").json();
    let said = json["diagnostics"].as_array().expect("a list");
    assert!(said.len() == 1 && said[0]["message"].as_str().is_some_and(|m| m.contains("black")), "{json}");
}

#[test]
fn the_replay_line_of_a_bad_sample_names_the_picture() {
    let scaled = "[3e38 3e38 3e38] \"float scale\" 1e10";
    let bright = MIRROR.replace("[0.5 0.5 0.5]", scaled).replace("mirror", "diffuse").replace("0.1", "1");
    let place = with_bytes(Place::new().with("m.pbrt", &bright), "sky.pfm", &pfm(1, &[&[[1.0; 3]]]));
    let ran =
        place.run("render m.pbrt --integrator whitted --env sky.pfm --width 20 --height 20 --spp 1 -o x.exr");
    let line = ran.stderr.lines().find(|l| l.contains("durer trace")).expect("infinite sums are told");
    assert!(line.contains("--env sky.pfm"), "{line}");
}

#[test]
fn pictures_that_cannot_be_had_are_named_with_the_reason() {
    let place = Place::new().with("words.hdr", "hello").with("empty.exr", "").with("cut.exr", "v/1\u{1}");
    for (file, reason) in [
        ("nothing.hdr", "file not found"),
        ("words.hdr", "the name says Radiance HDR, but it does not begin like one"),
        ("empty.exr", "the file is empty"),
        ("cut.exr", "damaged OpenEXR"),
        (".", "is a folder; name a picture in it"),
    ] {
        let ran = place.run(&format!("render --env {file} --width 8 --spp 1 -o x.png"));
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{file}");
        let begin = format!("error: --env {file}: ");
        assert!(ran.stderr.starts_with(&begin) && ran.stderr.contains(reason), "{file}: {}", ran.stderr);
        assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
    }
}

#[test]
fn the_picture_may_lie_anywhere() {
    let elsewhere = with_bytes(Place::new(), "sky.pfm", &pfm(1, &[&[[0.25; 3]]]));
    let place = Place::new().with("m.pbrt", MIRROR);
    let output = place
        .command("trace m.pbrt --width 9 --height 9 --spp 1 --pixel 0,0 --env")
        .arg(elsewhere.path("sky.pfm"))
        .output()
        .expect("durer runs");
    assert_eq!(Ran::of(output).pixel(), [0.25; 3]);
}
