//! Direct light: one shadow ray for each light.
use durer_core::{sampling::Sampler, spectrum::Spectrum};
use durer_model::bsdf::Seen;

use super::{super::shading::Shading, Walk};
use crate::{PathRay, media::Crossing, probe::Probe};

pub(super) use super::super::shading::LIGHT_BRANCH;

impl<P: Probe> Walk<'_, P> {
    /// Adds the light of all lights to `radiance`, in their order: the recorder folds them the same way.
    pub(super) fn lights(
        &mut self,
        ray: &PathRay,
        s: &Shading,
        crossing: &Crossing,
        (id, mut radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        let cx = self.cx;
        let lamps = if s.bsdf.is_sharp() { &[] } else { cx.scene.lamps.as_slice() };
        for light in lamps.iter().map(|&light| light as usize) {
            let sampler = ray.sampler.fork(LIGHT_BRANCH + light as u32);
            for part in 0..self.rules.shadow_rays.max(1) {
                let Some((weight, sample)) =
                    s.light(cx, light, &self.part(sampler, part), |pdf| self.seen(pdf))
                else {
                    if P::ACTIVE {
                        self.report_dark(ray, (s, crossing), (light, part), &self.part(sampler, part), id);
                    }
                    continue;
                };
                if P::RECORDS {
                    self.report_light(s, &self.part(sampler, part), &sample);
                }
                if sample.pdf.is_none() {
                    // There is but one way to a light without extent.
                    radiance += weight * self.shadow(ray, (s, crossing), light, weight, &sample, id);
                    break;
                }
                let weight = weight / self.rules.shadow_rays.max(1) as f32;
                radiance += weight * self.shadow(ray, (s, crossing), light, weight, &sample, id);
            }
        }
        radiance
    }

    /// The numbers of one of the shadow rays to a light.
    fn part(&self, sampler: Sampler, part: u32) -> Sampler {
        match self.rules.shadow_rays {
            0 => Sampler::middle(),
            rays => sampler.split(part, rays),
        }
    }

    /// How rays that follow a hit will meet a light that is sampled with the density `pdf`.
    pub(super) fn seen(&self, pdf: f32) -> Seen {
        match self.rules.gloss_rays {
            None => Seen::Branches,
            Some(rays) => Seen::Draws { pdf: self.light_density(pdf), rays: rays.get() as f32 },
        }
    }

    /// Density of all shadow rays to a light together; 0 if they all go to its middle and leave no other to be found.
    pub(super) fn light_density(&self, pdf: f32) -> f32 {
        pdf * self.rules.shadow_rays as f32
    }

    /// What a light that was hit sends along the ray, by the share that sampling the light leaves to the ray.
    pub(super) fn lamp(&self, ray: &PathRay, s: &Shading) -> Spectrum {
        let Some(lamp) = &s.lamp else { return Spectrum::BLACK };
        let share = ray.density.map_or(1.0, |density| {
            let sampled = self.light_density(s.lamp_pdf(self.cx, lamp, ray.from));
            density / (density + sampled)
        });
        lamp.radiance * share
    }
}
