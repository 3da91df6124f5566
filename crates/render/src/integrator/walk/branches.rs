//! The rays that follow a hit: mirrored and refracted.
use durer_core::spectrum::Spectrum;
use durer_model::bsdf::BranchKind;

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
        let branches = s.bsdf.branches(s.wo_local);
        let mut count = 0;
        for branch in branches.iter() {
            let (kind, media) = match branch.kind {
                BranchKind::Reflection => (RayKind::Reflection, parent.media),
                BranchKind::Transmission => (RayKind::Refraction, crossing.behind),
            };
            let d = s.keep_side(s.frame.to_world(branch.wi), branch.kind).normalize();
            let ray = s.surface.spawn(d, parent.ray.time);
            let child = PathRay { media, ..parent.child(ray, branch.weight, count) };
            radiance += branch.weight * self.trace(&child, kind, id);
            count += 1;
        }
        if let Some(weight) = branches.total_internal_reflection {
            let child = parent.child(parent.ray, weight, count);
            let refused = self.probe.ray(id, &child, RayKind::Refraction);
            self.probe.stop(refused, StopReason::TirNoRefraction, child.throughput);
            self.probe.result(refused, Spectrum::BLACK);
        } else if count == 0 {
            self.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
        }
        radiance
    }
}
