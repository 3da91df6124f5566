//! Enlarged bounding spheres: every primitive that a ray passes closely is told, and nothing else.
use std::collections::BTreeMap;

use durer_accel::{
    Accel, AccelBuilder, BuildOptions, Engine, Isa, NearMiss, Placement, Preset, Quads, Triangles, Visibility,
};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Bounds3, Motion, Point3, Ray, Segment, Transform, Vector3};

use crate::corpus::Random;
use crate::icosphere::icosphere;

/// Where the vertices of a primitive are at a moment, in object space.
type Hull = Box<dyn Fn(f32) -> Vec<Point3>>;

struct Scene {
    still: Triangles,
    quads: Quads,
    keys: Vec<(f32, Vec<Point3>)>,
    boxes: Vec<Bounds3>,
    instances: Vec<(usize, Placement, u32)>,
}

impl Scene {
    fn new(random: &mut Random) -> Self {
        let still = icosphere(2);
        let wander = |random: &mut Random| -> Vec<_> {
            still.positions.iter().map(|p| *p + random.direction() * 0.2).collect()
        };
        let keys = [0.1, 0.6, 0.9].map(|time| (time, wander(random))).to_vec();
        let corners = |random: &mut Random| {
            let p = random.point(2.0);
            [p, p + random.direction() * 0.1, p + random.direction() * 0.2, p + random.direction() * 0.1]
        };
        let positions: Vec<_> = (0..250).flat_map(|_| corners(random)).collect();
        let indices = (0..250).map(|i| [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3]).collect();
        let small = |random: &mut Random| {
            let p = random.point(2.0);
            Bounds3::new(p, p + random.direction().abs() * random.between(0.0, 0.1))
        };
        let mut boxes: Vec<_> = (0..60).map(|_| small(random)).collect();
        boxes.push(Bounds3::UNBOUNDED);
        let mut affine = || {
            let axis = random.direction().to_f64().normalize();
            let scale = DVec3::new(0.1 + f64::from(random.unit()), -2.0, 0.7);
            let turn = DQuat::from_axis_angle(axis, f64::from(random.unit()) * 3.0);
            DAffine3::from_scale_rotation_translation(scale, turn, random.point(4.0).to_f64())
        };
        let placed = |m: DAffine3| Placement::Still(Transform::from_f64(&m));
        let moving = Motion::keyed(vec![(0.0, affine()), (0.3, affine()), (1.0, affine())]);
        let moving = Placement::from_motion(&moving.expect("sound keys"));
        let instances = vec![
            (0, Placement::Identity, 1),
            (0, placed(affine()), 2),
            (0, moving.clone(), 3),
            (1, placed(affine()), 1),
            (2, Placement::Identity, 1),
            (2, moving, 2),
            (3, Placement::Identity, 3),
            (3, placed(affine()), 1),
        ];
        Self { still, quads: Quads { positions, indices }, keys, boxes, instances }
    }

    fn build(&self, options: BuildOptions) -> Accel {
        let mut builder = AccelBuilder::new(options);
        let keys = self.keys.iter().map(|(time, positions)| (*time, positions.as_slice()));
        let ids = [
            builder.triangles(self.still.clone()),
            builder.quads(self.quads.clone()),
            builder.keyed_triangles(&self.still.indices, keys),
            builder.user(self.boxes.clone()),
        ]
        .map(|id| id.expect("sound geometry"));
        for (geometry, placement, mask) in &self.instances {
            let seen = Visibility { mask: *mask, ..Visibility::default() };
            builder.instance_seen(ids[*geometry], placement.clone(), seen).expect("sound placement");
        }
        builder.build().expect("within limits")
    }

