//! Which primitives a ray passes closely: their bounding spheres, enlarged, against the ray.
//!
//! A sphere lies within some distance of the boxes of all nodes that its primitive is in ([`reach`]), so that nodes are
//! entered whose boxes the ray meets when they are enlarged by that and by the radius asked for ([`gate`]).
//!
//! Trees of instances lie in their own spaces, spheres in render space. A box with half the diagonal `W` in render space
//! holds boxes with centres `c` and half diagonals `w`, and `|c - C| + |w| <= sqrt(2) |W|`, because the two vectors on the
//! left add up to no more than `W` along each axis and so the sum of their squares is no more than `W^2`. So the sphere
//! of a placed primitive lies in a ball around the image of its own sphere's centre.
mod gate;
mod reach;

use std::cmp::Ordering;

use durer_core::glam::DVec3;
use durer_core::math::{Bounds3, Ray, Transform};

use super::SCENE;
use crate::{
    Accel,
    layout::{Link, MovingNode, MovingPacket, Node, NodePlanes, Packet, PacketRecord, Target},
    slab::Measured,
    tree::{Forest, Tree, Trees},
};
use gate::Gate;
pub(crate) use reach::Reaches;

/// A primitive whose enlarged bounding sphere the ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearMiss {
    /// Ray parameter nearest to the sphere's centre, in `[t_min, t_max]`.
    pub t: f32,
    /// Which instance, in the order they were added.
    pub instance: u32,
    /// Which of its primitives, as in [`Hit::prim`](crate::Hit::prim).
    pub prim: u32,
    /// From the sphere's centre to the ray at `t`, in units of render space.
    pub distance: f32,
    /// Of the bounding sphere before it is enlarged, in units of render space.
    pub radius: f32,
}

/// All near misses, by instance and primitive.
pub(crate) fn near_misses(
    accel: &Accel,
    ray: &Ray,
    mask: u32,
    radius_of: &dyn Fn(f32) -> f32,
) -> Vec<NearMiss> {
    if !Measured::of(ray).is_valid() || ray.t_min.partial_cmp(&ray.t_max).is_none_or(Ordering::is_gt) {
        return Vec::new();
    }
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let ends = (ray.t_min.into(), ray.t_max.into());
    let t_per_length = 1.0 / d.length();
    let reaches = accel.reaches.get_or_init(|| Reaches::of(accel));
    let mut search =
        Search { accel, reaches, ray, o, d, ends, t_per_length, mask, radius_of, found: Vec::new() };
    for forest in std::iter::once(&accel.scene).chain(accel.movers.iter().map(|movers| &movers.forest)) {
        search.forest(SCENE, forest, None);
    }
    let mut found = search.found;
    found.sort_by(|a, b| {
        let by_size = a.distance.total_cmp(&b.distance).then(a.radius.total_cmp(&b.radius));
        (a.instance, a.prim).cmp(&(b.instance, b.prim)).then(by_size)
    });
    // Triangles that lie in several leaves, and those of one quad.
    found.dedup_by_key(|miss| (miss.instance, miss.prim));
    found
}

struct Search<'a> {
    accel: &'a Accel,
    reaches: &'a Reaches,
    ray: &'a Ray,
    o: DVec3,
    d: DVec3,
    /// `t_min` and `t_max`.
    ends: (f64, f64),
    /// Of the ray parameter, per unit of length.
    t_per_length: f64,
    mask: u32,
    radius_of: &'a dyn Fn(f32) -> f32,
    found: Vec<NearMiss>,
}

/// A tree somewhere.
struct Site<'a> {
    tree: &'a Tree,
    /// Whose, or [`SCENE`].
    instance: u32,
    /// How far its stretch of time has gone.
    moment: f32,
    /// From its space to render space, unless they are the same.
    place: Option<Transform>,
}

