//! `durer draw`: lines from cast rays lie where geometry says, and nowhere else.
use std::f64::consts::PI;

use durer::{
    Options, Prepared, builtin,
    draw::{DVec2, Drawing, Kind, Line, Machine, Paper, Piece, Style, draw, svg},
    glam::DVec3,
};
use durer_tests::{look::Look, prepared};

/// The drawing of a scene with so many threads.
fn drawn_by(scene: &Prepared, machine: Machine) -> Drawing {
    draw(&scene.scene, &machine, &(), &Default::default()).expect("threads").expect("nobody cancels")
}

fn drawn(scene: &Prepared) -> Drawing {
    drawn_by(scene, Machine { threads: 2, ..Machine::default() })
}

const LOOK: Look = Look { eye: DVec3::new(1.3, 1.9, -4.0), size: [240, 180] };

/// Points of all lines, about a third of a pixel apart.
fn points(lines: &[Line]) -> Vec<DVec2> {
    let dense = |line: &Line| {
        let mut start = line.start;
        let mut points = vec![start];
        for piece in &line.pieces {
            let steps = (start.distance(piece.end()) * 3.0).ceil().max(8.0) as u32;
            points.extend((1..=steps).map(|i| piece.at(start, f64::from(i) / f64::from(steps))));
            start = piece.end();
        }
        points
    };
    lines.iter().flat_map(dense).collect()
}

fn length(line: &Line) -> f64 {
    line.points(32).windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn of_kind(drawing: &Drawing, kind: Kind) -> Vec<&Line> {
    drawing.lines.iter().filter(|line| line.kind == kind).collect()
}

#[test]
fn a_sphere_is_its_outline_to_a_twentieth_of_a_pixel() {
    for (center, radius) in
        [(DVec3::ZERO, 1.0), (DVec3::new(-1.0, 0.3, 0.5), 0.6), (DVec3::new(0.4, -0.5, -0.2), 0.05)]
    {
        let DVec3 { x, y, z } = center;
        let world = format!("Translate {x} {y} {z} Shape \"sphere\" \"float radius\" {radius}");
        let drawing = drawn(&LOOK.scene(&world));
        assert_eq!(drawing.lines.len(), 1, "{:?}", drawing.lines);
        let line = &drawing.lines[0];
        assert!(
            line.closed
                && line.kind == Kind::Silhouette
                && line.pieces.last().map(Piece::end) == Some(line.start)
        );
        for at in points(&drawing.lines) {
            let off = LOOK.outside_sphere(at, center, radius);
            assert!(off.abs() < 0.05, "{center} {radius}: {off} at {at}");
        }
        // Once around.
        let [a, b] = [DVec2::X, DVec2::Y].map(|axis| {
            let across = points(&drawing.lines)
                .iter()
                .map(|p| p.dot(axis))
                .fold([f64::MAX, f64::MIN], |m, v| [m[0].min(v), m[1].max(v)]);
            0.5 * (across[1] - across[0])
        });
        // Ramanujan's formula, for axes that nearly are those of the picture.
        let h = ((a - b) / (a + b)).powi(2);
        let around = PI * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        assert!((length(line) / around - 1.0).abs() < 0.02, "{} {around}", length(line));
    }
}

const CUBE: &str =
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]
    \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5]\n";

/// The edges of the cube of edge 2 at the origin that `LOOK` sees, as pairs of points of the picture.
fn visible_edges(look: &Look) -> Vec<(DVec2, DVec2)> {
    let corner =
        |i: usize| DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 }));
    let mut edges = Vec::new();
    for i in 0..8usize {
        for k in (0..3).filter(|k| i >> k & 1 == 0) {
            let j = i | 1 << k;
            // An edge is seen if one of its faces is turned to the eye, which is beyond the planes of those only.
            let is_seen = (0..3).filter(|&f| f != k).any(|f| look.eye[f] * corner(i)[f] > 1.0);
            if is_seen {
                edges.push((look.project(corner(i)), look.project(corner(j))));
            }
        }
    }
    edges
}

