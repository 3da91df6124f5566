//! Validation G2: three ways to intersect a triangle agree; a hit does not lie within its own rounding error.
use durer_accel::triangle::{Shear, TriangleHit, cramer, intersect};
use durer_core::math::{Normal3, Point3, Ray, Vector3, error};

use crate::corpus::{Random, ray_count};

/// All angles above 10 degrees.
fn triangle(random: &mut Random) -> [Point3; 3] {
    loop {
        let t: [Point3; 3] = std::array::from_fn(|_| random.point(1.0));
        let sharpest = (0..3).map(|i| {
            let (a, b) = (t[(i + 1) % 3] - t[i], t[(i + 2) % 3] - t[i]);
            a.dot(b) / (a.length() * b.length())
        });
        if sharpest.fold(-1.0, f32::max) < 0.98 && (t[1] - t[0]).length() > 0.2 {
            return t;
        }
    }
}

/// The lecture's other test: plane first, then weights as ratios of signed areas; in f64, for lines rather than rays.
fn area_ratios(ray: &Ray, t: &[Point3; 3]) -> (f64, [f64; 3], f64) {
    let [a, b, c] = t.map(Point3::to_f64);
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let n = (b - a).cross(c - a);
    let distance = n.dot(a - o) / n.dot(d);
    let p = o + d * distance;
    let area =
        |u: durer_core::glam::DVec3, v: durer_core::glam::DVec3| n.dot((u - p).cross(v - p)) / n.dot(n);
    (distance, [area(b, c), area(c, a), area(a, b)], n.dot(d).abs() / (n.length() * d.length()))
}

#[test]
fn cramer_area_ratios_and_watertight_agree() {
    let mut random = Random(1);
    let (mut inside, mut near_edge) = (0, 0);
    let rays = ray_count(100_000);
    for _ in 0..rays {
        let t = triangle(&mut random);
        let o = random.point(3.0);
        // Around the middle of the triangle, so that about half the rays hit.
        let weights = [random.between(-0.3, 1.0), random.between(-0.3, 1.0)];
        let aim = t[0] + (t[1] - t[0]) * weights[0] + (t[2] - t[0]) * weights[1];
        let ray = Ray::new(o, (aim - o).normalize());
        let (distance, exact, cosine) = area_ratios(&ray, &t);
        if cosine < 0.1736 || distance < 0.01 {
            continue;
        }
        let smallest = exact.iter().copied().fold(f64::INFINITY, f64::min);
        if smallest.abs() < 1e-4 {
            near_edge += 1;
            continue;
        }
        let shear = Shear::new(&ray).expect("valid direction");
        let watertight = intersect(&shear, &t, 0.0, f32::INFINITY);
        let lecture = cramer(&ray, &t);
        assert_eq!(watertight.is_some(), smallest > 0.0, "{ray:?} {t:?}");
        assert_eq!(lecture.is_some(), smallest > 0.0, "{ray:?} {t:?}");
        let (Some(hit), Some((lt, beta, gamma))) = (watertight, lecture) else {
            continue;
        };
        inside += 1;
        let sum: f64 = hit.weights.iter().map(|w| f64::from(*w)).sum();
        assert!((sum - 1.0).abs() < 2e-6, "{sum}");
        assert!(hit.weights.iter().all(|w| (0.0..=1.0).contains(w)));
        let close = |x: f32, y: f64, tolerance: f64| (f64::from(x) - y).abs() < tolerance;
        assert!(close(hit.t, distance, 2e-5) && close(lt, distance, 1e-4), "{hit:?} {lt} {distance}");
        assert!((0..3).all(|i| close(hit.weights[i], exact[i], 1e-4)), "{hit:?} {exact:?}");
        assert!(close(beta, exact[1], 1e-4) && close(gamma, exact[2], 1e-4));
    }
    assert!(inside > rays / 5 && near_edge < rays / 100, "{inside} inside, {near_edge} near an edge");
}

#[test]
fn weights_sum_to_one_on_edges_and_vertices() {
    let mut random = Random(2);
    let mut hits = 0;
    for _ in 0..20_000 {
        let t = triangle(&mut random);
        let o = random.point(3.0);
        let aim = if random.below(2) == 0 { t[random.below(3)] } else { t[0] + (t[1] - t[0]) * 0.5 };
        let ray = Ray::new(o, aim - o);
        let Some(TriangleHit { weights, .. }) =
            intersect(&Shear::new(&ray).expect("valid direction"), &t, 0.0, f32::INFINITY)
        else {
            continue;
        };
        hits += 1;
        assert!((weights.iter().map(|w| f64::from(*w)).sum::<f64>() - 1.0).abs() < 2e-6, "{weights:?}");
    }
    assert!(hits > 5_000, "{hits}");
}

