//! What a path tells those who record it beyond rays, hits and sums. None of this runs otherwise, and nothing here changes
//! what is traced.
use durer_core::{
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::bsdf::Scattered;

use super::{
    super::{shading::Shading, walk::Parts},
    direct::{Asked, share},
    follow::Follow,
};
use crate::{
    PathRay,
    media::Crossing,
    probe::{Choice, ChosenBy, LightEvent, Limit, Probe, RandomNumbers, RayKind, StopReason},
};

impl<P: Probe> Follow<'_, P> {
    /// The surface as it scatters, and whether sampling lights could have found the one that was hit.
    pub(super) fn report_hit(
        &mut self,
        ray: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        parts: &Parts,
        id: P::Id,
    ) {
        self.walk.report_shaded(ray, (s, crossing), parts, id);
        if let (Some(lamp), Some(density)) = (&s.lamp, ray.density) {
            let sampled = self.lamp_density(ray, s, lamp);
            self.walk.probe.met_light(id, sampled, share(density, sampled));
        }
    }

    /// How the weight of the shadow ray comes about that is announced next.
    pub(super) fn report_light(&mut self, sampler: &Sampler, asked: &Asked, (cos, u): (f32, f32)) {
        let extended = asked.sample.pdf.is_some();
        let point = sampler.d2(Dim::Light);
        self.walk.probe.chosen(&Choice {
            by: ChosenBy::Light,
            chance: asked.chosen.chance,
            light_choice: Some(RandomNumbers::one(Dim::LightChoice, u)),
            f: Some(asked.f),
            cos: Some(cos),
            pdf: asked.sample.pdf,
            other_pdf: asked.other_pdf,
            mis: extended.then_some(asked.mis),
            random: extended.then(|| RandomNumbers::two(Dim::Light, [point.x, point.y])),
            ..Choice::sharp()
        });
    }

    /// A light that no shadow ray is cast to because nothing of it would be reflected.
    pub(super) fn report_dark(
        &mut self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        asked: &Asked,
        u: f32,
        id: P::Id,
    ) {
        let Asked { chosen, sample, .. } = asked;
        if P::RECORDS {
            let choosing = parent.sampler.fork(super::super::shading::LIGHT_BRANCH);
            self.report_light(&choosing, asked, (asked.wi.z.abs(), u));
        }
        let reason = match asked.wi.z * s.wo_local.z > 0.0 {
            true => StopReason::BelowHorizon,
            false => StopReason::LightBehindSurface,
        };
        let weight = if asked.weight.is_finite() { asked.weight } else { Spectrum::BLACK };
        let path = self.walk.shadow_path(parent, (s, crossing), chosen.light, weight, sample);
        let shadow = self.walk.probe.ray(id, &path, RayKind::Shadow);
        let event = LightEvent {
            light: chosen.light as u32,
            point: sample.point,
            unoccluded: sample.weight,
            passed: Spectrum::BLACK,
            visible: false,
            blocker: None,
        };
        self.walk.probe.light(shadow, &event);
        self.walk.probe.stop(shadow, reason, path.throughput);
        self.walk.probe.result(shadow, Spectrum::BLACK);
    }

    /// How the weight of the scattered ray comes about that is announced next, which lives with probability `kept`.
    pub(super) fn report_scatter(
        &mut self,
        sampler: &Sampler,
        (s, scattered): (&Shading, &Scattered),
        kept: f32,
    ) {
        let cos = scattered.wi.z.abs();
        let lobe = s.bsdf.lobes().nth(scattered.lobe).map(|lobe| lobe.name());
        let u = sampler.d2(Dim::Scatter);
        let spread = scattered.pdf.is_some();
        self.walk.probe.chosen(&Choice {
            by: if spread { ChosenBy::Lobe } else { ChosenBy::Sharp },
            lobe,
            f: scattered.pdf.filter(|_| cos > 0.0).map(|pdf| scattered.weight * (pdf / cos)),
            cos: spread.then_some(cos),
            pdf: scattered.pdf,
            chance: if spread { 1.0 } else { scattered.chance },
            kept,
            random: spread.then(|| RandomNumbers::two(Dim::Scatter, [u.x, u.y])),
            ..Choice::sharp()
        });
    }

    /// A ray that chance ended. Nothing is lost: those that live carry as much more.
    pub(super) fn report_roulette(&mut self, (ray, kind): (&PathRay, RayKind), limit: Limit, id: P::Id) {
        let refused = self.walk.probe.ray(id, ray, kind);
        self.walk.probe.limit(refused, limit);
        self.walk.probe.stop(refused, StopReason::Roulette, Spectrum::BLACK);
        self.walk.probe.result(refused, Spectrum::BLACK);
    }
}
