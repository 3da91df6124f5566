//! What happens in the leaves of both levels: instances enter their geometry, primitives are tested.
use std::ops::Range;

use crate::{
    Accel, Engine, Hit, PrimitiveHit, TraversalProbe, UserGeometry,
    accel::Instance,
    geometry::{Geometry, Items, LeafBox, LeafTriangle},
    slab::{Window, greater},
    space::Space,
    tree::{Leaves, Span, Tree},
    triangle::{self, Shear},
};

/// The caller's side of a query.
pub(crate) struct Query<'a, U, P: TraversalProbe> {
    pub(crate) user: &'a U,
    pub(crate) probe: &'a mut P,
    pub(crate) id: P::Id,
}

/// Leaves that hold instances.
pub(crate) struct TopLevel<'a, U, P: TraversalProbe> {
    pub(crate) accel: &'a Accel,
    pub(crate) query: Query<'a, U, P>,
    /// The ray in render space.
    pub(crate) world: &'a Space<'a>,
    /// Where it ends: finite, unlike in the ray itself.
    pub(crate) t_max: f32,
}

/// Leaves that hold primitives of one instance.
pub(crate) struct BottomLevel<'a, 'q, U, P: TraversalProbe> {
    geometry: &'a Geometry,
    query: &'a mut Query<'q, U, P>,
    instance: u32,
    /// Where the ray enters the instance's box.
    near: f32,
    /// The ray in object space.
    space: &'a Space<'a>,
    /// Where it ends: finite, unlike in the ray itself.
    t_max: f32,
    /// What triangle tests need of the ray, where there are triangles.
    shear: Option<Shear>,
    /// Test everything, whatever was found.
    exhaustive: bool,
}

impl Instance {
    fn window(&self, world: &Space<'_>) -> Window {
        if self.is_bounded { world.slab.window_of(&self.bounds) } else { Window::ALL }
    }
}

impl LeafBox {
    fn window(&self, space: &Space<'_>) -> Window {
        if self.finite { space.slab.window_of(&self.bounds) } else { Window::ALL }
    }
}

impl<U: UserGeometry, P: TraversalProbe> TopLevel<'_, U, P> {
    /// Runs `visit` in the one instance there is, whose space is the world. Its box holds those of its primitives, so
    /// that they alone decide.
    #[inline]
    pub(crate) fn only<R>(
        &mut self,
        visit: impl FnOnce(&Tree, &mut BottomLevel<'_, '_, U, P>) -> R,
    ) -> Option<R> {
        let instance = self.accel.instances.first()?;
        let geometry = &self.accel.geometries[instance.geometry.index()];
        let shear = if geometry.has_triangles() { Some(Shear::new(self.world.ray)?) } else { None };
        let mut leaves = BottomLevel {
            geometry,
            query: &mut self.query,
            instance: 0,
            near: f32::NEG_INFINITY,
            space: self.world,
            t_max: self.t_max,
            shear,
            exhaustive: false,
        };
        Some(visit(&geometry.tree, &mut leaves))
    }

    /// Runs `visit` with the ray in the object space of instance `index`.
    fn enter<R>(
        &mut self,
        index: u32,
        instance: &Instance,
        near: f32,
        visit: impl FnOnce(&Geometry, &Space<'_>, &mut BottomLevel<'_, '_, U, P>) -> R,
    ) -> Option<R> {
        let geometry = &self.accel.geometries[instance.geometry.index()];
        let (local, transformed);
        let space = match instance.pose.object_ray(self.world.ray) {
            None => self.world,
            Some(ray) => {
                local = ray;
                transformed = Space::new(&local, &geometry.finite)?;
                &transformed
            }
        };
        let t_max = self.t_max;
        let shear = if geometry.has_triangles() { Some(Shear::new(space.ray)?) } else { None };
        let exhaustive = self.accel.engine == Engine::BruteForce;
        let query = &mut self.query;
        Some(visit(
            geometry,
            space,
            &mut BottomLevel { geometry, query, instance: index, near, space, t_max, shear, exhaustive },
        ))
    }
}

impl<U: UserGeometry, P: TraversalProbe> Leaves for TopLevel<'_, U, P> {
    #[inline]
    fn node(&mut self, node: u32) {
        self.query.probe.node(self.query.id, node);
    }

    fn nearest(&mut self, items: Range<usize>, best: &mut Hit) {
        let accel = self.accel;
        let t_min = self.world.ray.t_min;
        for &index in &accel.order[items] {
            let instance = &accel.instances[index as usize];
            let window = instance.window(self.world);
            let admitted = window.admits(t_min, best.t);
            if !admitted && accel.engine == Engine::Bvh {
                continue;
            }
            // Brute force tests what the box excludes too, and forgets the result.
            let mut ignored = *best;
            let target = if admitted { &mut *best } else { &mut ignored };
            self.enter(index, instance, window.near, |geometry, space, leaves| {
                geometry.tree.nearest(&space.slab, t_min, target, leaves);
            });
        }
    }

    fn blocks(&mut self, items: Range<usize>) -> bool {
        let accel = self.accel;
        let (t_min, t_max) = (self.world.ray.t_min, self.t_max);
        let mut blocked = false;
        for &index in &accel.order[items] {
            let instance = &accel.instances[index as usize];
            let window = instance.window(self.world);
            let admitted = window.admits(t_min, t_max);
            if !admitted && accel.engine == Engine::Bvh {
                continue;
            }
            let hit = self.enter(index, instance, window.near, |geometry, space, leaves| {
                geometry.tree.blocks(&space.slab, Span { t_min, t_max }, leaves)
            });
            blocked |= admitted && hit == Some(true);
            if blocked && accel.engine == Engine::Bvh {
                return true;
            }
        }
        blocked
    }
}

