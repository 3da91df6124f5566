//! Ribbons that face the ray: rectangles in closed form, any cubic against a dense scan of its centre line.
use durer_accel::curve::{CurveKind, Curves};
use durer_core::math::{Point3, Ray, Vector3};

use super::{BASES, intersect, invented, oracle, straight, towards};
use crate::corpus::{Random, ray_count};

#[test]
fn a_straight_ribbon_is_a_rectangle_or_a_trapezium() {
    let curves = straight(CurveKind::Flat, [0.0; 3], [2.0, 0.0, 0.0], [0.5, 0.25]);
    let down = Vector3::new(0.0, 0.0, -4.0);
    let hit = |x: f32, y: f32| intersect(&curves, &Ray::new(Point3::new(x, y, 4.0), down));
    for i in 0..=20 {
        let x = 0.1 * i as f32;
        let r = 0.5 - 0.125 * x;
        for y in [-0.99 * r, 0.0, 0.5 * r, 0.99 * r] {
            let h = hit(x.clamp(1e-6, 2.0 - 1e-6), y).expect("inside");
            assert!((h.t - 1.0).abs() < 1e-6 && (h.u - 0.5 * x).abs() < 2e-6, "{h:?}");
            assert!((h.v + y / r).abs() < 1e-5, "{h:?}");
            assert!((h.n_g - Vector3::new(0.0, 0.0, 1.0)).length() < 1e-6, "{h:?}");
        }
        assert_eq!(hit(x, 1.001 * r), None);
        assert_eq!(hit(x, -1.001 * r), None);
    }
    assert_eq!(hit(-1e-4, 0.0), None, "ends are cut straight");
    assert_eq!(hit(2.0 + 1e-4, 0.0), None);
    assert!(hit(0.0, 0.3).is_some() && hit(2.0, 0.2).is_some(), "ends belong to it");
}

#[test]
fn a_ribbon_does_not_meet_rays_that_start_within_two_radii_or_look_along_it() {
    let curves = straight(CurveKind::Flat, [0.0; 3], [2.0, 0.0, 0.0], [0.5, 0.5]);
    let from = |z: f32| intersect(&curves, &Ray::new(Point3::new(1.0, 0.2, z), Vector3::new(0.0, 0.0, -1.0)));
    assert_eq!(from(0.999), None);
    assert!(from(1.001).is_some());
    let along = Ray::new(Point3::new(-5.0, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0));
    assert_eq!(intersect(&curves, &along), None);
    let point = straight(CurveKind::Flat, [0.0; 3], [0.0; 3], [0.5, 0.5]);
    assert_eq!(intersect(&point, &Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(0.0, 0.0, -1.0))), None);
}

/// Distances along the ray at which the line across the curve passes it, by signs between samples; `None` if one is
/// nearly at a double root, an end, an edge or the limit of two radii.
fn scan(curves: &Curves, ray: &Ray) -> Option<Vec<f64>> {
    const SAMPLES: u32 = 2000;
    let (o, z) = (ray.o.to_f64(), ray.d.to_f64().normalize());
    let off = |s: f64| {
        let q = oracle::at(curves, 0, s).0 - o;
        (q - z * q.dot(z), q.dot(z))
    };
    let slope = |s: f64| off(s).0.dot(oracle::heading(curves, 0, s));
    let values: Vec<f64> = (0..=SAMPLES).map(|i| slope(f64::from(i) / f64::from(SAMPLES))).collect();
    let size = values.iter().fold(0f64, |a, b| a.max(b.abs()));
    if values[0].abs().min(values[values.len() - 1].abs()) < 1e-3 * size {
        return None;
    }
    let mut found = Vec::new();
    for i in 1..values.len() {
        let (a, b) = (values[i - 1], values[i]);
        if (a < 0.0) == (b < 0.0) {
            // A double root may hide between samples that are both small.
            let neighbour = values[(i + 1).min(values.len() - 1)];
            if a.abs().min(b.abs()) < 1e-4 * size && (b < 0.0) == (neighbour < 0.0) && b.abs() >= a.abs() {
                return None;
            }
            continue;
        }
        let (mut lo, mut hi) =
            (f64::from(i as u32 - 1) / f64::from(SAMPLES), f64::from(i as u32) / f64::from(SAMPLES));
        for _ in 0..50 {
            let middle = 0.5 * (lo + hi);
            if (slope(middle) < 0.0) == (a < 0.0) { lo = middle } else { hi = middle }
        }
        let ((across, along), r) = (off(lo), oracle::at(curves, 0, lo).1);
        let distance = across.length();
        if (distance - r).abs() < 1e-5 * r || (along.abs() - 2.0 * r).abs() < 1e-4 * r {
            return None;
        }
        if distance < r && along > 2.0 * r {
            found.push(along);
        }
    }
    found.sort_by(f64::total_cmp);
    Some(found)
}

