//! How far bounding spheres stick out of nodes.
//!
//! The sphere around a primitive with centre `c` and radius `r` lies within `|c - b| + r` of the box `b`. A box around
//! that box is no further from `c`, so that what holds for leaves holds for all nodes above them, with the largest.
//! Whoever comes near the sphere comes near each of these boxes.
//!
//! Of a primitive that lies in several leaves, each in a box around a part, one leaf answers for the whole: that whose box
//! is nearest to the centre.
use durer_core::math::Bounds3;

use super::{gate::sphere_stretch, sphere};
use crate::{
    Accel,
    geometry::Items,
    layout::{Link, MovingNode, MovingPacket, Node, NodeWriter, Packet, PacketRecord, Target},
    placement::{Pose, matrix},
    tree::{Forest, Tree, Trees},
};

/// For each node of an `Accel`, by its name, how far spheres of what lies below stick out of its box at most, in the space
/// of its tree.
#[derive(Clone, Debug)]
pub(crate) struct Reaches(Vec<f32>);

impl Reaches {
    pub(crate) fn of(accel: &Accel) -> Self {
        let mut reaches = Self(vec![0.0; accel.node_count() as usize]);
        let mut roots = Vec::with_capacity(accel.geometries.len());
        for geometry in &accel.geometries {
            let own = |prim: u32| geometry.items.own_box(prim);
            let has_parts = matches!(geometry.items, Items::Curves(..));
            let things = Things { has_parts, count: geometry.items.len(), own: &own, placed: &|_| 0.0 };
            roots.push(geometry.forest.as_ref().map_or(0.0, |forest| reaches.forest(accel, forest, &things)));
        }
        let own = |id: u32| {
            let (instance, prim) = accel.owners.of(id);
            accel.items(instance).own_box(prim)
        };
        let placed = |index: u32| {
            let instance = &accel.instances[index as usize];
            f64::from(roots[instance.geometry.index()]) * pose_stretch(&instance.pose)
        };
        let mut owners = accel.owners.ranges();
        let has_parts = owners.any(|(instance, _)| matches!(accel.items(instance), Items::Curves(..)));
        let things = Things { has_parts, count: accel.owners.total(), own: &own, placed: &placed };
        for forest in std::iter::once(&accel.scene).chain(accel.movers.iter().map(|m| &m.forest)) {
            reaches.forest(accel, forest, &things);
        }
        reaches
    }

    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    /// Of a node by its name.
    pub(super) fn at(&self, name: u32) -> f32 {
        self.0[name as usize]
    }

    /// Of everything in a geometry's or the scene's trees; returns the largest.
    fn forest(&mut self, accel: &Accel, forest: &Forest, things: &Things<'_>) -> f32 {
        let mut most = 0.0f32;
        for tree in forest.trees() {
            let own = &mut self.0[tree.base as usize..(tree.base + tree.nodes) as usize];
            match (&forest.trees, accel.registers.width()) {
                (Trees::Still(_), 16) => measure::<Node<16>, Packet>(tree, &[0.0], things, own),
                (Trees::Still(_), _) => measure::<Node<8>, Packet>(tree, &[0.0], things, own),
                (_, 16) => measure::<MovingNode<16>, MovingPacket>(tree, &[0.0, 1.0], things, own),
                (..) => measure::<MovingNode<8>, MovingPacket>(tree, &[0.0, 1.0], things, own),
            }
            most = most.max(own.first().copied().unwrap_or(0.0));
        }
        most
    }
}

/// What leaves that hold no triangles hold.
struct Things<'a> {
    /// Some may lie in several leaves.
    has_parts: bool,
    /// Numbers in the tree are below this.
    count: u32,
    /// The box of a shape.
    own: &'a dyn Fn(u32) -> Option<Bounds3>,
    /// How far spheres stick out of an instance's box.
    placed: &'a dyn Fn(u32) -> f64,
}

