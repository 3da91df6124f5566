//! A scene that was changed is hit like one that is built anew, bit for bit.
mod recipe;

use durer_accel::{
    Accel, AccelBuilder, BuildError, BuildOptions, Engine, GeometryData, Hit, Isa, Placement, Preset,
    Triangles,
};
use durer_core::glam::{DAffine3, DVec3};
use durer_core::math::{Bounds3, Point3, Ray, Transform, Vector3};

use crate::corpus::{Random, Shapes, ray_count};
use crate::icosphere::icosphere;
use recipe::{Recipe, placement};

fn bits(hit: Hit) -> [u32; 8] {
    let [x, y, z] = hit.n_g.to_array().map(f32::to_bits);
    [hit.instance, hit.prim, hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), x, y, z]
}

/// Returns how many rays hit.
fn assert_same(changed: &Accel, fresh: &Accel, shapes: &Shapes, rays: &[Ray]) -> usize {
    assert_eq!(changed.bounds(), fresh.bounds());
    let (a, b) = (changed.stats(), fresh.stats());
    assert_eq!((a.triangles, a.instances, a.user_primitives), (b.triangles, b.instances, b.user_primitives));
    let mut hits = 0;
    for (i, ray) in rays.iter().enumerate() {
        let mask = 1 + i as u32 % 3;
        let (got, expected) = [changed, fresh].map(|a| a.query(ray).user(shapes).mask(mask)).map_hits();
        assert_eq!(got.map(bits), expected.map(bits), "{ray:?} {got:?} {expected:?} {:?}", changed.isa());
        assert_eq!(changed.query(ray).user(shapes).mask(mask).any(), expected.is_some(), "{ray:?}");
        if i % 8 == 0 {
            let [mut got, mut expected] = [Vec::new(), Vec::new()];
            changed.near_misses(ray, |t| 0.01 * t.max(0.0), |miss| got.push(miss));
            fresh.near_misses(ray, |t| 0.01 * t.max(0.0), |miss| expected.push(miss));
            assert_eq!(got, expected, "{ray:?}");
        }
        hits += usize::from(got.is_some());
    }
    hits
}

trait MapHits {
    fn map_hits(self) -> (Option<Hit>, Option<Hit>);
}
impl<U: durer_accel::UserGeometry> MapHits for [durer_accel::Query<'_, U>; 2] {
    fn map_hits(self) -> (Option<Hit>, Option<Hit>) {
        let [a, b] = self;
        (a.closest(), b.closest())
    }
}

#[test]
fn changed_scenes_are_hit_like_new_ones() {
    let (mut hits, mut asked) = (0, 0);
    let mut engines: Vec<_> = Isa::available().into_iter().map(|isa| (Engine::Bvh, Some(isa))).collect();
    engines.push((Engine::BruteForce, None));
    for (seed, preset) in [(900, Preset::Balanced), (901, Preset::High), (902, Preset::Fast)] {
        let mut random = Random(seed);
        let mut recipe = Recipe::new(&mut random);
        let options = |(engine, isa)| BuildOptions { engine, isa, preset, ..BuildOptions::default() };
        let mut changed: Vec<_> = engines.iter().map(|e| recipe.build(options(*e))).collect();
        for step in 0..16 {
            if step % 2 == 0 {
                let geometry = random.below(recipe.geometries.len());
                recipe.geometries[geometry] = recipe.geometries[geometry].another(&mut random);
                for (accel, ids) in &mut changed {
                    accel.refit(ids[geometry], recipe.geometries[geometry].data()).expect("alike");
                }
            } else {
                let moved: Vec<_> = recipe.movable().into_iter().filter(|_| random.below(3) == 0).collect();
                let moved: Vec<_> = moved.into_iter().map(|i| (i, placement(&mut random))).collect();
                for (i, placement) in &moved {
                    recipe.instances[*i as usize].1 = placement.clone();
                }
                for (accel, _) in &mut changed {
                    accel.set_placements(moved.iter().cloned()).expect("instances of their own");
                }
            }
            let (fresh, _) = recipe.build(options((Engine::Bvh, None)));
            let landmarks = recipe.landmarks();
            let rays: Vec<_> = (0..ray_count(20_000) / 50).map(|_| random.ray(5.0, &landmarks)).collect();
            for (accel, _) in &changed {
                hits += assert_same(accel, &fresh, &recipe.shapes(), &rays);
                asked += rays.len();
            }
        }
        for (accel, _) in &mut changed {
            accel.regrow().expect("within limits");
            let rays: Vec<_> = (0..300).map(|_| random.ray(5.0, &recipe.landmarks())).collect();
            let (fresh, _) = recipe.build(options((Engine::BruteForce, None)));
            assert_same(accel, &fresh, &recipe.shapes(), &rays);
        }
    }
    assert!(hits * 2 > asked && asked > 5000, "{hits} of {asked}: the test means little");
}

