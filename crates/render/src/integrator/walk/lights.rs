//! Direct light: one shadow ray for each light.
use durer_core::spectrum::Spectrum;

use super::{super::shading::Shading, Walk};
use crate::{PathRay, probe::Probe};

pub(super) use super::super::shading::LIGHT_BRANCH;

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
}
