//! The built-in scene `cook`: five pool balls of which four move. Highlight, reflection and shadow of a ball are blurred
//! along its path like the ball itself, at the same moments; what stands still is sharp (whitted-cook.md C7).
use std::collections::HashSet;

use durer::{
    Distribution, Gather, Options, Prepared, builtin,
    glam::DVec3,
    integrator::Lights,
    math::{Interval, Point2},
    probe::{RayKind, RayTree, TreeNode},
    sampling::{Dim, Sampler},
};
use durer_tests::{bits, prepared, render};

/// The keys of a ball: times, and places of its middle; all have the radius 1. From the scene's text.
struct Ball {
    name: &'static str,
    keys: &'static [(f64, [f64; 3])],
}

const BALLS: [Ball; 5] = [
    Ball { name: "1", keys: &[(0.0, [-2.55, 1.0, -0.55])] },
    Ball { name: "9", keys: &[(0.0, [-0.75, 1.0, 2.75]), (0.5, [-0.35, 1.0, 1.95]), (1.0, [0.5, 1.0, 2.3])] },
    Ball { name: "8", keys: &[(0.35, [3.35, 1.0, 2.55]), (0.65, [3.6, 1.0, 2.85])] },
    Ball { name: "4", keys: &[(0.72, [2.35, 1.0, -1.0]), (1.0, [2.95, 1.0, -1.4])] },
    Ball { name: "cue ball", keys: &[(0.0, [-0.35, 1.0, -2.4]), (1.0, [0.35, 1.0, -1.45])] },
];

impl Ball {
    /// Its middle: held before the first and after the last key, on straight ways between.
    fn at(&self, time: f64) -> DVec3 {
        let place = |p: [f64; 3]| DVec3::from_array(p);
        let after = self.keys.partition_point(|key| key.0 <= time);
        match (after.checked_sub(1).map(|i| self.keys[i]), self.keys.get(after)) {
            (Some((t0, a)), Some(&(t1, b))) => place(a).lerp(place(b), (time - t0) / (t1 - t0)),
            (Some((_, p)), None) | (None, Some(&(_, p))) => place(p),
            (None, None) => DVec3::NAN,
        }
    }

    /// The ball that an object is part of: itself, its disc, its number.
    fn of(object: &str) -> Option<&'static Self> {
        BALLS.iter().find(|ball| object.split(',').next() == Some(ball.name))
    }
}

const SIZE: [u32; 2] = [64, 48];
const SAMPLES: u32 = 4;

fn cook(options: Options) -> Prepared {
    let (width, samples) = (options.width.or(Some(SIZE[0])), options.samples.or(Some(SAMPLES)));
    let options = Options { width, samples, ..options };
    prepared(builtin::find("cook").expect("built in").import(), &options)
}

fn still(time: f32) -> Prepared {
    cook(Options { time, shutter: Some(Interval::point(0.0)), ..Options::default() })
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

/// The moment of a sample.
fn moment(scene: &Prepared, pixel: [u32; 2], sample: u32) -> f64 {
    let settings = &scene.settings;
    let u = Sampler::new(settings.sampler, settings.seed, pixel, sample, settings.samples).d1(Dim::Time);
    f64::from(scene.scene.view.shutter.moment(u, pixel[1], SIZE[1]))
}

/// A sample of each pixel: where, when, what.
fn trees(scene: &Prepared) -> Vec<([u32; 2], f64, RayTree)> {
    let sample = |[x, y]: [u32; 2]| (x + 3 * y) % scene.settings.samples;
    let tree =
        |pixel| (pixel, moment(scene, pixel, sample(pixel)), scene.job().record(pixel, sample(pixel)).0);
    pixels().map(tree).collect()
}

fn name<'a>(scene: &'a Prepared, node: &TreeNode) -> Option<&'a str> {
    node.hit.map(|hit| scene.scene.object(hit.object).name.as_str())
}

fn world(scene: &Prepared, p: durer::math::Point3) -> DVec3 {
    DVec3::from_array(scene.scene.view.to_world(p))
}

/// How close the way from `a` to `b` comes to `p`.
fn distance(a: DVec3, b: DVec3, p: DVec3) -> f64 {
    let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (a.lerp(b, along) - p).length()
}

