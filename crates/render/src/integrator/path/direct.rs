//! Light that comes straight: sampled from a light that is chosen, or met by a ray.
use durer_core::{math::Vector3, sampling::Dim, spectrum::Spectrum};
use durer_model::{
    light::{LightCx, LightSample},
    medium::Flight,
};

use super::{
    super::shading::{LIGHT_BRANCH, Lamp, Shading},
    follow::Follow,
};
use crate::{
    Chosen, Lit, PathRay,
    media::Crossing,
    probe::{Probe, StopReason},
};

/// The share of what two strategies can both find that is left to the one with density `own` (balance heuristic).
pub(super) fn share(own: f32, other: f32) -> f32 {
    // Both may be infinite: then neither is better.
    if own.is_finite() { own / (own + other) } else { 0.5 }
}

/// A sampled light as a surface reflects it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) chosen: Chosen,
    pub(super) sample: LightSample,
    /// Unit direction to it in the frame of the lobes.
    pub(super) wi: Vector3,
    /// Value of all lobes, 1/sr.
    pub(super) f: Spectrum,
    /// Density with which scattering finds the light as well, if it does.
    pub(super) other_pdf: Option<f32>,
    /// What of it is left to sampling the light.
    pub(super) mis: f32,
    /// What the light's sample is multiplied with.
    pub(super) weight: Spectrum,
}

impl<P: Probe> Follow<'_, P> {
    /// Adds the light of one lamp to `radiance`.
    pub(super) fn light(
        &mut self,
        ray: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        lit: &Lit,
        (id, radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        if ray.depth >= self.course.rules.max_depth || s.bsdf.is_sharp() {
            return radiance;
        }
        let scene = self.walk.cx.scene;
        let choosing = ray.sampler.fork(LIGHT_BRANCH);
        let u = || choosing.d1(Dim::LightChoice);
        let Some(chosen) = scene.choose_light(self.course.light_sampler, lit, u) else { return radiance };
        let cx = LightCx { basis: self.walk.cx.basis, time: s.time };
        let Some(sample) = scene.lights[chosen.light].sample(&cx, lit.p, &choosing) else { return radiance };
        let asked = self.asked(s, chosen, sample);
        if asked.weight.is_black() {
            if P::ACTIVE {
                self.report_dark(ray, (s, crossing), &asked, u(), id);
            }
            return radiance;
        }
        if P::RECORDS {
            self.report_light(&choosing, &asked, (asked.wi.z.abs(), u()));
        }
        let mut path = self.walk.shadow_path(ray, (s, crossing), chosen.light, asked.weight, &sample);
        if self.walks && self.is_below(&path.media) {
            return radiance;
        }
        if self.walk.heeds_media {
            path.density = Some(1.0 - asked.mis);
        }
        let arriving = (sample.point, sample.weight);
        radiance + asked.weight * self.walk.send_shadow(&path, chosen.light as u32, arriving, id)
    }

    /// What of a sampled light is reflected, by the share that is left to it.
    fn asked(&self, s: &Shading, chosen: Chosen, sample: LightSample) -> Asked {
        let wi = s.frame.to_local(sample.wi);
        let (f, other_pdf, mis) = match sample.pdf {
            None => (s.bsdf.eval_radiance(s.wo_local, wi), None, 1.0),
            Some(pdf) => {
                let (f, other) = s.bsdf.eval_with_pdf(s.wo_local, wi);
                (f, Some(other), share(pdf * chosen.chance, other))
            }
        };
        let weight = f * (wi.z.abs() * mis / chosen.chance);
        Asked { chosen, sample, wi, f, other_pdf, mis, weight }
    }

    /// What a light that was hit sends along the ray, by the share that is left to the ray.
    pub(super) fn lamp(&self, ray: &PathRay, s: &Shading) -> Spectrum {
        let Some(lamp) = &s.lamp else { return Spectrum::BLACK };
        match ray.density {
            _ if lamp.radiance.is_black() => Spectrum::BLACK,
            None => lamp.radiance,
            Some(density) => lamp.radiance * share(density, self.lamp_density(ray, s, lamp)),
        }
    }

    /// Density with which a light that was hit would have been chosen and sampled.
    pub(super) fn lamp_density(&self, ray: &PathRay, s: &Shading, lamp: &Lamp) -> f32 {
        let light = lamp.light as usize;
        let chance = self.walk.cx.scene.light_chance(self.course.light_sampler, &ray.lit, light);
        if chance == 0.0 { 0.0 } else { chance * s.lamp_pdf(self.walk.cx, lamp, ray.lit.p) }
    }

    /// What surrounds the scene sends along a ray that left it.
    pub(super) fn escape(&mut self, ray: &PathRay, flight: Option<&Flight>, id: P::Id) -> Spectrum {
        let cx = self.walk.cx;
        let asked = LightCx { basis: cx.basis, time: ray.ray.time };
        let mut sky = Spectrum::BLACK;
        let seen = if self.course.hides(ray) { &[][..] } else { &cx.scene.far[..] };
        for &light in seen {
            let own = &cx.scene.lights[light as usize];
            let radiance = own.escaped(cx.basis, ray.ray.d);
            sky += match ray.density {
                _ if radiance.is_black() => Spectrum::BLACK,
                None => radiance,
                Some(density) => {
                    let chance = cx.scene.light_chance(self.course.light_sampler, &ray.lit, light as usize);
                    let other = chance * own.pdf_escaped(&asked, ray.lit.p, ray.ray.d);
                    if P::RECORDS {
                        self.walk.probe.met_light(id, other, share(density, other));
                    }
                    radiance * share(density, other)
                }
            };
        }
        let mut sky = self.walk.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY) * sky;
        if let Some(flight) = flight {
            sky = flight.weight * sky + flight.sent;
        }
        self.walk.probe.local(id, sky);
        self.walk.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }
}
