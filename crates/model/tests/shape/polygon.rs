//! Polygons: inside and outside, shared edges, area, refusals.
use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3},
};
use durer_model::shape::{
    Polygon, Shape,
    polygon::{FillRule, crossing_number, winding_number},
};
use durer_scene::{Data, Params, ValueType};
use durer_testkit::random::Random;

use super::{build, points, ray, shape};

type Loop = Vec<[f64; 2]>;

fn edges(loops: &[Loop]) -> Vec<[[f64; 2]; 2]> {
    loops.iter().flat_map(|l| (0..l.len()).map(|i| [l[i], l[(i + 1) % l.len()]])).collect()
}

fn lift(loops: &[Loop]) -> Vec<Vec<Point3>> {
    loops.iter().map(|l| l.iter().map(|p| Point3::new(p[0] as f32, p[1] as f32, 0.0)).collect()).collect()
}

/// A star of alternating radii: concave, simple.
fn star(spikes: u32, inner: f64, turn: f64) -> Loop {
    (0..2 * spikes)
        .map(|i| {
            let a = turn * std::f64::consts::TAU * f64::from(i) / f64::from(2 * spikes);
            let r = if i % 2 == 0 { 1.0 } else { inner };
            [r * a.cos(), r * a.sin()]
        })
        .collect()
}

/// Five points of a circle, every second one joined.
fn pentagram() -> Loop {
    (0..5).map(|i| f64::from(2 * i) * std::f64::consts::TAU / 5.0).map(|a| [a.cos(), a.sin()]).collect()
}

#[test]
fn crossings_and_windings_agree_on_simple_polygons() {
    let mut random = Random::new(3);
    let holed = [star(7, 0.6, 1.0), star(5, 0.4, -1.0).iter().map(|p| p.map(|c| c * 0.5)).collect()];
    for loops in [vec![star(9, 0.3, 1.0)], vec![star(4, 0.1, -1.0)], holed.to_vec()] {
        let (edges, mut inside) = (edges(&loops), 0);
        for _ in 0..20_000 {
            let p = [random.between(-1.1, 1.1), random.between(-1.1, 1.1)];
            let (crossings, windings) =
                (crossing_number(p, edges.iter().copied()), winding_number(p, edges.iter().copied()));
            assert_eq!(crossings % 2 == 1, windings != 0, "{p:?}");
            inside += usize::from(windings != 0);
        }
        assert!(inside > 1000 && inside < 19_000);
    }
}

#[test]
fn the_heart_of_a_pentagram_is_wound_around_twice() {
    let edges = edges(&[pentagram()]);
    assert_eq!(winding_number([0.0, 0.0], edges.iter().copied()), 2);
    assert_eq!(crossing_number([0.0, 0.0], edges.iter().copied()) % 2, 0);
    assert_eq!(winding_number([0.8, 0.0], edges.iter().copied()), 1);
    assert_eq!(winding_number([-0.8, 0.0], edges.iter().copied()), 0);
    let p: Vec<[f32; 3]> = pentagram().iter().map(|p| [p[0] as f32, p[1] as f32, 0.0]).collect();
    let (ty, data) = points(&p);
    let params = Params::new().with("P", ty, data);
    let down = Ray::new(Point3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0));
    assert!(shape("polygon", params.clone()).intersect(&down).is_none());
    assert!(shape("polygon", params.string("fillrule", "nonzero")).intersect(&down).is_some());
}

#[test]
fn a_point_on_a_shared_edge_belongs_to_exactly_one_polygon() {
    // A square cut into four triangles around its centre, tested on all edges and vertices of a fine grid.
    let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let parts: Vec<_> =
        (0..4).map(|i| edges(&[vec![corners[i], corners[(i + 1) % 4], [4.0, 4.0]]])).collect();
    let mirrored: Vec<_> =
        (0..4).map(|i| edges(&[vec![corners[(i + 1) % 4], corners[i], [4.0, 4.0]]])).collect();
    for i in 1..32 {
        for j in 1..32 {
            let p = [f64::from(i) * 0.25, f64::from(j) * 0.25];
            for tiling in [&parts, &mirrored] {
                for rule in [FillRule::EvenOdd, FillRule::NonZero] {
                    let owners = tiling.iter().filter(|e| rule.contains(p, e.iter().copied())).count();
                    assert_eq!(owners, 1, "{p:?}");
                }
            }
        }
    }
}