    /// For each primitive of a geometry the point sets whose boxes count.
    fn hulls(&self, geometry: usize) -> Vec<(u32, Hull)> {
        let still = |prim: usize, points: Vec<Point3>| -> (u32, Hull) {
            (prim as u32, Box::new(move |_| points.clone()))
        };
        let corners = |positions: &[Point3], indices: &[u32]| -> Vec<Point3> {
            indices.iter().map(|i| positions[*i as usize]).collect()
        };
        match geometry {
            0 => {
                let of = |(i, t): (usize, &[u32; 3])| still(i, corners(&self.still.positions, t));
                self.still.indices.iter().enumerate().map(of).collect()
            }
            1 => {
                let halves = |(i, [a, b, c, d]): (usize, &[u32; 4])| {
                    [[*a, *b, *d], [*c, *d, *b]].map(|t| still(i, corners(&self.quads.positions, &t)))
                };
                self.quads.indices.iter().enumerate().flat_map(halves).collect()
            }
            2 => {
                let of = |(i, t): (usize, &[u32; 3])| -> (u32, Hull) {
                    let keys: Vec<_> = self.keys.iter().map(|key| (key.0, corners(&key.1, t))).collect();
                    let hull = move |time: f32| {
                        let at = Segment::at(time, keys.len(), |i| keys[i].0);
                        let ends = keys[at.key].1.iter().zip(&keys[at.key + 1].1);
                        ends.map(|(a, b)| at.point(*a, *b)).collect()
                    };
                    (i as u32, Box::new(hull))
                };
                self.still.indices.iter().enumerate().map(of).collect()
            }
            _ => {
                let finite = self.boxes.iter().enumerate().filter(|(_, b)| b.is_finite());
                finite.map(|(i, b)| still(i, b.corners().to_vec())).collect()
            }
        }
    }
}

impl Scene {
    /// Which primitives of a placed geometry the ray meets: surely, surely not, or too close to say.
    fn expected(
        &self,
        geometry: usize,
        place: &Transform,
        ray: &Ray,
        radius_of: impl Fn(f32) -> f32,
    ) -> BTreeMap<u32, Option<bool>> {
        let mut expected = BTreeMap::new();
        for (prim, hull) in self.hulls(geometry) {
            let points: Vec<_> = hull(ray.time).iter().map(|p| place.point(*p)).collect();
            let meets = meets(&points, ray, &radius_of);
            // Of two halves one that is met is enough.
            let so_far = expected.entry(prim).or_insert(Some(false));
            *so_far = match (*so_far, meets) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (None, _) | (_, None) => None,
                _ => Some(false),
            };
        }
        expected
    }
}

/// Whether the ray meets the enlarged sphere: surely, surely not, or too close to say.
fn meets(points: &[Point3], ray: &Ray, radius_of: impl Fn(f32) -> f32) -> Option<bool> {
    let (min, max) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p.to_f64()), max.max(p.to_f64()))
    });
    let (center, radius) = ((min + max) * 0.5, (max - min).length() * 0.5);
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let t = ((center - o).dot(d) / d.length_squared()).clamp(ray.t_min.into(), ray.t_max.into());
    let distance = (o + d * t - center).length();
    let room = radius + f64::from(radius_of(t as f32)) - distance;
    (room.abs() > 2e-5).then_some(room > 0.0)
}

#[test]
fn near_misses_are_those_of_a_loop_over_all_primitives() {
    let (mut total, mut kinds) = (0, [0; 4]);
    for seed in 0..3 {
        let mut random = Random(800 + seed);
        let scene = Scene::new(&mut random);
        let options = |engine, isa| BuildOptions {
            engine,
            isa,
            preset: if seed == 1 { Preset::High } else { Preset::Balanced },
            ..BuildOptions::default()
        };
        let brute = scene.build(options(Engine::BruteForce, None));
        let trees = Isa::available().into_iter().map(|isa| scene.build(options(Engine::Bvh, Some(isa))));
        let trees: Vec<_> = trees.collect();
        for i in 0..300 {
            let mut ray = random.ray(5.0, &scene.still.positions);
            if ray.d.length() == 0.0 {
                continue;
            }
            if i % 3 == 0 {
                (ray.t_min, ray.t_max) = (random.between(-1.0, 1.0), random.between(1.0, 2.0));
            }
            let (near, spread) = ([0.0, 0.02, 0.3][i % 3], [0.0, 0.01][i % 2] * ray.d.length());
            let radius_of = |t: f32| near + spread * t.max(0.0);
            let mask = 1 + random.below(3) as u32;
            let all = |accel: &Accel| {
                let mut list = Vec::new();
                accel.query(&ray).mask(mask).near_misses(radius_of, |miss| list.push(miss));
                list
            };
            let found: Vec<NearMiss> = all(&brute);
            for tree in &trees {
                assert_eq!(all(tree), found, "{ray:?} {:?}", tree.isa());
            }
            assert!(found.is_sorted_by(|a, b| (a.instance, a.prim) < (b.instance, b.prim)), "each once");
            for (instance, (geometry, _, seen)) in (0u32..).zip(&scene.instances) {
                let place = brute.instance_transform(instance, ray.time);
                for (prim, meets) in scene.expected(*geometry, &place, &ray, radius_of) {
                    let told = found.iter().any(|miss| (miss.instance, miss.prim) == (instance, prim));
                    let expected = meets.map(|meets| meets && seen & mask != 0);
                    assert!(expected.is_none_or(|e| e == told), "{ray:?} {instance} {prim} {told}");
                    kinds[*geometry] += usize::from(told);
                }
            }
            total += found.len();
        }
    }
    assert!(total > 5000 && kinds.iter().all(|n| *n > 200), "{total} {kinds:?}: the test means little");
}

