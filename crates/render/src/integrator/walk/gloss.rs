//! Rays about a main direction instead of a single one: gloss and translucency (Cook, Porter and Carpenter 1984).
use durer_core::{sampling::Dim, spectrum::Spectrum};

use super::{super::shading::Shading, Walk};
use crate::{
    PathRay,
    media::Crossing,
    probe::{Probe, RayKind},
};

/// Drawn rays use sampler branches from here on; sharp directions use those below, shadow rays those above.
const GLOSS_BRANCH: u32 = 1 << 15;

impl<P: Probe> Walk<'_, P> {
    /// Adds `rays` drawn rays for each lobe that spreads to `radiance`, each with its share of the lobe.
    pub(super) fn gloss(
        &mut self,
        parent: &PathRay,
        s: &Shading,
        crossing: &Crossing,
        rays: u32,
        (id, mut radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        // All rays of the pixel's samples together are spread evenly over each lobe.
        let samplers =
            |part: u32| move |lobe: u32| parent.sampler.fork(GLOSS_BRANCH + lobe).split(part, rays);
        for part in 0..rays {
            let sampler_of = samplers(part);
            let draws = s.bsdf.draws(s.wo_local, |lobe| sampler_of(lobe).d2(Dim::Scatter));
            for (number, drawn) in (0..).zip(draws.iter()) {
                let branch = drawn.branch;
                let kind = RayKind::drawn(branch.kind);
                let d = s.keep_side(s.frame.to_world(branch.wi), branch.kind).normalize();
                let ray = s.surface.spawn(d, parent.ray.time);
                let child = PathRay {
                    media: crossing.media(branch.kind),
                    sampler: sampler_of(Self::AFTER_LOBES + number),
                    density: Some(drawn.pdf * rays as f32),
                    siblings: parent.siblings * rays as f32,
                    ..parent.child((s.surface.p, ray), branch.weight / rays as f32, 0)
                };
                if P::RECORDS {
                    let u = |lobe: u32| sampler_of(lobe).d2(Dim::Scatter);
                    self.report_draw(s, u, (number, drawn), rays);
                }
                radiance += child.weight * self.trace(&child, kind, id);
            }
            if P::ACTIVE {
                let u = |lobe: u32| sampler_of(lobe).d2(Dim::Scatter);
                self.report_lost_draws(parent, (s, crossing), u, rays, id);
            }
        }
        radiance
    }

    /// Sampler branches of the rays themselves follow those of the lobes that they were drawn from.
    const AFTER_LOBES: u32 = 64;
}