#[test]
fn a_cube_is_its_nine_visible_edges() {
    let look = Look { eye: DVec3::new(2.6, 3.1, -5.0), ..LOOK };
    let expected = visible_edges(&look);
    assert_eq!(expected.len(), 9);
    let drawing = drawn(&look.scene(CUBE));
    let mut found = Vec::new();
    for line in &drawing.lines {
        let mut start = line.start;
        for piece in &line.pieces {
            assert!(matches!(piece, Piece::Line(_)), "{line:?}");
            found.push((start, piece.end(), line.kind));
            start = piece.end();
        }
    }
    assert_eq!(found.len(), 9, "{found:#?}");
    for (a, b) in expected {
        let is_it = |p: DVec2, q: DVec2| p.distance(a) < 0.1 && q.distance(b) < 0.1;
        assert!(found.iter().any(|&(p, q, _)| is_it(p, q) || is_it(q, p)), "{a} {b}: {found:#?}");
    }
    let folds = found.iter().filter(|f| f.2 == Kind::Crease).count();
    assert_eq!((folds, of_kind(&drawing, Kind::Boundary).len()), (3, 0));
}

#[test]
fn what_a_sphere_hides_is_not_drawn() {
    let look = Look { eye: DVec3::new(0.0, 0.3, -5.0), ..LOOK };
    let board =
        [[-0.9, -0.7, 1.0], [0.9, -0.6, 1.0], [0.9, 0.5, 1.0], [-0.9, 0.6, 1.0]].map(DVec3::from_array);
    let text: String = board.iter().map(|p| format!("{} {} {}  ", p.x, p.y, p.z)).collect();
    let (center, radius) = (DVec3::new(0.5, 0.1, 0.0), 0.5);
    let world = format!(
        "Shape \"polygon\" \"point3 P\" [{text}]\nTranslate 0.5 0.1 0 Shape \"sphere\" \"float radius\" 0.5"
    );
    let drawing = drawn(&look.scene(&world));
    assert!(drawing.lines.iter().all(|line| line.kind == Kind::Silhouette), "{drawing:#?}");
    assert_eq!(drawing.lines.len(), 2, "{drawing:#?}");
    let corners = board.map(|p| look.project(p));
    let off_board = |p: DVec2| {
        let edges = (0..4).map(|i| (corners[i], corners[(i + 1) % 4]));
        edges
            .map(|(a, b)| {
                ((p - a) - (b - a) * ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0)).length()
            })
            .fold(f64::MAX, f64::min)
    };
    for at in points(&drawing.lines) {
        let outside = look.outside_sphere(at, center, radius);
        assert!(outside > -0.05, "{at}: {outside} inside of the ball");
        assert!(outside < 0.05 || off_board(at) < 0.05, "{at} is on no outline");
    }
    // The board's edge is drawn all the way: its parts that the ball leaves free end on its outline.
    let open =
        drawing.lines.iter().find(|line| !line.closed).expect("the board's outline is cut by the ball");
    for end in [open.start, open.pieces[open.pieces.len() - 1].end()] {
        assert!(look.outside_sphere(end, center, radius).abs() < 0.1, "{end}");
    }
    let free: f64 = (0..4)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            let n = 4000;
            let seen = (0..n).filter(|&k| {
                look.outside_sphere(a.lerp(b, f64::from(k) / f64::from(n)), center, radius) > 0.0
            });
            a.distance(b) * seen.count() as f64 / f64::from(n)
        })
        .sum();
    assert!((length(open) - free).abs() < 0.5, "{} {free}", length(open));
}

#[test]
fn things_that_cut_each_other_have_a_boundary() {
    // A ball half sunk into the floor.
    let world = "Shape \"polygon\" \"point3 P\" [-9 0 -9  9 0 -9  9 0 9  -9 0 9]\nTranslate 0.2 0 0.1 Shape \"sphere\" \"float radius\" 0.8";
    let drawing = drawn(&LOOK.scene(world));
    let boundaries = of_kind(&drawing, Kind::Boundary);
    assert_eq!(boundaries.len(), 1, "{:?}", drawing.lines);
    let ends = [boundaries[0].start, boundaries[0].pieces[boundaries[0].pieces.len() - 1].end()];
    for at in boundaries[0].points(16) {
        let d = LOOK.ray(at);
        let p = LOOK.eye - d * (LOOK.eye.y / d.y);
        let off = (p - DVec3::new(0.2, 0.0, 0.1)).length() - 0.8;
        let pixels = off * LOOK.pixels_per_tan() / LOOK.eye.length();
        // Where the outline lifts off, both are one.
        let near_end = ends.iter().any(|end| end.distance(at) < 4.0);
        assert!(pixels.abs() < if near_end { 0.5 } else { 0.1 }, "{at}: {pixels}");
    }
}

