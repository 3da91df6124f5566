//! What happens in leaves: packets of triangles are tested, shapes asked, instances entered.
use std::marker::PhantomData;

use super::{Best, Cx, Kernel, Level, Place, SCENE, boxes::BoxRay};
use crate::{
    layout::{Link, PACKET, PacketRecord, Target},
    probe::Watch,
    slab::Window,
    space::Space,
    tree::Tree,
    triangle::{self, Found, Reach},
};

/// The leaves of one tree, for one ray.
pub(crate) struct Leaves<'a, K, R, W, const ROBUST: bool> {
    kernel: K,
    cx: &'a Cx<'a>,
    level: &'a Level<'a>,
    space: &'a Space<'a>,
    tree: &'a Tree,
    /// How far the tree's stretch of time has gone.
    moment: f32,
    pub(crate) watch: &'a mut W,
    found: Found<[f32; PACKET]>,
    packets: PhantomData<R>,
}

impl<'a, K: Kernel, R: PacketRecord, W: Watch, const ROBUST: bool> Leaves<'a, K, R, W, ROBUST> {
    #[inline(always)]
    pub(crate) fn new(
        kernel: K,
        cx: &'a Cx<'a>,
        (level, space): (&'a Level<'a>, &'a Space<'a>),
        (tree, moment): (&'a Tree, f32),
        watch: &'a mut W,
    ) -> Self {
        let found = Found { t: [0.0; PACKET], u: [0.0; PACKET], v: [0.0; PACKET] };
        Self { kernel, cx, level, space, tree, moment, watch, found, packets: PhantomData }
    }

    #[inline(always)]
    /// Constants for boxes, and what they add to `t`. A sum is never minus zero, which has the bits of a negative number.
    pub(crate) fn box_ray(&self) -> (BoxRay<K::Boxes>, f32) {
        let space = self.space;
        let t_min = space.ray.t_min + space.slab.shift;
        (BoxRay::new(self.kernel, &space.slab, t_min, self.moment), space.slab.shift)
    }

    #[inline(always)]
    pub(crate) fn nearest(&mut self, link: Link, best: &mut Best) {
        if let Some(row) = link.packet() {
            return self.packet_nearest(row, best);
        }
        match link.target() {
            Target::Item(item) => self.item_nearest(item, best),
            Target::Instance(instance) => self.instance_nearest(instance, best),
            Target::Packet(_) | Target::Node(_) => {}
        }
    }

    #[inline(always)]
    pub(crate) fn blocked(&mut self, link: Link, t_max: f32) -> bool {
        if let Some(row) = link.packet() {
            return self.packet_blocks(row, t_max);
        }
        match link.target() {
            Target::Item(item) => self.item_blocks(item, t_max),
            Target::Instance(instance) => self.instance_blocks(instance, t_max),
            Target::Packet(_) | Target::Node(_) => false,
        }
    }

    /// Bit `i`: triangle `i` of the packet is hit, as `found` says.
    #[inline(always)]
    fn test(&mut self, packet: &R, t_max: f32) -> u32 {
        if W::ACTIVE {
            for &id in &packet.ids()[..packet.len()] {
                let (instance, prim) = self.cx.primitive(self.level.instance, id);
                self.watch.primitive(instance, prim);
            }
        }
        let space = self.space;
        let reach = Reach { t_min: space.ray.t_min, t_max, floor: self.level.floor };
        let (kernel, moment) = (self.kernel, self.moment);
        triangle::packet::<K::Packets, R, ROBUST>(
            kernel,
            packet,
            &space.shear,
            reach,
            moment,
            &mut self.found,
        )
    }

    /// The hit of a lane that `test` found.
    #[inline(always)]
    fn lane(&self, row: u32, packet: &R, lane: u32) -> Best {
        let at = lane as usize % PACKET;
        let place = Place { instance: self.level.instance, id: packet.ids()[at], row, lane };
        Best { t: self.found.t[at], u: self.found.u[at], v: self.found.v[at], place }
    }

    #[inline(always)]
    fn packet_nearest(&mut self, row: u32, best: &mut Best) {
        let packet: &R = self.tree.pages.get(row);
        let mut bits = self.test(packet, best.t);
        while bits != 0 {
            let lane = bits.trailing_zeros();
            bits &= bits - 1;
            let at = lane as usize % PACKET;
            let t = self.found.t[at];
            if t > best.t {
                continue;
            }
            if t == best.t {
                // PERF: a triangle that was cut is met again in another leaf (bench kernel).
                let again = packet.ids()[at] == best.place.id && self.level.instance == best.place.instance;
                if again || !self.wins_tie(row, packet, lane, best) {
                    continue;
                }
            }
            if self.cx.checks && !self.triangle_counts(packet, &self.lane(row, packet, lane)) {
                continue;
            }
            // PERF: field by field: a hit written in parts and copied as a whole stalls (bench kernel).
            best.t = t;
            best.u = self.found.u[at];
            best.v = self.found.v[at];
            best.place.instance = self.level.instance;
            best.place.id = packet.ids()[at];
            best.place.row = row;
            best.place.lane = lane;
        }
    }

    /// Of two hits as near the one with the smaller name counts.
    #[cold]
    #[inline(never)]
    fn wins_tie(&self, row: u32, packet: &R, lane: u32, best: &Best) -> bool {
        self.cx.wins(&self.lane(row, packet, lane), best)
    }

    #[inline(always)]
    fn packet_blocks(&mut self, row: u32, t_max: f32) -> bool {
        let packet: &R = self.tree.pages.get(row);
        let mut bits = self.test(packet, t_max);
        if !self.cx.checks {
            return bits != 0;
        }
        while bits != 0 {
            let hit = self.lane(row, packet, bits.trailing_zeros());
            bits &= bits - 1;
            if self.triangle_counts(packet, &hit) {
                return true;
            }
        }
        false
    }

    /// Whether the ray may see this hit: mask, side and filter.
    #[cold]
    fn triangle_counts(&self, packet: &R, hit: &Best) -> bool {
        let (instance, prim) = self.cx.primitive(hit.place.instance, hit.place.id);
        let placed = &self.cx.accel.instances[instance as usize];
        if placed.seen.mask & self.cx.mask == 0 {
            return false;
        }
        if self.cx.culls && placed.seen.hides_backs {
            let [a, b, c] = packet.triangle(hit.place.lane as usize, self.moment);
            let front = (b - a).cross(c - a).dot(self.level.ray.d) <= 0.0;
            if front == placed.seen.is_reversed {
                return false;
            }
        }
        self.cx.passes(instance, prim, hit)
    }

    #[inline(never)]
    fn item_nearest(&mut self, item: u32, best: &mut Best) {
        let Some(name) = self.item(item) else { return };
        self.cx.item_nearest((item, name), self.level, best, || self.window(name));
    }

    #[inline(never)]
    fn item_blocks(&mut self, item: u32, t_max: f32) -> bool {
        let Some(name) = self.item(item) else { return false };
        self.cx.item_blocks((item, name), self.level, t_max, || self.window(name))
    }

    /// The name of an item, if the ray may meet it.
    #[inline(always)]
    fn item(&mut self, item: u32) -> Option<(u32, u32)> {
        let (instance, prim) = self.cx.primitive(self.level.instance, item);
        if self.cx.accel.instances[instance as usize].seen.mask & self.cx.mask == 0 {
            return None;
        }
        self.watch.primitive(instance, prim);
        Some((instance, prim))
    }

    /// The stretch of the ray in an item's own box.
    #[inline(always)]
    fn window(&self, (instance, prim): (u32, u32)) -> Window {
        match self.cx.accel.items(instance).own_box(prim) {
            Some(own) => self.space.slab.window(&own),
            None => Window::ALL,
        }
    }

    #[inline(always)]
    fn instance_nearest(&mut self, index: u32, best: &mut Best) {
        let (kernel, cx, watch) = (self.kernel, self.cx, &mut *self.watch);
        cx.enter(index, self.space, best.t, |level| match level.forest.sole() {
            Some(item) => cx.sole_nearest::<W, ROBUST>(level, item, best, watch),
            None => kernel.nearest::<W, ROBUST>(cx, level, best, watch),
        });
    }

    #[inline(always)]
    fn instance_blocks(&mut self, index: u32, t_max: f32) -> bool {
        let (kernel, cx, watch) = (self.kernel, self.cx, &mut *self.watch);
        let blocked = cx.enter(index, self.space, t_max, |level| match level.forest.sole() {
            Some(item) => cx.sole_blocks::<W, ROBUST>(level, item, t_max, watch),
            None => kernel.blocked::<W, ROBUST>(cx, level, t_max, watch),
        });
        blocked == Some(true)
    }
}

impl Cx<'_> {
    /// The instance and primitive that number `id` in a tree stands for.
    #[inline(always)]
    pub(crate) fn primitive(&self, instance: u32, id: u32) -> (u32, u32) {
        if instance == SCENE { self.accel.owners.of(id) } else { (instance, id) }
    }
}
