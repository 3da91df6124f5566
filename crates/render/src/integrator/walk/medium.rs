//! The bodies along the way: where a ray is behind a surface, and what is absorbed before it.
use durer_core::spectrum::Spectrum;

use super::{super::shading::Shading, Walk};
use crate::{
    MediumStack,
    media::{Crossing, Imbalance},
    probe::Probe,
};

impl<P: Probe> Walk<'_, P> {
    /// Where a ray that met `s` is if it goes through; counts what is wrong with its account.
    pub(super) fn cross(&mut self, before: &MediumStack, s: &mut Shading) -> Crossing {
        let imbalances = &mut self.imbalances;
        let complain = |object, imbalance| match imbalance {
            Imbalance::LeftUnentered => imbalances.add(object),
            Imbalance::TooDeep => imbalances.too_deep += 1,
        };
        self.cx.scene.cross((s.object, &mut s.surface), (s.wo, s.time), before, complain)
    }

    /// The share of light that is left after `length` metres of a ray in these bodies.
    pub(super) fn arriving(&self, bodies: &MediumStack, length: f32) -> Spectrum {
        let media = &self.cx.scene.media;
        let present = bodies.present(media).medium.map(|id| media.get(id));
        match present.filter(|medium| medium.absorbs()) {
            Some(medium) => medium.transmittance(self.cx.basis, length),
            None => Spectrum::ONE,
        }
    }
}