#[test]
fn balls_reflections_and_shadows_are_where_the_ball_is_at_the_moment_of_the_sample_c7() {
    let scene = cook(Options::default());
    let (mut seen, mut mirrored, mut shaded) = (Vec::new(), Vec::new(), Vec::new());
    for (_, time, tree) in trees(&scene) {
        for node in &tree.nodes {
            if let (Some(ball), Some(hit)) = (name(&scene, node).and_then(Ball::of), node.hit) {
                let off = (world(&scene, hit.p) - ball.at(time)).length();
                // Numbers are painted a few thousandths above the ball.
                assert!((0.999..1.006).contains(&off), "{} at {time}: {off}", ball.name);
                let list = if node.kind == RayKind::Eye { &mut seen } else { &mut mirrored };
                list.push((ball.name, time));
            }
            let Some((light, point)) = node.light.and_then(|light| Some((light, light.point?))) else {
                continue;
            };
            let (from, to) = (world(&scene, node.o), world(&scene, point));
            let blocker = light.blocker.map(|object| scene.scene.object(object).name.as_str());
            if let Some(ball) = blocker.and_then(Ball::of) {
                assert!(distance(from, to, ball.at(time)) < 1.006, "{} at {time}", ball.name);
                shaded.push((ball.name, time));
            }
            if light.visible {
                let nearest = BALLS.iter().map(|ball| distance(from, to, ball.at(time)));
                assert!(nearest.fold(f64::INFINITY, f64::min) > 0.999, "light through a ball at {time}");
            }
        }
    }
    for ball in &BALLS {
        for (what, list, least) in [("seen", &seen, 80), ("mirrored", &mirrored, 5), ("shaded", &shaded, 80)]
        {
            let times: Vec<f64> =
                list.iter().filter(|(name, _)| *name == ball.name).map(|(_, t)| *t).collect();
            assert!(times.len() >= least, "{} is {what} {} times", ball.name, times.len());
            let span =
                times.iter().fold(0.0, |m: f64, t| m.max(*t)) - times.iter().fold(1.0, |m: f64, t| m.min(*t));
            assert!(span > 0.6, "{} is {what} for {span} s", ball.name);
        }
    }
}

#[test]
fn the_picture_differs_from_stills_where_stills_differ_and_nowhere_else_c7() {
    let moving = bits(&render(&cook(Options::default())));
    let stills: Vec<_> = (0..=16).map(|i| bits(&render(&still(i as f32 / 16.0)))).collect();
    let varies: Vec<bool> = (0..moving.len()).map(|i| stills.iter().any(|s| s[i] != stills[0][i])).collect();
    let blurred: Vec<bool> = (0..moving.len()).map(|i| moving[i] != stills[0][i]).collect();
    let near = |i: usize| {
        let (x, y) = (i % 64, i / 64);
        let around = (y.saturating_sub(1)..(y + 2).min(48))
            .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(64)).map(move |x| y * 64 + x));
        around.into_iter().any(|j| varies[j])
    };
    let count = |of: &dyn Fn(usize) -> bool| (0..moving.len()).filter(|&i| of(i)).count();
    // Between two of the stills an edge may cross a pixel that it has not reached in either.
    assert_eq!(count(&|i| blurred[i] && !near(i)), 0, "blur beside all paths");
    assert!(count(&|i| blurred[i] && !varies[i]) < 40, "{}", count(&|i| blurred[i] && !varies[i]));
    let (inside, outside) = (count(&|i| varies[i]), count(&|i| !near(i)));
    // Four samples may all be of the time that a ball rests in.
    assert!(count(&|i| blurred[i]) > inside * 7 / 10, "{} of {inside}", count(&|i| blurred[i]));
    assert!(outside > 600, "much of the picture is still: {outside}");
}

/// Where a point of the world lies in the picture, in pixels.
fn projected(scene: &Prepared, p: DVec3) -> [f64; 2] {
    let view = &scene.scene.view;
    let [w, h] = [view.width, view.height].map(f64::from);
    let ray = |x: f64, y: f64| view.ray(Point2::new(x as f32, y as f32), Point2::new(0.5, 0.5), 0.0);
    let middle = ray(w / 2.0, h / 2.0);
    let (eye, ahead) = (world(scene, middle.o), middle.d.to_f64());
    let to = p - eye;
    let axis = |x: f64, y: f64| {
        let d = ray(x, y).d.to_f64();
        let side = d / d.dot(ahead) - ahead;
        to.dot(side) / to.dot(ahead) / side.length_squared()
    };
    [w / 2.0 * (1.0 + axis(w, h / 2.0)), h / 2.0 * (1.0 + axis(w / 2.0, h))]
}

