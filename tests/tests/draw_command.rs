//! `durer draw`: parts of pictures, small pictures, and what the command refuses.
use std::process::Output;

use durer::{
    Options, Prepared, builtin,
    draw::{DVec2, Drawing, Kind, Machine, Tones, draw, hatch},
    film::Tile,
    math::{Point2, Ray},
};
use durer_tests::{look::Look, prepared, program::program};

fn lute(width: u32) -> Prepared {
    let options = Options { width: Some(width), samples: Some(1), ..Options::default() };
    prepared(builtin::find("durer").expect("built in").import(), &options)
}

fn drawn(scene: &Prepared, machine: Machine) -> Drawing {
    let machine = Machine { threads: 2, ..machine };
    draw(&scene.scene, &machine, &(), &Default::default()).expect("threads").expect("nobody cancels")
}

fn points(drawing: &Drawing) -> Vec<DVec2> {
    drawing.lines.iter().flat_map(|line| line.points(24)).collect()
}

fn nearest(at: DVec2, all: &[DVec2]) -> f64 {
    all.iter().map(|p| p.distance(at)).fold(f64::MAX, f64::min)
}

/// Where the dots on the paper are that are wholly seen, in pixels of a picture of this width.
fn dots(width: u32) -> Vec<DVec2> {
    let fine = lute(1600);
    let view = &fine.scene.view;
    let cx = durer::SampleCx { scene: &fine.scene, basis: durer::spectrum::Basis::Rgb };
    let mut found: std::collections::BTreeMap<usize, (DVec2, f64)> = Default::default();
    for y in 0..view.height {
        for x in 0..view.width {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let ray: Ray = view.ray(Point2::new(at.x as f32, at.y as f32), Point2::new(0.5, 0.5), 0.0);
            let Some(hit) = fine.scene.closest(&cx, &ray, &mut durer::probe::NoProbe, ()) else { continue };
            let object = fine.scene.resolve(&hit).0;
            if fine.scene.object(object).name == "dot" {
                let all = found.entry(object.index()).or_default();
                *all = (all.0 + at, all.1 + 1.0);
            }
        }
    }
    let scale = f64::from(width) / f64::from(view.width);
    found.values().filter(|(_, n)| *n > 6.0).map(|(sum, n)| *sum / *n * scale).collect()
}

#[test]
fn small_drawings_have_the_dots_on_the_paper() {
    for width in [320, 640] {
        let scene = lute(width);
        let size = [scene.scene.view.width, scene.scene.view.height];
        let (dots, near) = (dots(width), 2.5 * f64::from(width) / 1600.0 + 0.4);
        assert!(dots.len() > 40, "{}", dots.len());
        let missing = |rays: u32| {
            let all = points(&drawn(&scene, Machine { rays, ..Machine::default() }));
            dots.iter().filter(|dot| nearest(**dot, &all) > near).count()
        };
        let (chosen, one) = (missing(Machine::rays_for(size)), missing(1));
        assert!(chosen * 20 <= dots.len(), "{width}: {chosen} of {} are missing", dots.len());
        assert!(width > 320 || one > 2 * chosen + 3, "{width}: {one} with one ray, {chosen} with more");
    }
    assert_eq!([[1280, 720], [640, 360], [40, 30]].map(Machine::rays_for), [1, 2, 8]);
}

#[test]
fn a_part_of_a_drawing_is_that_part() {
    let scene = lute(320);
    let window = Tile { x0: 90, y0: 60, x1: 190, y1: 130 };
    let [whole, part] =
        [None, Some(window)].map(|window| drawn(&scene, Machine { rays: 2, window, ..Machine::default() }));
    assert_eq!(part.part, window);
    assert!(part.rays < whole.rays / 2, "{} {}", part.rays, whole.rays);
    let [all, some] = [&whole, &part].map(points);
    let inside = |margin: f64| {
        move |p: &&DVec2| {
            (90.0 + margin..190.0 - margin).contains(&p.x) && (60.0 + margin..130.0 - margin).contains(&p.y)
        }
    };
    assert!(some.iter().all(|p| inside(-1.5)(&p)), "nothing else is drawn");
    let middle: Vec<&DVec2> = all.iter().filter(inside(3.0)).collect();
    assert!(middle.len() > 500, "{}", middle.len());
    let far = middle.iter().filter(|p| nearest(***p, &some) > 0.5).count();
    assert!(far * 50 < middle.len(), "{far} of {} points are missing", middle.len());
    let other = some.iter().filter(inside(3.0)).filter(|p| nearest(**p, &all) > 0.5).count();
    assert!(other * 50 < middle.len(), "{other} points are not in the whole");
}

#[test]
fn strokes_of_a_part_lie_in_it() {
    let look = Look { eye: durer::glam::DVec3::new(0.0, 0.5, -4.0), size: [240, 180] };
    let wall = look.scene("Shape \"polygon\" \"point3 P\" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]");
    let tones = Tones::new([40, 30], &[[0.0; 3]; 1200]).expect("a picture").with_corner([150, 100]);
    let strokes =
        hatch(&wall.scene, &Machine::default(), &tones, 5.0, &Default::default()).expect("nobody cancels");
    assert!(strokes.len() > 5 && strokes.iter().all(|s| s.kind == Kind::Hatch), "{}", strokes.len());
    for at in strokes.iter().flat_map(|s| s.points(8)) {
        assert!((149.5..190.5).contains(&at.x) && (99.5..130.5).contains(&at.y), "{at}");
    }
}

#[test]
fn the_command_draws_a_part_and_refuses_what_it_cannot_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |words: &str| -> Output {
        let words = words.split_whitespace();
        std::process::Command::new(program())
            .args(words)
            .current_dir(folder.path())
            .output()
            .expect("it runs")
    };
    let done = run("draw durer --width 200 --crop 50,40,150,90 --hatch --spp 1");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = std::fs::read_to_string(folder.path().join("durer.svg")).expect("a file");
    assert!(text.contains("width=\"100\" height=\"50\" viewBox=\"50 40 100 50\""), "{text}");
    assert!(text.contains("<rect id=\"paper\" x=\"50\" y=\"40\"") && text.contains("id=\"hatch\""), "{text}");
    for (words, why) in [
        ("--hatch=0.5", "strokes are at least 1 pixel apart"),
        ("--width 200 --crop 300,40,350,90", "nothing to draw"),
    ] {
        let ran = run(&format!("draw durer {words}"));
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(ran.status.code() == Some(2) && said.contains(why), "{words}: {said}");
    }
    let help = String::from_utf8_lossy(&run("draw --help").stdout).into_owned();
    assert!(help.contains("count for --hatch only"), "{help}");
}