impl<U: UserGeometry, P: TraversalProbe> BottomLevel<'_, '_, U, P> {
    /// The `t` a hit at `t` counts with: not before the ray enters the boxes (see the crate's contract). `None` if that
    /// leaves `[t_min, t_max]`.
    #[inline]
    fn admit(&self, t: f32, window: Window, t_max: f32) -> Option<f32> {
        let t_min = self.space.ray.t_min;
        // PERF: not `f32::max`, which looks after NaN: that fails the test below (bench render).
        let raised = greater(greater(t, window.near), self.near);
        let valid = window.admits(t_min, t_max) && t >= t_min && raised <= t_max;
        valid.then_some(raised)
    }

    #[inline]
    fn triangle(&mut self, leaf: &LeafTriangle, t_max: f32) -> Option<Hit> {
        self.query.probe.primitive(self.query.id, self.instance, leaf.prim);
        let shear = self.shear.as_ref()?;
        let found = triangle::intersect(shear, &leaf.vertices, self.space.ray.t_min, t_max)?;
        let [_, u, v] = found.weights;
        let window = self.space.slab.window_of(&leaf.bounds());
        self.hit(leaf.prim, PrimitiveHit { t: found.t, u, v }, window, t_max)
    }

    fn user(&mut self, leaf: &LeafBox, t_max: f32) -> Option<Hit> {
        let window = leaf.window(self.space);
        if !self.asks(leaf.prim, window, t_max) {
            return None;
        }
        let found = self.query.user.intersect(self.instance, leaf.prim, self.space.ray, t_max)?;
        self.hit(leaf.prim, found, window, t_max)
    }

    fn user_blocks(&mut self, leaf: &LeafBox) -> bool {
        let t_max = self.t_max;
        if U::FILTERS {
            return self.user(leaf, t_max).is_some();
        }
        let window = leaf.window(self.space);
        self.asks(leaf.prim, window, t_max)
            && self.query.user.occludes(self.instance, leaf.prim, self.space.ray, t_max)
            && window.admits(self.space.ray.t_min, t_max)
            && self.near <= t_max
    }

    /// Whether the callback is asked; not if the box already says no.
    fn asks(&mut self, prim: u32, window: Window, t_max: f32) -> bool {
        let asks = self.exhaustive || window.admits(self.space.ray.t_min, t_max);
        if asks {
            self.query.probe.primitive(self.query.id, self.instance, prim);
        }
        asks
    }

    #[inline]
    fn hit(&self, prim: u32, found: PrimitiveHit, window: Window, t_max: f32) -> Option<Hit> {
        let t = self.admit(found.t, window, t_max)?;
        let hit = Hit { t, instance: self.instance, prim, u: found.u, v: found.v };
        (!U::FILTERS || self.query.user.accepts(&hit)).then_some(hit)
    }

    /// Whether `test` finds a hit on any item; brute force looks at all of them.
    #[inline]
    fn some<T>(
        &mut self,
        items: impl IntoIterator<Item = T>,
        mut test: impl FnMut(&mut Self, T) -> bool,
    ) -> bool {
        let mut blocked = false;
        for item in items {
            blocked |= test(self, item);
            if blocked && !self.exhaustive {
                return true;
            }
        }
        blocked
    }
}

impl<U: UserGeometry, P: TraversalProbe> Leaves for BottomLevel<'_, '_, U, P> {
    #[inline]
    fn node(&mut self, node: u32) {
        self.query.probe.node(self.query.id, node);
    }

    #[inline]
    fn nearest(&mut self, items: Range<usize>, best: &mut Hit) {
        match &self.geometry.items {
            Items::Triangles { leaves, .. } => {
                for leaf in &leaves[items] {
                    if let Some(hit) = self.triangle(leaf, best.t) {
                        best.offer(hit);
                    }
                }
            }
            Items::Moving(moving) => {
                for index in items {
                    if let Some(hit) = self.triangle(&moving.at(index, self.space.ray.time), best.t) {
                        best.offer(hit);
                    }
                }
            }
            Items::Boxes(leaves) => {
                for leaf in &leaves[items] {
                    if let Some(hit) = self.user(leaf, best.t) {
                        best.offer(hit);
                    }
                }
            }
        }
    }

    #[inline]
    fn blocks(&mut self, items: Range<usize>) -> bool {
        let t_max = self.t_max;
        match &self.geometry.items {
            Items::Triangles { leaves, .. } => {
                self.some(&leaves[items], |level, leaf| level.triangle(leaf, t_max).is_some())
            }
            Items::Moving(moving) => {
                let time = self.space.ray.time;
                self.some(items, |level, index| level.triangle(&moving.at(index, time), t_max).is_some())
            }
            Items::Boxes(leaves) => self.some(&leaves[items], Self::user_blocks),
        }
    }
}
