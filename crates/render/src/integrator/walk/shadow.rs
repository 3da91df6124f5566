//! Shadow rays: what of a light arrives.
use durer_core::spectrum::Spectrum;
use durer_model::light::LightSample;

use super::{super::shading::Shading, Walk, lights::LIGHT_BRANCH};
use crate::{
    PathRay,
    probe::{LightEvent, Probe, RayKind, StopReason},
};

impl<P: Probe> Walk<'_, P> {
    /// Sends the shadow ray; the light that arrives.
    pub(super) fn shadow(
        &mut self,
        parent: &PathRay,
        s: &Shading,
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
        id: P::Id,
    ) -> Spectrum {
        let cx = self.cx;
        let ray = match sample.point {
            Some(point) => s.surface.spawn_to(point, parent.ray.time),
            None => s.surface.spawn(sample.wi, parent.ray.time),
        };
        let shadow =
            self.probe.ray(id, &parent.child(ray, weight, LIGHT_BRANCH + light as u32), RayKind::Shadow);
        self.rays += 1;
        let visible = !cx.scene.occluded(cx, &ray, self.probe, shadow);
        let event = LightEvent {
            light: light as u32,
            point: sample.point,
            unoccluded: sample.weight,
            visible,
            blocker: if P::RECORDS && !visible { cx.scene.blocker(cx, &ray) } else { None },
        };
        self.probe.light(shadow, &event);
        let (arriving, reason) = match visible {
            true => (sample.weight, StopReason::HitLight),
            false => (Spectrum::BLACK, StopReason::LightOccluded),
        };
        self.probe.local(shadow, arriving);
        self.probe.stop(shadow, reason, Spectrum::BLACK);
        self.probe.result(shadow, arriving);
        arriving
    }
}