#[test]
fn random_ribbons_agree_with_a_scan_of_their_centre_line() {
    let mut random = Random(31);
    let (mut hits, mut compared) = (0, 0);
    for i in 0..ray_count(1500).min(20_000) {
        let size = [1.0, 1e-4, 1e6][i % 3];
        let curves = invented(&mut random, CurveKind::Flat, Vector3::ZERO, size, [0.5, 0.1, 0.01][i / 3 % 3]);
        let ray = towards(&mut random, &curves, 0, size);
        let Some(expected) = scan(&curves, &ray) else { continue };
        compared += 1;
        let hit = intersect(&curves, &ray);
        let length = ray.d.to_f64().length();
        match (hit, expected.first()) {
            (Some(h), Some(z)) => {
                hits += 1;
                let error = (f64::from(h.t) * length - z).abs();
                assert!(error < 1e-6 * (z + f64::from(size)), "{curves:?} {ray:?} {h:?}: {expected:?}");
                let (c, r) = oracle::at(&curves, 0, h.u.into());
                let distance = (c - ray.o.to_f64() - ray.d.to_f64() * f64::from(h.t)).length();
                let v = f64::from(h.v.abs());
                assert!((distance - v * r).abs() < 3e-6 * (z + f64::from(size)), "{h:?} {distance} {r}");
            }
            (None, None) => {}
            both => panic!("{curves:?} {ray:?}: {both:?}"),
        }
    }
    assert!(compared > 1000 && hits > 500, "{compared} {hits}");
}

#[test]
fn smooth_chains_have_no_seams() {
    let mut random = Random(32);
    let mut tried = 0;
    for i in 0..20_000 {
        // Bezier chains are smooth only if made so.
        let basis = BASES[1 + i % 2];
        let points: Vec<Point3> =
            (0..6).map(|i| Point3::new(i as f32, 0.0, 0.0) + random.direction() * 0.4).collect();
        let r = [0.1f32, 1e-2, 1e-3][i % 3];
        let curves = Curves {
            kind: CurveKind::Flat,
            basis,
            points,
            radii: vec![r; 6],
            normals: Vec::new(),
            segments: vec![0, 1, 2],
        };
        let joint = 1 + random.below(2) as u32;
        let c = oracle::at(&curves, joint, 0.0).0;
        let heading = oracle::heading(&curves, joint, 0.0).normalize();
        let d = heading.cross(random.direction().to_f64()).normalize();
        let aim = c + d.cross(heading) * (f64::from(random.between(-0.9, 0.9)) * f64::from(r));
        let ray = Ray::new(Point3::from_f64(aim - d * 3.0), Vector3::from_f64(d));
        let hit = |s: u32| curves.intersect(s, &ray, f32::INFINITY).is_some();
        tried += usize::from(hit(joint)) + usize::from(hit(joint - 1));
        assert!(hit(joint) || hit(joint - 1), "{curves:?} {joint} {ray:?}");
    }
    assert!(tried < 21_000, "seams hardly overlap: {tried}");
}