#[test]
fn meshes_whose_triangles_were_cut_are_refitted_whole() {
    // Long slanted triangles among small ones, as in the unit test of refitting, which shows that the builder cuts them.
    let mut random = Random(910);
    let mesh = |random: &mut Random| {
        let mut mesh = Triangles::default();
        for i in 0..1500u32 {
            let long = if i % 8 == 0 { 1.0 } else { 0.04 };
            let (p, d) = (random.point(1.0), random.direction() * long);
            mesh.positions.extend([p - d, p + d, p + d + random.direction() * 0.02]);
            mesh.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        mesh
    };
    let (first, second) = (mesh(&mut random), mesh(&mut random));
    for apart in [false, true] {
        let build = |mesh: &Triangles, preset| {
            let mut builder = AccelBuilder::new(BuildOptions { preset, ..BuildOptions::default() });
            let id = builder.triangles(mesh.clone()).expect("sound mesh");
            if apart {
                builder.keep_apart(id).expect("known");
            }
            builder.instance(id, Placement::Identity).expect("sound placement");
            (builder.build().expect("within limits"), id)
        };
        let (mut accel, id) = build(&first, Preset::High);
        let data = GeometryData::Triangles { positions: &second.positions, indices: &second.indices };
        accel.refit(id, data).expect("alike");
        let (fresh, _) = build(&second, Preset::High);
        let rays: Vec<_> = (0..3000).map(|_| random.ray(2.0, &second.positions)).collect();
        assert!(assert_same(&accel, &fresh, &Shapes::default(), &rays) > 1000);
        // Cut once more by building the scene's tree anew from what it holds.
        accel.regrow().expect("within limits");
        assert_same(&accel, &fresh, &Shapes::default(), &rays);
    }
}

#[test]
fn the_cost_grows_as_things_move_apart_and_falls_by_building_anew() {
    let Triangles { positions, indices } = icosphere(4);
    // Each triangle with vertices of its own.
    let triangles: Vec<_> = indices.iter().map(|t| t.map(|i| positions[i as usize])).collect();
    let indices: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let build = |triangles: &[[Point3; 3]], engine| {
        let mut builder = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
        let id = builder.borrowed_triangles(triangles.as_flattened(), &indices).expect("sound mesh");
        builder.instance(id, Placement::Identity).expect("sound placement");
        let accel = builder.build().expect("within limits");
        (accel.sah_cost(), accel, id)
    };
    let (cost, mut accel, id) = build(&triangles, Engine::Bvh);
    assert!(cost > 3.0 && cost < 60.0, "{cost}");
    let refit = |accel: &mut Accel, triangles: &[[Point3; 3]]| {
        let data = GeometryData::Triangles { positions: triangles.as_flattened(), indices: &indices };
        accel.refit(id, data).expect("alike");
        accel.sah_cost()
    };
    let same = refit(&mut accel, &triangles);
    assert!((same / cost - 1.0).abs() < 1e-5, "{same} {cost}");
    let larger: Vec<_> =
        triangles.iter().map(|t| t.map(|p| Point3::ZERO + (p - Point3::ZERO) * 8.0)).collect();
    let scaled = refit(&mut accel, &larger);
    assert!((scaled / cost - 1.0).abs() < 1e-4, "{scaled} {cost}: scale does not matter");
    let mut random = Random(911);
    let mut shuffled = triangles.clone();
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, random.below(i + 1));
    }
    let worse = refit(&mut accel, &shuffled);
    assert!(worse > 10.0 * cost, "{cost} {worse}");
    accel.regrow().expect("within limits");
    let better = accel.sah_cost();
    assert!((better / cost - 1.0).abs() < 0.05, "{better} {cost}");
    let (brute, ..) = build(&triangles, Engine::BruteForce);
    assert_eq!(brute, triangles.len() as f64 / 8.0);
}

#[test]
fn the_cost_of_a_scene_is_what_lines_through_its_box_visit() {
    // Lines between uniformly distributed points of a sphere around a scene are uniformly distributed lines.
    let mut random = Random(912);
    let mut recipe = Recipe::new(&mut random);
    for (_, placement, seen) in &mut recipe.instances {
        seen.mask = u32::MAX;
        // Stretches of time are measured in their middle only.
        if let Placement::Moving(keys) = placement {
            *placement = Placement::Still(keys[0].1);
        }
    }
    let (accel, _) = recipe.build(BuildOptions { isa: Some(Isa::Portable), ..BuildOptions::default() });
    let b = accel.bounds();
    let (center, radius) = (b.center(), b.diagonal().length() * 0.5);
    let (mut visits, mut lines) = (0u64, 0);
    while lines < 20_000 {
        let ends = [random.direction(), random.direction()].map(|d| center + d * radius);
        let ray = Ray { time: 0.5, ..Ray::new(ends[0], ends[1] - ends[0]) };
        if !crosses(&ray, &b) {
            continue;
        }
        lines += 1;
        let mut counts = durer_accel::TraversalCounts::default();
        accel.query(&ray).user(&Nothing).probe(&mut counts, ()).closest();
        visits += counts.nodes;
    }
    let (seen, cost) = (visits as f64 / f64::from(lines), accel.sah_cost());
    // Leaves are not counted by probes: the cost is more, but not many times as much.
    assert!(cost > seen && cost < 4.0 * seen, "{cost} against {seen} nodes");
}

