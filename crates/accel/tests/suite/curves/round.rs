//! Round curves: cylinders and cones in closed form, any cubic against traced spheres.
use durer_accel::curve::{CurveBasis, CurveKind, Curves};
use durer_core::math::{Normal3, Point3, Ray, Vector3, error::offset_ray_origin};

use super::{intersect, invented, oracle, straight, towards};
use crate::corpus::{Random, ray_count};

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() <= 3e-7 * b.abs().max(1.0)
}

#[test]
fn a_straight_curve_is_a_cylinder_with_half_balls() {
    let curves = straight(CurveKind::Round, [-3.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.5, 0.5]);
    for i in -9..=9 {
        let y = 0.05 * i as f32;
        let ray = Ray::new(Point3::new(1.0, y, 4.0), Vector3::new(0.0, 0.0, -2.0));
        let hit = intersect(&curves, &ray).expect("a hit");
        let depth = (0.25 - y * y).sqrt();
        assert!(close(hit.t, (4.0 - depth) / 2.0), "{hit:?}");
        assert!(close(hit.u, 0.5), "{hit:?}");
        // Direction times curve, -z times x, is -y.
        assert!(close(hit.v, -y / 0.5), "{hit:?}");
        assert!((hit.n_g - Vector3::new(0.0, y, depth) * 2.0).length() < 1e-6, "{hit:?}");
        let far = intersect(&curves, &Ray { t_min: hit.t.next_up(), ..ray }).expect("the way out");
        assert!(close(far.t, (4.0 + depth) / 2.0), "{far:?}");
        let inside = Ray { o: Point3::new(1.0, y, 0.0), ..ray };
        assert!(close(intersect(&curves, &inside).expect("the way out").t, depth / 2.0));
        // Along the axis: through both ends.
        let along = Ray::new(Point3::new(-5.0, y, 0.0), Vector3::new(1.0, 0.0, 0.0));
        let end = intersect(&curves, &along).expect("the end");
        assert!(close(end.t, 2.0 - depth) && end.u == 0.0, "{end:?}");
        let out = intersect(&curves, &Ray { t_min: 3.0, ..along }).expect("the other end");
        assert!(close(out.t, 10.0 + depth) && out.u == 1.0, "{out:?}");
    }
    let beside = Ray::new(Point3::new(1.0, 0.500_001, 4.0), Vector3::new(0.0, 0.0, -2.0));
    assert_eq!(intersect(&curves, &beside), None);
}

#[test]
fn a_linear_radius_makes_the_cone_that_touches_both_balls() {
    // Half angle alpha with sin alpha = k: at x the surface is (r0 + k x) / cos alpha from the axis.
    let curves = straight(CurveKind::Round, [0.0; 3], [4.0, 0.0, 0.0], [1.5, 0.5]);
    let k = -0.25f32;
    let cosine = (1.0 - k * k).sqrt();
    for i in 4..15 {
        let x = 0.25 * i as f32;
        let ray = Ray::new(Point3::new(x, 0.0, 3.0), Vector3::new(0.0, 0.0, -1.0));
        let hit = intersect(&curves, &ray).expect("a hit");
        let surface = (1.5 + k * x) / cosine;
        assert!(close(hit.t, 3.0 - surface), "{hit:?} {surface}");
        assert!((hit.n_g - Vector3::new(-k, 0.0, cosine)).length() < 1e-6, "{hit:?}");
    }
}

#[test]
fn a_ball_inside_another_does_not_show() {
    let curves = straight(CurveKind::Round, [0.0; 3], [0.2, 0.0, 0.0], [1.0, 0.5]);
    let ray = Ray::new(Point3::new(3.0, 0.0, 0.0), Vector3::new(-1.0, 0.0, 0.0));
    assert!(close(intersect(&curves, &ray).expect("the larger ball").t, 2.0));
    let point = straight(CurveKind::Round, [0.0; 3], [0.0; 3], [1.0, 1.0]);
    assert!(close(intersect(&point, &ray).expect("all in one place").t, 2.0));
    let nothing = straight(CurveKind::Round, [0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0]);
    assert_eq!(intersect(&nothing, &ray), None);
    // All balls touch one another where the ray enters: any of them may be named.
    let nested = straight(CurveKind::Round, [0.0; 3], [1.0, 0.0, 0.0], [2.0, 1.0]);
    assert!(close(intersect(&nested, &ray).expect("where all touch").t, 1.0));
}

