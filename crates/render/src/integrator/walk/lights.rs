//! Direct light: shadow rays to each light, or to one of them.
use durer_core::{
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{bsdf::Seen, light::LightSample};

use super::{
    super::shading::{Lamp, Shading},
    Lights, Walk,
};
use crate::{PathRay, media::Crossing, probe::Probe};

pub(super) use super::super::shading::LIGHT_BRANCH;

/// Where a shadow ray goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    pub(super) light: usize,
    /// Which of the rays.
    pub(super) part: u32,
    /// The probability that it was this light.
    pub(super) chance: f32,
    /// The number that chose it.
    pub(super) u: Option<f32>,
}

/// Whether a light has any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    None,
    Some,
}

impl<P: Probe> Walk<'_, P> {
    /// Adds the light of all lights to `radiance`, in their order: the recorder folds them the same way.
    pub(super) fn lights(
        &mut self,
        ray: &PathRay,
        s: &Shading,
        crossing: &Crossing,
        (id, mut radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        if s.bsdf.is_sharp() {
            return radiance;
        }
        let scene = self.cx.scene;
        let rays = self.rules.shadow_rays.max(1);
        match self.rules.lights {
            Lights::All => {
                for light in scene.lamps.iter().map(|&light| light as usize) {
                    for part in 0..rays {
                        let aim = Aim { light, part, chance: 1.0, u: None };
                        let (added, extent) = self.aim(ray, (s, crossing), &aim, id);
                        radiance += added;
                        if extent == Extent::None {
                            break;
                        }
                    }
                }
            }
            Lights::One => {
                let sampler = ray.sampler.fork(LIGHT_BRANCH);
                for part in 0..rays {
                    let u = sampler.split(part, rays).d1(Dim::LightChoice);
                    let chosen = scene.choose_lamp(s.surface.p, ray.ray.time, u);
                    let Some((light, chance)) = chosen else { break };
                    radiance += self.aim(ray, (s, crossing), &Aim { light, part, chance, u: Some(u) }, id).0;
                }
            }
        }
        radiance
    }

    /// What a shadow ray to a light adds.
    fn aim(
        &mut self,
        ray: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        aim: &Aim,
        id: P::Id,
    ) -> (Spectrum, Extent) {
        let Aim { light, part, chance, .. } = *aim;
        let sampler = self.part(ray.sampler.fork(LIGHT_BRANCH + light as u32), part);
        let Some((weight, sample)) = s.light(self.cx, light, &sampler, |pdf| self.seen(pdf * chance)) else {
            if P::ACTIVE {
                self.report_dark(ray, (s, crossing), aim, &sampler, id);
            }
            return (Spectrum::BLACK, Extent::Some);
        };
        if P::RECORDS {
            self.report_light(s, &sampler, &sample, aim);
        }
        let (extent, rays) = self.share(&sample);
        let weight = weight / (rays * chance);
        (weight * self.shadow(ray, (s, crossing), light, weight, &sample, id), extent)
    }

    /// Whether a light has extent, and how many shadow rays share its light.
    pub(super) fn share(&self, sample: &LightSample) -> (Extent, f32) {
        let rays = self.rules.shadow_rays.max(1) as f32;
        match (sample.pdf, self.rules.lights) {
            // There is but one way to a light without extent.
            (None, Lights::All) => (Extent::None, 1.0),
            (None, Lights::One) => (Extent::None, rays),
            (Some(_), _) => (Extent::Some, rays),
        }
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
        let share = ray.density.map_or(1.0, |density| density / (density + self.lamp_density(ray, s, lamp)));
        lamp.radiance * share
    }

    /// Density with which the shadow rays of the point that a ray came from would have gone the way that met a light.
    pub(super) fn lamp_density(&self, ray: &PathRay, s: &Shading, lamp: &Lamp) -> f32 {
        let chance = match self.rules.lights {
            Lights::All => 1.0,
            Lights::One => self.cx.scene.lamp_chance(lamp.light as usize, ray.lit.p, ray.ray.time),
        };
        self.light_density(s.lamp_pdf(self.cx, lamp, ray.lit.p) * chance)
    }
}
