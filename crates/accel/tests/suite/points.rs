//! Spheres and discs against closed forms, at extreme scales, from inside and from their own surface.
use durer_accel::point::{PointError, PointHit, PointKind, Points};
use durer_core::math::{Point3, Ray, Vector3};
use proptest::{prelude::*, test_runner::RngSeed};

use crate::corpus::Random;

fn one(kind: PointKind, center: [f32; 3], radius: f32) -> Points {
    let normals =
        if kind == PointKind::OrientedDisc { vec![Vector3::new(0.0, 0.0, 1.0)] } else { Vec::new() };
    Points { kind, centers: vec![center.into()], radii: vec![radius], normals }
}
fn intersect(points: &Points, ray: &Ray) -> Option<PointHit> {
    points.intersect(0, ray, f32::INFINITY)
}

#[test]
fn a_sphere_is_met_before_and_behind_its_middle() {
    let sphere = one(PointKind::Sphere, [0.0, 0.0, 1.0], 2.0);
    for i in -19..20 {
        let x = 0.1 * i as f32;
        let depth = (4.0 - x * x).sqrt();
        let ray = Ray::new(Point3::new(x, 0.0, 11.0), Vector3::new(0.0, 0.0, -2.0));
        let near = intersect(&sphere, &ray).expect("the front");
        assert!((near.t - (10.0 - depth) / 2.0).abs() < 1e-6, "{near:?}");
        assert!((near.n_g - Vector3::new(x, 0.0, depth) * 0.5).length() < 1e-6, "{near:?}");
        let far = intersect(&sphere, &Ray { t_min: near.t.next_up(), ..ray }).expect("the back");
        assert!((far.t - (10.0 + depth) / 2.0).abs() < 1e-6, "{far:?}");
        assert_eq!(intersect(&sphere, &Ray { t_min: far.t.next_up(), ..ray }), None);
        let inside = Ray { o: Point3::new(x, 0.0, 1.0), ..ray };
        assert!((intersect(&sphere, &inside).expect("from inside").t - depth / 2.0).abs() < 1e-6);
        assert_eq!(sphere.intersect(0, &ray, near.t), Some(near));
        assert_eq!(sphere.intersect(0, &ray, near.t.next_down()), None);
    }
    let beside = Ray::new(Point3::new(2.000_001, 0.0, 11.0), Vector3::new(0.0, 0.0, -2.0));
    assert_eq!(intersect(&sphere, &beside), None);
}

#[test]
fn far_small_spheres_are_met_where_they_are() {
    let mut random = Random(51);
    for i in 0..4000 {
        let r = [1e-4f32, 1e-2, 1.0, 1e6][i % 4];
        let center = Point3::ZERO + random.direction() * r * [0.0, 1e3, 1e6][i % 3];
        let sphere = one(PointKind::Sphere, center.to_array(), r);
        let o = center + random.direction() * (random.between(2.0, 1e4) * r);
        let aim = center.to_f64() + (random.direction() * (0.99 * r)).to_f64();
        let d = Vector3::from_f64(aim - o.to_f64()) * random.between(0.1, 10.0);
        let hit = intersect(&sphere, &Ray::new(o, d)).expect("aimed at");
        let p = o.to_f64() + d.to_f64() * f64::from(hit.t);
        let off = (p - center.to_f64()).length() - f64::from(r);
        let rounding = 1e-7 * (p - o.to_f64()).length();
        assert!(off.abs() < 1e-6 * f64::from(r) + rounding, "{sphere:?} {o:?} {d:?}: {off}");
        // The aim is a point of the ball whose t is known: the front is not behind it.
        let t_aim = (aim - o.to_f64()).dot(d.to_f64()) / d.to_f64().length_squared();
        assert!(f64::from(hit.t) <= t_aim * (1.0 + 1e-6));
    }
}

#[test]
fn rays_leave_spheres_and_discs_where_they_start() {
    let mut random = Random(52);
    for i in 0..20_000 {
        let r = [1e-4f32, 0.3, 5e3][i % 3];
        let center = Point3::ZERO + random.direction() * r * [0.0, 3.0, 100.0][i % 3];
        let sphere = one(PointKind::Sphere, center.to_array(), r);
        let n = random.direction();
        let o = Point3::from_f64(center.to_f64() + n.to_f64().normalize() * f64::from(r));
        let d = random.direction();
        let hit = intersect(&sphere, &Ray::new(o, d));
        let chord = -2.0 * n.dot(d) * r;
        // Rounding of the origin to f32 tilts it by as much.
        if chord < -1e-2 * r {
            assert_eq!(hit, None, "{sphere:?} {o:?} {d:?}");
        } else if chord > 1e-2 * r {
            let rounding = 4e-7 * (o - Point3::ZERO).length() * r / chord;
            let t = hit.expect("the other side").t;
            assert!((t - chord).abs() < 1e-5 * r + rounding, "{sphere:?} {o:?} {d:?}: {t}, not {chord}");
        }
        let turning = one(PointKind::Disc, center.to_array(), r);
        let on_disc = Point3::from_f64(center.to_f64() + n.to_f64() * f64::from(r * random.unit()));
        assert_eq!(intersect(&turning, &Ray::new(on_disc, d)), None);
        let mut still = one(PointKind::OrientedDisc, center.to_array(), r);
        still.normals[0] = n * 7.0;
        let radius = n.to_f64().cross(d.to_f64()) * f64::from(r * random.unit());
        let o = Point3::from_f64(center.to_f64() + radius);
        assert_eq!(intersect(&still, &Ray::new(o, random.direction())), None, "{still:?} {o:?}");
    }
}