/// By how much an instance enlarges spheres at most. The stretch of a mean of maps is no more than that of one of them.
fn pose_stretch(pose: &Pose) -> f64 {
    match pose {
        Pose::Identity => 1.0,
        Pose::Still(place) => sphere_stretch(&place.to_f64()),
        Pose::Moving(keys) => keys.keys.iter().map(|key| sphere_stretch(&matrix(&key.1))).fold(0.0, f64::max),
    }
}

/// Fills `reaches`, which holds zeros, for all nodes of a tree; `moments` are the ends of its stretch of time.
fn measure<N: NodeWriter, R: PacketRecord>(
    tree: &Tree,
    moments: &[f32],
    things: &Things<'_>,
    reaches: &mut [f32],
) {
    // How near the boxes come that hold a primitive to its centre, by its number in the tree.
    let mut gaps = Vec::new();
    if things.has_parts || tree.is_cut {
        gaps = vec![f64::INFINITY; things.count as usize];
        leaves::<N, R>(tree, &[0.0], things, |_, leaf| {
            if let Leaf::Primitive { id, gap, .. } = leaf {
                let least = &mut gaps[id as usize];
                *least = least.min(gap);
            }
        });
    }
    leaves::<N, R>(tree, moments, things, |node, leaf| {
        let reach = match leaf {
            Leaf::Instance(reach) => reach,
            Leaf::Node(below) => reaches[below].into(),
            Leaf::Primitive { id, gap, .. } if gaps.get(id as usize).is_some_and(|least| gap > *least) => 0.0,
            Leaf::Primitive { gap, radius, .. } => gap + radius,
        };
        reaches[node] = reaches[node].max((reach as f32).next_up());
    });
}

/// What a lane holds.
enum Leaf {
    /// A node, by its number.
    Node(usize),
    /// The distance of a sphere's centre from the lane's box, and its radius.
    Primitive { id: u32, gap: f64, radius: f64 },
    /// How far spheres stick out of its box.
    Instance(f64),
}

