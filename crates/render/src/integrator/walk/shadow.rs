//! Shadow rays: what of a light arrives.
//!
//! With transparent shadows a ray goes straight on through what is transparent, as often as need be. However many
//! surfaces it passes, it counts as one ray.
use durer_accel::Hit;
use durer_core::{
    Id,
    math::{Point3, Ray},
    sampling::Dim,
    spectrum::Spectrum,
};
use durer_model::{bsdf::Straight, light::LightSample};

use super::{
    super::shading::{MEDIUM_BRANCH, Shading},
    MOST_PASSED, Walk,
    lights::LIGHT_BRANCH,
    span,
};
use crate::{
    MediumStack, Object, PathRay,
    media::{Boundary, Crossing},
    probe::{LightEvent, Probe, RayKind, StopReason},
};

/// What a light sends through whatever is in between.
pub(in super::super) struct Passage {
    /// The share that arrives.
    pub(in super::super) share: Spectrum,
    /// What kept all of it.
    pub(in super::super) blocker: Option<Id<Object>>,
    /// Why nothing arrives, if nothing does.
    pub(in super::super) end: StopReason,
}

/// What floats on the way to a light.
struct Floating<'a> {
    path: &'a PathRay,
    /// Parts of the way, each with random numbers of its own.
    ways: u32,
    /// The density with which each lane would have sent a scattered ray through all of it.
    drawn: Spectrum,
}

impl Floating<'_> {
    /// What is left of light on a part of the way, up to parameter `t` of its ray.
    fn left<P: Probe>(
        &mut self,
        walk: &Walk<'_, P>,
        bodies: &MediumStack,
        (from, ray): (Point3, &Ray),
        t: f32,
    ) -> Spectrum {
        self.ways += 1;
        let Some(volume) = walk.volume(bodies) else { return Spectrum::ONE };
        let unit = ray.d.length();
        let seen = Ray { d: ray.d / unit, ..*ray };
        let sampler = self.path.sampler.fork(MEDIUM_BRANCH + self.ways);
        let draws = |i| sampler.fork(i).d2(Dim::Medium);
        let passage = volume.pass(walk.cx.basis, &seen, span(from, &seen, t * unit), &draws);
        self.drawn *= passage.passed;
        passage.share
    }
    /// What a light's share against scattered rays, reckoned as if nothing were in the way, is to be divided by: these get
    /// through by chance (balance heuristic).
    fn other_share(&self) -> f32 {
        let other = self.path.density.unwrap_or(0.0);
        (1.0 - other) + other * self.drawn.mean()
    }
}

/// The segment from a place among particles to another point.
pub(in super::super) fn between(from: Point3, to: Point3, time: f32) -> Ray {
    Ray { t_max: 1.0f32.next_down(), time, ..Ray::new(from, to - from) }
}

