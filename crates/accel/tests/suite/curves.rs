//! Curves against closed forms, against slow oracles, at joints, ends and extreme scales.
mod flat;
mod oracle;
mod oriented;
mod round;

use durer_accel::curve::{CurveBasis, CurveError, CurveHit, CurveKind, Curves};
use durer_core::math::{Point3, Ray, Vector3};
use proptest::{prelude::*, test_runner::RngSeed};

use crate::corpus::Random;

const BASES: [CurveBasis; 4] =
    [CurveBasis::Bezier, CurveBasis::BSpline, CurveBasis::CatmullRom, CurveBasis::Linear];
const KINDS: [CurveKind; 3] = [CurveKind::Round, CurveKind::Flat, CurveKind::Oriented];

/// One straight segment.
fn straight(kind: CurveKind, a: [f32; 3], b: [f32; 3], radii: [f32; 2]) -> Curves {
    let normals = if kind == CurveKind::Oriented { vec![Vector3::new(0.0, 0.0, 1.0); 2] } else { Vec::new() };
    Curves {
        kind,
        basis: CurveBasis::Linear,
        points: vec![a.into(), b.into()],
        radii: radii.to_vec(),
        normals,
        segments: vec![0],
    }
}

/// One segment inside the cube `[-size, size]^3 + center`, of radii up to `thickness size`.
fn invented(random: &mut Random, kind: CurveKind, center: Vector3, size: f32, thickness: f32) -> Curves {
    let basis = BASES[random.below(4)];
    let count = basis.points();
    let normals = if kind == CurveKind::Oriented { count } else { 0 };
    Curves {
        kind,
        basis,
        points: (0..count).map(|_| random.point(size) + center).collect(),
        radii: (0..count).map(|_| random.between(0.1, 1.0) * thickness * size).collect(),
        normals: (0..normals).map(|_| random.direction() + Vector3::new(0.0, 0.0, 1.5)).collect(),
        segments: vec![0],
    }
}

/// A ray from some way off towards a point near the curve's centre line.
fn towards(random: &mut Random, curves: &Curves, segment: u32, size: f32) -> Ray {
    let (c, r) = oracle::at(curves, segment, random.unit().into());
    let aim = Point3::from_f64(c) + random.direction() * (random.between(0.0, 1.3) * r as f32);
    let o = aim + random.direction() * (random.between(0.1, 4.0) * size);
    Ray::new(o, (aim - o) * random.between(0.2, 3.0))
}

fn intersect(curves: &Curves, ray: &Ray) -> Option<CurveHit> {
    curves.intersect(0, ray, f32::INFINITY)
}

