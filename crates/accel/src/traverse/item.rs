//! Shapes that are not triangles, in the leaves of a tree or alone in their instance.
use super::{Best, Cx, Level, Place};
use crate::{
    Hit, PrimitiveHit,
    probe::Watch,
    slab::{Measured, Slab, Window, greater},
};

/// An item by its number in a tree, and `(instance, primitive)`.
type Named = (u32, (u32, u32));

impl Cx<'_> {
    /// Offers a shape's hit to `best`. `window` is the stretch of the ray in its own box. PERF: asked of hits only; the node
    /// that holds the item has tested a box that is hardly larger (bench render).
    #[inline(always)]
    pub(super) fn item_nearest(
        &self,
        (item, (instance, prim)): Named,
        level: &Level<'_>,
        best: &mut Best,
        window: impl FnOnce() -> Window,
    ) {
        let found = self.meet(instance, prim, level.ray, best.t);
        let Some(PrimitiveHit { t, u, v }) = found else { return };
        let Some(t) = level.admit(t, window(), best.t) else { return };
        let place = Place { instance: level.instance, id: item, row: Place::NO_PACKET, lane: 0 };
        let hit = Best { t, u, v, place };
        if self.wins(&hit, best) && self.passes(instance, prim, &hit) {
            *best = hit;
        }
    }

    /// Whether a shape is hit with `t` up to `t_max`; `window` as above.
    #[inline(always)]
    pub(super) fn item_blocks(
        &self,
        (item, (instance, prim)): Named,
        level: &Level<'_>,
        t_max: f32,
        window: impl FnOnce() -> Window,
    ) -> bool {
        if !self.filters {
            let blocks = self.is_met(instance, prim, level.ray, t_max);
            return blocks && window().admits(level.ray.t_min, t_max) && level.floor <= t_max;
        }
        let found = self.meet(instance, prim, level.ray, t_max);
        let Some(PrimitiveHit { t, u, v }) = found else { return false };
        let Some(t) = level.admit(t, window(), t_max) else { return false };
        let place = Place { instance: level.instance, id: item, row: Place::NO_PACKET, lane: 0 };
        self.passes(instance, prim, &Best { t, u, v, place })
    }

    /// [`Self::item_nearest`] of the only shape of an instance. PERF: a walk would be prepared for no box (bench render).
    #[inline(never)]
    pub(super) fn sole_nearest<W: Watch, const ROBUST: bool>(
        &self,
        level: &Level<'_>,
        item: u32,
        best: &mut Best,
        watch: &mut W,
    ) {
        watch.primitive(level.instance, item);
        let window = || self.sole_window::<ROBUST>(level, item);
        self.item_nearest((item, (level.instance, item)), level, best, window);
    }

    /// [`Self::item_blocks`] of the only shape of an instance.
    #[inline(never)]
    pub(super) fn sole_blocks<W: Watch, const ROBUST: bool>(
        &self,
        level: &Level<'_>,
        item: u32,
        t_max: f32,
        watch: &mut W,
    ) -> bool {
        watch.primitive(level.instance, item);
        let window = || self.sole_window::<ROBUST>(level, item);
        self.item_blocks((item, (level.instance, item)), level, t_max, window)
    }

    /// The stretch of the ray in the own box of an instance's only shape; of rays that can hit nothing none.
    fn sole_window<const ROBUST: bool>(&self, level: &Level<'_>, item: u32) -> Window {
        let Some(own) = self.accel.items(level.instance).own_box(item) else { return Window::ALL };
        let measured = Measured::of(level.ray);
        let region = level.forest.region;
        match (measured.is_valid(), measured.is_odd(region)) {
            (false, _) => Window::NONE,
            (true, false) => Slab::new::<ROBUST>(&measured).window(&own),
            (true, true) => Slab::odd::<ROBUST>(&measured, region).window(&own),
        }
    }

    /// Nearer, or as near with a smaller name.
    pub(super) fn wins(&self, hit: &Best, best: &Best) -> bool {
        hit.t < best.t || (hit.t == best.t && self.rank(&hit.place) < self.rank(&best.place))
    }

    /// Whether the caller's filter lets the hit count.
    pub(super) fn passes(&self, instance: u32, prim: u32, hit: &Best) -> bool {
        let asks = self.filters && self.accel.instances[instance as usize].seen.is_filtered;
        !asks || {
            let (prim, u, v) = self.accel.called(instance, prim, hit.u, hit.v);
            let n_g = durer_core::math::Vector3::ZERO;
            self.callback.accepts(&Hit { t: hit.t, instance, prim, u, v, n_g })
        }
    }
}

impl Level<'_> {
    /// The `t` a hit at `t` counts with: not before the ray enters the boxes (see the crate's contract). `None` if that
    /// leaves `[t_min, t_max]`.
    fn admit(&self, t: f32, window: Window, t_max: f32) -> Option<f32> {
        let t_min = self.ray.t_min;
        let raised = greater(greater(t, window.near), self.floor);
        let valid = window.admits(t_min, t_max) && t >= t_min && raised <= t_max;
        valid.then_some(raised)
    }
}