impl Search<'_> {
    fn forest(&mut self, instance: u32, forest: &Forest, place: Option<Transform>) {
        let (tree, moment) = forest.tree(self.ray.time);
        let site = Site { tree, instance, moment, place };
        let gate = Gate::new(self.ray, site.place.as_ref(), forest.region);
        match (&forest.trees, self.accel.registers.width()) {
            (Trees::Still(_), 16) => self.walk::<16, Node<16>, Packet>(&site, &gate),
            (Trees::Still(_), _) => self.walk::<8, Node<8>, Packet>(&site, &gate),
            (Trees::Moving { .. }, 16) => self.walk::<16, MovingNode<16>, MovingPacket>(&site, &gate),
            (Trees::Moving { .. }, _) => self.walk::<8, MovingNode<8>, MovingPacket>(&site, &gate),
        }
    }

    fn walk<const N: usize, B: NodePlanes<N>, R: PacketRecord>(&mut self, site: &Site<'_>, gate: &Gate) {
        let tree = site.tree;
        for &link in tree.unbounded.iter().chain(&tree.leaves) {
            self.leaf::<R>(site, link, None);
        }
        let Some(Target::Node(root)) = tree.root.map(Link::target) else { return };
        let all = [tree.bounds.min.to_array(), tree.bounds.max.to_array()];
        let furthest = gate.furthest(all, self.reaches.at(tree.name(root)));
        // Nodes, with the largest radius asked for in each.
        let mut open = vec![(root, (self.radius_of)(furthest))];
        while let Some((row, radius)) = open.pop() {
            let node: &B = tree.pages.get(row);
            let planes = node.planes(site.moment);
            let reach = self.reaches.at(tree.name(row));
            let mut near = gate.lanes(&planes, &gate.margin(reach, radius));
            while near != 0 {
                let lane = near.trailing_zeros() as usize % N;
                near &= near - 1;
                let link = Link(node.links()[lane]);
                // Once more with what is known of this lane alone.
                let below = match link.target() {
                    Target::Node(row) => self.reaches.at(tree.name(row)),
                    _ => reach,
                };
                let own = planes.map(|[lower, upper]| [[lower[lane]], [upper[lane]]]);
                let furthest = gate.furthest([own.map(|a| a[0][0]), own.map(|a| a[1][0])], below);
                let radius = (self.radius_of)(furthest);
                if gate.lanes(&own, &gate.margin(below, radius)) == 0 {
                    continue;
                }
                match link.target() {
                    Target::Node(row) => open.push((row, radius)),
                    _ => self.leaf::<R>(site, link, Some((gate, radius))),
                }
            }
        }
    }

    /// `filter` has the largest radius asked for in a leaf that is entered; `None` tests all.
    fn leaf<R: PacketRecord>(&mut self, site: &Site<'_>, link: Link, filter: Option<(&Gate, f32)>) {
        match link.target() {
            Target::Packet(row) => {
                let packet: &R = site.tree.pages.get(row);
                let mut near = filter.map_or((1 << packet.len()) - 1, |(gate, radius)| {
                    gate.triangles(packet, site.moment, radius)
                });
                while near != 0 {
                    self.triangle(site, packet, near.trailing_zeros() as usize);
                    near &= near - 1;
                }
            }
            Target::Item(item) => {
                let (instance, prim) = self.name(site, item);
                if let Some(own) = self.accel.items(instance).own_box(prim) {
                    self.primitive(site, item, &site.placed(&own));
                }
            }
            Target::Instance(index) => {
                let instance = &self.accel.instances[index as usize];
                let forest = &self.accel.geometries[instance.geometry.index()].forest;
                if let (true, Some(forest)) = (instance.seen.mask & self.mask != 0, forest) {
                    self.forest(index, forest, instance.pose.at(self.ray.time));
                }
            }
            Target::Node(_) => {}
        }
    }
}

impl Search<'_> {
    fn triangle<R: PacketRecord>(&mut self, site: &Site<'_>, packet: &R, lane: usize) {
        let corners = packet.triangle(lane, site.moment);
        let placed = corners.map(|p| site.place.as_ref().map_or(p, |m| m.point(p)));
        self.primitive(site, packet.ids()[lane], &Bounds3::around(placed));
    }

    /// Instance and primitive of a number in the tree.
    fn name(&self, site: &Site<'_>, id: u32) -> (u32, u32) {
        if site.instance == SCENE { self.accel.owners.of(id) } else { (site.instance, id) }
    }

    /// Notes a primitive if it is near and seen. `id` is its number in the tree.
    fn primitive(&mut self, site: &Site<'_>, id: u32, bounds: &Bounds3) {
        let (center, half) = sphere(bounds);
        let t = self.approach(center).clamp(self.ends.0, self.ends.1);
        let distance = self.distance(center, t) as f32;
        let (t, radius) = (t as f32, half as f32);
        // False for the NaN of a box that is not finite.
        if distance <= radius + (self.radius_of)(t) && bounds.is_finite() {
            let (instance, prim) = self.name(site, id);
            if self.accel.instances[instance as usize].seen.mask & self.mask != 0 {
                let (prim, ..) = self.accel.called(instance, prim, 0.0, 0.0);
                self.found.push(NearMiss { t, instance, prim, distance, radius });
            }
        }
    }

    /// The parameter at which the ray's line is nearest to `p`.
    fn approach(&self, p: DVec3) -> f64 {
        (p - self.o).dot(self.d) * (self.t_per_length * self.t_per_length)
    }

    fn distance(&self, p: DVec3, t: f64) -> f64 {
        (self.o + self.d * t - p).length()
    }
}

impl Site<'_> {
    /// The box in render space around a box of the tree's space.
    fn placed(&self, b: &Bounds3) -> Bounds3 {
        self.place.as_ref().map_or(*b, |m| m.bounds(b))
    }
}

/// Centre and half the diagonal.
fn sphere(b: &Bounds3) -> (DVec3, f64) {
    let (min, max) = (b.min.to_f64(), b.max.to_f64());
    ((min + max) * 0.5, (max - min).length() * 0.5)
}