/// Where on a ball the eye sees a light mirrored: the normal halves the angle between the ways to both.
fn highlight(eye: DVec3, middle: DVec3, light: DVec3) -> DVec3 {
    let mut normal = DVec3::Y;
    for _ in 0..100 {
        let p = middle + normal;
        normal = ((eye - p).normalize() + (light - p).normalize()).normalize();
    }
    middle + normal
}

#[test]
fn highlights_are_blurred_along_the_path_of_their_ball_c7() {
    let scene = cook(Options { samples: Some(96), ..Options::default() });
    let eye = world(&scene, scene.scene.view.ray(Point2::new(0.0, 0.0), Point2::new(0.5, 0.5), 0.0).o);
    let windows =
        [("window, left", DVec3::new(-7.8, 10.05, -1.3)), ("window, right", DVec3::new(-7.8, 10.05, 1.3))];
    let cue = &BALLS[4];
    let mut found: Vec<([f64; 2], f64)> = Vec::new();
    // Around the way of the highlight.
    for pixel in pixels().filter(|[x, y]| (18..35).contains(x) && (23..38).contains(y)) {
        for sample in 0..96 {
            let tree = scene.job().record(pixel, sample).0;
            let (time, is_cue) =
                (moment(&scene, pixel, sample), name(&scene, &tree.nodes[0]) == Some(cue.name));
            for node in tree
                .nodes
                .iter()
                .filter(|n| is_cue && n.parent == Some(0) && n.kind == RayKind::GlossyReflection)
            {
                let window = windows.iter().find(|(window, _)| name(&scene, node) == Some(window));
                if let Some((_, light)) = window {
                    let at = projected(&scene, highlight(eye, cue.at(time), *light));
                    let off = [0, 1].map(|i| f64::from(pixel[i]) + 0.5 - at[i]);
                    // The windows' image is two pixels wide.
                    assert!(off[0].hypot(off[1]) < 2.5, "{time}: {pixel:?}, expected {at:?}");
                    // Sampling the window leaves the ray nearly half of what it sends.
                    assert!(node.result.max() > 0.434 * 36.0, "{time}: the windows shine into the room");
                    found.push((pixel.map(f64::from), time));
                }
            }
        }
    }
    let mean = |times: std::ops::Range<f64>| {
        let some: Vec<_> = found.iter().filter(|f| times.contains(&f.1)).map(|f| f.0).collect();
        assert!(some.len() > 20, "{}", some.len());
        [0, 1].map(|i| some.iter().map(|p| p[i]).sum::<f64>() / some.len() as f64 + 0.5)
    };
    // As long as the path, between the ends of it.
    let (first, last) = (mean(0.0..0.2), mean(0.8..1.0));
    let ends = [0.1, 0.9].map(|t| projected(&scene, cue.at(t)));
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let (streak, path) = (length(first, last), length(ends[0], ends[1]));
    assert!(path > 5.0 && (streak / path - 1.0).abs() < 0.15, "{streak} {path}");
}

#[test]
fn the_ball_that_stands_still_is_sharp() {
    let (moving, at_rest) = (cook(Options::default()), still(0.0));
    let mut edge = HashSet::new();
    for pixel in pixels().filter(|[x, _]| *x < 22) {
        let hits = |scene: &Prepared| -> Vec<bool> {
            let of_one = |i| {
                name(scene, &scene.job().record(pixel, i).0.nodes[0])
                    .and_then(Ball::of)
                    .is_some_and(|b| b.name == "1")
            };
            (0..SAMPLES).map(of_one).collect()
        };
        let (a, b) = (hits(&moving), hits(&at_rest));
        assert_eq!(a, b, "{pixel:?}");
        if a.contains(&true) && a.contains(&false) {
            edge.insert(pixel);
        }
    }
    assert!((10..80).contains(&edge.len()), "{}", edge.len());
}

