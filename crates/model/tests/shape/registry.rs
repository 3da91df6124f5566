//! What holds for every registered shape (T1).
use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3},
};
use durer_model::shape::{Geometry, SHAPES, Shape, mesh_surface};
use durer_scene::{Data, Params, ValueType};
use durer_testkit::random::Random;

use super::{build, points, ray};

/// Parameter sets to try; a new kind needs none if it can be built from defaults.
fn samples(kind: &str) -> Vec<Params> {
    let corners = [[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [1.0, 1.0, 0.5], [0.2, 0.0, 0.5]];
    let (ty, data) = points(&corners);
    let floats = |v: &[f32]| Data::Floats(v.to_vec());
    match kind {
        "polygon" => vec![Params::new().with("P", ty, data)],
        "bilinearmesh" => {
            let twisted = [[-1.0, -1.0, 0.5], [1.0, -1.0, -0.3], [-1.0, 1.0, -0.6], [0.8, 1.2, 0.4]];
            [corners, twisted].map(|c| Params::new().with("P", ty, points(&c).1)).to_vec()
        }
        "curve" => vec![Params::new().with("P", ty, data)],
        "plymesh" => vec![Params::new().string("filename", "square.ply")],
        "trianglemesh" | "loopsubdiv" => {
            let indices = Data::Ints(vec![0, 1, 2, 0, 2, 3]);
            vec![Params::new().with("P", ty, data).with("indices", ValueType::Integer, indices)]
        }
        "sphere" => vec![
            Params::new(),
            Params::new().float("radius", 0.7).float("zmin", -0.2).float("zmax", 0.6).float("phimax", 200.0),
        ],
        "cylinder" => vec![
            Params::new(),
            Params::new().float("radius", 0.7).float("zmin", -0.2).float("zmax", 0.6).float("phimax", 200.0),
        ],
        "sdfgrid" => vec![super::sdfgrid::ball(9), super::sdfgrid::ball(12).string("normals", "analytic")],
        "disk" => vec![
            Params::new(),
            Params::new().float("height", -0.3).float("innerradius", 0.4).float("phimax", 90.0),
        ],
        "plane" => vec![
            Params::new(),
            Params::new().with("normal", ValueType::Vector3, floats(&[1.0, 2.0, -3.0])).with(
                "point",
                ValueType::Point3,
                floats(&[0.2, 0.1, -0.3]),
            ),
        ],
        _ => vec![Params::new()],
    }
}

fn shapes() -> Vec<(&'static str, Arc<dyn Shape>)> {
    let all = SHAPES.iter().flat_map(|e| samples(e.schema.name).into_iter().map(|p| (e.schema.name, p)));
    all.filter_map(|(kind, params)| match build(kind, params).expect("sample parameters are sound") {
        Geometry::Shapes(parts) => Some((kind, parts.into_iter().next().expect("one part"))),
        Geometry::Mesh(mesh) => {
            let s = mesh_surface(&mesh, 0, [0.25, 0.25], 0.0);
            assert!(s.n_g.z == 1.0 && s.p.z == 0.5);
            None
        }
        // The kernel's: crates/accel/tests/suite/curves.rs.
        Geometry::Strands(_) => None,
    })
    .collect()
}

#[test]
fn every_shape_documents_its_parameters() {
    for entry in SHAPES {
        let names: Vec<_> = entry.schema.params.iter().map(|p| p.name).collect();
        assert!(
            entry.schema.doc.len() > 10 && entry.schema.params.iter().all(|p| p.doc.len() > 5),
            "{names:?}"
        );
        assert!(SHAPES.iter().filter(|e| e.answers_to(entry.schema.name)).count() == 1);
    }
}

#[test]
fn hits_lie_where_the_ray_and_the_bounds_say_and_are_hit_again() {
    let mut random = Random::new(8);
    for (kind, shape) in shapes() {
        let mut hits = 0;
        for _ in 0..20_000 {
            let o = random.direction() * random.between(0.0, 4.0);
            let ray = ray(o, (random.direction() - o) * random.between(0.1, 2.0));
            let Some(hit) = shape.intersect(&ray) else {
                continue;
            };
            hits += 1;
            let s = shape.surface(&ray, &hit);
            assert!(ray.contains(hit.t) && hit.t > 0.0);
            assert!(
                (s.p - ray.at(hit.t)).length() < 2e-6 * (8.0 + s.p.to_f64().length() as f32),
                "{kind} {ray:?}"
            );
            assert!((s.n_g.length() - 1.0).abs() < 1e-6 && s.n_s.dot(s.n_g) > 0.0);
            let (du, dv) = (s.dpdu.dot(s.n_g).abs(), s.dpdv.dot(s.n_g).abs());
            assert!(du <= 1e-5 * s.dpdu.length() && dv <= 1e-5 * s.dpdv.length(), "{kind}: {s:?}");
            let grown = shape.bounds().with(s.p);
            assert!(
                grown == shape.bounds() || (grown.diagonal() - shape.bounds().diagonal()).length() < 1e-6
            );
            assert!(
                kind == "plane" || [s.uv.x, s.uv.y].iter().all(|c| (-1e-6..=1.0 + 1e-6).contains(c)),
                "{:?}",
                s.uv
            );
            // Nothing is nearer, and the interval's ends are respected.
            assert_eq!(shape.intersect(&Ray { t_max: hit.t, ..ray }), Some(hit));
            assert_eq!(shape.intersect(&Ray { t_max: hit.t.next_down(), ..ray }), None);
            assert!(shape.intersect(&Ray { t_min: hit.t, ..ray }).is_none_or(|h| h.t > hit.t));
            // Seen along the normal, from either side.
            for side in [1e-3, -1e-3] {
                let n = Vector3::from(s.n_g) * side;
                let close = Ray { t_max: 2.0, ..Ray::new(s.p + n, -n) };
                let edge = shape.intersect(&close).is_none();
                assert!(!edge || kind != "plane");
                if let Some(again) = shape.intersect(&close) {
                    let q = shape.surface(&close, &again).p;
                    assert!(
                        (q - s.p).length() < 1e-6 * (1.0 + (s.p - Point3::ZERO).length()),
                        "{kind}: {q:?} {s:?}"
                    );
                }
            }
        }
        assert!(hits > 200, "{kind}: only {hits} hits");
    }
}

#[test]
fn degenerate_rays_give_neither_hits_nor_nan() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (kind, shape) in shapes() {
        for d in [DVec3::ZERO, DVec3::splat(nan), DVec3::new(inf, 0.0, 0.0), DVec3::new(0.0, nan, 1.0)] {
            for o in [DVec3::ZERO, DVec3::splat(2.0)] {
                assert_eq!(shape.intersect(&ray(o, d)), None, "{kind} {o} {d}");
            }
        }
        for o in [DVec3::splat(nan), DVec3::splat(inf), DVec3::new(-inf, 0.0, 0.0)] {
            assert_eq!(shape.intersect(&ray(o, DVec3::new(0.1, -0.7, 0.3))), None, "{kind} {o}");
        }
        for (o, d) in [(1e30, -1e-30), (1e-30, -1e30), (3.0, -1e-38), (1e15, -1e15)] {
            let ray = ray(DVec3::splat(o), DVec3::splat(d));
            if let Some(hit) = shape.intersect(&ray) {
                let s = shape.surface(&ray, &hit);
                assert!(
                    s.p.is_finite() && s.n_g.is_finite() && s.dpdu.is_finite() && s.dpdv.is_finite(),
                    "{kind} {s:?}"
                );
            }
        }
        // Straight through the poles and centres.
        let axis = Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(0.0, 0.0, -1.0));
        if let Some(hit) = shape.intersect(&axis) {
            let s = shape.surface(&axis, &hit);
            let numbers =
                [s.uv.x, s.uv.y, s.dpdu.length(), s.dpdv.length(), s.n_s.length(), s.p_error.length()];
            assert!(numbers.iter().all(|x| x.is_finite()), "{kind}: {s:?}");
        }
    }
}
