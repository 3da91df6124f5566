//! Curves and points in scenes: trees of every register width, brute force and the plain loop over all find the same hits.
use durer_accel::curve::{CurveBasis, CurveError, CurveKind, Curves};
use durer_accel::point::{PointError, PointKind, Points};
use durer_accel::{
    Accel, AccelBuilder, BuildError, BuildOptions, Engine, Hit, Isa, Placement, PrimitiveHit,
    TraversalCounts, UserGeometry, Visibility,
};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Motion, Point3, Ray, Transform, Vector3};

use crate::corpus::{Random, ray_count};
use crate::icosphere::icosphere;

const CURVES: [CurveKind; 3] = [CurveKind::Round, CurveKind::Flat, CurveKind::Oriented];
const POINTS: [PointKind; 3] = [PointKind::Sphere, PointKind::Disc, PointKind::OrientedDisc];
const BASES: [(CurveBasis, usize); 4] =
    [(CurveBasis::Bezier, 3), (CurveBasis::BSpline, 1), (CurveBasis::CatmullRom, 1), (CurveBasis::Linear, 1)];

/// Chains of segments inside a cube of half width 2.
pub(crate) fn strands(random: &mut Random, kind: CurveKind, chains: usize) -> Curves {
    let (basis, step) = BASES[random.below(4)];
    let mut curves = Curves {
        kind,
        basis,
        points: Vec::new(),
        radii: Vec::new(),
        normals: Vec::new(),
        segments: Vec::new(),
    };
    for _ in 0..chains {
        let mut p = random.point(2.0);
        let first = curves.points.len();
        let segments = 1 + random.below(4);
        for _ in 0..basis.points() + step * (segments - 1) {
            curves.points.push(p);
            p = p + random.direction() * random.between(0.1, 0.6);
            curves.radii.push(random.between(0.005, 0.1));
            if kind == CurveKind::Oriented {
                curves.normals.push(random.direction() + Vector3::new(0.0, 0.0, 1.5));
            }
        }
        curves.segments.extend((0..segments).map(|i| (first + i * step) as u32));
    }
    curves
}

/// Points inside a cube of half width 2, some of them twice.
pub(crate) fn cloud(random: &mut Random, kind: PointKind, count: usize) -> Points {
    let mut centers: Vec<_> = (0..count).map(|_| random.point(2.0)).collect();
    let mut radii: Vec<_> = (0..count).map(|_| random.between(0.01, 0.2)).collect();
    for i in (0..count).step_by(10) {
        (centers[i], radii[i]) = (centers[count - 1 - i], radii[count - 1 - i]);
    }
    let normals = match kind {
        PointKind::OrientedDisc => (0..count).map(|_| random.direction()).collect(),
        _ => Vec::new(),
    };
    Points { kind, centers, radii, normals }
}

/// Where instances are, and who sees them.
fn places(random: &mut Random) -> [(Placement, Visibility); 3] {
    let mut affine = || {
        let turn =
            DQuat::from_axis_angle(random.direction().to_f64().normalize(), random.between(0.0, 3.0).into());
        let scale = DVec3::new(random.between(0.3, 1.5).into(), -0.7, random.between(0.3, 1.5).into());
        DAffine3::from_scale_rotation_translation(scale, turn, random.point(2.0).to_f64())
    };
    let motion = Motion::keyed(vec![(0.0, affine()), (1.0, affine())]).expect("sound keys");
    let masked = Visibility { mask: 2, ..Visibility::default() };
    [
        (Placement::Identity, Visibility::default()),
        (Placement::Still(Transform::from_f64(&affine())), masked),
        (Placement::from_motion(&motion), Visibility::default()),
    ]
}

struct Scene {
    curves: Vec<Curves>,
    points: Vec<Points>,
    /// Geometries count curves first; the mesh is the last.
    instances: Vec<(usize, Placement, Visibility)>,
    landmarks: Vec<Point3>,
}