#[test]
fn rays_leave_spheres_through_the_worlds_origin() {
    let mut random = Random(53);
    for i in 0..3000 {
        // (2, 3, 6) has length 7, also in f32.
        let size = [1.0f32, 1.0 / 8192.0, 131_072.0][i % 3];
        let sphere = one(PointKind::Sphere, [2.0 * size, 3.0 * size, 6.0 * size], 7.0 * size);
        let d = random.direction();
        let cosine = -d.dot(Vector3::new(2.0, 3.0, 6.0)) / 7.0;
        let hit = intersect(&sphere, &Ray::new(Point3::ZERO, d));
        if cosine > 0.01 {
            assert_eq!(hit, None, "{d:?}");
        } else if cosine < -0.01 {
            assert!(hit.is_some_and(|h| h.t > 0.05 * size), "{d:?}: {hit:?}");
        }
    }
}

#[test]
fn discs_are_discs() {
    let turning = one(PointKind::Disc, [1.0, 0.0, 0.0], 0.5);
    let still = one(PointKind::OrientedDisc, [1.0, 0.0, 0.0], 0.5);
    let down = |x: f32| Ray::new(Point3::new(x, 0.0, 3.0), Vector3::new(0.0, 0.0, -1.0));
    for (x, inside) in [(0.501, true), (0.499, false), (1.0, true), (1.499, true), (1.501, false)] {
        for disc in [&turning, &still] {
            let hit = intersect(disc, &down(x));
            assert_eq!(hit.is_some(), inside, "{disc:?} {x}");
            if let Some(h) = hit {
                assert_eq!((h.t, h.n_g), (3.0, Vector3::new(0.0, 0.0, 1.0)));
            }
        }
    }
    // From the side the turning disc shows all of itself, the other one 45 degrees of it.
    let slanted = |z: f32| Ray::new(Point3::new(-3.0, 0.0, 4.0 + z), Vector3::new(1.0, 0.0, -1.0));
    for (z, both) in [(0.0, (true, true)), (0.6, (true, false)), (0.49, (true, true)), (0.71, (false, false))]
    {
        assert_eq!(
            (intersect(&turning, &slanted(z)).is_some(), intersect(&still, &slanted(z)).is_some()),
            both
        );
    }
    let hit = intersect(&still, &slanted(0.25)).expect("a hit");
    assert!((hit.t - 4.25).abs() < 1e-6 && hit.n_g == Vector3::new(0.0, 0.0, 1.0), "{hit:?}");
    let edge_on = Ray::new(Point3::new(-3.0, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0));
    assert!(intersect(&turning, &edge_on).is_some() && intersect(&still, &edge_on).is_none());
}

#[test]
fn unsound_points_are_refused() {
    let sound = one(PointKind::OrientedDisc, [0.0; 3], 1.0);
    assert_eq!(sound.check(), Ok(()));
    let refused = |change: fn(&mut Points)| {
        let mut points = sound.clone();
        change(&mut points);
        points.check().expect_err("a mistake")
    };
    assert_eq!(refused(|p| p.radii.clear()), PointError::RadiusCount { centers: 1, radii: 0 });
    assert_eq!(refused(|p| p.normals.clear()), PointError::NormalCount { expected: 1, normals: 0 });
    assert_eq!(refused(|p| p.kind = PointKind::Sphere), PointError::NormalCount { expected: 0, normals: 1 });
    assert_eq!(refused(|p| p.centers[0].z = f32::NAN), PointError::CenterNotFinite { point: 0 });
    assert_eq!(refused(|p| p.radii[0] = -1.0), PointError::RadiusInvalid { point: 0 });
    assert_eq!(refused(|p| p.normals[0] = Vector3::ZERO), PointError::NormalInvalid { point: 0 });
    let error = PointError::RadiusCount { centers: 3, radii: 2 };
    assert_eq!(error.to_string(), "there are 3 centres but 2 radii; give each point its radius");
}

fn triple() -> impl Strategy<Value = [f32; 3]> {
    let coordinate =
        || prop_oneof![(-2i32..=2).prop_map(|i| i as f32), -2.0f32..2.0, Just(1e-30), Just(1e6), Just(3e38)];
    [coordinate(), coordinate(), coordinate()]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn whatever_the_point_hits_are_in_range_and_in_its_box(
        kind in 0usize..3,
        (center, normal, o, d) in (triple(), triple(), triple(), triple()),
        r in prop_oneof![Just(0.0f32), Just(1e-30), Just(1e6), 0.0f32..3.0],
        cut in 0.0f32..3.0,
    ) {
        let kind = [PointKind::Sphere, PointKind::Disc, PointKind::OrientedDisc][kind];
        let mut points = one(kind, center, r);
        points.normals.iter_mut().for_each(|n| *n = normal.into());
        let ray = Ray::new(o.into(), d.into());
        let hit = intersect(&points, &ray);
        prop_assert_eq!(points.intersect(0, &ray, cut), hit.filter(|h| h.t <= cut));
        if let Some(h) = hit {
            prop_assert!(r > 0.0 && h.t >= 0.0 && h.t.is_finite());
            prop_assert!((h.n_g.length() - 1.0).abs() < 1e-5, "{:?}", h);
            let (b, t) = (points.bounds(0), f64::from(h.t));
            let p = ray.o.to_f64() + ray.d.to_f64() * t;
            // The last term is for a t that underflows.
            let length = ray.d.to_f64().length();
            let slack = 2e-7 * (length * t + p.abs().max_element()) + 1e-45 * length;
            prop_assert!(p.cmpge(b.min.to_f64() - slack).all() && p.cmple(b.max.to_f64() + slack).all());
        }
    }
}
