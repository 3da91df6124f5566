//! G6: from 1e-4 to 1e6, no ray meets the surface it leaves, none leaks through the other side.
use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Point3, Ray, Transform, Vector3},
};
use durer_model::{
    Surface,
    shape::{Cylinder, Disk, Patch, Plane, Polygon, Shape, Sphere, mesh_surface, polygon::FillRule},
};
use durer_scene::Mesh;
use durer_testkit::random::Random;

use super::ray;

const SCALES: std::ops::RangeInclusive<i32> = -4..=6;

fn placement(random: &mut Random, scale: f64) -> Transform {
    let q = DQuat::from_axis_angle(random.direction(), random.between(0.0, 6.0));
    let stretch = DVec3::new(1.0, random.between(0.3, 3.0), random.between(-2.0, -0.5));
    let stretch = if random.unit() < 0.5 { stretch } else { DVec3::ONE };
    let away = random.direction() * random.between(0.0, 20.0);
    Transform::from_f64(&DAffine3::from_scale_rotation_translation(stretch * scale, q, away * scale))
}

/// A direction on the given side, from nearly tangent to steep.
fn leaving(random: &mut Random, s: &Surface, side: f64) -> Vector3 {
    let n = s.n_g.to_f64();
    let any = random.direction();
    let along = (any - n * n.dot(any)).normalize();
    let sine = 10f64.powf(random.between(-4.0, 0.0));
    Vector3::from_f64(along * (1.0 - sine * sine).sqrt() + n * (sine * side))
}

/// What becomes of rays that leave hits of `shape` to either side.
fn sweep(name: &str, shape: &dyn Shape, size: f64, inside_is_closed: bool) {
    let mut random = Random::new(5);
    for scale in SCALES.map(|e| 10f64.powi(e)) {
        let mut hits = 0;
        for _ in 0..3000 {
            let m = placement(&mut random, scale);
            let target = random.direction() * random.between(0.0, 0.8) * size;
            let o = random.direction() * 4.0 * size;
            let from = m.point(Point3::from_f64(o));
            let to = m.point(Point3::from_f64(target));
            let local = m.inverse().ray(&Ray::new(from, to - from));
            let Some(hit) = shape.intersect(&local) else {
                continue;
            };
            hits += 1;
            let s = shape.surface(&local, &hit).placed(&m, false);
            for side in [1.0, -1.0] {
                let spawned = m.inverse().ray(&s.spawn(leaving(&mut random, &s, side), 0.0));
                let again = shape.intersect(&spawned);
                let expected = inside_is_closed && side < 0.0;
                assert_eq!(
                    again.is_some(),
                    expected,
                    "{name} scale {scale:e} side {side}: {s:?} {spawned:?} {again:?}"
                );
            }
        }
        assert!(hits > 300, "{name}: only {hits} hits at scale {scale}");
    }
}

#[test]
fn grazing_rays_never_meet_the_surface_they_leave() {
    let lifted = |l: &[[f32; 2]]| l.iter().map(|p| Point3::new(p[0], p[1], 0.3)).collect::<Vec<_>>();
    let outline = lifted(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 0.2], [-1.0, 1.0]]);
    let polygon = Polygon::new(&[outline], FillRule::EvenOdd).expect("a polygon");
    sweep("disk", &Disk::new(0.1, 1.0, 0.0, 360.0), 1.0, false);
    sweep("polygon", &polygon, 1.0, false);
    let flat = [[-1.0, -1.0, 0.3], [1.0, -1.0, 0.3], [-1.0, 1.0, 0.3], [0.8, 1.1, 0.3]].map(Point3::from);
    sweep("flat patch", &Patch::new(flat), 1.0, false);
    sweep("plane", &Plane::new(Point3::new(0.1, 0.2, 0.3), Vector3::new(0.3, 1.0, -0.2), 1.0), 1.0, false);
    sweep("sphere", &Sphere::new(1.0), 1.0, true);
    // So long that no ray leaves by its ends.
    sweep("cylinder", &Cylinder::new(1.0, -1e6, 1e6, 360.0), 1.0, true);
    for size in SCALES.map(|e| 10f64.powi(e)) {
        sweep("sphere of its own size", &Sphere::new(size as f32), size, true);
    }
}

/// Möller and Trumbore's test in f64, without any tolerance.
fn meets(ray: &Ray, t: [DVec3; 3]) -> bool {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let (e1, e2) = (t[1] - t[0], t[2] - t[0]);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - t[0];
    let q = s.cross(e1);
    let (u, v, at) = (s.dot(p) / det, d.dot(q) / det, e2.dot(q) / det);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0
}

#[test]
fn grazing_rays_never_meet_the_triangle_they_leave() {
    let mut random = Random::new(6);
    for scale in SCALES.map(|e| 10f64.powi(e)) {
        for _ in 0..5000 {
            let m = placement(&mut random, scale);
            let positions: Vec<_> = (0..3).map(|_| Point3::from_f64(random.direction() * 2.0)).collect();
            let corners = [0, 1, 2].map(|i| positions[i].to_f64());
            let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
            if e1.cross(e2).length() < 0.05 * e1.length() * e2.length() {
                continue;
            }
            let mesh = Mesh { positions, indices: vec![[0, 1, 2]], ..Mesh::default() };
            let (u, v) = (random.between(0.0, 0.5) as f32, random.between(0.0, 0.5) as f32);
            let s = mesh_surface(&mesh, 0, [u, v], 0.0).placed(&m, false);
            for side in [1.0, -1.0] {
                let spawned = m.inverse().ray(&s.spawn(leaving(&mut random, &s, side), 0.0));
                assert!(!meets(&spawned, corners), "scale {scale:e} side {side}: {s:?} {spawned:?}");
            }
        }
    }
}

#[test]
fn shadow_rays_between_two_sides_of_a_sphere_are_blocked() {
    let mut random = Random::new(7);
    for scale in SCALES.map(|e| 10f64.powi(e)) {
        let sphere = Sphere::new(1.0);
        for _ in 0..2000 {
            let m = placement(&mut random, scale);
            let outside = random.direction() * 3.0;
            let aimed = ray(outside, -outside + random.direction() * 0.9);
            let Some(hit) = sphere.intersect(&aimed) else {
                continue;
            };
            let s = sphere.surface(&aimed, &hit).placed(&m, false);
            // A lamp straight behind the sphere.
            let lamp = m.point(Point3::from_f64(-outside.normalize() * 50.0));
            let lit = m.inverse().ray(&s.spawn_to(lamp, 0.0));
            assert!(sphere.intersect(&lit).is_some(), "scale {scale:e}: light leaks to {s:?}");
            let front = m.point(Point3::from_f64(hit_point(&aimed, hit.t) * 50.0));
            let free = m.inverse().ray(&s.spawn_to(front, 0.0));
            assert!(sphere.intersect(&free).is_none(), "scale {scale:e}: {s:?} shadows itself");
        }
    }
}

fn hit_point(ray: &Ray, t: f32) -> DVec3 {
    ray.o.to_f64() + ray.d.to_f64() * f64::from(t)
}
