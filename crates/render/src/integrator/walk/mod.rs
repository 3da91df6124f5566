//! The recursion that all branching integrators share:
//!
//! `L = T (L_e + ambient term + sum over lights of (f cos * light, if its shadow ray arrives) + sum over branches of
//! weight * L(child))`,
//!
//! where `T` is what the way along the ray leaves: absorption in the body it is in, and the distance attenuation of the
//! rules. `T` is part of the local terms and of the weights, so that the sum is one of children.
//!
//! They differ in their [`Rules`] only.
mod branches;
mod gloss;
mod lights;
mod medium;
mod report;
mod rules;
mod shadow;

use durer_accel::Hit;
use durer_core::spectrum::Spectrum;
use durer_model::texture::Habit;

use super::{Start, below::Descent, shading::Shading};
use crate::{
    Below, Contribution, Imbalances, PathRay, SampleCx, Value,
    footprint::Onlooker,
    media::Boundary,
    probe::{Probe, RayKind, StopReason},
};

pub(super) use medium::{deflection, draws, span};
pub(super) use report::Parts;
pub(super) use rules::Rules;
pub use rules::{Lights, Shadows};
pub(super) use shadow::between;

/// Surfaces passed in a row at most: each is a step of the recursion, though no bounce.
const MOST_PASSED: u32 = 1000;

/// The recursion's state: one per sample.
pub(super) struct Walk<'a, P: Probe> {
    pub(super) rules: &'a Rules,
    pub(super) cx: &'a SampleCx<'a>,
    pub(super) probe: &'a mut P,
    pub(super) rays: u64,
    pub(super) imbalances: Imbalances,
    /// Whether what floats in places counts: surfaces that are not there are met where media begin and end.
    pub(super) heeds_media: bool,
    /// What becomes of light below surfaces, for walks from both ends.
    pub(super) descent: Descent,
}

impl<'a, P: Probe> Walk<'a, P> {
    /// The walk of one sample.
    pub(super) fn new(rules: &'a Rules, cx: &'a SampleCx<'a>, probe: &'a mut P) -> Self {
        Self {
            rules,
            cx,
            probe,
            rays: 0,
            imbalances: Imbalances::default(),
            heeds_media: false,
            descent: Descent::Flat,
        }
    }

    /// The same, for which counts what floats in places and what is below surfaces, if that is anywhere.
    pub(super) fn in_media(
        rules: &'a Rules,
        cx: &'a SampleCx<'a>,
        probe: &'a mut P,
        descent: Descent,
    ) -> Self {
        let descent = if cx.scene.media.are_walked() { descent } else { Descent::Flat };
        Self { heeds_media: !cx.scene.volumes.is_empty(), descent, ..Self::new(rules, cx, probe) }
    }

    /// Walks the whole tree of an eye ray, which starts in the bodies that the camera is in, or follows a recorded ray.
    pub(super) fn start(mut self, start: Start<'_>, parent: P::Id, out: &mut Contribution) {
        let radiance = match start {
            Start::Eye(ray) => {
                let ray = PathRay { media: self.cx.scene.start, ..*ray };
                self.trace(&ray, RayKind::Eye, parent)
            }
            Start::Again(node) => match &node.light {
                Some(event) => {
                    self.send_shadow(&node.path, event.light, (event.point, event.unoccluded), parent)
                }
                None => self.trace(&node.path, node.kind, parent),
            },
        };
        out.value = Value::Radiance(radiance);
        out.rays = self.rays;
        out.imbalances = self.imbalances;
    }

    /// Radiance arriving along a ray.
    pub(super) fn trace(&mut self, ray: &PathRay, kind: RayKind, parent: P::Id) -> Spectrum {
        let id = self.probe.ray(parent, ray, kind);
        let radiance = match self.reason_to_stop(ray) {
            Some(reason) => {
                if P::RECORDS {
                    self.report_limit(ray, reason, id);
                }
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

    pub(super) fn reason_to_stop(&self, ray: &PathRay) -> Option<StopReason> {
        let is_lost = |below: Below| below.rays > Below::MOST_RAYS;
        if ray.depth > self.rules.max_depth || ray.passed > MOST_PASSED || ray.below.is_some_and(is_lost) {
            Some(StopReason::DepthLimit)
        } else if ray.depth > 0 && ray.throughput.max() * ray.siblings <= self.rules.min_contribution {
            Some(StopReason::ContributionBelowCutoff)
        } else if P::RECORDS && self.probe.is_full() {
            Some(StopReason::Cancelled)
        } else {
            None
        }
    }

    fn escape(&mut self, ray: &PathRay, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let sky = self.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY)
            * cx.scene.escaped(cx.basis, ray.ray.d);
        self.probe.local(id, sky);
        self.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }

    fn shade(&mut self, ray: &PathRay, hit: &Hit, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let mut s = Shading::at(cx, &ray.ray, hit, Some(Onlooker::of(ray, Habit::Asked)));
        self.probe.surface(id, s.object, hit, &s.surface);
        let crossing = self.cross(&ray.media, &mut s, hit.t);
        let arriving = self.arriving(&ray.media, ray.from, &ray.ray, hit.t);
        match crossing.boundary {
            Boundary::Passed => {
                if P::RECORDS {
                    self.report_passed(ray, &crossing, arriving, id);
                }
                let beyond = s.surface.spawn(ray.ray.d, ray.ray.time);
                let child = ray.passing((s.surface.p, beyond), arriving, crossing.behind, hit.t);
                return arriving * self.trace(&child, RayKind::Passing, id);
            }
            Boundary::Between(eta) => s.bsdf.set_eta(s.wo_local, eta),
            Boundary::Own => {}
        }
        let arriving = arriving * self.rules.attenuation(ray, hit.t);
        let emission = arriving * (s.emission + self.lamp(ray, &s));
        let collapsed;
        let (ray, arriving) = match crossing.disperses && !ray.is_collapsed {
            true => {
                collapsed = PathRay { is_collapsed: true, ..*ray };
                (&collapsed, arriving * cx.basis.collapse())
            }
            false => (ray, arriving),
        };
        s.bsdf.dim(arriving);
        let ambient = s.ambient(cx);
        let mut radiance = emission + ambient;
        let mut blurred_sky = Spectrum::BLACK;
        if self.rules.gloss_rays.is_none() {
            blurred_sky = s.blurred_sky(cx);
            radiance += blurred_sky;
        }
        if P::RECORDS {
            let parts = Parts { arrived: arriving, emission, ambient, blurred_sky };
            self.report_hit(ray, (&s, &crossing), &parts, id);
        }
        self.probe.local(id, radiance);
        let radiance = self.lights(ray, &s, &crossing, (id, radiance));
        let radiance = self.branches(ray, &s, &crossing, (id, radiance));
        match self.rules.gloss_rays {
            Some(rays) if s.bsdf.spreads() => self.gloss(ray, &s, &crossing, rays.get(), (id, radiance)),
            _ => radiance,
        }
    }
}
