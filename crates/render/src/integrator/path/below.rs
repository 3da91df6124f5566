//! Paths below surfaces: see [`super::super::below`].
//!
//! Lights are asked where a walk gets out, as no straight ray passes the boundary; those below the surface are met by walks
//! only.
use durer_model::{Fill, bsdf::BranchKind};

use super::{
    super::{below::descend, shading::Shading},
    follow::Follow,
};
use crate::{MediumStack, PathRay, media::Crossing, probe::Probe};

impl<P: Probe> Follow<'_, P> {
    /// Whether light walks in what fills the place.
    pub(super) fn is_below(&self, bodies: &MediumStack) -> bool {
        let cx = self.walk.cx;
        matches!(bodies.fill(&cx.scene.media), Fill::Below(_))
    }

    /// Whether light walks below a surface.
    pub(super) fn is_walked(&self, s: &Shading) -> bool {
        self.walks && self.walk.cx.scene.material(s.object).is_walked()
    }

    /// Lets light that a walk brings to the surface leave it in all directions.
    pub(super) fn leave(&self, ray: &PathRay, s: &mut Shading) {
        let is_walk = ray.below.is_some_and(|below| below.is_scattered);
        if is_walk && !s.surface.is_outside(s.wo) && self.is_walked(s) {
            s.bsdf.leave(s.wo_local);
        }
    }

    /// Makes a ray that leaves a surface on a side one of a walk, if it starts one or goes on with one.
    ///
    /// PERF: apart, as most scenes have no walks (bench render).
    #[inline(never)]
    pub(super) fn below(
        &self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        kind: BranchKind,
        child: &mut PathRay,
    ) {
        descend(self.walk.cx, parent, (s, crossing), kind, child);
    }
}
