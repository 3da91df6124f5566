//! How a particle begins: at a light, or in a medium that glows.
//!
//! What glows is a light with a volume ([`Glowing`](durer_model::medium::Glowing)): a place is drawn by about what it sends out,
//! the direction evenly. A place that turns out not to be in the medium sends nothing.
use durer_core::{math::Ray, sampling::Dim};
use durer_model::{
    Fill,
    light::{Emitted, LightCx, Source},
};

use super::{super::walk::Walk, EMISSION_BRANCH, End, Flight, LENS_BRANCH, Particle, Stamina};
use crate::{
    PathRay,
    emitters::Emitter,
    media,
    probe::{Choice, ChosenBy, Probe, RandomNumbers},
};

/// A particle that sets out.
pub(super) struct Begun<'a> {
    /// It, without a vertex.
    pub(super) particle: Particle<'a>,
    /// Its first ray.
    pub(super) ray: PathRay,
    /// How that was chosen.
    pub(super) flight: Flight,
    /// The same, for those who want to know.
    pub(super) told: Choice,
}

impl<'a, P: Probe> Walk<'a, P> {
    /// Begins a particle at the moment of an eye ray, by numbers of its sample. `None` if nothing sends any, or what was chosen
    /// is black.
    pub(super) fn begin(&self, eye: &PathRay, stamina: Stamina) -> Option<Begun<'a>> {
        let scene = self.cx.scene;
        let sampler = eye.sampler.apart(EMISSION_BRANCH);
        let (emitter, chance) = scene.choose_emitter(self.heeds_media, || sampler.d1(Dim::LightChoice))?;
        let time = eye.ray.time;
        let u = [sampler.d2(Dim::Light), sampler.d2(Dim::Scatter)];
        let (begun, light) = match emitter {
            Emitter::Light(light) => {
                let asked = LightCx { basis: self.cx.basis, time };
                (scene.lights[light].emit(&asked, &scene.extent, u)?, light)
            }
            Emitter::Glow(volume) => {
                let u = [u[0], sampler.d2(Dim::Medium), u[1]];
                (scene.glowing(volume)?.emit(&scene.volumes[volume], self.cx.basis, u)?, volume)
            }
        };
        let (own, flight) = match begun.source {
            Source::Point | Source::Surface(_) | Source::Glow(_) => {
                (begun.pdf_place, Flight::Direction(begun.pdf_direction))
            }
            Source::Parallel | Source::Far => (begun.pdf_direction, Flight::Place(begun.pdf_place)),
        };
        let p = match begun.source {
            Source::Surface(hit) => hit.p,
            _ => begun.p,
        };
        let end = End { light, source: begun.source, p };
        let ray = self.first_ray(eye, &begun, (time, chance), &end)?;
        let told = Choice {
            by: ChosenBy::Light,
            chance,
            pdf: Some(begun.pdf_direction),
            random: Some(RandomNumbers::two(Dim::Scatter, u[1].to_array())),
            ..Choice::sharp()
        };
        let particle = Particle { end, own: own * chance, other: 0.0, vertices: stamina.room(), length: 0 };
        Some(Begun { particle, ray, flight, told })
    }

    /// The first ray; `None` if nothing comes so far of light from far away, and from a place that is not in the medium.
    fn first_ray(
        &self,
        eye: &PathRay,
        begun: &Emitted,
        (time, chance): (f32, f32),
        end: &End,
    ) -> Option<PathRay> {
        let ray = Ray { time, ..Ray::new(begun.p, begun.d) };
        let is_far = matches!(begun.source, Source::Parallel | Source::Far);
        let media = match is_far {
            _ if self.heeds_media => media::at(self.cx.scene, begun.p, time),
            false => media::around(self.cx.scene, &ray),
            true => Default::default(),
        };
        if let Source::Glow(_) = begun.source
            && media.fill(&self.cx.scene.media) != Fill::Volume(end.light as u32)
        {
            return None;
        }
        let sampler = eye.sampler.apart(EMISSION_BRANCH);
        // Not the first depth: that is for what is seen directly.
        let first = PathRay { media, depth: 1, ..PathRay::eye(ray, sampler) };
        let mut power = begun.power() / chance;
        if is_far && let Some(volume) = self.volume(&media) {
            let back = PathRay { ray: Ray { d: -ray.d, ..ray }, sampler: sampler.fork(LENS_BRANCH), ..first };
            power *= self.see(volume, &back, (0.0, f32::INFINITY)).weight;
        }
        (!is_far || !power.is_black()).then_some(PathRay { weight: power, throughput: power, ..first })
    }
}
