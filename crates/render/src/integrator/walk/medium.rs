//! The bodies along the way: where a ray is behind a surface, and what is absorbed before it.
use durer_core::{
    math::{Point3, Ray},
    spectrum::Spectrum,
};

use super::{super::shading::Shading, Walk};
use crate::{
    MediumStack,
    media::{Crossing, Imbalance},
    probe::Probe,
};

impl<P: Probe> Walk<'_, P> {
    /// Where a ray that met `s` after `t` metres is if it goes through; counts what is wrong with its account.
    pub(in super::super) fn cross(&mut self, before: &MediumStack, s: &mut Shading, t: f32) -> Crossing {
        if self.cx.scene.media.is_empty() {
            return Crossing::nothing(before);
        }
        let imbalances = &mut self.imbalances;
        let complain = |object, imbalance| match imbalance {
            Imbalance::LeftUnentered => imbalances.add(object),
            Imbalance::TooDeep => imbalances.too_deep += 1,
        };
        self.cx.scene.cross(&self.cx.basis, (s.object, &mut s.surface), (s.wo, s.time, t), before, complain)
    }

    /// The share of light that is left of a ray in these bodies on its way from the surface point `from` to its parameter
    /// `t`.
    pub(in super::super) fn arriving(
        &self,
        bodies: &MediumStack,
        from: Point3,
        ray: &Ray,
        t: f32,
    ) -> Spectrum {
        if bodies.is_empty() {
            return Spectrum::ONE;
        }
        let media = &self.cx.scene.media;
        let present = bodies.present(media, &self.cx.basis).medium.map(|id| media.get(id));
        match present.filter(|medium| medium.absorbs()) {
            Some(medium) => medium.transmittance(&self.cx.basis, way(from, ray, t)),
            None => Spectrum::ONE,
        }
    }
}

/// Metres from the surface point `from` to the parameter `t` of a ray that left it.
///
/// NUMERICS: rays start rounding errors beyond the surface that they leave. Without that way bodies are thinner than they
/// are by as much at each of their surfaces, and always (the_body_of_highest_priority_fills_every_place).
fn way(from: Point3, ray: &Ray, t: f32) -> f32 {
    let length = ray.d.length();
    (ray.o - from).dot(ray.d) / length + t * length
}
