//! How rays walk: [`Kernel::nearest`] for the first hit, [`Kernel::blocked`] for any.
//!
//! One function walks every tree, that of the whole scene and those of instances; an instance in a leaf calls it again.
//! It is written over [`Kernel`] and compiled once for each set of registers.
mod blocked;
mod boxes;
mod exhaustive;
mod item;
mod kernel;
mod leaf;
mod near_miss;
mod nearest;
mod shape;

use durer_core::math::Ray;

use crate::{
    Accel,
    accel::Instance,
    slab::{Window, greater},
    space::Space,
    tree::Forest,
    user::Callback,
};

pub(crate) use blocked::blocked;
pub(crate) use exhaustive::{exhaustive_blocked, exhaustive_nearest};
pub(crate) use kernel::Kernel;
pub use near_miss::NearMiss;
pub(crate) use near_miss::{Reaches, near_misses};
pub(crate) use nearest::nearest;

/// What a query asks, and of what.
pub(crate) struct Cx<'a> {
    pub(crate) accel: &'a Accel,
    pub(crate) callback: &'a dyn Callback,
    /// Instances whose mask shares no bit with this are not there.
    pub(crate) mask: u32,
    /// One-sided instances are not hit from behind.
    pub(crate) culls: bool,
    /// Hits are put to the callback.
    pub(crate) filters: bool,
    /// Hits on triangles need a look at their instance, or a question to the callback.
    pub(crate) checks: bool,
    /// Brute force: boxes exclude nothing.
    pub(crate) exhaustive: bool,
}

/// The instance of what lies in the tree of the whole scene: each primitive has its own.
pub(crate) const SCENE: u32 = u32::MAX;

/// A ray in a tree's own space.
#[derive(Clone, Copy)]
pub(crate) struct Level<'a> {
    /// In the tree's own space. Borrowed. PERF: a ray just written in parts and copied as a whole stalls (bench render).
    pub(crate) ray: &'a Ray,
    pub(crate) forest: &'a Forest,
    /// The trees of what moves, in the same space. PERF: walked with what is prepared for the first (bench render).
    pub(crate) movers: Option<&'a Forest>,
    /// Whose tree it is, or [`SCENE`].
    pub(crate) instance: u32,
    /// Hits nearer than this count as if they were here.
    pub(crate) floor: f32,
}

impl Level<'_> {
    /// The largest coordinate of what the ray may meet.
    #[inline(always)]
    pub(crate) fn region(&self) -> f32 {
        self.movers.map_or(self.forest.region, |movers| greater(movers.region, self.forest.region))
    }
}

/// The nearest hit so far; `t` ends the ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) place: Place,
}

/// Which primitive was hit. What it is called is looked up only when the ray is done, or in a tie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Whose tree, or [`SCENE`].
    pub(crate) instance: u32,
    /// Its number in that tree.
    pub(crate) id: u32,
    /// The row of its packet, or [`Place::NO_PACKET`] for a shape.
    pub(crate) row: u32,
    pub(crate) lane: u32,
}

impl Place {
    pub(crate) const NO_PACKET: u32 = u32::MAX;
    /// No hit yet: loses every tie.
    pub(crate) const NOWHERE: Self = Self { instance: SCENE, id: u32::MAX, row: Self::NO_PACKET, lane: 0 };
}

impl Cx<'_> {
    /// `(instance, primitive number in its geometry's own count)`: what decides ties.
    pub(crate) fn rank(&self, place: &Place) -> (u32, u32) {
        match (place.instance, place.id) {
            (_, u32::MAX) => (u32::MAX, u32::MAX),
            (SCENE, id) => self.accel.owners.of(id),
            (instance, id) => (instance, id),
        }
    }

    /// Whether the ray enters an instance's box before `t_max`, and where; `None` if the instance is not there for it.
    #[inline(always)]
    fn window(&self, index: u32, world: &Space<'_>, t_max: f32) -> Option<(bool, f32)> {
        let instance = &self.accel.instances[index as usize];
        let window = match (instance.is_bounded, instance.mover, &self.accel.movers) {
            (false, _, _) => Window::ALL,
            (true, Instance::STANDS, _) | (true, _, None) => world.slab.window(&instance.bounds),
            (true, mover, Some(movers)) => world.slab.window(&movers.own_box(mover, world.ray.time)),
        };
        (instance.seen.mask & self.mask != 0).then(|| (window.admits(world.ray.t_min, t_max), window.near))
    }

    /// Runs `visit` with the ray in the space of instance `index`, whose box it enters at `floor`.
    #[inline(always)]
    fn inside<R>(
        &self,
        index: u32,
        world: &Space<'_>,
        floor: f32,
        visit: impl FnOnce(&Level<'_>) -> R,
    ) -> Option<R> {
        let instance = &self.accel.instances[index as usize];
        let forest = self.accel.geometries[instance.geometry.index()].forest.as_ref()?;
        let object_ray = instance.pose.object_ray(world.ray);
        let ray = object_ray.as_ref().unwrap_or(world.ray);
        Some(visit(&Level { ray, forest, movers: None, instance: index, floor: greater(floor, f32::MIN) }))
    }

    /// The same, if the ray enters the box before `t_max`.
    #[inline(always)]
    fn enter<R>(
        &self,
        index: u32,
        world: &Space<'_>,
        t_max: f32,
        visit: impl FnOnce(&Level<'_>) -> R,
    ) -> Option<R> {
        let (admitted, floor) = self.window(index, world, t_max)?;
        if admitted { self.inside(index, world, floor, visit) } else { None }
    }
}
