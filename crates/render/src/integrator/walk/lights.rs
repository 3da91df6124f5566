//! Direct light: one shadow ray for each light.
use durer_core::spectrum::Spectrum;
use durer_model::light::LightSample;

use super::{super::shading::Shading, Walk};
use crate::{
    PathRay,
    probe::{LightEvent, Probe, RayKind, StopReason},
};

/// Shadow rays use sampler branches from here on; sharp directions use those below.
const LIGHT_BRANCH: u32 = 1 << 16;

impl<P: Probe> Walk<'_, P> {
    /// Adds the light of all lights to `radiance`, in their order: the recorder folds them the same way.
    pub(super) fn lights(
        &mut self,
        ray: &PathRay,
        s: &Shading,
        id: P::Id,
        mut radiance: Spectrum,
    ) -> Spectrum {
        let cx = self.cx;
        let lamps = if s.bsdf.is_sharp() { &[] } else { cx.scene.lamps.as_slice() };
        for light in lamps.iter().map(|&light| light as usize) {
            let sampler = ray.sampler.fork(LIGHT_BRANCH + light as u32);
            if let Some((weight, sample)) = s.light(cx, light, &sampler) {
                radiance += weight * self.shadow(ray, s, light, weight, &sample, id);
            }
        }
        radiance
    }

    /// Sends the shadow ray; the light that arrives.
    fn shadow(
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
