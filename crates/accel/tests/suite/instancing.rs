//! Validation G11: a mesh placed by an instance is hit like one whose vertices were moved.
use durer_accel::{AccelBuilder, BuildOptions, Hit, Placement, Triangles};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Point3, Ray, Transform};

use crate::corpus::{Random, ray_count};
use crate::icosphere::icosphere;

fn near_edge(hit: &Hit) -> bool {
    hit.u.min(hit.v).min(1.0 - hit.u - hit.v) < 1e-4
}

#[test]
fn instances_and_baked_meshes_are_hit_alike() {
    let mut random = Random(21);
    let mesh = icosphere(3);
    let (mut compared, mut rays) = (0, 0);
    for _ in 0..10 {
        let turn =
            DQuat::from_axis_angle(random.direction().to_f64().normalize(), random.between(0.0, 3.0).into());
        let scale = f64::from(random.between(0.5, 4.0));
        let affine =
            DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, random.point(5.0).to_f64());
        let map = Transform::from_f64(&affine);
        let positions =
            mesh.positions.iter().map(|p| Point3::from_f64(affine.transform_point3(p.to_f64()))).collect();
        let baked = Triangles { positions, indices: mesh.indices.clone() };
        let build = |mesh: &Triangles, placement: Placement| {
            let mut builder = AccelBuilder::new(BuildOptions::default());
            let id = builder.triangles(mesh.clone()).expect("valid mesh");
            builder.instance(id, placement).expect("valid placement");
            builder.build().expect("within limits")
        };
        let placed = build(&mesh, Placement::Still(map));
        let reference = build(&baked, Placement::Identity);
        for _ in 0..ray_count(50_000) / 10 {
            let o = map.point(Point3::ZERO + random.direction() * random.between(0.0, 3.0));
            let aim = map.point(random.point(0.7));
            let ray = Ray::new(o, (aim - o).normalize());
            let closest = |a: &durer_accel::Accel| a.query(&ray).closest();
            rays += 1;
            let (Some(a), Some(b)) = (closest(&placed), closest(&reference)) else {
                let one = closest(&placed).or(closest(&reference));
                assert!(one.is_none_or(|h| near_edge(&h)), "{ray:?} {one:?}");
                continue;
            };
            if a.prim != b.prim {
                assert!(near_edge(&a) && near_edge(&b), "{ray:?} {a:?} {b:?}");
                continue;
            }
            let [p, q, r] = baked.indices[b.prim as usize].map(|i| baked.positions[i as usize]);
            let n = b.n_g.normalize();
            let largest = [o, p, q, r, ray.at(b.t)]
                .iter()
                .map(|p| p.to_array().map(f32::abs).into_iter().fold(0.0, f32::max))
                .fold(0.0, f32::max);
            let tolerance = 8.0 * f32::EPSILON * largest / n.dot(ray.d).abs();
            assert!((a.t - b.t).abs() <= tolerance, "{ray:?} {a:?} {b:?} {tolerance}");
            compared += 1;
        }
    }
    assert!(compared * 10 > rays * 7, "{compared} of {rays}");
}

#[test]
fn a_moving_instance_is_met_where_it_is_at_the_time_of_the_ray() {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let id = builder.triangles(icosphere(2)).expect("valid mesh");
    let at = |x: f64| Transform::from_f64(&DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)));
    builder.instance(id, Placement::Moving(vec![(0.0, at(0.0)), (1.0, at(10.0))])).expect("valid placement");
    let accel = builder.build().expect("within limits");
    for (time, x) in [(-1.0, 0.0), (0.0, 0.0), (0.25, 2.5), (1.0, 10.0), (4.0, 10.0)] {
        for (offset, expected) in [(0.9, true), (-0.9, true), (1.1, false), (-1.1, false)] {
            let o = Point3::new(x + offset, 0.0, -5.0);
            let ray = Ray { time, ..Ray::new(o, [0.0, 0.0, 1.0].into()) };
            assert_eq!(accel.query(&ray).any(), expected, "{time} {offset}");
        }
        let map = accel.instance_transform(0, time);
        assert!((map.point(Point3::ZERO) - Point3::new(x, 0.0, 0.0)).length() < 1e-6);
    }
    let b = accel.bounds();
    assert!(b.min.x < -0.99 && b.min.x > -1.01 && b.max.x > 10.99 && b.max.x < 11.01, "{b:?}");
}
