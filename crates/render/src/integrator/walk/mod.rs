//! The recursion that all branching integrators share:
//!
//! `L = L_e + ambient term + sum over lights of (f cos * light, if its shadow ray arrives) + sum over branches of
//! weight * L(child)`.
//!
//! They differ in their [`Rules`] only.
mod branches;
mod gloss;
mod lights;
mod rules;
mod shadow;

use durer_accel::Hit;
use durer_core::spectrum::Spectrum;

pub(super) use rules::{MAX_DEPTH, MIN_CONTRIBUTION, Rules};

use super::shading::Shading;
use crate::{
    Contribution, PathRay, SampleCx, Value,
    probe::{Probe, RayKind, StopReason},
};

/// The recursion's state: one per sample.
pub(super) struct Walk<'a, P: Probe> {
    pub(super) rules: &'a Rules,
    pub(super) cx: &'a SampleCx<'a>,
    pub(super) probe: &'a mut P,
    pub(super) rays: u64,
}

impl<'a, P: Probe> Walk<'a, P> {
    /// The walk of one sample.
    pub(super) fn new(rules: &'a Rules, cx: &'a SampleCx<'a>, probe: &'a mut P) -> Self {
        Self { rules, cx, probe, rays: 0 }
    }

    /// Walks the whole tree of an eye ray.
    pub(super) fn sample(mut self, ray: &PathRay, parent: P::Id, out: &mut Contribution) {
        out.value = Value::Radiance(self.trace(ray, RayKind::Eye, parent));
        out.rays = self.rays;
    }

    /// Radiance arriving along a ray.
    pub(super) fn trace(&mut self, ray: &PathRay, kind: RayKind, parent: P::Id) -> Spectrum {
        let id = self.probe.ray(parent, ray, kind);
        let radiance = match self.reason_to_stop(ray) {
            Some(reason) => {
                self.probe.stop(id, reason, ray.throughput);
                Spectrum::BLACK
            }
            None => {
                self.rays += 1;
                match self.cx.scene.closest(self.cx, &ray.ray, self.probe, id) {
                    Some(hit) => self.shade(ray, &hit, id),
                    None => self.escape(ray, id),
                }
            }
        };
        self.probe.result(id, radiance);
        radiance
    }

    fn reason_to_stop(&self, ray: &PathRay) -> Option<StopReason> {
        if ray.depth > self.rules.max_depth {
            Some(StopReason::DepthLimit)
        } else if ray.depth > 0 && ray.throughput.max() * ray.siblings <= self.rules.min_contribution {
            Some(StopReason::ContributionBelowCutoff)
        } else {
            None
        }
    }

    fn escape(&mut self, ray: &PathRay, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let sky = cx.scene.escaped(cx.basis, ray.ray.d);
        self.probe.local(id, sky);
        self.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }

    fn shade(&mut self, ray: &PathRay, hit: &Hit, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let s = Shading::at(cx, &ray.ray, hit);
        self.probe.surface(id, s.object, hit, &s.surface);
        let mut radiance = s.emission + self.lamp(ray, &s) + s.ambient(cx);
        if self.rules.gloss_rays.is_none() {
            radiance += s.blurred_sky(cx);
        }
        self.probe.local(id, radiance);
        let radiance = self.lights(ray, &s, id, radiance);
        let radiance = self.branches(ray, &s, id, radiance);
        match self.rules.gloss_rays {
            Some(rays) => self.gloss(ray, &s, id, rays.get(), radiance),
            None => radiance,
        }
    }
}