#[test]
fn random_cubics_agree_with_traced_spheres() {
    let mut random = Random(21);
    let (mut hits, mut inside) = (0, 0);
    for i in 0..ray_count(1500).min(30_000) {
        let thickness = [0.5, 0.1, 0.01, 0.001][i % 4];
        let curves = invented(&mut random, CurveKind::Round, Vector3::ZERO, 1.0, thickness);
        let mut ray = towards(&mut random, &curves, 0, 1.0);
        if i % 5 == 0 {
            ray.o = Point3::from_f64(oracle::at(&curves, 0, random.unit().into()).0);
            inside += 1;
        }
        let hit = intersect(&curves, &ray);
        hits += usize::from(hit.is_some());
        oracle::assert_round(&curves, 0, &ray, hit);
    }
    assert!(hits > 700 && inside > 200, "{hits} {inside}");
}

#[test]
fn random_cubics_agree_at_every_scale_and_place() {
    let mut random = Random(22);
    let mut hits = 0;
    for i in 0..600 {
        let size = [1e-4, 1e-2, 1e3, 1e6][i % 4];
        let center = random.direction() * [0.0, 10.0, 1000.0][i % 3] * size;
        let curves = invented(&mut random, CurveKind::Round, center, size, 0.2);
        let ray = towards(&mut random, &curves, 0, size);
        let hit = intersect(&curves, &ray);
        hits += usize::from(hit.is_some());
        oracle::assert_round(&curves, 0, &ray, hit);
    }
    assert!(hits > 300, "{hits}");
}

#[test]
fn rays_along_thin_strands_agree() {
    let mut random = Random(23);
    for _ in 0..300 {
        let mut curves = invented(&mut random, CurveKind::Round, Vector3::ZERO, 1.0, 0.02);
        // Nearly straight along x, then looked at along x.
        for (i, p) in curves.points.iter_mut().enumerate() {
            *p = Point3::new(i as f32, 0.01 * p.y, 0.01 * p.z);
        }
        let o = Point3::new(-1.0, random.between(-0.02, 0.02), random.between(-0.02, 0.02));
        let ray = Ray::new(o, Vector3::new(1.0, random.between(-0.01, 0.01), random.between(-0.01, 0.01)));
        oracle::assert_round(&curves, 0, &ray, intersect(&curves, &ray));
    }
}

/// A strand of B-spline segments that winds, with radii of its own.
fn chain(random: &mut Random, basis: CurveBasis, radius: f32, winding: f32) -> Curves {
    let points: Vec<Point3> =
        (0..13).map(|i| Point3::new(0.5 * i as f32, 0.0, 0.0) + random.direction() * winding).collect();
    let segments = match basis {
        CurveBasis::Bezier => vec![0, 3, 6, 9],
        _ => (0..10).collect(),
    };
    let radii = points.iter().map(|_| radius * random.between(0.5, 1.5)).collect();
    Curves { kind: CurveKind::Round, basis, points, radii, normals: Vec::new(), segments }
}

#[test]
fn no_ray_passes_between_the_segments_of_a_chain() {
    let mut random = Random(24);
    for i in 0..ray_count(20_000).min(200_000) {
        let basis = super::BASES[i % 4];
        let curves = chain(&mut random, basis, [0.1, 0.01, 1e-3][i % 3], 0.3);
        let joint = 1 + random.below(curves.segments.len() - 1) as u32;
        let (c, r) = oracle::at(&curves, joint, 0.0);
        let heading = oracle::heading(&curves, joint, 0.0).normalize();
        // Almost in the plane between both, up to the rim.
        let across = heading.cross(random.direction().to_f64()).normalize();
        let aim = c + across * (f64::from(random.between(0.0, 0.999)) * r);
        let d = across.cross(heading) + heading * f64::from(random.between(-1e-3, 1e-3));
        let ray = Ray::new(Point3::from_f64(aim - d * 3.0), Vector3::from_f64(d));
        // Fat chains wind through themselves: the nearest may be another segment.
        let hit = |s: u32| curves.intersect(s, &ray, f32::INFINITY).is_some();
        assert!((0..curves.segments.len() as u32).any(hit), "{curves:?} {joint} {ray:?}");
    }
}