impl<P: Probe> Walk<'_, P> {
    /// Sends the shadow ray; the light that arrives.
    pub(in super::super) fn shadow(
        &mut self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
        id: P::Id,
    ) -> Spectrum {
        let path = self.shadow_path(parent, (s, crossing), light, weight, sample);
        self.send_shadow(&path, light as u32, (sample.point, sample.weight), id)
    }

    /// The ray to a light.
    pub(in super::super) fn shadow_path(
        &self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
    ) -> PathRay {
        let ray = match sample.point {
            Some(point) => s.surface.spawn_to(point, parent.ray.time),
            None => s.surface.spawn(sample.wi, parent.ray.time),
        };
        let media = crossing.media(s.side_of(sample.wi));
        PathRay { media, ..parent.child((s.surface.p, ray), weight, LIGHT_BRANCH + light as u32) }
    }

    /// The ray to a light from a place among particles.
    pub(in super::super) fn shadow_path_at(
        &self,
        parent: &PathRay,
        p: Point3,
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
    ) -> PathRay {
        let time = parent.ray.time;
        let ray = match sample.point {
            Some(point) => between(p, point, time),
            None => Ray { time, ..Ray::new(p, sample.wi) },
        };
        parent.child((p, ray), weight, LIGHT_BRANCH + light as u32)
    }

    /// Sends a shadow ray to a light at a point, or infinitely far away, which sends `unoccluded`; the light that arrives.
    pub(in super::super) fn send_shadow(
        &mut self,
        path: &PathRay,
        light: u32,
        (point, unoccluded): (Option<Point3>, Spectrum),
        id: P::Id,
    ) -> Spectrum {
        let shadow = self.probe.ray(id, path, RayKind::Shadow);
        let passage = self.way(path, point, shadow);
        let visible = !passage.share.is_black();
        let (passed, blocker) = (passage.share, passage.blocker);
        self.probe.light(shadow, &LightEvent { light, point, unoccluded, passed, visible, blocker });
        let (arriving, reason) = match visible {
            true => (passed * unoccluded, StopReason::HitLight),
            false => (Spectrum::BLACK, passage.end),
        };
        self.probe.local(shadow, arriving);
        self.probe.stop(shadow, reason, Spectrum::BLACK);
        self.probe.result(shadow, arriving);
        arriving
    }

    /// What a straight ray to a point, or to infinity, lets pass.
    pub(in super::super) fn way(&mut self, path: &PathRay, to: Option<Point3>, shadow: P::Id) -> Passage {
        self.rays += 1;
        match self.straight() {
            Some(how) => self.passage(path, to, how, shadow),
            None => self.free_passage(path, shadow),
        }
    }

    /// How surfaces are passed; `None` if all of them block light, or there is none to be passed.
    fn straight(&self) -> Option<Straight> {
        let may_pass = self.heeds_media || self.cx.scene.is_passed;
        self.rules.straight.filter(|how| *how != Straight::Clear || may_pass)
    }

    /// The way to a light that everything blocks; in a body that absorbs, its length counts all the same.
    fn free_passage(&mut self, path: &PathRay, shadow: P::Id) -> Passage {
        let cx = self.cx;
        let ray = &path.ray;
        if !cx.scene.occluded(cx, ray, self.probe, shadow) {
            let t = if ray.t_max.is_finite() { 1.0 } else { f32::INFINITY };
            let share = self.arriving(&path.media, path.from, ray, t);
            return Passage { share, blocker: None, end: StopReason::Absorbed };
        }
        let blocker = if P::RECORDS { cx.scene.blocker(cx, ray) } else { None };
        Passage { share: Spectrum::BLACK, blocker, end: StopReason::LightOccluded }
    }

    /// The way to a light at `to`, or infinitely far away, through what is transparent.
    fn passage(&mut self, path: &PathRay, to: Option<Point3>, how: Straight, shadow: P::Id) -> Passage {
        let cx = self.cx;
        let (mut from, mut ray) = (path.from, path.ray);
        let mut bodies: MediumStack = path.media;
        let mut share = Spectrum::ONE;
        let mut floating = Floating { path, ways: 0, drawn: path.lanes };
        for _ in 0..MOST_PASSED {
            let asked = (&mut *self.probe, shadow);
            let Some(hit) = cx.scene.closest_in_the_way(cx, &ray, self.heeds_media, asked) else {
                let t = if to.is_some() { 1.0 } else { f32::INFINITY };
                share *= self.arriving(&bodies, from, &ray, t);
                if self.heeds_media {
                    share *= floating.left(self, &bodies, (from, &ray), t);
                    share = share / floating.other_share();
                }
                return Passage { share, blocker: None, end: StopReason::Absorbed };
            };
            share *= self.arriving(&bodies, from, &ray, hit.t);
            if self.heeds_media {
                share *= floating.left(self, &bodies, (from, &ray), hit.t);
            }
            let is_absorbed = share.is_black();
            // Surfaces expect a unit direction.
            let unit = ray.d.length();
            let seen = Ray { d: ray.d / unit, ..ray };
            let hit = Hit { t: hit.t * unit, ..hit };
            let mut s = Shading::at(cx, &seen, &hit, None);
            let crossing = self.cross(&bodies, &mut s, hit.t);
            match crossing.boundary {
                Boundary::Passed => {}
                Boundary::Between(eta) => {
                    s.bsdf.set_eta(s.wo_local, eta);
                    share *= s.bsdf.straight(s.wo_local, how);
                }
                Boundary::Own => share *= s.bsdf.straight(s.wo_local, how),
            }
            if share.is_black() {
                return match is_absorbed {
                    true => Passage { share, blocker: None, end: StopReason::Absorbed },
                    false => Passage { share, blocker: Some(s.object), end: StopReason::LightOccluded },
                };
            }
            bodies = crossing.behind;
            from = s.surface.p;
            ray = match to {
                Some(point) => s.surface.spawn_to(point, ray.time),
                None => s.surface.spawn(ray.d, ray.time),
            };
        }
        Passage { share: Spectrum::BLACK, blocker: None, end: StopReason::LightOccluded }
    }
}
