//! What floats on the way of a path: how far its rays get in a medium, and what particles do with light.
//!
//! `L = light sent out on the way + weight * (light of one lamp, scattered + L(next ray))`: the direction of the next ray is
//! drawn from the phase function, so that it keeps its weight. Paths that lanes would draw differently count by the mean of
//! these densities, see [`durer_model::medium::Flight`].
use durer_core::{math::Point3, sampling::Dim, spectrum::Spectrum};
use durer_model::{
    light::LightCx,
    medium::{End, Phase, Turn},
};

use super::{
    super::{
        shading::LIGHT_BRANCH,
        walk::{deflection, draws, span},
    },
    direct::{Asked, share},
    follow::{Follow, SCATTER_BRANCH, Step},
};
use crate::{
    Lit, PathRay,
    probe::{Limit, Probe, RayKind, StopReason},
};

/// A particle that a ray met.
struct Met<'a> {
    phase: &'a Phase,
    p: Point3,
    /// What its light is multiplied with.
    weight: Spectrum,
}

impl<P: Probe> Follow<'_, P> {
    /// Where a ray gets among what floats.
    pub(super) fn step_in_media(&mut self, ray: &mut PathRay, id: P::Id) -> Step {
        let walk = &mut self.walk;
        let cx = walk.cx;
        let hit = match walk.heeds_media {
            true => cx.scene.closest_boundary(cx, &ray.ray, walk.probe, id),
            false => cx.scene.closest(cx, &ray.ray, walk.probe, id),
        };
        let way = span(ray.from, &ray.ray, hit.map_or(f32::INFINITY, |hit| hit.t));
        let below = ray.below.map(|below| (below, Phase::HenyeyGreenstein(below.inside.phase)));
        let (flight, phase) = match (&below, walk.volume(&ray.media)) {
            (Some((below, phase)), _) => (below.fly(cx.scene, ray, (way, hit.as_ref()), &draws(ray)), phase),
            (None, Some(volume)) => (walk.fly(volume, ray, way), volume.phase()),
            (None, None) => {
                return match hit {
                    Some(hit) => self.shade(ray, &hit, (None, id)),
                    None => Step::end(self.escape(ray, None, id)),
                };
            }
        };
        if P::RECORDS {
            walk.report_floating(ray, &flight, id);
        }
        ray.lanes = flight.lanes;
        ray.density = ray.density.map(|density| density * flight.passed);
        match (flight.end, hit) {
            (End::Scattered(t), _) => {
                // The body absorbs what the volume in it does not.
                let left = self.walk.arriving(&ray.media, ray.from, &ray.ray, t);
                let met = Met { phase, p: ray.ray.at(t), weight: left * flight.weight };
                self.scattered(ray, (&met, flight.sent), id)
            }
            (End::Through, Some(hit)) => self.shade(ray, &hit, (Some(&flight), id)),
            (End::Through, None) => Step::end(self.escape(ray, Some(&flight), id)),
        }
    }

    fn scattered(&mut self, ray: &mut PathRay, (met, sent): (&Met<'_>, Spectrum), id: P::Id) -> Step {
        self.walk.probe.local(id, sent);
        if met.weight.is_black() {
            self.walk.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
            return Step::end(sent);
        }
        let lit = Lit { p: met.p, n: None, time: ray.ray.time };
        // From below a surface no straight ray gets out.
        let lamps = if ray.below.is_some() { Spectrum::BLACK } else { self.light_at(ray, met, &lit, id) };
        let radiance = sent + lamps;
        Step { radiance, next: self.scatter_at(ray, met, id) }
    }

    /// The light of one lamp that a particle scatters back along the ray.
    fn light_at(&mut self, ray: &PathRay, met: &Met<'_>, lit: &Lit, id: P::Id) -> Spectrum {
        if ray.depth >= self.course.rules.max_depth {
            return Spectrum::BLACK;
        }
        let scene = self.walk.cx.scene;
        let choosing = ray.sampler.fork(LIGHT_BRANCH);
        let u = || choosing.d1(Dim::LightChoice);
        let Some(chosen) = scene.choose_light(self.course.light_sampler, lit, u) else {
            return Spectrum::BLACK;
        };
        let cx = LightCx { basis: self.walk.cx.basis, time: lit.time };
        let Some(sample) = scene.lights[chosen.light].sample(&cx, lit.p, &choosing) else {
            return Spectrum::BLACK;
        };
        let (phase, turn) = (met.phase, Turn { p: met.p, from: ray.ray.d, to: sample.wi });
        let f = phase.density(&turn);
        let mis = sample.pdf.map_or(1.0, |pdf| share(pdf * chosen.chance, f));
        let scattered = met.weight * phase.tint(&cx.basis, &turn);
        let weight = scattered * (f * mis / chosen.chance);
        if weight.is_black() {
            return Spectrum::BLACK;
        }
        if P::RECORDS {
            let other_pdf = sample.pdf.map(|_| f);
            let asked = Asked { chosen, sample, wi: sample.wi, f: scattered * f, other_pdf, mis, weight };
            self.report_light(&choosing, &asked, (1.0, u()));
        }
        let child = self.walk.shadow_path_at(ray, met.p, chosen.light, weight, &sample);
        let path = PathRay { density: Some(1.0 - mis), ..child };
        weight * self.walk.send_shadow(&path, chosen.light as u32, (sample.point, sample.weight), id)
    }

    /// Puts the ray that a particle sends on in the place of the one that met it, if chance lets it.
    fn scatter_at(&mut self, parent: &mut PathRay, met: &Met<'_>, id: P::Id) -> Option<RayKind> {
        let sampler = parent.sampler.fork(SCATTER_BRANCH);
        let mut child = self.walk.deflect(parent, (met.phase, met.p), met.weight, SCATTER_BRANCH);
        child.walk_on(parent, true);
        let kept = self.kept(&child);
        let u = if kept < 1.0 { sampler.d1(Dim::Roulette) } else { 0.0 };
        if P::RECORDS {
            let kept = if u < kept { kept } else { 1.0 };
            self.walk.probe.chosen(&deflection((&sampler, met.phase.name()), &child, kept));
        }
        if u >= kept {
            if P::ACTIVE {
                self.report_roulette((&child, RayKind::Scattered), Limit { value: u, threshold: kept }, id);
            }
            return None;
        }
        child.weight = child.weight / kept;
        child.throughput = parent.throughput * child.weight;
        *parent = child;
        Some(RayKind::Scattered)
    }
}
