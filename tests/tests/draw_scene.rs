//! The built-in scene `durer` shows what Dürer's machine does, and `durer draw` draws it.
use std::collections::BTreeMap;

use durer::{
    Id, Options, Prepared, SampleCx, builtin,
    glam::DVec3,
    math::{Point2, Point3, Ray, Vector3},
    probe::NoProbe,
    spectrum::Basis,
};
use durer_tests::{prepared, program::program, render};

/// From the scene's text: the eyelet, the plane of the frame, the axis the door hangs on, and how far it is open.
const EYELET: DVec3 = DVec3::new(0.98, 0.86, -0.12);
const FRAME: f64 = 0.10;
const AXIS: f64 = 0.3425;
const OPEN: f64 = 104.0;

fn scene(width: u32) -> Prepared {
    let options = Options { width: Some(width), samples: Some(4), ..Options::default() };
    prepared(builtin::find("durer").expect("built in").import(), &options)
}

/// Parts of the lute.
const LUTE: [&str; 10] =
    ["soundboard", "rib", "neck", "fingerboard", "string", "fret", "rose", "rose ring", "tracery", "nut"];

/// What a ray meets: the object and the place, in world space.
fn met(scene: &Prepared, ray: &Ray) -> Option<(Id<durer::Object>, DVec3)> {
    let cx = SampleCx { scene: &scene.scene, basis: Basis::Rgb };
    let hit = scene.scene.closest(&cx, ray, &mut NoProbe, ())?;
    let (object, surface) = scene.scene.surface(ray, &hit);
    Some((object, DVec3::from_array(scene.scene.view.to_world(surface.p))))
}

fn name(scene: &Prepared, object: Id<durer::Object>) -> &str {
    &scene.scene.object(object).name
}

/// Every object that is seen, with the mean of the places where it is.
fn seen(scene: &Prepared) -> BTreeMap<u32, (DVec3, u32)> {
    let view = &scene.scene.view;
    let mut seen: BTreeMap<u32, (DVec3, u32)> = BTreeMap::new();
    for y in 0..view.height {
        for x in 0..view.width {
            let ray = view.ray(Point2::new(x as f32 + 0.5, y as f32 + 0.5), Point2::new(0.5, 0.5), 0.0);
            if let Some((object, p)) = met(scene, &ray) {
                let all = seen.entry(object.index() as u32).or_default();
                *all = (all.0 + p, all.1 + 1);
            }
        }
    }
    seen
}

#[test]
fn each_dot_is_where_a_thread_from_the_eyelet_to_the_lute_passes_the_frame() {
    let scene = scene(800);
    let mut dots = 0;
    for (object, (sum, n)) in seen(&scene) {
        if name(&scene, Id::new(object)) != "dot" {
            continue;
        }
        let dot = sum / f64::from(n);
        // The door closed again: along it, and out of it.
        let (sin, cos) = OPEN.to_radians().sin_cos();
        let (x, z) = (dot.x - FRAME, dot.z - AXIS);
        let (along, out) = (x * sin - z * cos, x * cos + z * sin);
        assert!(out.abs() < 0.005, "a dot lies on the paper: {out}");
        let on_frame = DVec3::new(FRAME, dot.y, AXIS - along);

        // What a thread from the eyelet touches behind the frame, moved aside a little: dots for an edge lie on it.
        let touches = |dy: f64, dz: f64| {
            let through = on_frame + DVec3::new(0.0, dy, dz);
            let from = through - scene.scene.view.world_from_render;
            let ray = Ray::new(Point3::from_f64(from), Vector3::from_f64((through - EYELET).normalize()));
            met(&scene, &ray).map_or("nothing", |(object, _)| name(&scene, object)).to_owned()
        };
        let aside = 0.005;
        let around = [(0.0, 0.0), (aside, 0.0), (-aside, 0.0), (0.0, aside), (0.0, -aside)];
        let touched = around.map(|(dy, dz)| touches(dy, dz));
        assert!(touched.iter().any(|what| LUTE.contains(&what.as_str())), "{dot}: {touched:?}");
        dots += 1;
    }
    assert!(dots > 40, "{dots} dots are seen");
}

#[test]
fn the_picture_shows_lute_frame_thread_and_weight_in_good_light() {
    let scene = scene(320);
    let mut pixels: BTreeMap<String, u32> = BTreeMap::new();
    for (object, (_, n)) in seen(&scene) {
        *pixels.entry(name(&scene, Id::new(object)).to_owned()).or_default() += n;
    }
    let least = [
        ("soundboard", 2000),
        ("table top", 9000),
        ("paper", 2000),
        ("post", 700),
        ("door", 500),
        ("thread", 100),
    ];
    for (thing, least) in
        least.into_iter().chain([("weight", 50), ("rib", 200), ("rose ring", 20), ("pointer", 15)])
    {
        assert!(pixels.get(thing).is_some_and(|&n| n >= least), "{thing}: {:?}", pixels.get(thing));
    }
    let rendered = render(&scene);
    let mean: f32 = rendered.film.pixels().iter().map(|p| p.mean().iter().sum::<f32>() / 3.0).sum::<f32>()
        / rendered.film.pixels().len() as f32;
    let burnt = rendered.film.pixels().iter().filter(|p| p.mean().iter().any(|&v| v > 1.0)).count();
    assert!((0.1..0.4).contains(&mean) && burnt < 100, "{mean} {burnt}");
}

#[test]
fn the_command_writes_a_group_per_kind_and_a_path_per_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |words: &[&str]| {
        std::process::Command::new(program())
            .args(words)
            .current_dir(folder.path())
            .output()
            .expect("durer runs")
    };
    let done = run(&["draw", "durer", "--width", "200", "--paper", "none", "--stroke", "2"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(String::from_utf8_lossy(&done.stdout), "durer.svg\n");
    let text = std::fs::read_to_string(folder.path().join("durer.svg")).expect("a file");
    assert!(
        text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"150\""),
        "{text}"
    );
    for kind in
        ["id=\"silhouette\" stroke-width=\"2\"", "id=\"boundary\" stroke-width=\"1.4\"", "id=\"crease\""]
    {
        assert_eq!(text.matches(kind).count(), 1, "{kind}");
    }
    assert!(!text.contains("rect") && text.matches("<path d=\"M").count() == text.matches("<path").count());
    let summary = String::from_utf8_lossy(&done.stderr).into_owned();
    let counted: usize = summary
        .split([' ', ','])
        .zip(summary.split([' ', ',']).skip(1))
        .filter(|(_, word)| ["silhouettes", "boundaries", "creases"].contains(word))
        .filter_map(|(n, _)| n.parse::<usize>().ok())
        .sum();
    assert_eq!(counted, text.matches("<path").count(), "{summary}");

    let wrong = run(&["draw", "whitted", "-o", "whitted.png"]);
    assert_eq!(wrong.status.code(), Some(2), "{}", String::from_utf8_lossy(&wrong.stderr));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains(".svg"));
    for words in
        [["--crease", "180"], ["--crease", "0"], ["--rays", "0"], ["--tolerance", "-1"], ["--paper", "blue"]]
    {
        assert_eq!(run(&["draw", "whitted", words[0], words[1]]).status.code(), Some(2), "{words:?}");
    }
    assert_eq!(run(&["draw", "nothing.glb"]).status.code(), Some(1));
    assert!(!folder.path().join("whitted.svg").exists());
}
