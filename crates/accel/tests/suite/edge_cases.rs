//! Empty scenes, impossible rays, mistakes in the input, and what a debugger asks.
use durer_accel::{
    Accel, AccelBuilder, BuildError, BuildOptions, Engine, Placement, TraversalCounts, TraversalProbe,
    Triangles,
};
use durer_core::glam::{DAffine3, DVec3};
use durer_core::math::{Bounds3, Point3, Ray, Transform, Vector3};

use crate::corpus::{Random, Shape, Shapes};
use crate::icosphere::icosphere;

/// The slab test in f64, with nothing of the kernel in it.
fn enters(ray: &Ray, b: &Bounds3) -> bool {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let (t0, t1) = ((b.min.to_f64() - o) / d, (b.max.to_f64() - o) / d);
    t0.min(t1).max_element().max(ray.t_min.into()) <= t0.max(t1).min_element()
}

const ENGINES: [Engine; 2] = [Engine::Bvh, Engine::BruteForce];

fn builder(engine: Engine) -> AccelBuilder<'static> {
    AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() })
}
fn closest(accel: &Accel, ray: &Ray) -> Option<durer_accel::Hit> {
    accel.query(ray).closest()
}
fn square() -> Triangles {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    Triangles { positions: positions.to_vec(), indices: vec![[0, 1, 2], [0, 2, 3]] }
}

#[test]
fn empty_scenes_are_never_hit() {
    for engine in ENGINES {
        let nothing = builder(engine).build().expect("within limits");
        let mut b = builder(engine);
        let (mesh, boxes) = (b.triangles(Triangles::default()), b.user(vec![]));
        b.instance(mesh.expect("empty mesh"), Placement::Identity).expect("valid placement");
        b.instance(boxes.expect("no boxes"), Placement::Identity).expect("valid placement");
        for accel in [nothing, b.build().expect("within limits")] {
            let ray = Ray::new(Point3::ZERO, Vector3::new(1.0, 2.0, 3.0));
            assert_eq!(closest(&accel, &ray), None);
            assert!(!accel.query(&ray).any());
            assert!(accel.bounds().is_empty() && accel.stats().triangles == 0);
        }
    }
}

#[test]
fn impossible_rays_hit_nothing() {
    let mut b = builder(Engine::Bvh);
    let id = b.triangles(square()).expect("valid mesh");
    b.instance(id, Placement::Identity).expect("valid placement");
    let accel = b.build().expect("within limits");
    let good = Ray::new(Point3::new(0.3, 0.6, -1.0), Vector3::new(0.0, 0.0, 1.0));
    assert_eq!(closest(&accel, &good).map(|h| (h.t, h.prim)), Some((1.0, 1)));
    let bad = [
        Ray { d: Vector3::ZERO, ..good },
        Ray { d: Vector3::new(f32::NAN, 0.0, 1.0), ..good },
        Ray { d: Vector3::new(0.0, 0.0, f32::INFINITY), ..good },
        Ray { o: Point3::new(f32::NAN, 0.0, 0.0), ..good },
        Ray { t_min: 2.0, t_max: 1.5, ..good },
        Ray { t_max: f32::NAN, ..good },
        Ray { t_min: 1.000_001, ..good },
        Ray { t_max: 0.999_999, ..good },
    ];
    for ray in bad {
        assert_eq!(closest(&accel, &ray), None, "{ray:?}");
        assert!(!accel.query(&ray).any(), "{ray:?}");
    }
    let ends = Ray { t_min: 1.0, t_max: 1.0, ..good };
    assert_eq!(closest(&accel, &ends).map(|h| h.t), Some(1.0), "both ends belong to the range");
}

#[test]
fn rays_in_the_plane_and_along_the_edges_of_flat_boxes_are_safe() {
    for engine in ENGINES {
        let mut b = builder(engine);
        let id = b.triangles(square()).expect("valid mesh");
        b.instance(id, Placement::Identity).expect("valid placement");
        let accel = b.build().expect("within limits");
        for (o, d) in [([-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]), ([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0])] {
            assert_eq!(closest(&accel, &Ray::new(o.into(), d.into())), None, "edge-on has no area");
        }
        for (x, y) in [(0.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.0, 0.5), (1.0, 0.25), (0.5, 1.0)] {
            for z in [-2.0, 2.0] {
                let ray = Ray::new(Point3::new(x, y, z), Vector3::new(0.0, 0.0, -z));
                assert_eq!(closest(&accel, &ray).map(|h| h.t), Some(1.0), "{x} {y} {z}");
            }
        }
        // On the diagonal both triangles are hit at the same t: the first counts.
        let diagonal = Ray::new(Point3::new(0.25, 0.25, 1.0), Vector3::new(0.0, 0.0, -1.0));
        assert_eq!(closest(&accel, &diagonal).map(|h| h.prim), Some(0));
    }
}

