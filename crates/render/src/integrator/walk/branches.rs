//! The rays that follow a hit: mirrored and refracted.
use durer_core::spectrum::Spectrum;

use super::{super::shading::Shading, Walk};
use crate::{
    PathRay,
    media::Crossing,
    probe::{Probe, RayKind, StopReason},
};

impl<P: Probe> Walk<'_, P> {
    /// Adds mirrored and refracted rays to `radiance`, in this order: the recorder folds them the same way.
    pub(super) fn branches(
        &mut self,
        parent: &PathRay,
        s: &Shading,
        crossing: &Crossing,
        (id, mut radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        // PERF: most surfaces are matte (bench render).
        if !s.bsdf.is_followed() {
            self.end(s, id);
            return radiance;
        }
        let (branches, follows) = match self.rules.gloss_rays {
            None => (s.bsdf.branches(s.wo_local), false),
            Some(_) => (s.bsdf.sharp(s.wo_local), s.bsdf.spreads()),
        };
        let mut count = 0;
        for branch in branches.iter() {
            let kind = RayKind::sharp(branch.kind);
            let d = s.keep_side(s.frame.to_world(branch.wi), branch.kind).normalize();
            let ray = s.surface.spawn(d, parent.ray.time);
            let mut child = parent.child((s.surface.p, ray), branch.weight, count);
            child.media = crossing.media(branch.kind);
            if P::RECORDS {
                self.report_branch(s, count);
            }
            radiance += branch.weight * self.trace(&child, kind, id);
            count += 1;
        }
        if let Some(weight) = branches.total_internal_reflection {
            let child = parent.child((parent.from, parent.ray), weight, count);
            let refused = self.probe.ray(id, &child, RayKind::Refraction);
            self.probe.stop(refused, StopReason::TirNoRefraction, child.throughput);
            self.probe.result(refused, Spectrum::BLACK);
        } else if count == 0 && !follows {
            self.end(s, id);
        }
        radiance
    }

    /// No ray follows.
    fn end(&mut self, s: &Shading, id: P::Id) {
        let absorbs = P::ACTIVE && s.bsdf.is_black();
        let reason = if absorbs { StopReason::Absorbed } else { StopReason::OpaqueNoChildren };
        self.probe.stop(id, reason, Spectrum::BLACK);
    }
}
