//! The sphere against closed forms.
use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3},
};
use durer_model::shape::{Shape, Sphere};
use durer_scene::Params;
use durer_testkit::random::Random;

use super::{build, ray, shape};

#[test]
fn the_silhouette_is_where_the_tangent_cone_says() {
    // G1: radius 1 at distance 3, tan = 1 / sqrt(8).
    let sphere = Sphere::new(1.0);
    let hits =
        |tan: f64| sphere.intersect(&ray(DVec3::new(0.0, 0.0, -3.0), DVec3::new(tan, 0.0, 1.0))).is_some();
    let (mut inside, mut outside) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (inside + outside);
        if hits(middle) { inside = middle } else { outside = middle }
    }
    assert!((inside - 1.0 / 8f64.sqrt()).abs() < 1e-7, "{inside}");
}

#[test]
fn counted_rays_measure_the_solid_angle() {
    // G1: 2 pi (1 - sqrt(8) / 3). A grid over the cone of 30 degrees, equal solid angles.
    let sphere = Sphere::new(1.0);
    let (n, edge) = (1000, 30f64.to_radians().cos());
    let mut hits = 0;
    for i in 0..n {
        for j in 0..100 {
            let z = 1.0 - (1.0 - edge) * (f64::from(i) + 0.5) / f64::from(n);
            let phi = std::f64::consts::TAU * f64::from(j) / 100.0;
            let r = (1.0 - z * z).sqrt();
            let d = DVec3::new(r * phi.cos(), r * phi.sin(), z);
            hits += i32::from(sphere.intersect(&ray(DVec3::new(0.0, 0.0, -3.0), d)).is_some());
        }
    }
    let measured = f64::from(hits) / (f64::from(n) * 100.0) * std::f64::consts::TAU * (1.0 - edge);
    assert!((measured - 0.359_341).abs() < 1e-3, "{measured}");
}

/// The textbook quadratic in f64: independent of the code, good away from grazing incidence.
fn textbook(ray: &Ray, radius: f64) -> Option<DVec3> {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let (a, b, c) = (d.dot(d), 2.0 * o.dot(d), o.dot(o) - radius * radius);
    let root = (b * b - 4.0 * a * c).sqrt();
    let t = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)].into_iter().find(|t| *t > 1e-9)?;
    Some(o + d * t)
}

#[test]
fn the_error_bound_contains_the_exact_point() {
    let mut random = Random::new(1);
    for radius in [1e-4f32, 0.37, 1.0, 1e3, 1e6] {
        let (sphere, r) = (Sphere::new(radius), f64::from(radius));
        for _ in 0..2000 {
            let distance = 10f64.powf(random.between(-0.5, 2.0)) * r;
            let o = random.direction() * distance;
            let target = random.direction() * random.between(0.0, 0.99) * r;
            let ray = ray(o, (target - o) * random.between(0.01, 3.0));
            let (Some(hit), Some(exact)) = (sphere.intersect(&ray), textbook(&ray, r)) else {
                panic!("{ray:?} misses a sphere of radius {radius}")
            };
            let s = sphere.surface(&ray, &hit);
            let off = (s.p.to_f64() - exact).abs();
            assert!(off.cmple(s.p_error.to_f64() + 1e-10 * r).all(), "{ray:?}: {off:?} > {:?}", s.p_error);
        }
    }
}

