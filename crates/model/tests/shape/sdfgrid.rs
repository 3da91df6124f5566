//! Distances on a grid, against spheres and planes.
use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Ray, Vector3},
};
use durer_model::shape::{Outline, SdfGrid, Shape};
use durer_scene::{Data, Params, ValueType};
use durer_testkit::random::Random;

use super::{build, ray, shape};

/// The grid of a distance over the cube from -1 to 1, `n` values along each axis.
pub(super) fn grid(n: usize, distance: impl Fn(DVec3) -> f64) -> Params {
    let place = |i: usize| -1.0 + 2.0 * i as f64 / (n - 1) as f64;
    let values = (0..n * n * n)
        .map(|i| distance(DVec3::new(place(i % n), place(i / n % n), place(i / (n * n)))) as f32);
    let params = Params::new().with("distance", ValueType::Float, Data::Floats(values.collect()));
    let corner = |v: f32| Data::Floats(vec![v; 3]);
    let params = ["nx", "ny", "nz"].into_iter().fold(params, |p, name| p.int(name, n as i32));
    params.with("p0", ValueType::Point3, corner(-1.0)).with("p1", ValueType::Point3, corner(1.0))
}

pub(super) fn ball(n: usize) -> Params {
    grid(n, |p| p.length() - 0.7)
}

fn made(params: Params) -> Arc<dyn Shape> {
    shape("sdfgrid", params)
}

#[test]
fn a_plane_between_distances_is_met_where_it_is() {
    let n = DVec3::new(0.3, -0.5, 0.81).normalize();
    let wall = made(grid(9, |p| n.dot(p) - 0.123));
    let mut random = Random::new(3);
    let mut hits = 0;
    for _ in 0..20_000 {
        let ray = ray(random.direction() * 0.95 * random.between(0.0, 0.6), random.direction());
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let t = (0.123 - n.dot(o)) / n.dot(d);
        let p = o + d * t;
        let expected = t > 1e-4 && p.abs().max_element() < 1.0 - 1e-6;
        if t.abs() < 1e-4 || (p.abs().max_element() - 1.0).abs() < 1e-6 {
            continue;
        }
        let hit = wall.intersect(&ray);
        assert_eq!(hit.is_some(), expected, "{ray:?} {t}");
        let Some(hit) = hit else { continue };
        hits += 1;
        assert!((f64::from(hit.t) - t).abs() < 1e-6 / n.dot(d).abs(), "{} {t}", hit.t);
        let s = wall.surface(&ray, &hit);
        assert!((DVec3::from(s.n_g.to_array().map(f64::from)) - n).length() < 1e-5);
        assert!((DVec3::from(s.n_s.to_array().map(f64::from)) - n).length() < 1e-5);
    }
    assert!(hits > 5000, "{hits}");
}

#[test]
fn a_sphere_between_distances_is_as_near_as_its_cells_are_small() {
    let mut random = Random::new(5);
    for (n, most) in [(17, 6e-3), (33, 1.5e-3), (65, 4e-4)] {
        let ball = made(ball(n));
        for _ in 0..4000 {
            let o = random.direction() * 3.0;
            let to = random.direction() * random.between(0.0, 0.66);
            let ray = ray(o, to - o);
            let hit = ball.intersect(&ray).expect("the ray goes into it");
            let s = ball.surface(&ray, &hit);
            let p = s.p.to_f64();
            assert!((p.length() - 0.7).abs() < most, "{n}: {}", p.length());
            let n_s = DVec3::from(s.n_s.to_array().map(f64::from));
            assert!((n_s - p.normalize()).length() < 8.0 * most, "{n}: {n_s} {p}");
        }
        let area = 4.0 * std::f64::consts::PI * 0.49;
        assert!((f64::from(ball.area()) / area - 1.0).abs() < 4.0 * most, "{n}: {}", ball.area());
    }
}

#[test]
fn rays_that_go_in_come_out_also_along_faces_and_edges_of_cells() {
    // Walks from hit to hit as rays are spawned, counting them: two for every line through the ball.
    let ball = made(ball(17));
    let count = |mut ray: Ray| {
        let starts_inside = ray.o.to_f64().length() < 0.7;
        let mut hits = 0;
        while let Some(hit) = ball.intersect(&ray) {
            let s = ball.surface(&ray, &hit);
            let inwards = s.n_g.dot(ray.d) < 0.0;
            assert_eq!(inwards, (hits % 2 == 0) != starts_inside, "{ray:?}");
            ray = s.spawn(ray.d, 0.0);
            hits += 1;
            assert!(hits < 10);
        }
        hits
    };
    let mut random = Random::new(11);
    for _ in 0..20_000 {
        let o = random.direction() * 2.0;
        let to = random.direction() * random.between(0.0, 0.66);
        assert_eq!(count(ray(o, (to - o).normalize())), 2);
        assert_eq!(count(ray(to * 0.9, random.direction())), 1, "from inside");
    }
    // On faces between cells, on edges, through corners.
    for i in -5..=5 {
        for j in -5..=5 {
            let at = |i: i32| f64::from(i) * 0.125;
            if at(i).hypot(at(j)) > 0.68 {
                continue;
            }
            for d in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
                let (u, v) = (DVec3::new(d.y, d.z, d.x), DVec3::new(d.z, d.x, d.y));
                assert_eq!(count(ray(u * at(i) + v * at(j) - d * 2.0, d)), 2, "{i} {j} {d}");
            }
            // In a face, across.
            if at(i).abs() < 0.68 {
                let d = DVec3::new(0.6, 0.8, 0.0);
                assert_eq!(count(ray(DVec3::new(0.0, 0.0, at(i)) - d * 2.0, d)), 2, "{i}");
            }
        }
    }
    for signs in 0..8 {
        let sign = |bit: i32| if signs >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let d = DVec3::new(sign(0), sign(1), sign(2));
        assert_eq!(count(ray(-d * 2.0, d)), 2);
    }
}

