//! Which hits are put to a query's filter, and which side of a placed triangle is its back.
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use durer_accel::{
    Accel, AccelBuilder, BuildOptions, Engine, Hit, Placement, PrimitiveHit, Triangles, UserGeometry,
    Visibility,
};
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Bounds3, Point3, Ray, Transform, Vector3},
};

const ENGINES: [Engine; 2] = [Engine::Bvh, Engine::BruteForce];

/// Refuses all hits on the instances it is asked about, and counts them.
#[derive(Default)]
struct Refuses(AtomicU32);

impl UserGeometry for Refuses {
    const FILTERS: bool = true;

    fn intersect(&self, _: u32, _: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        let t = (2.5 - ray.o.z) / ray.d.z;
        (ray.t_min..=t_max).contains(&t).then_some(PrimitiveHit { t, u: 0.0, v: 0.0 })
    }
    fn accepts(&self, _: &Hit) -> bool {
        self.0.fetch_add(1, Relaxed);
        false
    }
}

/// A triangle at `z` that turns its front towards +z.
fn triangle(z: f32) -> Triangles {
    let positions = [[-1.0, -1.0, z], [1.0, -1.0, z], [0.0, 1.0, z]].map(Point3::from).to_vec();
    Triangles { positions, indices: vec![[0, 1, 2]] }
}

/// Triangles at z = 1, 2 and 4, the last moved there from 3, and a box with something at 2.5; hits on those of `filtered`
/// are put to filters.
fn scene(engine: Engine, filtered: [bool; 4]) -> Accel {
    let mut b = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
    let boxed = Bounds3::new(Point3::new(-1.0, -1.0, 2.4), Point3::new(1.0, 1.0, 2.6));
    let lift = Transform::translate(Vector3::new(0.0, 0.0, 1.0));
    let things = [
        (b.triangles(triangle(1.0)), Placement::Identity),
        (b.triangles(triangle(2.0)), Placement::Identity),
        (b.user(vec![boxed]), Placement::Identity),
        (b.triangles(triangle(3.0)), Placement::Moving(vec![(0.0, lift), (1.0, lift)])),
    ];
    for ((geometry, placement), is_filtered) in things.into_iter().zip(filtered) {
        let seen = Visibility { is_filtered, ..Visibility::default() };
        b.instance_seen(geometry.expect("valid geometry"), placement, seen).expect("valid placement");
    }
    b.build().expect("within limits")
}

#[test]
fn filters_are_asked_about_hits_on_filtered_instances_only() {
    let ray = Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0));
    for engine in ENGINES {
        for bits in 0..16u32 {
            let filtered = std::array::from_fn(|i| bits >> i & 1 == 1);
            let accel = scene(engine, filtered);
            let refuses = Refuses::default();
            let first = filtered.iter().position(|f| !f);
            let hit = accel.query(&ray).user(&refuses).closest();
            assert_eq!(hit.map(|h| h.t), first.map(|i| [1.0, 2.0, 2.5, 4.0][i]), "{engine:?} {filtered:?}");
            assert_eq!(hit.map(|h| h.instance as usize), first, "{engine:?} {filtered:?}");
            assert_eq!(accel.query(&ray).user(&refuses).any(), first.is_some(), "{engine:?} {filtered:?}");
            let asked = refuses.0.into_inner();
            assert!(asked <= 2 * bits.count_ones() && (asked > 0 || bits & 1 == 0), "{asked} {filtered:?}");
        }
    }
}

#[test]
fn a_mirrored_triangle_keeps_its_front_and_its_normal_however_it_is_held() {
    let mirror = Transform::from_f64(&DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)));
    let seen = Visibility { hides_backs: true, ..Visibility::default() };
    for engine in ENGINES {
        // Placed once it lies in the tree of the scene, placed twice it has its own.
        for copies in [1, 2] {
            let mut b = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
            let id = b.triangles(triangle(-1.0)).expect("valid mesh");
            for _ in 0..copies {
                b.instance_seen(id, Placement::Still(mirror), seen).expect("valid placement");
            }
            let accel = b.build().expect("within limits");
            // In object space the triangle at z = -1 turns its front towards +z: mirrored at 1, towards -z.
            let towards = |z: f32, d: f32| {
                let ray = Ray::new(Point3::new(0.0, 0.0, z), Vector3::new(0.0, 0.0, d));
                accel.query(&ray).cull_backs(true).closest().map(|hit| hit.n_g)
            };
            let normal = Vector3::new(0.0, 0.0, 4.0);
            assert_eq!((towards(0.0, 1.0), towards(2.0, -1.0)), (Some(normal), None), "{engine:?} {copies}");
        }
    }
}