impl Scene {
    fn new(random: &mut Random) -> Self {
        let curves: Vec<_> = CURVES.iter().map(|kind| strands(random, *kind, 40)).collect();
        let points: Vec<_> = POINTS.iter().map(|kind| cloud(random, *kind, 80)).collect();
        let mut instances = vec![(6, Placement::Identity, Visibility::default())];
        // One of each kind of shapes is placed once and lies in the scene's tree, the others have trees of their own.
        for geometry in 0..6 {
            let places = places(random);
            let count = if geometry % 3 == 0 { 1 } else { 3 };
            instances.extend(places.into_iter().take(count).map(|(p, v)| (geometry, p, v)));
        }
        let landmarks = curves.iter().flat_map(|c| c.points.iter()).chain(&points[0].centers);
        let landmarks = landmarks.copied().collect();
        Self { curves, points, instances, landmarks }
    }
    fn build(&self, options: BuildOptions) -> Accel {
        let mut builder = AccelBuilder::new(options);
        let mut ids = Vec::new();
        ids.extend(self.curves.iter().map(|c| builder.curves(c.clone()).expect("sound curves")));
        ids.extend(self.points.iter().map(|p| builder.points(p.clone()).expect("sound points")));
        ids.push(builder.triangles(icosphere(1)).expect("sound mesh"));
        for (geometry, placement, seen) in &self.instances {
            builder.instance_seen(ids[*geometry], placement.clone(), *seen).expect("sound placement");
        }
        builder.build().expect("within limits")
    }
    fn primitives(&self) -> u64 {
        let mut sizes: Vec<usize> = self.curves.iter().map(|c| c.segments.len()).collect();
        sizes.extend(self.points.iter().map(|p| p.centers.len()));
        sizes.push(icosphere(1).indices.len());
        self.instances.iter().map(|(geometry, ..)| sizes[*geometry] as u64).sum()
    }
}

/// Every third primitive has a hole wherever `u` is small.
struct Holes;

impl UserGeometry for Holes {
    const FILTERS: bool = true;
    fn intersect(&self, _: u32, _: u32, _: &Ray, _: f32) -> Option<PrimitiveHit> {
        panic!("there are no shapes of the caller")
    }
    fn accepts(&self, hit: &Hit) -> bool {
        !hit.prim.is_multiple_of(3) || hit.u > 0.4
    }
}

fn bits(hit: Hit) -> [u32; 8] {
    let [x, y, z] = hit.n_g.to_array().map(f32::to_bits);
    [hit.instance, hit.prim, hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), x, y, z]
}

#[test]
fn trees_of_curves_and_points_find_the_hits_of_brute_force() {
    let mut hits = [0; 7];
    for seed in 0..6 {
        let mut random = Random(600 + seed);
        let scene = Scene::new(&mut random);
        let brute = scene.build(BuildOptions { engine: Engine::BruteForce, ..BuildOptions::default() });
        let with = |isa| scene.build(BuildOptions { isa: Some(isa), ..BuildOptions::default() });
        let trees: Vec<_> = Isa::available().into_iter().map(with).collect();
        for _ in 0..ray_count(6000) / 6 {
            let ray = random.ray(5.0, &scene.landmarks);
            let mask = 1 + random.below(3) as u32;
            let plain = brute.query(&ray).mask(mask).closest();
            let holed = brute.query(&ray).mask(mask).user(&Holes).closest();
            for tree in &trees {
                let query = || tree.query(&ray).mask(mask);
                assert_eq!(query().closest().map(bits), plain.map(bits), "{ray:?} {:?}", tree.isa());
                assert_eq!(query().any(), plain.is_some(), "{ray:?}");
                assert_eq!(query().user(&Holes).closest().map(bits), holed.map(bits), "{ray:?}");
                assert_eq!(query().user(&Holes).any(), holed.is_some(), "{ray:?}");
            }
            if let Some(hit) = plain {
                hits[brute.instance_geometry(hit.instance).index()] += 1;
                let is_unit = (hit.n_g.length() - 1.0).abs() < 1e-5;
                assert!(is_unit || brute.instance_geometry(hit.instance).index() == 6, "{hit:?}");
                assert!(scene.instances[hit.instance as usize].2.mask & mask != 0);
            }
        }
    }
    assert!(hits.iter().all(|n| *n > 40), "{hits:?}: the test means little");
}