/// The slab test in f64.
fn crosses(ray: &Ray, b: &Bounds3) -> bool {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let (t0, t1) = ((b.min.to_f64() - o) / d, (b.max.to_f64() - o) / d);
    t0.min(t1).max_element() <= t0.max(t1).min_element()
}

/// Nothing counts: rays go through everything.
struct Nothing;

impl durer_accel::UserGeometry for Nothing {
    const FILTERS: bool = true;
    fn intersect(&self, _: u32, _: u32, _: &Ray, _: f32) -> Option<durer_accel::PrimitiveHit> {
        None
    }
    fn accepts(&self, _: &Hit) -> bool {
        false
    }
}

#[test]
fn mistakes_leave_the_scene_as_it_was() {
    let mut random = Random(913);
    let recipe = Recipe::new(&mut random);
    let (mut accel, ids) = recipe.build(BuildOptions::default());
    let (fresh, _) = recipe.build(BuildOptions::default());
    let mesh = icosphere(1);
    let short = GeometryData::Triangles { positions: &mesh.positions, indices: &mesh.indices[..3] };
    let count = accel.refit(ids[0], short.clone()).expect_err("too few");
    assert!(
        matches!(count, BuildError::CountChanged { geometry: 0, what: "triangles", given: 3, .. }),
        "{count}"
    );
    let kind = accel.refit(ids[3], short).expect_err("triangles instead of quads");
    assert_eq!(kind, BuildError::KindChanged { geometry: 3, built: "quads", given: "triangles" });
    let wild = GeometryData::Triangles { positions: &mesh.positions, indices: &[[0, 1, 99_999]] };
    assert!(matches!(accel.refit(ids[0], wild), Err(BuildError::VertexOutOfRange { .. })));
    let nowhere = accel.set_placement(999, Placement::Identity);
    assert_eq!(nowhere, Err(BuildError::InstanceUnknown { instance: 999 }));
    let merged = accel.set_placement(0, Placement::Identity);
    assert_eq!(merged, Err(BuildError::InstanceMerged { instance: 0 }));
    let last = *recipe.movable().last().expect("some");
    let flat = Transform::from_f64(&DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)));
    let moves = [(last, placement(&mut random)), (last, Placement::Still(flat))];
    let singular = accel.set_placements(moves);
    assert_eq!(singular, Err(BuildError::TransformSingular { instance: last as usize, key: 0 }));
    let mut other = AccelBuilder::new(BuildOptions::default());
    let ids: Vec<_> = (0..50).map(|_| other.user(vec![]).expect("no boxes")).collect();
    assert_eq!(
        accel.refit(ids[49], GeometryData::User(vec![])),
        Err(BuildError::GeometryUnknown { geometry: 49 })
    );
    let mut empty = AccelBuilder::new(BuildOptions::default());
    assert_eq!(empty.keep_apart(ids[49]), Err(BuildError::GeometryUnknown { geometry: 49 }));
    let rays: Vec<_> = (0..500).map(|_| random.ray(5.0, &recipe.landmarks())).collect();
    assert!(assert_same(&accel, &fresh, &recipe.shapes(), &rays) > 100);
    assert_eq!(accel.stats(), fresh.stats());
    assert_eq!(accel.sah_cost().to_bits(), fresh.sah_cost().to_bits());
}

#[test]
fn a_ball_that_is_kept_apart_flies() {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let id = builder.triangles(icosphere(3)).expect("sound mesh");
    builder.keep_apart(id).expect("known");
    builder.instance(id, Placement::Identity).expect("sound placement");
    let mut accel = builder.build().expect("within limits");
    for step in 0..20 {
        let x = step as f32;
        accel
            .set_placement(0, Placement::Still(Transform::translate(Vector3::new(x, 0.0, 0.0))))
            .expect("apart");
        for (offset, expected) in [(0.0, true), (0.9, true), (1.1, false), (-1.1, false)] {
            let ray = Ray::new(Point3::new(x + offset, 0.01, -5.0), Vector3::new(0.0, 0.0, 1.0));
            assert_eq!(accel.any(&ray), expected, "{step} {offset}");
        }
        assert!((accel.bounds().center().x - x).abs() < 1e-3);
    }
}