#[test]
fn what_is_hit_is_a_near_miss_even_without_any_enlargement() {
    let mut random = Random(810);
    let scene = Scene::new(&mut random);
    let accel = scene.build(BuildOptions::default());
    let mut hits = 0;
    for _ in 0..3000 {
        let ray = random.ray(5.0, &scene.still.positions);
        let Some(hit) = accel.closest(&ray) else { continue };
        hits += 1;
        let mut found = false;
        // A triangle seen at the rim of its sphere may be lost by rounding.
        accel.near_misses(&ray, |_| 1e-5, |m| found |= (m.instance, m.prim) == (hit.instance, hit.prim));
        assert!(found, "{ray:?} {hit:?}");
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn a_speck_between_the_rays_of_a_grid_is_never_lost() {
    // Samples 0.01 apart at distance 1; a ball a fiftieth of that in size, anywhere within their square.
    let mut random = Random(811);
    for _ in 0..1000 {
        let distance = random.between(1.0, 50.0);
        let (x, y) = (random.between(-0.5, 0.5) * 0.01, random.between(-0.5, 0.5) * 0.01);
        let center = Point3::new(x * distance, y * distance, distance);
        let r = Vector3::splat(1e-4 * distance);
        let mut builder = AccelBuilder::new(BuildOptions::default());
        let id = builder.user(vec![Bounds3::new(center - r, center + r)]).expect("sound box");
        builder.instance(id, Placement::Identity).expect("sound placement");
        let accel = builder.build().expect("within limits");
        let mut told = 0;
        for (x, y) in [(-0.005, -0.005), (0.005, -0.005), (0.005, 0.005), (-0.005, 0.005)] {
            let ray = Ray::new(Point3::ZERO, Vector3::new(x, y, 1.0));
            accel.near_misses(
                &ray,
                |t| 0.01 * std::f32::consts::FRAC_1_SQRT_2 * t,
                |miss| {
                    assert!((miss.t - distance).abs() < 0.01 * distance && miss.prim == 0);
                    told += 1;
                },
            );
        }
        assert!(told > 0, "{center:?}");
    }
}

#[test]
fn rays_that_can_hit_nothing_miss_nothing_nearly() {
    let scene = Scene::new(&mut Random(812));
    let accel = scene.build(BuildOptions::default());
    let good = Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0));
    let count = |ray: &Ray| {
        let mut count = 0;
        accel.near_misses(ray, |_| 1e3, |_| count += 1);
        count
    };
    assert_eq!(count(&good), 3 * 320 + 250 + 2 * 320 + 2 * 60, "all that have a finite box");
    let nan = Vector3::new(f32::NAN, 0.0, 1.0);
    let bad = [
        Ray { d: Vector3::ZERO, ..good },
        Ray { d: nan, ..good },
        Ray { t_min: 2.0, t_max: 1.0, ..good },
        Ray { t_min: f32::NAN, ..good },
        Ray { t_max: f32::NAN, ..good },
    ];
    for bad in bad {
        assert_eq!(count(&bad), 0);
    }
}
