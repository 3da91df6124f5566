//! How a walk goes on from where it scatters.
use durer_core::{
    math::{Point3, Ray, Vector3},
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::Scattered,
    medium::{Phase, Turn},
};

use super::{
    super::{
        shading::Shading,
        walk::{Walk, deflection},
    },
    Place, SCATTER_BRANCH, Vertex,
};
use crate::{
    PathRay,
    media::Crossing,
    probe::{Choice, ChosenBy, Probe, RandomNumbers, RayKind},
};

/// The next ray of a walk.
pub(in super::super) struct Onward {
    pub(in super::super) child: PathRay,
    /// How it was scattered.
    pub(in super::super) kind: RayKind,
    /// Unit direction that was drawn.
    d: Vector3,
    /// Its density, 1/sr, if it was not the only one.
    pdf: Option<f32>,
    /// How it came about, if anybody wants to know.
    pub(in super::super) told: Option<Choice>,
}

impl Onward {
    /// In a direction that a surface scatters in, with the share that is left of the ray before any index of refraction or
    /// normal counts; whether it keeps to its side of the true surface if it is not sharp, too.
    pub(in super::super) fn of<P: Probe>(
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        (scattered, weight, keeps_side): (&Scattered, Spectrum, bool),
        sampler: &Sampler,
    ) -> Self {
        let d = s.frame.to_world(scattered.wi);
        let kind = match scattered.pdf {
            None => RayKind::sharp(scattered.kind),
            Some(_) => RayKind::drawn(scattered.kind),
        };
        let told = P::RECORDS.then(|| chosen(s, scattered, (sampler, s.pdf(d, s.wo))));
        let child = scattered_on(parent, (s, crossing), scattered, (weight, keeps_side));
        Self { child, kind, d, pdf: scattered.pdf, told }
    }
    /// The same of a particle of light, which `phase` scattered as `parent` came.
    pub(super) fn skewed(mut self, parent: &PathRay, phase: &Phase) -> Self {
        let skew = phase.skew(&Turn { p: self.child.ray.o, from: parent.ray.d, to: self.d });
        self.child.weight = self.child.weight * skew;
        self.child.throughput = self.child.throughput * skew;
        if let Some(f) = self.told.as_mut().and_then(|told| told.f.as_mut()) {
            *f = *f * skew;
        }
        self
    }
    /// Whether it brings anything that is a number.
    pub(super) fn brings_something(&self) -> bool {
        !self.child.weight.is_black() && self.child.weight.is_finite()
    }
}

impl<'a> Vertex<'a> {
    /// Notes how the walk goes on: densities of the direction and of the way back from there, see
    /// [`Vertex::there_and_back`].
    pub(in super::super) fn go_on(&mut self, onward: &Onward) -> [f32; 2] {
        self.is_sharp = onward.pdf.is_none();
        self.there_and_back(onward.pdf, onward.d)
    }
}

impl<'a, P: Probe> Walk<'a, P> {
    /// A particle that a ray met at parameter `t`, where `weight` is left and scattered, and the ray that it sends on.
    pub(in super::super) fn deflected(
        &self,
        parent: &PathRay,
        (phase, t): (&'a Phase, f32),
        weight: Spectrum,
    ) -> (Vertex<'a>, Onward) {
        let p = parent.ray.at(t);
        let onward = self.onward(parent, (phase, p), weight);
        (Vertex::new(Place::Particle(phase), p, weight, *parent), onward)
    }

    /// The ray that a particle at `p` sends on, where `weight` is left and scattered.
    pub(super) fn onward(&self, parent: &PathRay, (phase, p): (&Phase, Point3), weight: Spectrum) -> Onward {
        let child = self.deflect(parent, (phase, p), weight, SCATTER_BRANCH);
        let told = P::RECORDS.then(|| deflection((&child.sampler, phase.name()), &child, 1.0));
        Onward { d: child.ray.d, pdf: child.density, child, kind: RayKind::Scattered, told }
    }
}

/// The ray in a scattered direction.
fn scattered_on(
    parent: &PathRay,
    (s, crossing): (&Shading, &Crossing),
    scattered: &Scattered,
    (weight, keeps_side): (Spectrum, bool),
) -> PathRay {
    let d = s.frame.to_world(scattered.wi);
    let d = if scattered.pdf.is_none() || keeps_side { s.keep_side(d, scattered.kind) } else { d };
    let ray: Ray = s.surface.spawn(d.normalize(), parent.ray.time);
    PathRay {
        media: crossing.media(scattered.kind),
        density: scattered.pdf,
        compression: parent.compression * scattered.compression,
        ..parent.child((s.surface.p, ray), weight, SCATTER_BRANCH)
    }
}

/// How the direction came about that a walk goes on in; `other` is the density of the way back.
pub(in super::super) fn chosen(
    s: &Shading,
    scattered: &Scattered,
    (sampler, other): (&Sampler, f32),
) -> Choice {
    let cos = scattered.wi.z.abs();
    let u = sampler.d2(Dim::Scatter);
    let spread = scattered.pdf.is_some();
    Choice {
        by: if spread { ChosenBy::Lobe } else { ChosenBy::Sharp },
        lobe: s.bsdf.lobes().nth(scattered.lobe).map(|lobe| lobe.name()),
        f: scattered.pdf.filter(|_| cos > 0.0).map(|pdf| scattered.weight * (pdf / cos)),
        cos: spread.then_some(cos),
        pdf: scattered.pdf,
        other_pdf: spread.then_some(other),
        chance: if spread { 1.0 } else { scattered.chance },
        random: spread.then(|| RandomNumbers::two(Dim::Scatter, u.to_array())),
        ..Choice::sharp()
    }
}
