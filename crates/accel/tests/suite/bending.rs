//! Meshes whose vertices move: against the same mesh frozen at the ray's moment, and a closed form.
use durer_accel::{Accel, AccelBuilder, BuildError, BuildOptions, Engine, Placement, Triangles};
use durer_core::math::{Point3, Ray, Segment, Vector3};

use crate::corpus::{Random, ray_count};
use crate::icosphere::icosphere;

type Keys = Vec<(f32, Vec<Point3>)>;

fn build(indices: &[[u32; 3]], keys: &Keys, engine: Engine) -> Accel {
    let mut builder = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
    let keys = keys.iter().map(|(time, positions)| (*time, positions.as_slice()));
    let id = builder.keyed_triangles(indices, keys).expect("sound keys");
    builder.instance(id, Placement::Identity).expect("sound placement");
    builder.build().expect("within limits")
}

fn closest(accel: &Accel, ray: &Ray) -> Option<durer_accel::Hit> {
    accel.query(ray).closest()
}

/// A sphere whose vertices wander.
fn wobbling(random: &mut Random) -> (Vec<[u32; 3]>, Keys) {
    let Triangles { positions, indices } = icosphere(2);
    let mut keys = vec![(0.25, positions)];
    for time in [0.5, 2.0] {
        let shifted = keys[0].1.iter().map(|p| *p + random.direction() * 0.3 + Vector3::splat(time));
        keys.push((time, shifted.collect()));
    }
    (indices, keys)
}

#[test]
fn a_mesh_is_hit_as_it_is_at_the_moment_of_the_ray() {
    let mut random = Random(41);
    let (mut hits, rays) = (0, ray_count(8000));
    for _ in 0..4 {
        let (indices, keys) = wobbling(&mut random);
        let (tree, brute) = (build(&indices, &keys, Engine::Bvh), build(&indices, &keys, Engine::BruteForce));
        for _ in 0..rays / 80 {
            let time = random.between(0.0, 2.3);
            let segment = Segment::at(time, keys.len(), |key| keys[key].0);
            let (a, b) = (&keys[segment.key].1, &keys[segment.key + 1].1);
            let positions: Vec<_> = a.iter().zip(b).map(|(a, b)| segment.point(*a, *b)).collect();
            let frozen = build(&indices, &vec![(0.0, positions.clone())], Engine::Bvh);
            for _ in 0..20 {
                let (aim, o) = (positions[random.below(positions.len())], random.point(4.0));
                let ray = Ray { time, ..Ray::new(o, aim + random.direction() * 0.2 - o) };
                let (hit, expected) = (closest(&tree, &ray), closest(&frozen, &ray));
                assert_eq!(hit, expected, "{ray:?}");
                assert_eq!(closest(&brute, &ray), expected, "{ray:?}");
                let any = tree.query(&ray).any();
                assert_eq!(any, expected.is_some());
                hits += usize::from(hit.is_some());
            }
        }
    }
    assert!(hits * 2 > rays, "only {hits} hits: the test means nothing");
}

#[test]
fn a_wall_that_comes_nearer_is_met_earlier() {
    let wall = |z: f32| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Point3::new(x, y, z)).to_vec()
    };
    let keys = vec![(1.0, wall(10.0)), (2.0, wall(6.0)), (4.0, wall(2.0))];
    let accel = build(&[[0, 1, 2], [0, 2, 3]], &keys, Engine::Bvh);
    for (time, z) in [(0.0, 10.0), (1.0, 10.0), (1.5, 8.0), (2.0, 6.0), (3.0, 4.0), (4.0, 2.0), (9.0, 2.0)] {
        let ray = Ray { time, ..Ray::new(Point3::new(0.3, 0.1, 0.0), Vector3::new(0.0, 0.0, 1.0)) };
        let t = closest(&accel, &ray).expect("the wall is in the way").t;
        assert!((t - z).abs() <= 2.0 * f32::EPSILON * z, "{t} at {time} s");
    }
    assert_eq!(accel.stats().triangles, 2);
}

#[test]
fn keys_that_do_not_fit_are_refused() {
    let points = |n: usize| vec![Point3::ZERO; n];
    let refused = |keys: Keys| {
        let mut builder = AccelBuilder::new(BuildOptions::default());
        builder.keyed_triangles(&[[0, 1, 2]], keys.iter().map(|(t, p)| (*t, p.as_slice()))).err()
    };
    let key = |key| Some(BuildError::VertexKeyInvalid { key });
    assert_eq!(refused(vec![(0.0, points(3)), (1.0, points(4))]), key(1));
    assert_eq!(refused(vec![(0.0, points(3)), (1.0, points(3)), (1.0, points(3))]), key(2));
    assert_eq!(refused(vec![(0.0, points(3)), (f32::NAN, points(3))]), key(1));
    assert_eq!(refused(vec![(0.0, points(3)), (1.0, points(3))]), None);
    let vertices = refused(vec![(0.0, points(2)), (1.0, points(2))]);
    assert!(matches!(vertices, Some(BuildError::VertexOutOfRange { vertex: 2, .. })));
}