#[test]
fn partials_are_derivatives_of_the_parametrisation() {
    // P(u, v) = r (sin theta cos phi, sin theta sin phi, cos theta), theta from zmin to zmax.
    let cut = Sphere::cut(2.0, -1.0, 1.5, 270.0);
    let (bottom, top) = ((-0.5f64).acos(), 0.75f64.acos());
    let at = |u: f64, v: f64| {
        let (phi, theta) = (u * 270f64.to_radians(), bottom + v * (top - bottom));
        2.0 * DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.7), (0.33, 0.95)] {
        let p = at(u, v);
        let inward = ray(p * 2.0, -p);
        let hit = cut.intersect(&inward).expect("aimed at the surface");
        let s = cut.surface(&inward, &hit);
        let h = 1e-5;
        let (du, dv) = ((at(u + h, v) - at(u - h, v)) / (2.0 * h), (at(u, v + h) - at(u, v - h)) / (2.0 * h));
        assert!((f64::from(s.uv.x) - u).abs() < 1e-6 && (f64::from(s.uv.y) - v).abs() < 1e-6, "{:?}", s.uv);
        assert!((s.dpdu.to_f64() - du).length() < 1e-4 && (s.dpdv.to_f64() - dv).length() < 1e-4);
        assert!(s.dpdu.cross(s.dpdv).dot(s.n_g) > 0.0 && s.n_g.dot(Vector3::from_f64(p)) > 0.0);
    }
}

#[test]
fn cut_spheres_let_rays_through_to_the_far_side() {
    let bowl = shape("sphere", Params::new().float("radius", 1.0).float("zmax", 0.0));
    let down = Ray::new(Point3::new(0.3, 0.0, 2.0), Vector3::new(0.0, 0.0, -1.0));
    let hit = bowl.intersect(&down).expect("the bottom");
    assert!(bowl.surface(&down, &hit).p.z < 0.0);
    let quarter = Sphere::cut(1.0, -1.0, 1.0, 90.0);
    let along = |x, y| Ray::new(Point3::new(x, y, 2.0), Vector3::new(0.0, 0.0, -1.0));
    assert!(quarter.intersect(&along(0.3, 0.3)).is_some());
    assert!(quarter.intersect(&along(-0.3, 0.3)).is_none() && quarter.intersect(&along(0.3, -0.3)).is_none());
}

#[test]
fn areas_are_those_of_zones() {
    let pi = std::f32::consts::PI;
    assert!((Sphere::new(2.0).area() - 16.0 * pi).abs() < 1e-5);
    assert!((Sphere::cut(2.0, 0.5, -1.0, 90.0).area() - 2.0 * pi * 2.0 * 1.5 / 4.0).abs() < 1e-5);
}

#[test]
fn spheres_of_nothing_are_refused() {
    for params in [
        Params::new().float("radius", 0.0),
        Params::new().float("phimax", 0.0),
        Params::new().float("zmin", 2.0).float("zmax", 3.0),
        Params::new().float("radius", -1.0),
    ] {
        assert!(build("sphere", params.clone()).is_err(), "{params:?}");
    }
}

#[test]
fn rays_from_a_point_exactly_on_the_sphere_do_not_meet_it_at_once() {
    let sphere = Sphere::new(1.0);
    let o = Point3::new(1.0, 0.0, 0.0);
    assert!(sphere.intersect(&Ray::new(o, Vector3::new(1.0, 0.3, 0.0))).is_none());
    let across = sphere.intersect(&Ray::new(o, Vector3::new(-0.5, 0.0, 0.0))).expect("the far side");
    assert_eq!(across.t, 4.0);
}

#[test]
fn rays_that_graze_away_from_the_point_they_start_on_hit_nothing() {
    // (3, 4, 0) lies on the sphere exactly. With `o . d > 0`, which f64 tells exactly here, no root is positive; what
    // rounding makes of the double root at a tangent must not count.
    let sphere = shape("sphere", Params::new().float("radius", 5.0));
    let mut random = Random::new(5);
    let mut rays = 0;
    for _ in 0..200_000 {
        let (along, up) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let away = 10f64.powf(random.between(-12.0, -3.0));
        let d = DVec3::new(-0.8, 0.6, 0.0) * along + DVec3::Z * up + DVec3::new(0.6, 0.8, 0.0) * away;
        let ray = ray(DVec3::new(3.0, 4.0, 0.0), d);
        if 3.0 * f64::from(ray.d.x) + 4.0 * f64::from(ray.d.y) > 0.0 {
            rays += 1;
            assert_eq!(sphere.intersect(&ray), None, "{ray:?}");
        }
    }
    assert!(rays > 100_000, "only {rays} rays");
}