/// Metres of a line on the cloth, from 0.6 before `start` to 0.6 behind it, in which part of the lamp is seen past the ball
/// 4: the integral of `4 V (1 - V)` with `V` the visible share. First as rendered, then by the oracle `visible`.
fn penumbra(scene: &Prepared, start: DVec3, along: DVec3, visible: impl Fn(DVec3) -> f64) -> [f64; 2] {
    let (points, step) = (60, 1.2 / 60.0);
    let mut width = [0.0; 2];
    for i in 0..points {
        let point = start + along * (step * (f64::from(i) + 0.5) - 0.6);
        let pixel = projected(scene, point).map(|v| v as u32);
        let (mut seen, mut all, mut expected) = (0.0, 0.0, 0.0);
        for sample in 0..scene.settings.samples {
            let tree = scene.job().record(pixel, sample).0;
            let Some(hit) = tree.nodes[0].hit.filter(|_| name(scene, &tree.nodes[0]) == Some("cloth")) else {
                continue;
            };
            let to_lamp =
                |n: &&TreeNode| n.light.and_then(|l| l.point).is_some_and(|p| world(scene, p).x > 4.0);
            let Some(light) = tree.nodes.iter().find(to_lamp).and_then(|n| n.light) else { continue };
            (seen, all) = (seen + f64::from(u8::from(light.visible)), all + 1.0);
            expected += visible(world(scene, hit.p));
        }
        assert!(all > 50.0, "the cloth is seen at {point}");
        let part = |v: f64| 4.0 * v * (1.0 - v) * step;
        // Of the mean of n samples the square has V (1 - V) / n too much.
        width[0] += part(seen / all) * all / (all - 1.0);
        width[1] += part(expected / all);
    }
    width
}

#[test]
fn shadows_are_sharper_nearer_the_cloth() {
    let options = Options { samples: Some(64), shutter: Some(Interval::point(0.0)), ..Options::default() };
    let distribution = Distribution { lights: Some(Lights::All), ..Distribution::default() };
    let scene = cook(Options { width: Some(640), distribution, ..options });
    // A horizontal disk of the radius 1.6.
    let (ball, lamp) = (BALLS[3].at(0.0), DVec3::new(6.5, 11.0, 6.0));
    let visible = |from: DVec3| {
        let n = 24;
        let cell = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * 3.2 - 1.6;
        let grid = || (0..n).flat_map(|i| (0..n).map(move |j| DVec3::new(cell(i), 0.0, cell(j))));
        let disk = || grid().filter(|p| p.length() < 1.6);
        let free =
            disk().filter(|p| BALLS.iter().all(|b| distance(from, lamp + *p, b.at(0.0)) > 1.0)).count();
        free as f64 / disk().count() as f64
    };
    let away = DVec3::new(ball.x - lamp.x, 0.0, ball.z - lamp.z);
    let slope = (lamp.y - ball.y) / away.length();
    let away = away.normalize();
    let aside = DVec3::new(-away.z, 0.0, away.x);
    let middle = DVec3::new(ball.x, 0.0, ball.z) + away / slope;
    // At the tip the ball's upper part blocks the light, 1.6 above the cloth; at the side its middle, 1 above it.
    let tip = penumbra(&scene, middle + away * (1.0 + slope * slope).sqrt() / slope, away, visible);
    let side = penumbra(&scene, middle + aside, aside, visible);

    assert!(
        [tip, side].iter().all(|[got, expected]| (got / expected - 1.0).abs() < 0.08),
        "{tip:?} {side:?}"
    );
    assert!(tip[0] > 1.4 * side[0], "{tip:?} {side:?}");
}

#[test]
fn all_effects_of_the_scene_have_their_rays() {
    let count = |options: Options| {
        let scene = cook(Options { samples: Some(2), ..options });
        scene.job().render(Gather::Counters, &(), &Default::default()).counters.expect("asked for")
    };
    let counters = count(Options::default());
    let eye = u64::from(SIZE[0] * SIZE[1] * 2);
    assert_eq!(counters.rays(RayKind::Eye), eye);
    assert!(counters.rays(RayKind::Shadow) > eye && counters.rays(RayKind::GlossyReflection) > eye / 5);
    assert_eq!(counters.rays(RayKind::Reflection), 0, "no reflection is perfectly sharp");
}
