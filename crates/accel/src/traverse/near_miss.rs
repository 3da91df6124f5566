//! Which primitives a ray meets or passes closely: their bounding spheres, enlarged, against the ray.
//!
//! A node whose box has the centre `C` and half the diagonal `W` holds boxes with centres `c` and half diagonals `w`, and
//! `|c - C| + |w| <= sqrt(2) |W|`, because the two vectors on the left add up to no more than `W` along each axis and so
//! the sum of their squares is no more than `W^2`. If the ray stays further than that from `C`, it meets none of the
//! spheres inside. The enlargement is that at the furthest `c`, which the ray passes within `|W|` of where it passes `C`.
//! Triangles that the builder cut lie in no box as a whole: they are tested one by one.
use std::cmp::Ordering;

use durer_core::glam::DVec3;
use durer_core::math::{Bounds3, Ray, Transform};

use super::{Level, SCENE};
use crate::{
    Accel,
    layout::{Link, MovingNode, MovingPacket, Node, NodeWriter, Packet, PacketRecord, Target},
    slab::Measured,
    tree::{Forest, Tree, Trees},
};

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

/// Room for roundings of boxes and distances to f32, as a fraction.
const SLACK: f64 = 1e-5;

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
    let mut search = Search { accel, ray, o, d, ends, t_per_length, mask, radius_of, found: Vec::new() };
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
        let level = Level { ray: self.ray, forest, instance, floor: f32::MIN };
        let (tree, moment) = level.tree();
        let site = Site { tree, instance, moment, place };
        match (&forest.trees, self.accel.registers.width()) {
            (Trees::Still(_), 16) => self.walk::<Node<16>, Packet>(&site),
            (Trees::Still(_), _) => self.walk::<Node<8>, Packet>(&site),
            (Trees::Moving { .. }, 16) => self.walk::<MovingNode<16>, MovingPacket>(&site),
            (Trees::Moving { .. }, _) => self.walk::<MovingNode<8>, MovingPacket>(&site),
        }
    }

    fn walk<N: NodeWriter, R: PacketRecord>(&mut self, site: &Site<'_>) {
        for &link in site.tree.unbounded.iter().chain(&site.tree.leaves) {
            self.leaf::<R>(site, link);
        }
        // Nodes hold but parts of these.
        for &(row, lane) in &site.tree.cut {
            self.triangle::<R>(site, row, lane as usize);
        }
        let mut open: Vec<Link> = site.tree.root.into_iter().collect();
        while let Some(link) = open.pop() {
            let Target::Node(row) = link.target() else {
                self.leaf::<R>(site, link);
                continue;
            };
            let node: &N = site.tree.pages.get(row);
            for ([min, max], link) in (0..N::WIDTH).filter_map(|lane| node.lane(lane, site.moment)) {
                let bounds = site.placed(&Bounds3 { min: min.into(), max: max.into() });
                if self.may_reach(&bounds) {
                    open.push(Link(link));
                }
            }
        }
    }

    fn leaf<R: PacketRecord>(&mut self, site: &Site<'_>, link: Link) {
        match link.target() {
            Target::Packet(row) => {
                let packet: &R = site.tree.pages.get(row);
                (0..packet.len()).for_each(|lane| self.triangle::<R>(site, row, lane));
            }
            Target::Item(item) => {
                let (instance, prim) = self.name(site, item);
                let own = self.accel.items(instance).own_box(prim);
                self.primitive(site, item, own.map(|own| site.placed(&own)));
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
    fn triangle<R: PacketRecord>(&mut self, site: &Site<'_>, row: u32, lane: usize) {
        let packet: &R = site.tree.pages.get(row);
        let corners = packet.triangle(lane, site.moment);
        let placed = corners.map(|p| site.place.as_ref().map_or(p, |m| m.point(p)));
        self.primitive(site, packet.ids()[lane], Some(Bounds3::around(placed)));
    }

    /// Instance and primitive of a number in the tree.
    fn name(&self, site: &Site<'_>, id: u32) -> (u32, u32) {
        if site.instance == SCENE { self.accel.owners.of(id) } else { (site.instance, id) }
    }

    /// Notes a primitive if it is near and seen. `id` is its number in the tree.
    fn primitive(&mut self, site: &Site<'_>, id: u32, bounds: Option<Bounds3>) {
        let (instance, prim) = self.name(site, id);
        let seen = self.accel.instances[instance as usize].seen.mask & self.mask != 0;
        let Some(bounds) = bounds.filter(|b| seen && b.is_finite()) else { return };
        let (center, half) = sphere(&bounds);
        let t = self.approach(center).clamp(self.ends.0, self.ends.1);
        let distance = self.distance(center, t) as f32;
        let (t, radius) = (t as f32, half as f32);
        if distance <= radius + (self.radius_of)(t) {
            let (prim, ..) = self.accel.called(instance, prim, 0.0, 0.0);
            self.found.push(NearMiss { t, instance, prim, distance, radius });
        }
    }

    /// False if the ray meets no enlarged sphere of a primitive whose box lies inside `bounds`.
    fn may_reach(&self, bounds: &Bounds3) -> bool {
        if !bounds.is_finite() {
            return true;
        }
        let (center, half) = sphere(bounds);
        let (t_min, t_max) = self.ends;
        let size = center.abs().max_element() + self.o.abs().max_element();
        let slack = SLACK * (half + size);
        let nearest = self.approach(center);
        let distance = self.distance(center, nearest.clamp(t_min, t_max));
        let furthest = nearest + (half + slack) * self.t_per_length;
        let furthest = (furthest.clamp(t_min, t_max) as f32).next_up().min(self.ray.t_max).min(f32::MAX);
        let enlarged = std::f64::consts::SQRT_2 * half + f64::from((self.radius_of)(furthest));
        distance <= enlarged * (1.0 + SLACK) + slack
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