#[test]
fn rays_that_start_on_a_triangle_do_not_meet_it_at_zero() {
    let mut random = Random(5);
    for scale in [1e-4, 1.0, 1e6] {
        for _ in 0..10_000 {
            // The plane z = 0 holds the origin exactly; every direction leaves it, many at a grazing angle.
            let flat = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 0.0]]
                .map(|p| Point3::new(p[0] * scale, p[1] * scale, p[2] * scale));
            let o = Point3::new(random.between(-0.9, 0.4) * scale, random.between(-0.9, 0.4) * scale, 0.0);
            let mut d = random.direction();
            d.z *= [1.0, 1e-3, 1e-6][random.below(3)];
            let shear = Shear::new(&Ray::new(o, d)).expect("valid direction");
            assert_eq!(intersect(&shear, &flat, 0.0, f32::INFINITY), None, "{o:?} {d:?}");
        }
    }
}

#[test]
fn rays_that_start_on_an_edge_or_vertex_do_not_meet_it_at_zero() {
    let mut random = Random(9);
    for _ in 0..50_000 {
        // Coordinates with few bits: the origin lies on the edge exactly, and often sees edge functions of 0.
        let t = triangle(&mut random).map(|p| {
            let round = |x: f32| (x * 64.0).round() / 64.0;
            Point3::new(round(p.x), round(p.y), round(p.z))
        });
        let o = t[0] + (t[1] - t[0]) * (random.below(9) as f32 / 8.0);
        let shear = Shear::new(&Ray::new(o, random.direction())).expect("valid direction");
        assert_eq!(intersect(&shear, &t, 0.0, f32::INFINITY), None, "{t:?} {o:?}");
    }
}

#[test]
fn offset_origins_on_tilted_triangles_never_hit_them_again() {
    let mut random = Random(6);
    for scale in [1e-4, 1.0, 1e6] {
        for _ in 0..20_000 {
            let t = triangle(&mut random).map(|p| Point3::new(p.x * scale, p.y * scale, p.z * scale));
            let (u, v) = (random.between(0.0, 0.5), random.between(0.0, 0.5));
            let weights = [1.0 - u - v, u, v];
            let terms: [Vector3; 3] = std::array::from_fn(|i| (t[i] - Point3::ZERO) * weights[i]);
            let p = Point3::ZERO + (terms[0] + terms[1] + terms[2]);
            let e = (terms[0].abs() + terms[1].abs() + terms[2].abs()) * error::gamma(7);
            let n = Normal3::from((t[1] - t[0]).cross(t[2] - t[0]).normalize());
            let mut w = random.direction();
            if random.below(2) == 0 {
                // Grazing: nearly all of the normal part taken away.
                w = w - Vector3::from(n) * (w.dot(n) * 0.9999);
            }
            let o = error::offset_ray_origin(p, e, n, w);
            let shear = Shear::new(&Ray::new(o, w)).expect("valid direction");
            assert_eq!(intersect(&shear, &t, 0.0, f32::INFINITY), None, "{t:?} {o:?} {w:?}");
        }
    }
}

#[test]
fn degenerate_triangles_are_never_hit() {
    let mut random = Random(8);
    for _ in 0..10_000 {
        let (a, b) = (random.point(1.0), random.point(1.0));
        let o = random.point(2.0);
        let ray = Ray::new(o, a - o);
        let shear = Shear::new(&ray).expect("valid direction");
        for t in [[a, a, a], [a, b, b], [a, b, a]] {
            assert_eq!(intersect(&shear, &t, 0.0, f32::INFINITY), None);
            assert_eq!(cramer(&ray, &t), None);
        }
    }
}

#[test]
fn coordinates_whose_products_overflow_or_vanish_are_hit() {
    for scale in [1e-25f32, 1e-12, 1e12, 1e25] {
        let t = [[-1.0, -1.0, 1.0], [2.0, -1.0, 1.0], [-1.0, 2.0, 1.0]]
            .map(|p| Point3::new(p[0] * scale, p[1] * scale, p[2] * scale));
        let ray = Ray::new(Point3::ZERO, Vector3::new(0.1, 0.0, 1.0));
        let hit =
            intersect(&Shear::new(&ray).expect("valid direction"), &t, 0.0, f32::INFINITY).expect("hits");
        assert!((hit.t / scale - 1.0).abs() < 1e-5, "{hit:?} at {scale}");
    }
}
