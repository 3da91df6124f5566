//! What the recursion tells those who record it beyond rays, hits and sums. None of this runs otherwise, and nothing here
//! changes what is traced.
use durer_core::{
    math::{Point2, Vector3},
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::{Bsdf, Drawn, Seen},
    light::LightSample,
};

use super::{
    super::shading::Shading,
    Lights, MOST_PASSED, Walk,
    lights::{Aim, Extent},
};
use crate::{
    Below, PathRay,
    media::Crossing,
    probe::{Choice, ChosenBy, LightEvent, Limit, Probe, RandomNumbers, RayKind, Shaded, StopReason},
};

/// What of a hit's radiance comes from no other ray, and what is left of it on the way.
pub(in super::super) struct Parts {
    pub(in super::super) arrived: Spectrum,
    pub(in super::super) emission: Spectrum,
    pub(in super::super) ambient: Spectrum,
    pub(in super::super) blurred_sky: Spectrum,
}

impl<P: Probe> Walk<'_, P> {
    /// The surface as it scatters, and whether sampling lights could have found the one that was hit.
    pub(super) fn report_hit(
        &mut self,
        ray: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        parts: &Parts,
        id: P::Id,
    ) {
        self.report_shaded(ray, (s, crossing), parts, id);
        if let (Some(lamp), Some(density)) = (&s.lamp, ray.density) {
            let sampled = self.lamp_density(ray, s, lamp);
            self.probe.met_light(id, sampled, density / (density + sampled));
        }
    }

    /// The surface as it scatters.
    pub(in super::super) fn report_shaded(
        &mut self,
        ray: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        parts: &Parts,
        id: P::Id,
    ) {
        self.probe.shaded(
            id,
            &Shaded {
                wo: s.wo_local,
                bsdf: &s.bsdf,
                before: ray.media,
                after: crossing.behind,
                arrived: parts.arrived,
                emission: parts.emission,
                ambient: parts.ambient,
                blurred_sky: parts.blurred_sky,
            },
        );
    }

    /// A surface that is not there for the ray: what it is in changes, though not what fills the place.
    pub(in super::super) fn report_passed(
        &mut self,
        ray: &PathRay,
        crossing: &Crossing,
        arrived: Spectrum,
        id: P::Id,
    ) {
        let nothing = Bsdf::default();
        self.probe.shaded(
            id,
            &Shaded {
                wo: Vector3::new(0.0, 0.0, 1.0),
                bsdf: &nothing,
                before: ray.media,
                after: crossing.behind,
                arrived,
                emission: Spectrum::BLACK,
                ambient: Spectrum::BLACK,
                blurred_sky: Spectrum::BLACK,
            },
        );
    }

    /// The bound that ended a ray.
    pub(in super::super) fn report_limit(&mut self, ray: &PathRay, reason: StopReason, id: P::Id) {
        let rules = self.rules;
        let limit = match reason {
            StopReason::DepthLimit if ray.depth > rules.max_depth => {
                Limit { value: ray.depth as f32, threshold: rules.max_depth as f32 }
            }
            StopReason::DepthLimit if ray.below.is_some_and(|b| b.rays > Below::MOST_RAYS) => {
                let value = ray.below.map_or(0.0, |below| below.rays as f32);
                Limit { value, threshold: Below::MOST_RAYS as f32 }
            }
            StopReason::DepthLimit => Limit { value: ray.passed as f32, threshold: MOST_PASSED as f32 },
            StopReason::ContributionBelowCutoff => {
                Limit { value: ray.throughput.max() * ray.siblings, threshold: rules.min_contribution }
            }
            _ => return,
        };
        self.probe.limit(id, limit);
    }

    /// How the weight of the shadow ray comes about that is announced next. `sampler` gave the light its numbers.
    pub(super) fn report_light(&mut self, s: &Shading, sampler: &Sampler, sample: &LightSample, aim: &Aim) {
        let chance = aim.chance;
        let wi = s.frame.to_local(sample.wi);
        let f = s.bsdf.eval(s.wo_local, wi);
        let mut choice = Choice {
            by: ChosenBy::Light,
            chance,
            kept: 1.0,
            light_choice: aim.u.map(|u| RandomNumbers::one(Dim::LightChoice, u)),
            lobe: None,
            f: Some(f),
            cos: Some(wi.z.abs()),
            pdf: sample.pdf,
            other_pdf: None,
            mis: None,
            rays: self.share(sample).1 as u32,
            random: None,
        };
        if let Some(pdf) = sample.pdf {
            let u = sampler.d2(Dim::Light);
            choice.random = Some(RandomNumbers::two(Dim::Light, [u.x, u.y]));
            let seen = self.seen(pdf * chance);
            let counted = s.bsdf.eval_shared(s.wo_local, wi, seen);
            let mis = if f.mean() > 0.0 { counted.mean() / f.mean() } else { 1.0 };
            choice.mis = Some(mis);
            if mis > 0.0 {
                choice.f = Some(counted / mis);
            }
            if let Seen::Draws { .. } = seen {
                let of_lobes = s.bsdf.lobes().filter_map(|lobe| {
                    let own = lobe.pdf(s.wo_local, wi)?;
                    Some((lobe.eval(s.wo_local, wi).mean(), own))
                });
                choice.other_pdf = of_lobes.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, own)| own);
            }
        }
        self.probe.chosen(&choice);
    }

    /// A light that no shadow ray is cast to because it lies behind the surface.
    pub(super) fn report_dark(
        &mut self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        aim: &Aim,
        sampler: &Sampler,
        id: P::Id,
    ) {
        let Aim { light, part, chance, .. } = *aim;
        let Some(sample) = s.behind(self.cx, light, sampler) else { return };
        let (extent, rays) = self.share(&sample);
        if part > 0 && extent == Extent::None && self.rules.lights == Lights::All {
            return;
        }
        let wi = s.frame.to_local(sample.wi);
        let reason = match wi.z * s.wo_local.z > 0.0 {
            true => StopReason::BelowHorizon,
            false => StopReason::LightBehindSurface,
        };
        if P::RECORDS {
            self.report_light(s, sampler, &sample, aim);
        }
        let weight = s.bsdf.eval(s.wo_local, wi) * (wi.z.abs() / (rays * chance));
        let weight = if weight.is_finite() { weight } else { Spectrum::BLACK };
        let path = self.shadow_path(parent, (s, crossing), light, weight, &sample);
        let shadow = self.probe.ray(id, &path, RayKind::Shadow);
        let event = LightEvent {
            light: light as u32,
            point: sample.point,
            unoccluded: sample.weight,
            passed: Spectrum::BLACK,
            visible: false,
            blocker: None,
        };
        self.probe.light(shadow, &event);
        self.probe.stop(shadow, reason, path.throughput);
        self.probe.result(shadow, Spectrum::BLACK);
    }

    /// Which lobe the `number`-th sharp direction belongs to, whose ray is announced next.
    pub(super) fn report_branch(&mut self, s: &Shading, number: u32) {
        let lobe = match self.rules.gloss_rays {
            None => s.bsdf.lobe_of_branch(s.wo_local, number as usize),
            Some(_) => s.bsdf.lobe_of_sharp(s.wo_local, number as usize),
        };
        self.probe.chosen(&Choice { lobe, ..Choice::sharp() });
    }

    /// How the weight of the `number`-th drawn ray comes about, which is announced next. `u` are the numbers of the lobes.
    pub(super) fn report_draw(
        &mut self,
        s: &Shading,
        u: impl Fn(u32) -> Point2,
        (number, drawn): (u32, &Drawn),
        rays: u32,
    ) {
        let lobe = s.bsdf.lobe_of_draw(s.wo_local, &u, number as usize);
        let numbers = lobe.map(|(index, _)| u(index));
        let cos = drawn.branch.wi.z.abs();
        self.probe.chosen(&Choice {
            by: ChosenBy::Lobe,
            lobe: lobe.map(|(_, lobe)| lobe.name()),
            f: (cos > 0.0).then(|| drawn.branch.weight * (drawn.pdf / cos)),
            cos: Some(cos),
            pdf: Some(drawn.pdf),
            rays,
            random: numbers.map(|u| RandomNumbers::two(Dim::Scatter, [u.x, u.y])),
            ..Choice::sharp()
        });
    }

    /// Draws that microfacets send to the wrong side of the surface.
    pub(super) fn report_lost_draws(
        &mut self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        u: impl Fn(u32) -> Point2,
        rays: u32,
        id: P::Id,
    ) {
        for lost in s.bsdf.lost_draws(s.wo_local, &u) {
            let branch = lost.branch;
            let at = u(lost.number);
            let d = s.frame.to_world(branch.wi).normalize();
            let ray = s.surface.spawn(d, parent.ray.time);
            let weight = branch.weight / rays as f32;
            let path = PathRay {
                media: crossing.media(branch.kind),
                siblings: parent.siblings * rays as f32,
                ..parent.child((s.surface.p, ray), weight, 0)
            };
            if P::RECORDS {
                self.probe.chosen(&Choice {
                    by: ChosenBy::Lobe,
                    lobe: Some(lost.lobe),
                    cos: Some(branch.wi.z.abs()),
                    rays,
                    random: Some(RandomNumbers::two(Dim::Scatter, [at.x, at.y])),
                    ..Choice::sharp()
                });
            }
            let refused = self.probe.ray(id, &path, RayKind::drawn(branch.kind));
            self.probe.stop(refused, StopReason::BelowHorizon, path.throughput);
            self.probe.result(refused, Spectrum::BLACK);
        }
    }
}