#[test]
fn the_edges_of_a_cube_of_polygons_do_not_leak() {
    let corner = |i: usize| Point3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32);
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        .map(|f| Polygon::new(&[f.map(corner).to_vec()], FillRule::EvenOdd).expect("a square"));
    let centre = DVec3::splat(0.5);
    for axis in 0..3 {
        for i in 0..=64 {
            // Along the twelve edges, ends included: every line from the centre passes exactly one face.
            for (a, b) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (f64::from(i) / 64.0, a, b);
                let out = ray(centre, DVec3::from(p) - centre);
                let hits = faces.iter().filter(|f| f.intersect(&out).is_some()).count();
                assert_eq!(hits, 1, "towards {p:?}");
            }
        }
    }
}

#[test]
fn area_is_exact_also_where_loops_overlap() {
    let square = |x: f64, s: f64| vec![[x, x], [x + s, x], [x + s, x + s], [x, x + s]];
    let area = |loops: &[Loop], rule| Polygon::new(&lift(loops), rule).expect("a polygon").area();
    assert!((area(&[square(0.0, 4.0), square(1.0, 2.0)], FillRule::EvenOdd) - 12.0).abs() < 1e-5);
    assert!((area(&[square(0.0, 4.0), square(1.0, 2.0)], FillRule::NonZero) - 16.0).abs() < 1e-5);
    assert!((area(&[square(0.0, 2.0), square(1.0, 2.0)], FillRule::EvenOdd) - 6.0).abs() < 1e-5);
    // Pentagram of circumradius 1: five tips, and a pentagon of circumradius 1 / golden ratio squared.
    let (tau, golden) = (std::f64::consts::TAU, f64::midpoint(1.0, 5f64.sqrt()));
    let heart = 2.5 * golden.powi(-4) * (tau / 5.0).sin();
    let whole = 5.0 * golden.powi(-2) * (tau / 10.0).sin();
    assert!((f64::from(area(&[pentagram()], FillRule::NonZero)) - whole).abs() < 1e-5);
    assert!((f64::from(area(&[pentagram()], FillRule::EvenOdd)) - (whole - heart)).abs() < 1e-5);
}

#[test]
fn the_normal_follows_the_first_loop_and_uv_its_rectangle() {
    let p = [[1.0, 1.0, 5.0], [3.0, 1.0, 5.0], [3.0, 5.0, 5.0], [1.0, 5.0, 5.0]];
    let (ty, data) = points(&p);
    let square = shape("polygon", Params::new().with("P", ty, data));
    let up = Ray::new(Point3::new(1.5, 4.0, 0.0), Vector3::new(0.0, 0.0, 2.0));
    let s = square.surface(&up, &square.intersect(&up).expect("above"));
    assert_eq!((s.n_g.z, s.uv.x, s.uv.y), (1.0, 0.25, 0.75));
    assert_eq!((s.dpdu, s.dpdv), (Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 4.0, 0.0)));
}

#[test]
fn polygons_that_are_none_are_refused_with_the_reason() {
    let refusal = |p: &[[f32; 3]], counts: &[i32]| {
        let (ty, data) = points(p);
        let params = Params::new().with("P", ty, data);
        let params = if counts.is_empty() {
            params
        } else {
            params.with("counts", ValueType::Integer, Data::Ints(counts.to_vec()))
        };
        build("polygon", params).expect_err("a refusal")
    };
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.01]];
    let said = refusal(&square, &[]);
    assert!(
        said.contains("vertex 3") || said.contains("vertex 0") && said.contains("off the plane"),
        "{said}"
    );
    assert!(refusal(&square[..2], &[]).contains("2 vertices"));
    assert!(refusal(&[[0.0; 3], [1.0; 3], [2.0; 3]], &[]).contains("no area"));
    assert!(refusal(&square, &[3]).contains("adds up to 3"));
    assert!(refusal(&[], &[]).contains("0 vertices"));
}
