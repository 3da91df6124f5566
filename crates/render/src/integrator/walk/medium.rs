//! The bodies along the way: where a ray is behind a surface, and what is absorbed before it.
use durer_core::{
    math::{Point2, Point3, Ray},
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};

use durer_model::{
    Medium, Volume,
    medium::{End, Flier, Flight, Phase, Turn},
};

use super::{
    super::shading::{MEDIUM_BRANCH, Shading},
    Walk,
};
use crate::{
    Below, MediumStack, PathRay,
    media::{Crossing, Imbalance},
    probe::{Choice, ChosenBy, Floating, Particle, Probe, RandomNumbers},
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
        bodies.body(media).map(|id| media.get(id)).filter(|medium| medium.absorbs())
    }
}

impl<'a, P: Probe> Walk<'a, P> {
    /// What floats where a ray in these bodies is; `None` if that is nothing, or does not concern this integrator.
    pub(in super::super) fn volume(&self, bodies: &MediumStack) -> Option<&'a Volume> {
        let scene = self.cx.scene;
        let fill = bodies.fill(&scene.media);
        scene.volume_of(fill).filter(|_| self.heeds_media)
    }

    /// How far a ray gets in a volume on this part of its way.
    pub(in super::super) fn fly(&self, volume: &Volume, ray: &PathRay, way: (f32, f32)) -> Flight {
        let absorption = self.absorption(&ray.media);
        let flier = Flier { basis: self.cx.basis, lanes: ray.lanes, absorption };
        volume.fly(&flier, &ray.ray, way, &draws(ray))
    }

    /// What is seen through a volume, on this part of the way of a ray, of what is not scattered there.
    pub(in super::super) fn see(&self, volume: &Volume, ray: &PathRay, way: (f32, f32)) -> Flight {
        let weight = volume.pass(self.cx.basis, &ray.ray, way, &draws(ray)).share;
        let sent = if volume.is_dark() { Spectrum::BLACK } else { self.fly(volume, ray, way).sent };
        Flight { end: End::Through, weight, lanes: ray.lanes, passed: 1.0, sent }
    }

    /// The ray that a particle at `p` sends on, where `weight` is left and scattered.
    pub(in super::super) fn deflect(
        &self,
        parent: &PathRay,
        (phase, p): (&Phase, Point3),
        weight: Spectrum,
        branch: u32,
    ) -> PathRay {
        let u = parent.sampler.fork(branch).d2(Dim::Scatter);
        let from = parent.ray.d;
        let d = phase.deflected((p, from), u);
        let turn = Turn { p, from, to: d };
        let weight = weight * phase.tint(&self.cx.basis, &turn);
        let ray = Ray { time: parent.ray.time, ..Ray::new(p, d) };
        let density = Some(phase.density(&turn));
        PathRay { density, is_blurred: true, ..parent.child((p, ray), weight, branch) }
    }

    /// Tells what floats on the way of a ray, and the particle that it met.
    pub(in super::super) fn report_floating(&mut self, ray: &PathRay, flight: &Flight, id: P::Id) {
        let (scene, basis) = (self.cx.scene, self.cx.basis);
        let fill = ray.media.fill(&scene.media);
        let at = |t| {
            let p = ray.ray.at(t);
            let (sigma_a, sigma_s, g) = match (&ray.below, self.volume(&ray.media)) {
                (Some(Below { inside, .. }), _) => (inside.sigma_a, inside.sigma_s, inside.phase.g()),
                (None, Some(volume)) => {
                    let (sigma_a, sigma_s) = volume.coefficients(basis, p);
                    (sigma_a, sigma_s, volume.phase().g())
                }
                (None, None) => return None,
            };
            Some(Particle { t, p, sigma_a, sigma_s, g })
        };
        let particle = match flight.end {
            End::Scattered(t) => at(t),
            End::Through => None,
        };
        let Flight { weight, sent, passed, .. } = *flight;
        self.probe.floating(id, &Floating { fill, weight, sent, passed, particle });
    }
}

/// The random numbers of a ray's flight.
pub(in super::super) fn draws(ray: &PathRay) -> impl Fn(u32) -> Point2 + use<> {
    let sampler = ray.sampler.fork(MEDIUM_BRANCH);
    move |i| if i == 0 { sampler.d2(Dim::Medium) } else { sampler.fork(i).d2(Dim::Medium) }
}

/// How the ray came about that a particle sends on, which lives with probability `kept`.
pub(in super::super) fn deflection(
    (sampler, phase): (&Sampler, &'static str),
    child: &PathRay,
    kept: f32,
) -> Choice {
    let u = sampler.d2(Dim::Scatter);
    Choice {
        by: ChosenBy::Phase,
        lobe: Some(phase),
        f: child.density.map(|pdf| child.weight * pdf),
        cos: Some(1.0),
        pdf: child.density,
        kept,
        random: Some(RandomNumbers::two(Dim::Scatter, [u.x, u.y])),
        ..Choice::sharp()
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