#[test]
fn results_depend_on_the_end_of_the_ray_only_through_that_bound() {
    let mut random = Random(5);
    let mut hits = 0;
    for i in 0..3000 {
        let kind = KINDS[i % 3];
        let curves = invented(&mut random, kind, Vector3::ZERO, 1.0, 0.3);
        let ray = towards(&mut random, &curves, 0, 1.0);
        let Some(hit) = intersect(&curves, &ray) else { continue };
        hits += 1;
        assert_eq!(curves.intersect(0, &ray, hit.t), Some(hit), "up to the hit itself");
        assert_eq!(curves.intersect(0, &ray, hit.t.next_down()), None, "up to just before");
        assert_eq!(intersect(&curves, &Ray { t_min: hit.t, ..ray }), Some(hit), "from the hit on");
        let next = intersect(&curves, &Ray { t_min: hit.t.next_up(), ..ray });
        assert!(next.is_none_or(|n| n.t > hit.t), "{hit:?} then {next:?}");
        let reversed = Ray::new(ray.at(2.0 * hit.t), -ray.d);
        assert!(kind != CurveKind::Round || intersect(&curves, &reversed).is_some(), "{curves:?} {ray:?}");
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn the_surface_at_a_hit_is_where_the_ray_is() {
    let mut random = Random(6);
    let mut hits = 0;
    for i in 0..3000 {
        let kind = KINDS[i % 3];
        let center = random.direction() * [0.0, 100.0][i % 2];
        let curves = invented(&mut random, kind, center, 1.0, [0.3, 0.01][i / 3 % 2]);
        let ray = towards(&mut random, &curves, 0, 1.0);
        let Some(hit) = intersect(&curves, &ray) else { continue };
        hits += 1;
        let surface = curves.surface(0, &ray, &hit);
        let at_t = ray.o.to_f64() + ray.d.to_f64() * f64::from(hit.t);
        // Where a ribbon twists, rounding u slides the point along it.
        let slide = if kind == CurveKind::Oriented { 3e-6 } else { 3e-7 };
        let rounding = slide * (f64::from(hit.t) * ray.d.to_f64().length() + at_t.length() + 1.0);
        let off = (surface.p.to_f64() - at_t).length();
        assert!(off < rounding, "{curves:?} {ray:?} {hit:?} {surface:?}: {off}");
        let (dpdu, dpdv, n) = (surface.dpdu, surface.dpdv, hit.n_g);
        assert!(dpdu.dot(n).abs() <= 1e-5 * dpdu.length() && dpdv.dot(n).abs() <= 1e-5 * dpdv.length());
        assert!(dpdu.dot(dpdv).abs() <= 1e-5 * dpdu.length() * dpdv.length());
        let (_, r) = oracle::at(&curves, 0, hit.u.into());
        assert!((f64::from(dpdv.length()) - r).abs() < 1e-5 * r, "{surface:?}");
        let along = oracle::heading(&curves, 0, hit.u.into());
        assert!(along.dot(dpdu.to_f64()) > 0.0);
        assert!(kind != CurveKind::Flat || (along - dpdu.to_f64()).length() < 1e-3 * along.length());
        // A step towards larger v, seen by a parallel ray; on end caps both directions turn about the pole.
        let side_on = hit.u > 0.0 && hit.u < 1.0 && n.dot(ray.d).abs() > 0.3 * ray.d.length();
        let beside = Ray { o: ray.o + dpdv * 0.01, ..ray };
        if let Some(h) = intersect(&curves, &beside).filter(|h| (h.u - hit.u).abs() < 1e-2) {
            let grows = h.v > hit.v || hit.v.abs() > 0.9 || !side_on;
            assert!(grows, "{curves:?} {ray:?} {hit:?} {h:?} {surface:?}");
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn rays_that_can_hit_nothing_miss() {
    for kind in KINDS {
        let curves = straight(kind, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.5]);
        let o = Point3::new(0.0, 0.1, 3.0);
        let good = Ray::new(o, Vector3::new(0.0, 0.0, -1.0));
        assert!(intersect(&curves, &good).is_some(), "{kind:?}");
        for d in [[0.0; 3], [f32::NAN; 3], [0.0, f32::INFINITY, 0.0]] {
            assert_eq!(intersect(&curves, &Ray::new(o, d.into())), None);
        }
        assert_eq!(intersect(&curves, &Ray { o: Point3::splat(f32::NAN), ..good }), None);
        assert_eq!(intersect(&curves, &Ray { t_min: 5.0, ..good }), None);
        assert_eq!(intersect(&curves, &Ray { t_min: f32::NAN, ..good }), None);
        assert_eq!(curves.intersect(0, &good, f32::NAN), None);
        assert_eq!(curves.intersect(0, &good, 1.0), None);
    }
}

#[test]
fn all_bases_agree_on_the_same_line() {
    // Evenly spaced control points make the same straight line in every basis.
    let line = |i: i32| Point3::new(i as f32, 0.5 * i as f32, 0.0);
    let ray = Ray::new(Point3::new(0.6, -0.3, 4.0), Vector3::new(0.0, 0.25, -1.0));
    for kind in KINDS {
        let all = BASES.map(|basis| {
            let (first, step) = match basis {
                CurveBasis::BSpline | CurveBasis::CatmullRom => (-1, 1),
                CurveBasis::Linear | CurveBasis::Bezier => (0, 1),
            };
            let points: Vec<Point3> = match basis {
                CurveBasis::Bezier => {
                    (0..4).map(|i| Point3::new(i as f32 / 3.0, i as f32 / 6.0, 0.0)).collect()
                }
                _ => (0..basis.points() as i32).map(|i| line(first + i * step)).collect(),
            };
            let n = points.len();
            let normals =
                if kind == CurveKind::Oriented { vec![Vector3::new(0.0, 0.0, 2.0); n] } else { Vec::new() };
            let curves = Curves { kind, basis, points, radii: vec![0.5; n], normals, segments: vec![0] };
            assert_eq!(curves.check(), Ok(()));
            intersect(&curves, &ray).expect("a hit")
        });
        for hit in all {
            assert!((hit.t - all[0].t).abs() < 1e-6 && (hit.u - all[0].u).abs() < 1e-6, "{all:?}");
            assert!((hit.v - all[0].v).abs() < 1e-6 && (hit.n_g - all[0].n_g).length() < 1e-6, "{all:?}");
        }
    }
}

#[test]
fn unsound_curves_are_refused() {
    let mut curves = straight(CurveKind::Round, [0.0; 3], [1.0; 3], [0.1, f32::NAN]);
    assert_eq!(curves.check(), Err(CurveError::RadiusInvalid { point: 1 }));
    curves.radii[1] = 0.1;
    assert_eq!(curves.check(), Ok(()));
}

/// Small integers make degenerate, coincident and axis-aligned things likely.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => (-2i32..=2).prop_map(|i| i as f32),
        4 => -2.0f32..2.0,
        1 => Just(-0.0),
        1 => Just(1e-30),
        1 => Just(1e6),
        1 => Just(3e37),
    ]
}
fn triple() -> impl Strategy<Value = [f32; 3]> {
    [coordinate(), coordinate(), coordinate()]
}
fn radius() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0f32), Just(1.0), Just(1e-30), Just(1e6), 0.0f32..2.0]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn whatever_the_curve_hits_are_in_range_and_in_its_box(
        points in prop::collection::vec(triple(), 4),
        radii in prop::collection::vec(radius(), 4),
        normals in prop::collection::vec(triple(), 4),
        (kind, basis) in (0usize..3, 0usize..4),
        (o, d, cut) in (triple(), triple(), 0.0f32..3.0),
    ) {
        let kind = KINDS[kind];
        let points: Vec<Point3> = points.into_iter().map(Point3::from).collect();
        let normals = match kind {
            CurveKind::Oriented => normals.into_iter().map(Vector3::from).collect(),
            CurveKind::Round | CurveKind::Flat => Vec::new(),
        };
        let curves = Curves { kind, basis: BASES[basis], points, radii, normals, segments: vec![0] };
        let ray = Ray::new(o.into(), d.into());
        let hit = intersect(&curves, &ray);
        prop_assert_eq!(curves.intersect(0, &ray, cut), hit.filter(|h| h.t <= cut));
        if let Some(h) = hit {
            prop_assert!(h.t >= 0.0 && h.t.is_finite());
            prop_assert!((0.0..=1.0).contains(&h.u) && (-1.0..=1.0).contains(&h.v));
            prop_assert!((h.n_g.length() - 1.0).abs() < 1e-5, "{:?}", h);
            let (b, t) = (curves.bounds(0), f64::from(h.t));
            let p = ray.o.to_f64() + ray.d.to_f64() * t;
            // The last term is for a t that underflows.
            let length = ray.d.to_f64().length();
            let slack = 2e-7 * (length * t + p.abs().max_element()) + 1e-45 * length;
            prop_assert!(p.cmpge(b.min.to_f64() - slack).all() && p.cmple(b.max.to_f64() + slack).all());
        }
    }
}