/// Several things that hide, touch and cut each other, of all sorts.
fn still_life() -> String {
    format!(
        "Shape \"polygon\" \"point3 P\" [-3 -1 -2  3 -1 -2  3 -1 3  -3 -1 3]
        AttributeBegin Translate 0.9 -0.4 0.3 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd
        AttributeBegin Translate -0.8 -0.55 0 Rotate 25 0 1 0 Scale 0.45 0.45 0.45 {CUBE} AttributeEnd
        AttributeBegin Translate -0.2 0.6 1.5 Rotate 20 1 0 0 Shape \"disk\" \"float radius\" 0.7 \"float innerradius\" 0.3 AttributeEnd
        ObjectBegin \"pair\" {CUBE} Translate 0 1.6 0 Shape \"sphere\" \"float radius\" 0.6 ObjectEnd
        AttributeBegin Translate 0.1 -0.7 -1 Scale 0.2 0.3 0.2 ObjectInstance \"pair\" AttributeEnd
        AttributeBegin Translate 1.35 -0.6 -0.7 Rotate 40 0 1 0 Scale 0.25 0.4 0.25 ObjectInstance \"pair\" AttributeEnd"
    )
}

/// How far the points of some lines are from others at most, both ways.
fn hausdorff(a: &[DVec2], b: &[DVec2]) -> f64 {
    let one_way = |a: &[DVec2], b: &[DVec2]| {
        let nearest = |p: &DVec2| {
            b.windows(2)
                .map(|w| {
                    let (v, d) = (w[1] - w[0], *p - w[0]);
                    // Between lines there is no line.
                    let u =
                        if v.length() < 3.0 { (d.dot(v) / v.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
                    (d - v * u).length()
                })
                .fold(f64::MAX, f64::min)
        };
        a.iter().map(nearest).fold(0.0, f64::max)
    };
    one_way(a, b).max(one_way(b, a))
}

fn kinds(drawing: &Drawing) -> [usize; 3] {
    [Kind::Silhouette, Kind::Boundary, Kind::Crease].map(|kind| of_kind(drawing, kind).len())
}

#[test]
fn more_rays_move_no_line() {
    let still_life = || LOOK.scene(&still_life());
    let beaker = || {
        prepared(
            builtin::find("beaker").expect("built in").import(),
            &Options { width: Some(240), ..Options::default() },
        )
    };
    for (name, scene) in [("still life", still_life()), ("beaker", beaker())] {
        let [coarse, fine] =
            [1, 2].map(|rays| drawn_by(&scene, Machine { rays, threads: 2, ..Machine::default() }));
        assert_eq!(kinds(&coarse), kinds(&fine), "{name}");
        let off = hausdorff(&points(&coarse.lines), &points(&fine.lines));
        assert!(off < 0.3, "{name}: {off}");
    }
}

#[test]
fn larger_pictures_have_the_same_lines() {
    let coarse = drawn(&LOOK.scene(&still_life()));
    let fine = drawn(&Look { size: LOOK.size.map(|n| 2 * n), ..LOOK }.scene(&still_life()));
    assert_eq!(kinds(&coarse), kinds(&fine));
    let halved: Vec<DVec2> = points(&fine.lines).into_iter().map(|p| 0.5 * p).collect();
    let inside = |p: &DVec2| p.x > 0.0 && p.y > 0.0 && p.x < 240.0 && p.y < 180.0;
    let [a, b] =
        [points(&coarse.lines), halved].map(|all| all.into_iter().filter(inside).collect::<Vec<_>>());
    assert!(hausdorff(&a, &b) < 0.3, "{}", hausdorff(&a, &b));
}

/// A sphere of the radius 1 of 100 352 triangles, with normals or without.
fn ball(with_normals: bool) -> String {
    let n = 224u32;
    let mut places = String::new();
    let mut triangles = String::new();
    for i in 0..=n {
        for j in 0..n {
            let (a, b) = (PI * f64::from(i) / f64::from(n), 2.0 * PI * f64::from(j) / f64::from(n));
            places += &format!("{:.7} {:.7} {:.7} ", a.sin() * b.cos(), a.cos(), a.sin() * b.sin());
            if i < n {
                let at = |i: u32, j: u32| i * n + j % n;
                triangles += &format!(
                    "{} {} {}  {} {} {} ",
                    at(i, j),
                    at(i, j + 1),
                    at(i + 1, j + 1),
                    at(i, j),
                    at(i + 1, j + 1),
                    at(i + 1, j)
                );
            }
        }
    }
    let normals = if with_normals { format!("\"normal N\" [{places}]") } else { String::new() };
    format!("Shape \"trianglemesh\" \"point3 P\" [{places}] \"integer indices\" [{triangles}] {normals}")
}

#[test]
fn what_a_smooth_mesh_is_made_of_is_not_drawn() {
    for with_normals in [false, true] {
        let drawing = drawn(&LOOK.scene(&ball(with_normals)));
        assert_eq!(kinds(&drawing), [1, 0, 0], "{with_normals}");
        assert!(drawing.lines[0].closed);
        for at in points(&drawing.lines) {
            let off = LOOK.outside_sphere(at, DVec3::ZERO, 1.0);
            assert!(off.abs() < 0.1, "{off} at {at}");
        }
    }
}

#[test]
fn instances_are_drawn_where_they_stand() {
    let world = "ObjectBegin \"ball\" Shape \"loopsubdiv\" \"integer levels\" 4 \"integer indices\" [0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4]
        \"point3 P\" [0 1 0  1 0 0  0 0 1  -1 0 0  0 0 -1  0 -1 0] ObjectEnd
        AttributeBegin Translate -1 0 0 Scale 0.5 0.5 0.5 ObjectInstance \"ball\" AttributeEnd
        AttributeBegin Translate 0.6 0.4 0.5 Scale 0.3 0.6 0.3 ObjectInstance \"ball\" AttributeEnd
        AttributeBegin Translate 0.4 -0.5 -0.5 Scale 0.4 0.4 0.4 ObjectInstance \"ball\" AttributeEnd";
    let drawing = drawn(&LOOK.scene(world));
    assert_eq!(kinds(&drawing), [3, 0, 0]);
    for center in [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(0.6, 0.4, 0.5), DVec3::new(0.4, -0.5, -0.5)] {
        let at = LOOK.project(center);
        let middle = |line: &Line| {
            let all = line.points(8);
            all.iter().copied().sum::<DVec2>() / all.len() as f64
        };
        assert!(drawing.lines.iter().any(|line| line.closed && middle(line).distance(at) < 2.0), "{center}");
    }
}

#[test]
fn threads_thinner_than_the_lattice_are_followed_to_their_ends() {
    // A wire a fifth of a pixel wide that passes behind a ball.
    let world = "Translate 0 0 0 Shape \"sphere\" \"float radius\" 0.4
        Shape \"trianglemesh\" \"point3 P\" [-1.5 -0.7 0.6  -1.5 -0.695 0.6  1.5 0.6 0.6  1.5 0.605 0.6] \"integer indices\" [0 1 2 1 3 2]";
    let look = Look { eye: DVec3::new(0.0, 0.0, -5.0), ..LOOK };
    let drawing = drawn(&look.scene(world));
    let way = [DVec3::new(-1.5, -0.7, 0.6), DVec3::new(1.5, 0.6, 0.6)].map(|p| look.project(p));
    let all = points(&drawing.lines);
    for i in 1..60 {
        let at = way[0].lerp(way[1], f64::from(i) / 60.0);
        let is_hidden = look.outside_sphere(at, DVec3::ZERO, 0.4) < 0.3;
        let is_drawn = all.iter().any(|p| p.distance(at) < 0.5);
        assert!(is_hidden || is_drawn, "nothing is drawn at {at}");
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let options = Options { width: Some(160), ..Options::default() };
    let scene = prepared(builtin::find("durer").expect("built in").import(), &options);
    let text = |threads| {
        let drawing = drawn_by(&scene, Machine { threads, ..Machine::default() });
        svg(&drawing, "durer", &Style { stroke: 1.0, paper: Paper::Cream })
    };
    let one = text(1);
    assert!(one.matches("<path").count() > 50, "{one}");
    assert_eq!(one, text(4));
}

#[test]
fn a_drawing_that_is_given_up_is_none() {
    let scene = LOOK.scene("Shape \"sphere\"");
    let given_up = draw(&scene.scene, &Machine::default(), &(), &true.into()).expect("threads");
    assert_eq!(given_up, None);
}