#[test]
fn weights_belong_to_vertices_one_and_two() {
    let mut b = builder(Engine::Bvh);
    let id = b.triangles(square()).expect("valid mesh");
    b.instance(id, Placement::Identity).expect("valid placement");
    let ray = Ray::new(Point3::new(0.75, 0.5, 1.0), Vector3::new(0.0, 0.0, -1.0));
    let hit = closest(&b.build().expect("within limits"), &ray).expect("hits");
    // 0.25 (0,0) + 0.25 (1,0) + 0.5 (1,1)
    assert!((hit.u - 0.25).abs() < 1e-6 && (hit.v - 0.5).abs() < 1e-6, "{hit:?}");
}

#[test]
fn mistakes_are_named() {
    let mut b = builder(Engine::Bvh);
    let mut nan = square();
    nan.positions[2].y = f32::NAN;
    assert_eq!(b.triangles(nan), Err(BuildError::VertexNotFinite { vertex: 2 }));
    let mut wild = square();
    wild.indices[1][2] = 4;
    let error = BuildError::VertexOutOfRange { triangle: 1, vertex: 4, vertices: 4 };
    assert_eq!(b.triangles(wild), Err(error));
    let hollow = Bounds3 { min: Point3::splat(1.0), max: Point3::ZERO };
    let holey = Bounds3 { min: Point3::new(f32::NAN, 0.0, 0.0), max: Point3::splat(1.0) };
    for bad in [hollow, holey] {
        let boxes = vec![Bounds3::UNBOUNDED, bad];
        assert_eq!(b.user(boxes), Err(BuildError::BoxInvalid { prim: 1 }));
    }
    let id = b.triangles(square()).expect("valid mesh");
    let flat = Transform::from_f64(&DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)));
    let still = b.instance(id, Placement::Still(flat));
    assert_eq!(still, Err(BuildError::TransformSingular { instance: 0, key: 0 }));
    let whole = Transform::IDENTITY;
    let moving = |keys| Placement::Moving(keys);
    let error = BuildError::TransformSingular { instance: 0, key: 1 };
    assert_eq!(b.instance(id, moving(vec![(0.0, whole), (1.0, flat)])), Err(error));
    for (keys, key) in [
        (vec![], 0),
        (vec![(0.0, whole), (0.0, whole)], 1),
        (vec![(0.0, whole), (1.0, whole), (f32::NAN, whole)], 2),
    ] {
        assert_eq!(b.instance(id, moving(keys)), Err(BuildError::MotionKeyInvalid { instance: 0, key }));
    }
    let mut other = builder(Engine::Bvh);
    let unknown = other.instance(id, Placement::Identity);
    assert_eq!(unknown, Err(BuildError::GeometryUnknown { geometry: 0 }));
    assert_eq!(b.instance(id, Placement::Identity), Ok(0), "nothing was added by the failures");
}

#[test]
fn thousands_of_equal_triangles_make_a_shallow_tree() {
    let mut b = builder(Engine::Bvh);
    let Triangles { positions, indices } = square();
    let repeated = Triangles { positions, indices: vec![indices[0]; 5000] };
    let id = b.triangles(repeated).expect("valid mesh");
    b.instance(id, Placement::Identity).expect("valid placement");
    let accel = b.build().expect("within limits");
    assert!(accel.stats().max_depth <= 6, "{:?}", accel.stats());
    let ray = Ray::new(Point3::new(0.5, 0.25, 1.0), Vector3::new(0.0, 0.0, -1.0));
    assert_eq!(closest(&accel, &ray).map(|h| h.prim), Some(0));
}

