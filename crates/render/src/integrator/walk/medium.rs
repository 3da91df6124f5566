//! The bodies along the way: where a ray is behind a surface, and what is absorbed before it.
use durer_core::{
    math::{Point3, Ray},
    spectrum::Spectrum,
};

use durer_model::{Medium, Volume};

use super::{super::shading::Shading, Walk};
use crate::{
    MediumStack,
    media::{Crossing, Imbalance},
    probe::Probe,
};

impl<P: Probe> Walk<'_, P> {
    /// Where a ray that met `s` after `t` metres is if it goes through, and whether one wavelength goes on alone.
    pub(in super::super) fn cross(&mut self, before: &MediumStack, s: &mut Shading, t: f32) -> Crossing {
        let mut crossing = self.cross_bodies(before, s, t);
        crossing.disperses |= s.bsdf.is_led();
        crossing
    }

    /// The same of the bodies behind surfaces alone; counts what is wrong with the ray's account.
    fn cross_bodies(&mut self, before: &MediumStack, s: &mut Shading, t: f32) -> Crossing {
        let scene = self.cx.scene;
        let concern = if self.heeds_media { !scene.media.is_empty() } else { scene.media.has_bodies() };
        if !concern {
            return Crossing::nothing(before);
        }
        let imbalances = &mut self.imbalances;
        let complain = |object, imbalance| match imbalance {
            Imbalance::LeftUnentered if scene.is_body(object) => imbalances.add(object),
            // What floats on both sides of others is known.
            Imbalance::LeftUnentered => {}
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
        match self.absorbing(bodies) {
            Some(medium) => medium.transmittance(&self.cx.basis, way(from, ray, t)),
            None => Spectrum::ONE,
        }
    }

    /// What the body that a ray is in absorbs, 1/m.
    pub(in super::super) fn absorption(&self, bodies: &MediumStack) -> Spectrum {
        self.absorbing(bodies).map_or(Spectrum::BLACK, |body| self.cx.basis.unbounded(body.absorption))
    }

    fn absorbing(&self, bodies: &MediumStack) -> Option<&Medium> {
        if bodies.is_empty() {
            return None;
        }
        let media = &self.cx.scene.media;
        let present = bodies.present(media, &self.cx.basis).medium.map(|id| media.get(id));
        present.filter(|medium| medium.absorbs())
    }
}

impl<'a, P: Probe> Walk<'a, P> {
    /// What floats where a ray in these bodies is; `None` if that is nothing, or does not concern this integrator.
    pub(in super::super) fn volume(&self, bodies: &MediumStack) -> Option<&'a Volume> {
        let scene = self.cx.scene;
        let fill = bodies.present(&scene.media, &self.cx.basis).fill;
        scene.volume_of(fill).filter(|_| self.heeds_media)
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

/// The part of a ray of unit direction from the surface point `from` to its parameter `t`, by parameters.
pub(in super::super) fn span(from: Point3, ray: &Ray, t: f32) -> (f32, f32) {
    ((from - ray.o).dot(ray.d), t)
}
