//! The cylinder against closed forms.
use durer_core::{
    glam::DVec3,
    math::{Point2, Point3, Ray, Vector3},
};
use durer_model::shape::{Cylinder, Shape};
use durer_scene::Params;
use durer_testkit::random::Random;

use super::{build, ray};

/// The textbook quadratic in f64: independent of the code, good away from grazing incidence.
fn textbook(ray: &Ray, r: f64) -> Option<DVec3> {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let (a, b, c) = (d.x * d.x + d.y * d.y, 2.0 * (o.x * d.x + o.y * d.y), o.x * o.x + o.y * o.y - r * r);
    let root = (b * b - 4.0 * a * c).sqrt();
    let t = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
    t.into_iter().filter(|t| *t > 1e-9).map(|t| o + d * t).find(|p| p.z.abs() <= 2.0 * r)
}

#[test]
fn the_error_bound_contains_the_exact_point() {
    let mut random = Random::new(1);
    let mut hits = 0;
    for radius in [1e-4f32, 0.37, 1.0, 1e3, 1e6] {
        let r = f64::from(radius);
        let cylinder = Cylinder::new(radius, -2.0 * radius, 2.0 * radius, 360.0);
        for _ in 0..2000 {
            let o = random.direction() * 10f64.powf(random.between(-0.5, 2.0)) * r;
            let target = random.direction() * random.between(0.0, 0.99) * r;
            let ray = ray(o, (target - o) * random.between(0.01, 3.0));
            let (hit, exact) = (cylinder.intersect(&ray), textbook(&ray, r));
            let near_the_rim = exact.is_some_and(|p| (p.z.abs() / r - 2.0).abs() < 1e-6);
            assert!(near_the_rim || hit.is_some() == exact.is_some(), "{ray:?}");
            let (Some(hit), Some(exact)) = (hit, exact) else { continue };
            let s = cylinder.surface(&ray, &hit);
            let off = (s.p.to_f64() - exact).abs();
            assert!(off.cmple(s.p_error.to_f64() + 1e-10 * r).all(), "{ray:?}: {off:?} > {:?}", s.p_error);
            hits += 1;
        }
    }
    assert!(hits > 6000, "only {hits} hits");
}

#[test]
fn partials_are_derivatives_of_the_parametrisation() {
    // P(u, v) = (r cos phi, r sin phi, z), z from zmin to zmax.
    let part = Cylinder::new(2.0, -1.0, 1.5, 270.0);
    let at = |u: f64, v: f64| {
        let phi = u * 270f64.to_radians();
        DVec3::new(2.0 * phi.cos(), 2.0 * phi.sin(), -1.0 + 2.5 * v)
    };
    for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.7), (0.33, 0.95)] {
        let p = at(u, v);
        let across = DVec3::new(p.x, p.y, 0.0);
        let inward = ray(p + across, -across);
        let s = part.surface(&inward, &part.intersect(&inward).expect("aimed at the surface"));
        let h = 1e-5;
        let (du, dv) = ((at(u + h, v) - at(u - h, v)) / (2.0 * h), (at(u, v + h) - at(u, v - h)) / (2.0 * h));
        assert!((f64::from(s.uv.x) - u).abs() < 1e-6 && (f64::from(s.uv.y) - v).abs() < 1e-6, "{:?}", s.uv);
        assert!((s.dpdu.to_f64() - du).length() < 1e-4 && (s.dpdv.to_f64() - dv).length() < 1e-4);
        assert!(s.dpdu.cross(s.dpdv).dot(s.n_g) > 0.0 && s.n_g.dot(Vector3::from_f64(across)) > 0.0);
    }
}

#[test]
fn rays_go_in_at_one_end_and_meet_the_inside() {
    let tube = Cylinder::new(1.0, 0.0, 2.0, 360.0);
    let slanted = Ray::new(Point3::new(0.0, 0.0, -1.0), Vector3::new(0.5, 0.0, 1.0));
    let hit = tube.intersect(&slanted).expect("the wall, from inside");
    let s = tube.surface(&slanted, &hit);
    assert!(hit.t == 2.0 && s.p == Point3::new(1.0, 0.0, 1.0) && s.n_g.x == 1.0, "{s:?}");
    // Through without touching, along the axis, and past the end.
    for (o, d) in [
        ([0.3, 0.0, -1.0], [0.0, 0.0, 1.0]),
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([-2.0, 0.0, 2.1], [1.0, 0.0, 0.0]),
    ] {
        assert_eq!(tube.intersect(&Ray::new(Point3::from(o), Vector3::new(d[0], d[1], d[2]))), None);
    }
    let half = Cylinder::new(1.0, 0.0, 2.0, 180.0);
    let across = Ray::new(Point3::new(0.0, -3.0, 1.0), Vector3::new(0.0, 1.0, 0.0));
    assert_eq!(half.intersect(&across).map(|hit| hit.t), Some(4.0), "the near half is not there");
}

#[test]
fn points_by_area_lie_on_it_with_the_density_of_its_area() {
    let part = Cylinder::new(2.0, -1.0, 1.5, 90.0);
    assert!((part.area() - std::f32::consts::PI * 2.5).abs() < 1e-5);
    for (x, y) in [(0.0, 0.0), (0.3, 0.9), (0.99, 0.5)] {
        let point = part.by_area(Point2::new(x, y)).expect("a point");
        let inward = ray(point.p + point.n, -point.n);
        let s = part.surface(&inward, &part.intersect(&inward).expect("on the surface"));
        assert!(
            (s.p.to_f64() - point.p).length() < 1e-6
                && (point.density * f64::from(part.area()) - 1.0).abs() < 1e-6
        );
    }
}

#[test]
fn cylinders_of_nothing_are_refused() {
    let flat = Params::new().float("zmin", 1.0);
    for params in [Params::new().float("radius", 0.0), Params::new().float("phimax", 0.0), flat] {
        assert!(build("cylinder", params.clone()).is_err(), "{params:?}");
    }
}