#[test]
fn there_are_no_walls_inside_a_chain() {
    let mut random = Random(26);
    let mut crossed = 0;
    for i in 0..600 {
        let basis = [CurveBasis::BSpline, CurveBasis::CatmullRom, CurveBasis::Linear][i % 3];
        let curves = chain(&mut random, basis, 0.04, 0.15);
        let segments = curves.segments.len();
        let start = random.below(segments - 2) as u32;
        let (o, _) = oracle::at(&curves, start, 0.95);
        let (aim, _) = oracle::at(&curves, start + 1, 0.1);
        let o = Point3::from_f64(o);
        let ray = Ray::new(o, Point3::from_f64(aim) - o + random.direction() * 0.01);
        let nearest = (0..segments as u32)
            .filter_map(|s| curves.intersect(s, &ray, f32::INFINITY).map(|h| (h.t, s)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let (t, segment) = nearest.expect("a way out");
        crossed += usize::from(segment != start);
        let p = ray.o.to_f64() + ray.d.to_f64() * f64::from(t);
        let depth =
            (0..segments as u32).map(|s| oracle::distance(&curves, s, p)).fold(f64::INFINITY, f64::min);
        assert!(depth.abs() < 1e-5 * 0.04, "{curves:?} {ray:?}: {depth} at {t}");
    }
    assert!(crossed > 300, "{crossed}");
}

#[test]
fn a_ray_that_leaves_the_surface_does_not_meet_it_where_it_starts() {
    let mut random = Random(25);
    let mut starts = 0;
    for i in 0..4000 {
        let size = [1.0, 1e-3, 1e4][i % 3];
        let center = random.direction() * ([0.0, 3.0][i % 2] * size);
        let curves = invented(&mut random, CurveKind::Round, center, size, [0.3, 0.05][i % 2]);
        let ray = towards(&mut random, &curves, 0, size);
        let Some(hit) = intersect(&curves, &ray) else { continue };
        let r = oracle::at(&curves, 0, hit.u.into()).1;
        let surface = curves.surface(0, &ray, &hit);
        let off = oracle::distance(&curves, 0, surface.p.to_f64()).abs();
        let allowed = f64::from(hit.n_g.abs().dot(surface.p_error));
        assert!(off <= allowed && allowed < 1e-5 * f64::from(size), "{surface:?}: {off} > {allowed}");
        let d = random.direction();
        // As it is, or offset as renderers do.
        let o = match i % 4 {
            0 => offset_ray_origin(surface.p, surface.p_error, Normal3::from(hit.n_g.to_array()), d),
            _ => surface.p,
        };
        let cosine = d.dot(hit.n_g);
        if cosine.abs() < 0.1 {
            continue;
        }
        starts += 1;
        // The nearest other place, wherever the curve bends, is further than noise.
        let least = 1e-3 * r * f64::from(cosine.abs());
        if let Some(again) = intersect(&curves, &Ray::new(o, d)) {
            assert!(f64::from(again.t) > least, "{curves:?} from {o:?} along {d:?}: {again:?}");
        } else {
            assert!(cosine > 0.0, "{curves:?} from {o:?} along {d:?} into nothing");
        }
    }
    assert!(starts > 1000, "{starts}");
}

#[test]
fn rays_leave_surfaces_through_the_worlds_origin() {
    // No coordinate of the origin is rounded there: what is left is the error of the hit itself.
    let mut random = Random(27);
    for i in 0..3000 {
        let size = [1.0, 1.0 / 8192.0, 131_072.0][i % 3];
        // (2, 3, 6) has length 7; the curve runs across it. All of that is exact in f32.
        let mut sixteenth = || random.below(17) as f32 / 16.0;
        let at = |k: f32| [(2.0 + 3.0 * k) * size, (3.0 - 2.0 * k) * size, 6.0 * size];
        let curves = straight(CurveKind::Round, at(-sixteenth()), at(sixteenth()), [7.0 * size; 2]);
        let curves = if i % 2 == 0 { curves } else { Curves { points: vec![at(0.0).into(); 2], ..curves } };
        let d = random.direction();
        let cosine = -d.dot(Vector3::new(2.0, 3.0, 6.0)) / 7.0;
        let hit = intersect(&curves, &Ray::new(Point3::ZERO, d));
        if cosine > 0.05 {
            assert_eq!(hit, None, "{curves:?} {d:?}");
        } else if cosine < -0.05 {
            assert!(hit.is_some_and(|h| h.t > 0.05 * size), "{curves:?} {d:?}: {hit:?}");
        }
    }
}

#[test]
fn a_tapered_end_is_hit_up_to_its_tip() {
    let curves = straight(CurveKind::Round, [0.0; 3], [1.0, 0.0, 0.0], [0.1, 0.0]);
    for i in 1..40 {
        let x = 1.0 - 0.5f32.powi(i.min(20));
        let ray = Ray::new(Point3::new(x, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0));
        let hit = intersect(&curves, &ray).expect("up to the tip");
        let surface = 0.1 * (1.0 - x) / 0.99f32.sqrt();
        assert!((hit.t - (1.0 - surface)).abs() < 1e-7, "{hit:?}");
    }
}
