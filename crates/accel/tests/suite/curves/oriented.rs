//! Ribbons with normals: rectangles in closed form, any cubic against a fine mesh of the same ribbon.
use durer_accel::curve::{CurveKind, Curves};
use durer_accel::triangle::{self, Shear};
use durer_core::glam::DVec3;
use durer_core::math::{Point3, Ray, Vector3};

use super::{intersect, invented, oracle, straight, towards};
use crate::corpus::Random;

#[test]
fn a_straight_ribbon_with_one_normal_is_a_plane_rectangle() {
    let mut curves = straight(CurveKind::Oriented, [0.0; 3], [2.0, 0.0, 0.0], [0.5, 0.5]);
    curves.normals = vec![Vector3::new(0.0, -3.0, 3.0); 2];
    // The plane y = z; b is n x c', along (0, 1, 1).
    for (d, front) in [([0.0, 0.0, -1.0], 1.0f32), ([0.0, 1.0, 0.0], 1.0), ([0.3, 0.5, 2.0], -1.0)] {
        let d = Vector3::from(d);
        for (x, w) in [(0.01f32, 0.49f32), (1.0, -0.3), (1.99, -0.499), (0.5, 0.0)] {
            let aim = Point3::new(x, w / 2f32.sqrt(), w / 2f32.sqrt());
            let hit = intersect(&curves, &Ray::new(aim - d * 2.0, d)).expect("inside");
            assert!((hit.t - 2.0).abs() < 1e-6 && (hit.u - 0.5 * x).abs() < 1e-6, "{hit:?}");
            assert!((hit.v - w / 0.5).abs() < 3e-6, "{hit:?}");
            let n = Vector3::new(0.0, -1.0, 1.0).normalize();
            assert!((hit.n_g - n).length() < 1e-6 && hit.n_g.dot(d) * front < 0.0, "{hit:?}");
        }
        for (x, w) in [(0.5f32, 0.501f32), (1.0, -0.501), (-0.001, 0.0), (2.001, 0.3)] {
            let aim = Point3::new(x, w / 2f32.sqrt(), w / 2f32.sqrt());
            assert_eq!(intersect(&curves, &Ray::new(aim - d * 2.0, d)), None);
        }
    }
    for x in [0.0, 2.0] {
        let ray = Ray::new(Point3::new(x, 0.1, 3.0), Vector3::new(0.0, 0.0, -1.0));
        assert!(intersect(&curves, &ray).is_some(), "ends belong to it");
    }
    let edge_on = Ray::new(Point3::new(1.0, -3.0, -3.0), Vector3::new(0.0, 1.0, 1.0));
    assert_eq!(intersect(&curves, &edge_on), None);
    curves.normals = vec![Vector3::new(1.0, 0.0, 0.0); 2];
    let ray = Ray::new(Point3::new(1.0, 0.0, 3.0), Vector3::new(0.0, 0.0, -1.0));
    assert_eq!(intersect(&curves, &ray), None, "normals along the curve make no ribbon");
}

#[test]
fn normals_that_pass_through_zero_add_nothing() {
    let mut curves = straight(CurveKind::Oriented, [0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.5]);
    let hit = |curves: &Curves, x: f32| {
        intersect(curves, &Ray::new(Point3::new(x, 0.1, 3.0), Vector3::new(0.0, 0.0, -1.0)))
    };
    for i in 1..40 {
        // 0 near, but by rounding hardly ever at, the same place on the strand; the ribbon stays in its plane.
        let turn = i as f32 / 40.3;
        curves.normals = vec![Vector3::new(0.0, 0.0, turn), Vector3::new(0.0, 0.0, turn - 1.0)];
        for x in [-0.3, -0.01, 1.01, 1.3] {
            assert_eq!(hit(&curves, x), None, "turns at {turn}, beyond the end");
        }
        for x in [0.1, 0.77] {
            let h = hit(&curves, x).expect("inside");
            assert!((h.t - 3.0).abs() < 1e-6 && (h.u - x).abs() < 1e-5, "{h:?}");
        }
    }
}

/// Both edges of the ribbon at `s`.
fn edges(curves: &Curves, s: f64) -> [Point3; 2] {
    let (c, r) = oracle::at(curves, 0, s);
    let n = oracle::at(&Curves { points: normals_as_points(curves), ..curves.clone() }, 0, s).0;
    let b = n.cross(oracle::heading(curves, 0, s)).normalize_or(DVec3::ZERO) * r;
    [Point3::from_f64(c - b), Point3::from_f64(c + b)]
}
fn normals_as_points(curves: &Curves) -> Vec<Point3> {
    curves.normals.iter().map(|n| Point3::ZERO + *n).collect()
}