/// Visits what nodes hold, those below before those above; nodes by their numbers.
fn leaves<N: NodeWriter, R: PacketRecord>(
    tree: &Tree,
    moments: &[f32],
    things: &Things<'_>,
    mut visit: impl FnMut(usize, Leaf),
) {
    for number in (0..tree.nodes).rev() {
        let node: &N = tree.pages.get(number * tree.node_rows);
        for (moment, lane) in moments.iter().flat_map(|m| (0..N::WIDTH).map(move |lane| (*m, lane))) {
            let Some(([min, max], link)) = node.lane(lane, moment) else { continue };
            let around = Bounds3 { min: min.into(), max: max.into() };
            let mut primitive = |id: u32, b: &Bounds3| {
                let (center, radius) = sphere(b);
                let gap = (center - center.clamp(around.min.to_f64(), around.max.to_f64())).length();
                visit(number as usize, Leaf::Primitive { id, gap, radius });
            };
            match Link(link).target() {
                Target::Node(row) => visit(number as usize, Leaf::Node((row / tree.node_rows) as usize)),
                Target::Instance(index) => visit(number as usize, Leaf::Instance((things.placed)(index))),
                Target::Item(id) => (things.own)(id).iter().for_each(|own| primitive(id, own)),
                Target::Packet(row) => {
                    let packet: &R = tree.pages.get(row);
                    for at in 0..packet.len() {
                        primitive(packet.ids()[at], &Bounds3::around(packet.triangle(at, moment)));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AccelBuilder, BuildOptions, Engine, NearMiss, Placement, Preset, Triangles};
    use durer_core::glam::{DAffine3, DQuat, DVec3};
    use durer_core::math::{Motion, Point3, Ray, Transform, Vector3};

    const TRIANGLES: u32 = 3000;

    /// Numbers in `[-1, 1)`.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        }
        fn vector(&mut self, size: f32) -> Vector3 {
            Vector3::new(self.next() * size, self.next() * size, self.next() * size)
        }
    }

    /// Long triangles, slanted alike, among small ones.
    fn mesh(random: &mut Random, size: f32) -> Triangles {
        let mut mesh = Triangles::default();
        for i in 0..TRIANGLES {
            let is_long = i.is_multiple_of(4);
            let slant = Vector3::new(0.7, 0.7, 0.7 * random.next()) * size;
            let d = if is_long { slant } else { random.vector(0.04 * size) };
            let p = Point3::ZERO + random.vector(size);
            mesh.positions.extend([p - d, p + d, p + d + random.vector(0.005 * size)]);
            mesh.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        mesh
    }

    fn placements(random: &mut Random, size: f32) -> Vec<Placement> {
        let mut affine = |skew: f64| {
            let turn = DQuat::from_axis_angle(DVec3::Z, f64::from(random.next()));
            let place = random.vector(4.0 * size).to_f64();
            DAffine3::from_scale_rotation_translation(DVec3::new(0.1, -skew, 1.0), turn, place)
        };
        let moving = Motion::keyed(vec![(0.0, affine(0.5)), (0.5, affine(2.0)), (1.0, affine(1.0))]);
        vec![
            Placement::Identity,
            Placement::Still(Transform::from_f64(&affine(3.0))),
            Placement::Still(Transform::translate(random.vector(1e3 * size))),
            Placement::from_motion(&moving.expect("sound keys")),
        ]
    }

    fn scene(size: f32, places: &[Placement], engine: Engine) -> Accel {
        let preset = Preset::High;
        let mut builder = AccelBuilder::new(BuildOptions { engine, preset, ..BuildOptions::default() });
        let id = builder.triangles(mesh(&mut Random(1), size)).expect("sound mesh");
        for place in places {
            builder.instance(id, place.clone()).expect("sound placement");
        }
        builder.build().expect("within limits")
    }

    #[test]
    fn cut_triangles_and_odd_places_lose_no_sphere() {
        let mut random = Random(7);
        let mut found = 0;
        for size in [1.0, 1e-4, 1e6] {
            let places = placements(&mut random, size);
            for places in [&places[..1], &places[1..3], &places[2..]] {
                let [tree, brute] = [Engine::Bvh, Engine::BruteForce].map(|e| scene(size, places, e));
                let mut forests = std::iter::once(&tree.scene).chain(&tree.geometries[0].forest);
                assert!(forests.any(|forest| forest.trees()[0].is_cut), "nothing was cut");
                for i in 0..150 {
                    let mut ray = Ray::new(Point3::ZERO + random.vector(2.0 * size), random.vector(1.0));
                    ray.time = random.next();
                    match i % 4 {
                        0 => ray.d.x = 0.0,
                        1 => (ray.t_min, ray.t_max) = (-2.0 * size, size),
                        2 => ray.o = Point3::ZERO + random.vector(100.0 * size),
                        _ => ray.d = ray.d * 1e-3,
                    }
                    let (near, spread) = ([0.0, 0.01, 0.3][i % 3] * size, [0.0, 0.02][i % 2]);
                    let radius_of = |t: f32| near + spread * t.max(0.0) * ray.d.length();
                    let all = |accel: &Accel| {
                        let mut list: Vec<NearMiss> = Vec::new();
                        accel.near_misses(&ray, radius_of, |miss| list.push(miss));
                        list
                    };
                    let expected = all(&brute);
                    assert_eq!(all(&tree), expected, "{ray:?}");
                    found += expected.len();
                }
            }
        }
        assert!(found > 10_000, "{found}: the test means little");
    }

    #[test]
    fn an_endless_radius_finds_all_and_one_that_is_no_number_none() {
        let places = placements(&mut Random(9), 1.0);
        let tree = scene(1.0, &places, Engine::Bvh);
        let ray = Ray::new(Point3::ZERO, Vector3::new(0.0, 1.0, 0.0));
        for (radius, expected) in [(f32::INFINITY, 4 * TRIANGLES), (f32::MAX, 4 * TRIANGLES), (f32::NAN, 0)] {
            let mut count = 0;
            tree.near_misses(&ray, |_| radius, |_| count += 1);
            assert_eq!(count, expected, "{radius}");
        }
    }
}