#[test]
fn the_nearest_of_all_segments_is_hit_and_its_normal_told() {
    let mut random = Random(700);
    let mut hits = 0;
    for kind in CURVES {
        let curves = strands(&mut random, kind, 100);
        let mut builder = AccelBuilder::new(BuildOptions::default());
        let id = builder.curves(curves.clone()).expect("sound curves");
        builder.instance(id, Placement::Identity).expect("sound placement");
        let accel = builder.build().expect("within limits");
        assert_eq!(accel.stats().curve_segments, curves.segments.len() as u64);
        for _ in 0..1500 {
            let ray = random.ray(4.0, &curves.points);
            let all = (0..curves.segments.len() as u32).filter_map(|segment| {
                let hit = curves.intersect(segment, &ray, ray.t_max.min(f32::MAX))?;
                Some((segment, hit))
            });
            let expected = all.min_by(|a, b| a.1.t.total_cmp(&b.1.t).then(a.0.cmp(&b.0)));
            let got = accel.closest(&ray).map(|h| (h.prim, h.t, h.u, h.v, h.n_g));
            assert_eq!(got, expected.map(|(segment, h)| (segment, h.t, h.u, h.v, h.n_g)), "{ray:?}");
            hits += usize::from(got.is_some());
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn the_nearest_of_all_points_is_hit_and_its_normal_told() {
    let mut random = Random(701);
    let mut hits = 0;
    for kind in POINTS {
        let points = cloud(&mut random, kind, 200);
        let mut builder = AccelBuilder::new(BuildOptions::default());
        let id = builder.points(points.clone()).expect("sound points");
        builder.instance(id, Placement::Identity).expect("sound placement");
        let accel = builder.build().expect("within limits");
        assert_eq!(accel.stats().points, 200);
        for _ in 0..1500 {
            let ray = random.ray(4.0, &points.centers);
            let all = (0..200).filter_map(|prim| Some((prim, points.intersect(prim, &ray, f32::MAX)?)));
            let all = all.filter(|(_, hit)| hit.t <= ray.t_max);
            let expected = all.min_by(|a, b| a.1.t.total_cmp(&b.1.t).then(a.0.cmp(&b.0)));
            let got = accel.closest(&ray).map(|h| (h.prim, h.t, h.u, h.v, h.n_g));
            assert_eq!(got, expected.map(|(prim, h)| (prim, h.t, 0.0, 0.0, h.n_g)), "{ray:?}");
            hits += usize::from(got.is_some());
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn brute_force_tests_every_segment_and_point_and_trees_test_few() {
    let mut random = Random(702);
    let scene = Scene::new(&mut random);
    let brute = scene.build(BuildOptions { engine: Engine::BruteForce, ..BuildOptions::default() });
    let tree = scene.build(BuildOptions::default());
    let (mut all, mut few) = (TraversalCounts::default(), TraversalCounts::default());
    for _ in 0..100 {
        let ray = Ray::new(random.point(4.0), random.direction());
        brute.query(&ray).probe(&mut all, ()).closest();
        tree.query(&ray).probe(&mut few, ()).closest();
    }
    assert_eq!(all, TraversalCounts { nodes: 0, primitives: 100 * scene.primitives() });
    assert!(few.primitives * 10 < all.primitives, "{few:?} {all:?}");
}

#[test]
fn unsound_curves_and_points_are_refused() {
    let mut random = Random(703);
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let mut curves = strands(&mut random, CurveKind::Round, 3);
    curves.radii[2] = f32::NAN;
    assert_eq!(builder.curves(curves), Err(BuildError::Curves(CurveError::RadiusInvalid { point: 2 })));
    let mut points = cloud(&mut random, PointKind::Disc, 5);
    points.centers[4].x = f32::INFINITY;
    let error = builder.points(points).expect_err("a mistake");
    assert_eq!(error, BuildError::Points(PointError::CenterNotFinite { point: 4 }));
    assert!(error.to_string().contains("centre 4"), "{error}");
    let huge = Points {
        kind: PointKind::Sphere,
        centers: vec![Point3::splat(3e38)],
        radii: vec![3e38],
        normals: vec![],
    };
    // Its box is infinite: it is tested with every ray.
    let id = builder.points(huge).expect("sound points");
    builder.instance(id, Placement::Identity).expect("sound placement");
    let accel = builder.build().expect("within limits");
    let ray = Ray::new(Point3::ZERO, Vector3::splat(1.0));
    assert!(accel.closest(&ray).is_some_and(|hit| hit.t > 1e38 && hit.t < 1.3e38));
}
