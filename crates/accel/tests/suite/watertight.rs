//! Validation G2 and G6: nothing passes between the triangles of a closed mesh, at any scale, through the tree.
use durer_accel::{Accel, AccelBuilder, BuildOptions, Placement, Triangles};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Motion, Point3, Ray, Transform, Vector3};

use crate::corpus::{Random, ray_count};
use crate::icosphere::{icosphere, moved};

fn build(mesh: &Triangles, placement: Placement) -> Accel {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let id = builder.triangles(mesh.clone()).expect("valid mesh");
    builder.instance(id, placement).expect("valid placement");
    builder.build().expect("within limits")
}

/// From inside and outside towards vertices, edge midpoints and anything between; `center` and `scale` say where the
/// unit sphere went, `targets` are its vertices there.
fn assert_closed(
    accel: &Accel,
    targets: &[Point3],
    mesh: &Triangles,
    (center, scale): (Point3, f32),
    rays: usize,
) {
    let mut random = Random(11);
    for i in 0..rays {
        let [a, b, c] = mesh.indices[i % mesh.indices.len()].map(|v| targets[v as usize] - Point3::ZERO);
        let aim = Point3::ZERO
            + match random.below(4) {
                0 => a,
                1 => (a + b) * 0.5,
                2 => a + (c - a) * random.unit(),
                _ => a * 0.25 + b * 0.5 + c * 0.25,
            };
        let inside = center + random.direction() * (random.between(0.0, 0.7) * scale);
        // Twice the radius away on the same side: incidence stays below 60 degrees.
        let outside = aim + (aim - center) * 2.0 + random.direction() * scale;
        for o in [inside, outside] {
            let ray = Ray { time: random.unit(), ..Ray::new(o, aim - o) };
            let hit = accel.query(&ray).closest();
            assert!(hit.is_some_and(|h| (h.t - 1.0).abs() < 0.05), "leak: {ray:?} {hit:?}");
            assert!(accel.query(&ray).any(), "leak: {ray:?}");
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    let mesh = icosphere(3);
    let accel = build(&mesh, Placement::Identity);
    assert_closed(&accel, &mesh.positions, &mesh, (Point3::ZERO, 1.0), ray_count(50_000));
}

#[test]
fn no_ray_leaves_a_closed_mesh_at_any_scale() {
    let mesh = icosphere(2);
    for (scale, shift) in [(1e-4, 0.0), (1e-4, 0.05), (1e6, 0.0), (1.0, 500.0), (1e3, -1e5)] {
        let shift = Vector3::new(shift, -0.3 * shift, 0.7 * shift);
        let there = moved(&mesh, scale, shift);
        let accel = build(&there, Placement::Identity);
        assert_closed(&accel, &there.positions, &mesh, (Point3::ZERO + shift, scale), 10_000);
    }
}

#[test]
fn no_ray_leaves_a_placed_mesh() {
    let mesh = icosphere(2);
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
    let affine =
        DAffine3::from_scale_rotation_translation(DVec3::splat(3.0), turn, DVec3::new(20.0, -7.0, 3.0));
    let map = Transform::from_f64(&affine);
    let targets: Vec<_> = mesh.positions.iter().map(|p| map.point(*p)).collect();
    let center = map.point(Point3::ZERO);
    assert_closed(&build(&mesh, Placement::Still(map)), &targets, &mesh, (center, 3.0), 20_000);
    // Spinning about its centre it stays a sphere: never a hole, at any moment.
    let spun = affine * DAffine3::from_rotation_y(2.5);
    let motion = Motion::keyed(vec![(0.0, affine), (1.0, spun)]).expect("valid keys");
    let accel = build(&mesh, Placement::from_motion(&motion));
    assert_closed(&accel, &targets, &mesh, (center, 3.0), 20_000);
}
