//! Plane and disk against closed forms.
use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point3, Ray, Vector3},
};
use durer_model::shape::{Disk, Plane, Shape};
use durer_scene::{Data, Params, ValueType};
use durer_testkit::random::Random;

use super::{build, ray, shape};

#[test]
fn the_implicit_form_is_the_signed_distance() {
    let plane = Plane::new(Point3::new(1.0, 2.0, 3.0), Vector3::new(0.0, -4.0, 3.0), 1.0);
    assert_eq!(plane.signed_distance(Point3::new(7.0, 2.0, 3.0)), 0.0);
    assert!((plane.signed_distance(Point3::new(1.0, 2.0, 8.0)) - 3.0).abs() < 1e-6);
    assert!((plane.signed_distance(Point3::new(1.0, 7.0, 3.0)) + 4.0).abs() < 1e-6);
}

#[test]
fn hits_lie_within_their_error_however_far_away() {
    let mut random = Random::new(2);
    for _ in 0..20_000 {
        let n = random.direction();
        let origin = random.direction() * 10f64.powf(random.between(-3.0, 3.0));
        let plane = Plane::new(Point3::from_f64(origin), Vector3::from_f64(n), 1.0);
        let (n, origin) = (Vector3::from_f64(n).to_f64().normalize(), Point3::from_f64(origin).to_f64());
        let far = 10f64.powf(random.between(-2.0, 6.0));
        let d = random.direction();
        let grazing = (d - n * n.dot(d)).normalize() - n * 10f64.powf(random.between(-6.0, 0.0));
        let ray = ray(origin + n * far + d, grazing);
        let Some(hit) = plane.intersect(&ray) else {
            continue;
        };
        let s = plane.surface(&ray, &hit);
        let t = n.dot(origin - ray.o.to_f64()) / n.dot(ray.d.to_f64());
        let exact = ray.o.to_f64() + ray.d.to_f64() * t;
        // The oracle itself is worth 1e-15 / slope.
        let slope = n.dot(ray.d.to_f64()).abs();
        let own = 1e-15 * (ray.o.to_f64().length() + exact.length()) / slope;
        let off = (s.p.to_f64() - exact).abs();
        assert!(off.cmple(s.p_error.to_f64() + own).all(), "{ray:?}: {off:?} > {:?}", s.p_error);
        let height = n.dot(s.p.to_f64() - origin).abs();
        assert!(height <= n.abs().dot(s.p_error.to_f64()), "{height} off the plane at t = {}", hit.t);
    }
}

#[test]
fn a_floor_has_u_along_x_and_v_along_z() {
    let floor = shape("plane", Params::new().float("uvscale", 2.0));
    let down = Ray::new(Point3::new(3.0, 5.0, -4.0), Vector3::new(0.0, -1.0, 0.0));
    let s = floor.surface(&down, &floor.intersect(&down).expect("below"));
    assert_eq!((s.uv.x, s.uv.y), (6.0, -8.0));
    assert_eq!((s.dpdu, s.dpdv), (Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, 0.0, 0.5)));
    assert_eq!(floor.bounds(), Bounds3::UNBOUNDED);
    assert!(floor.area().is_infinite());
}

#[test]
fn rays_in_or_along_the_plane_miss() {
    let floor = shape("plane", Params::new());
    for height in [0.0, 1.0, -1e-30] {
        let along = Ray::new(Point3::new(0.0, height, 0.0), Vector3::new(1.0, 0.0, 0.3));
        assert_eq!(floor.intersect(&along), None);
    }
}

#[test]
fn planes_without_direction_are_refused() {
    let zero = Params::new().with("normal", ValueType::Vector3, Data::Floats(vec![0.0; 3]));
    assert!(build("plane", zero).is_err_and(|m| m.contains("zero vector")));
    assert!(build("plane", Params::new().float("uvscale", 0.0)).is_err());
}

#[test]
fn disk_partials_are_derivatives_of_the_parametrisation() {
    let disk = Disk::new(0.5, 2.0, 0.5, 300.0);
    let at = |u: f64, v: f64| {
        let (phi, r) = (u * 300f64.to_radians(), 2.0 - v * 1.5);
        DVec3::new(r * phi.cos(), r * phi.sin(), 0.5)
    };
    for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.95, 0.9)] {
        let down = ray(at(u, v) + DVec3::Z, -DVec3::Z);
        let s = disk.surface(&down, &disk.intersect(&down).expect("below"));
        let h = 1e-5;
        let (du, dv) = ((at(u + h, v) - at(u - h, v)) / (2.0 * h), (at(u, v + h) - at(u, v - h)) / (2.0 * h));
        assert!((f64::from(s.uv.x) - u).abs() < 1e-6 && (f64::from(s.uv.y) - v).abs() < 1e-6, "{:?}", s.uv);
        assert!((s.dpdu.to_f64() - du).length() < 1e-4 && (s.dpdv.to_f64() - dv).length() < 1e-4);
        assert!(s.dpdu.cross(s.dpdv).dot(s.n_g) > 0.0 && s.n_g.z == 1.0);
    }
}

#[test]
fn a_ring_is_hit_between_its_radii_from_both_sides() {
    let ring = Disk::new(0.0, 1.0, 0.5, 180.0);
    let hit = |x: f32, y: f32, side: f32| {
        ring.intersect(&Ray::new(Point3::new(x, y, side), Vector3::new(0.0, 0.0, -side))).is_some()
    };
    for side in [1.0, -1.0] {
        assert!(hit(0.0, 0.75, side) && hit(0.5, 0.0, side) && hit(1.0, 0.0, side));
        assert!(!hit(0.0, 0.25, side) && !hit(0.0, 1.001, side) && !hit(0.1, -0.75, side));
    }
    assert!((ring.area() - std::f32::consts::PI * 0.375).abs() < 1e-6);
    assert!(build("disk", Params::new().float("innerradius", 1.0)).is_err_and(|m| m.contains("innerradius")));
}
