//! Light that photons brought, gathered where a path meets what is matte or rough.
//!
//! `L = sum over the photons in a disc of f(wo, wi) |wi n_s| / |wi n_g| P / (n pi r²)`: the photons' density on the true
//! surface times what scatters it. Photons of surfaces that face elsewhere are left out: those of the other wall in a corner.
use durer_core::spectrum::Spectrum;

use super::{super::shading::Shading, follow::Follow};
use crate::{
    PathRay,
    probe::{Gathered, Probe},
};

/// Least cosine between the normals of a surface and of those whose photons it gathers.
const FACING: f32 = 0.7;

impl<P: Probe> Follow<'_, P> {
    /// Whether the light that others hand on is gathered at a surface instead of being looked for by a scattered ray.
    pub(super) fn gathers(&self, ray: &PathRay, s: &Shading) -> bool {
        self.photons.is_some() && ray.depth < self.course.rules.max_depth && s.bsdf.is_broad()
    }

    /// What photons brought to a surface that scatters it along the ray.
    pub(super) fn gather(&mut self, ray: &PathRay, s: &Shading, id: P::Id) -> Spectrum {
        let Some(photons) = self.photons else { return Spectrum::BLACK };
        // With the hit here, and from light and eye together.
        let most = self.course.rules.max_depth - ray.depth - 1;
        let (mut sum, mut count) = (Spectrum::BLACK, 0);
        for photon in photons.near(s.surface.p) {
            if photon.bounces > most || photon.n.dot(s.surface.n_g) < FACING {
                continue;
            }
            count += 1;
            let f = s.bsdf.eval_with_pdf(s.wo_local, s.frame.to_local(photon.wi)).0;
            if f.is_black() {
                continue;
            }
            let tilt = (s.surface.n_s.dot(photon.wi) / s.surface.n_g.dot(photon.wi)).abs();
            // Both parts count their one wavelength for all four: once is enough.
            let twice = if ray.is_collapsed && photon.is_collapsed { 0.25 } else { 1.0 };
            sum += f * photon.power * (tilt * twice);
        }
        let radiance = sum * photons.per_area();
        if P::RECORDS {
            self.walk.probe.gathered(id, &Gathered { photons: count, radius: photons.radius(), radiance });
        }
        radiance
    }
}