/// The nearest `(t, s, v)` on a mesh of the ribbon.
fn mesh_hit(curves: &Curves, ray: &Ray) -> Option<(f64, f64, f64)> {
    const PIECES: u32 = 1500;
    let shear = Shear::new(ray)?;
    let rows: Vec<[Point3; 2]> =
        (0..=PIECES).map(|i| edges(curves, f64::from(i) / f64::from(PIECES))).collect();
    let mut best: Option<(f64, f64, f64)> = None;
    for (i, pair) in rows.windows(2).enumerate() {
        let [[a, b], [c, d]] = [pair[0], pair[1]];
        // (vertex, s offset, v) of both halves.
        for corners in
            [[(a, 0.0, -1.0), (b, 0.0, 1.0), (c, 1.0, -1.0)], [(b, 0.0, 1.0), (d, 1.0, 1.0), (c, 1.0, -1.0)]]
        {
            let Some(h) = triangle::intersect(&shear, &corners.map(|c| c.0), ray.t_min, f32::INFINITY) else {
                continue;
            };
            let mean = |f: fn(&(Point3, f64, f64)) -> f64| -> f64 {
                corners.iter().zip(h.weights).map(|(c, w)| f(c) * f64::from(w)).sum()
            };
            if best.is_none_or(|b| f64::from(h.t) < b.0) {
                best = Some((h.t.into(), (i as f64 + mean(|c| c.1)) / f64::from(PIECES), mean(|c| c.2)));
            }
        }
    }
    best
}

#[test]
fn random_ribbons_agree_with_fine_meshes_of_them() {
    let mut random = Random(41);
    let (mut hits, mut differ) = (0, 0);
    for i in 0..600 {
        let curves = invented(&mut random, CurveKind::Oriented, Vector3::ZERO, 1.0, [0.5, 0.1][i % 2]);
        let ray = towards(&mut random, &curves, 0, 1.0);
        match (intersect(&curves, &ray), mesh_hit(&curves, &ray)) {
            (Some(h), Some((t, s, v))) => {
                hits += 1;
                let away = (f64::from(h.t) - t).abs() * ray.d.to_f64().length();
                let near =
                    away < 1e-3 && (f64::from(h.u) - s).abs() < 2e-3 && (f64::from(h.v) - v).abs() < 0.02;
                differ += usize::from(!near);
                if near {
                    let [a, b] = edges(&curves, h.u.into()).map(|p| p.to_f64());
                    let p = a + (b - a) * (0.5 + 0.5 * f64::from(h.v));
                    let off = (p - ray.o.to_f64() - ray.d.to_f64() * f64::from(h.t)).length();
                    assert!(off < 1e-5, "{curves:?} {ray:?} {h:?}: {off}");
                    let step = edges(&curves, f64::from(h.u) + 1e-4).map(|p| p.to_f64());
                    let along = step[0] + (step[1] - step[0]) * (0.5 + 0.5 * f64::from(h.v)) - p;
                    let cosine = h.n_g.to_f64().dot(along.normalize());
                    differ += usize::from(cosine.abs() > 0.02);
                    assert!(h.n_g.to_f64().dot((b - a).normalize()).abs() < 1e-5, "{h:?}");
                }
            }
            (None, None) => {}
            _ => differ += 1,
        }
    }
    // At edges, folds and where the ribbon is seen edge-on a mesh differs.
    assert!(hits > 200 && differ * 50 < hits, "{differ} of {hits}");
}

#[test]
fn smooth_chains_have_no_seams_and_rays_leave_where_they_start() {
    let mut random = Random(42);
    for i in 0..5000 {
        let points: Vec<Point3> =
            (0..6).map(|i| Point3::new(i as f32, 0.0, 0.0) + random.direction() * 0.3).collect();
        let normals: Vec<Vector3> =
            (0..6).map(|_| Vector3::new(0.0, 0.0, 1.0) + random.direction() * 0.3).collect();
        let curves = Curves {
            kind: CurveKind::Oriented,
            basis: super::BASES[1 + i % 2],
            points,
            radii: vec![0.05; 6],
            normals,
            segments: vec![0, 1, 2],
        };
        let [a, b] = edges(&Curves { segments: vec![1], ..curves.clone() }, 0.0);
        let aim = a + (b - a) * random.between(0.05, 0.95);
        let d = Vector3::new(random.between(-0.5, 0.5), random.between(-0.5, 0.5), -1.0);
        let ray = Ray::new(aim - d * 2.0, d);
        let hit = |s: u32, ray: &Ray| curves.intersect(s, ray, f32::INFINITY);
        let found = hit(0, &ray).or(hit(1, &ray)).expect("one of both");
        assert!((found.t - 2.0).abs() < 1e-4, "{found:?}");
        // A plane rectangle, so that there is nothing else to meet.
        let mut flat = straight(CurveKind::Oriented, [0.0; 3], [1.0, 0.0, 0.0], [0.3, 0.3]);
        flat.normals = vec![random.direction() + Vector3::new(0.0, 2.0, 0.0); 2];
        let towards = Ray::new(Point3::new(0.4, 3.0, 0.1), Vector3::new(0.1, -3.0, 0.0));
        let Some(h) = intersect(&flat, &towards) else { continue };
        let [a, b] = edges(&flat, h.u.into());
        let o = Point3::from_f64(a.to_f64() + (b - a).to_f64() * (0.5 + 0.5 * f64::from(h.v)));
        let again = intersect(&flat, &Ray::new(o, random.direction()));
        assert!(again.is_none(), "{flat:?} {o:?} {again:?}");
    }
}