#[test]
fn lopsided_scenes_stay_within_the_traversal_stack() {
    // Each triangle is much larger than all before it together: SAH would peel them off one by one.
    let mut mesh = Triangles::default();
    for i in 0..124u32 {
        let s = 2f32.powi(i as i32 - 62);
        mesh.positions.extend([[s, 0.0, s], [s, s, s], [s, 0.0, 2.0 * s]].map(Point3::from));
        mesh.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let mut b = AccelBuilder::new(BuildOptions::default());
    let id = b.triangles(mesh.clone()).expect("valid mesh");
    b.instance(id, Placement::Identity).expect("valid placement");
    let accel = b.build().expect("within limits");
    assert!(accel.stats().max_depth <= 64, "{:?}", accel.stats());
    for (prim, [a, b, c]) in mesh.indices.iter().enumerate() {
        let sum =
            [*a, *b, *c].iter().fold(Vector3::ZERO, |s, i| s + (mesh.positions[*i as usize] - Point3::ZERO));
        let middle = Point3::ZERO + sum * (1.0 / 3.0);
        let mut ray = Ray::new(middle, Vector3::new(1.0, 0.0, 0.0));
        ray.o.x *= 0.99;
        assert_eq!(closest(&accel, &ray).map(|h| h.prim as usize), Some(prim));
    }
}

#[test]
fn an_infinite_plane_is_found_behind_and_before_finite_things() {
    let plane = Shape::Plane { point: Point3::new(0.0, -1.0, 0.0), normal: [0.0, 1.0, 0.0].into() };
    let ball = Shape::Sphere { center: Point3::ZERO, radius: 0.5 };
    let tilt = Transform::from_f64(&DAffine3::from_rotation_z(0.1));
    for (engine, placement) in
        ENGINES.into_iter().flat_map(|e| [Placement::Identity, Placement::Still(tilt)].map(|p| (e, p)))
    {
        let mut b = builder(engine);
        let id = b.user(vec![plane.bounds(), ball.bounds()]).expect("valid boxes");
        b.instance(id, placement).expect("valid placement");
        let (accel, shapes) = (b.build().expect("within limits"), Shapes(vec![vec![plane, ball]]));
        assert!(accel.bounds().is_finite(), "the finite part only");
        let mut nodes = (0..accel.stats().nodes as u32).filter_map(|n| accel.node_bounds(n));
        assert!(nodes.all(|n| n.bounds.is_finite()), "infinite boxes would spoil the tree");
        let down = |x: f32| Ray::new(Point3::new(x, 4.0, 0.0), Vector3::new(0.0, -1.0, 0.0));
        let prim = |ray: &Ray| accel.query(ray).user(&shapes).closest().map(|h| h.prim);
        assert_eq!((prim(&down(0.0)), prim(&down(30.0))), (Some(1), Some(0)));
        let up = Ray::new(Point3::new(0.0, -4.0, 0.0), Vector3::new(0.0, 1.0, 0.0));
        assert_eq!(prim(&up), Some(0));
        assert!(accel.query(&down(30.0)).user(&shapes).any());
    }
}

#[test]
fn of_many_walls_in_a_row_only_the_first_few_are_tested() {
    let mut walls = Triangles::default();
    for i in 0..256u32 {
        let z = i as f32;
        walls.positions.extend([[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]].map(Point3::from));
        walls.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let mut b = builder(Engine::Bvh);
    let id = b.triangles(walls).expect("valid mesh");
    b.instance(id, Placement::Identity).expect("valid placement");
    let accel = b.build().expect("within limits");
    for (z, d, first) in [(-5.0, 1.0, 0), (260.0, -1.0, 255)] {
        let mut counts = TraversalCounts::default();
        let ray = Ray::new(Point3::new(0.1, 0.2, z), Vector3::new(0.01, 0.0, d));
        let hit = accel.query(&ray).probe(&mut counts, ()).closest();
        assert_eq!(hit.map(|h| h.prim), Some(first));
        assert!(counts.primitives <= 24 && counts.nodes <= 4, "{counts:?}");
    }
}

/// Remembers which nodes were entered, and by which ray.
#[derive(Default)]
struct Visited(Vec<(u8, u32)>);

impl TraversalProbe for Visited {
    type Id = u8;
    fn node(&mut self, id: u8, bvh_node: u32) {
        self.0.push((id, bvh_node));
    }
}

#[test]
fn probes_see_nodes_whose_boxes_the_ray_enters() {
    let mut b = builder(Engine::Bvh);
    let (ball, floor) = (b.triangles(icosphere(2)), b.triangles(square()));
    let (ball, floor) = (ball.expect("valid mesh"), floor.expect("valid mesh"));
    for id in [ball, floor] {
        b.instance(id, Placement::Identity).expect("valid placement");
    }
    let accel = b.build().expect("within limits");
    let nodes = accel.stats().nodes as u32;
    assert!((0..nodes).all(|n| accel.node_bounds(n).is_some()) && accel.node_bounds(nodes).is_none());
    let leaves: u32 = (0..nodes).filter_map(|n| accel.node_bounds(n)).map(|n| n.leaf_items).sum();
    assert!((322 / 8..322).contains(&leaves), "{leaves} leaves of up to 8 triangles");
    let mut random = Random(4);
    let mut seen = Visited::default();
    for i in 0..100 {
        let ray = Ray::new(random.point(3.0), random.direction());
        seen.0.clear();
        accel.query(&ray).probe(&mut seen, i).closest();
        assert_eq!(
            seen.0.first().map(|(_, node)| *node),
            Some(0),
            "walks begin at the root, whatever its box"
        );
        for (id, node) in &seen.0[1..] {
            let view = accel.node_bounds(*node).expect("a node");
            // A little larger, for this test's box arithmetic is another.
            let grown = Vector3::splat(1e-5);
            let b = Bounds3 { min: view.bounds.min - grown, max: view.bounds.max + grown };
            assert!(*id == i && enters(&ray, &b), "{ray:?} {view:?}");
        }
    }
    assert_eq!(accel.instance_geometry(1), floor);
}