#[test]
fn surfaces_on_faces_between_cells_have_no_gaps() {
    let mut random = Random::new(17);
    for (axis, sign) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        // A layer of zeros at 0.25.
        let wall = made(grid(9, |p| sign * (p[axis] - 0.25)));
        for _ in 0..20_000 {
            let mut point = || DVec3::from([(); 3].map(|()| random.between(-0.9, 0.9)));
            let (mut through, from) = (point(), point());
            through[axis] = 0.25;
            if (from[axis] - 0.25).abs() < 1e-3 {
                continue;
            }
            let line = ray(from, (through - from).normalize());
            let hit = wall.intersect(&line).unwrap_or_else(|| panic!("{axis} {sign}: {line:?} goes through"));
            assert!((f64::from(line.at(hit.t).to_array()[axis]) - 0.25).abs() < 1e-6);
            let s = wall.surface(&line, &hit);
            assert!(wall.intersect(&s.spawn(line.d, 0.0)).is_none(), "{axis} {sign}: {line:?} is met twice");
        }
    }
}

#[test]
fn thin_walls_within_a_cell_are_met_twice() {
    // Two zeros of one cubic: inside only near the middle of a cell.
    let values = vec![1.0, -0.4, -0.4, 1.0, -0.4, 1.0, 1.0, -0.4];
    let params = Params::new().with("distance", ValueType::Float, Data::Floats(values));
    let params = ["nx", "ny", "nz"].into_iter().fold(params, |p, name| p.int(name, 2));
    let saddle = made(params);
    let mut random = Random::new(2);
    for _ in 0..20_000 {
        let mut point = || DVec3::from([(); 3].map(|()| random.between(0.0, 1.0)));
        let (a, b) = (point(), point());
        let d = (b - a).normalize();
        let line = ray(a - d * 3.0, d);
        let (o, d) = (line.o.to_f64(), line.d.to_f64());
        // The first change of sign among many steps.
        let f = |p: DVec3| {
            let e = |v: f64, i: usize| if i == 1 { v } else { 1.0 - v };
            let corner = |i: usize| [1.0, -0.4, -0.4, 1.0, -0.4, 1.0, 1.0, -0.4][i];
            (0..8).map(|i| corner(i) * e(p.x, i & 1) * e(p.y, i >> 1 & 1) * e(p.z, i >> 2)).sum::<f64>()
        };
        const STEPS: usize = 4000;
        let at = |i: usize| o + d * (6.0 * i as f64 / STEPS as f64);
        let inside = |p: DVec3| p.min_element() >= 0.0 && p.max_element() <= 1.0;
        let change = (1..STEPS).find(|i| {
            let (p, q) = (at(i - 1), at(*i));
            inside(p) && inside(q) && f(p) * f(q) < 0.0
        });
        let hit = saddle.intersect(&line).map(|hit| f64::from(hit.t) / 6.0 * STEPS as f64);
        match (change, hit) {
            (Some(i), Some(t)) => assert!(t < i as f64 + 0.01, "{line:?} {i} {t}"),
            (Some(_), None) => panic!("{line:?} is not met"),
            (None, _) => {}
        }
        if let Some(t) = hit {
            let p = o + d * (t * 6.0 / STEPS as f64);
            assert!(f(p).abs() < 1e-5 && (p - 0.5).abs().max_element() < 0.500_01, "{line:?} {p}");
        }
    }
}

#[test]
fn smooth_normals_have_no_steps_where_those_of_cells_have() {
    let step = |normals: &str| {
        let ball = made(ball(9).string("normals", normals));
        let n = |y: f64| {
            let ray = ray(DVec3::new(0.1, y, 3.0), -DVec3::Z);
            ball.surface(&ray, &ball.intersect(&ray).expect("in front")).n_s
        };
        let (below, above): (Vector3, Vector3) = (n(0.25 - 1e-5).into(), n(0.25 + 1e-5).into());
        (below - above).length()
    };
    assert!(step("smooth") < 1e-3 && step("analytic") > 0.02, "{} {}", step("smooth"), step("analytic"));
}

#[test]
fn triangles_near_it_face_outwards() {
    let Outline::Near(triangles) = made(ball(9)).outline() else { panic!("no triangles") };
    assert!(triangles.len() > 100);
    for [a, b, c] in triangles {
        let n = (b - a).cross(c - a);
        assert!(n.dot(a + b + c) >= 0.0, "{a} {b} {c}");
        assert!([a, b, c].iter().all(|p| (p.length() - 0.7).abs() < 0.06));
    }
}

#[test]
fn what_is_no_surface_is_told() {
    let floats = |v: &[f32]| Data::Floats(v.to_vec());
    let eight = |nz: i32| {
        let values = floats(&[1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
        Params::new().with("distance", ValueType::Float, values).int("nx", 2).int("ny", 2).int("nz", nz)
    };
    for (params, part) in [
        (grid(3, |_| 1.0), "no surface"),
        (grid(3, |_| -1.0), "no surface"),
        (eight(3), "expected 2 x 2 x 3"),
        (eight(2).with("p1", ValueType::Point3, floats(&[0.0, 1.0, 1.0])), "flat"),
        (Params::new(), "distance"),
    ] {
        let said = build("sdfgrid", params).expect_err("wrong");
        assert!(said.contains(part), "{said}");
    }
    assert!(SdfGrid::new([1, 2, 2], vec![1.0; 4], [DVec3::ZERO, DVec3::ONE], false).is_none());
}
