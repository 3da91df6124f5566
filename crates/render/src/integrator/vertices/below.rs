//! Walks below surfaces as edges: what of them counts in shares, and where nothing can be joined.
//!
//! In the space of paths that includes the particles of a walk, its steps have the same densities from both ends: flights,
//! turns and ways fall out of shares. What is left are the directions `w` in which it gets in and out, by their cosines: the
//! walk comes to the other end with density `p(w) / |n w|`, or 1 where that is sharp. What is reflected below, and with
//! which chance light gets through, is left out from both ends, so that shares still sum to 1.
//!
//! Where facets are narrow, paths from the eye get in as they are refracted and out as even light does. Turned round,
//! particles get in evenly and out as they are refracted ([`Descent::Adjoint`]), but those that meet nothing below, which are
//! refracted twice: which of both a particle shall be is drawn before. Nothing is seen to leave a smooth boundary then; light
//! tracing does it as the eye does ([`Descent::Mirrored`]).
use std::f32::consts::FRAC_1_PI;

use durer_accel::Hit;
use durer_core::{
    math::Vector3,
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{
    Fill,
    bsdf::{BranchKind, Bsdf, Scattered},
    medium::{Flight as Flown, Phase},
};

use super::{
    super::{
        below::Descent,
        shading::Shading,
        walk::{Walk, draws, span},
    },
    Asked, Flight, Onward, Place, Vertex,
    particle::adjoint,
};
use crate::{Below, MediumStack, PathRay, media::Crossing, probe::Probe};

/// What of the sampler says how a particle gets below a surface.
const ENTRY_BRANCH: u32 = super::LENS_BRANCH + 1;

/// What walks below surfaces have to do with a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in super::super) struct Walked {
    /// A walk came here.
    pub(in super::super) is_walked: bool,
    /// Light gets through evenly.
    pub(in super::super) is_even: bool,
    /// The walk went on below: whatever comes after, comes not from here.
    pub(in super::super) is_glance: bool,
    /// Light walks on the side that the ray came from, and behind.
    sides: [bool; 2],
}

impl Vertex<'_> {
    /// Whether light walks on the side of direction `d`: nothing is joined there.
    pub(super) fn is_below(&self, d: Vector3) -> bool {
        match &self.place {
            Place::Surface(s, _) => self.below.sides[usize::from(s.side_of(d) == BranchKind::Transmission)],
            Place::Particle(_) => false,
        }
    }
    /// Whether a walk through the surface along `d` begins or ends there.
    pub(super) fn goes_below(&self, d: Vector3) -> bool {
        match &self.place {
            Place::Surface(s, _) => self.is_crossed(s, s.wo, d),
            Place::Particle(_) => false,
        }
    }
    /// The same from `from` to `to`.
    pub(super) fn is_crossed(&self, s: &Shading, from: Vector3, to: Vector3) -> bool {
        self.below.sides != [false; 2] && s.surface.is_outside(from) != s.surface.is_outside(to)
    }
    /// Density of going through in direction `to`, 1/sr, by what is the same for whoever comes there; the cosine of sharp ones.
    pub(super) fn crossing_pdf(&self, s: &Shading, from: Vector3, to: Vector3) -> f32 {
        if self.below.is_even {
            return self.cos(to) * FRAC_1_PI;
        }
        let pdf = s.bsdf.crossing_pdf(s.frame.to_local(from), s.frame.to_local(to));
        if pdf > 0.0 { pdf } else { self.cos(to) }
    }
    /// Density with which a walk that goes back from here, along the ray that came, by density `pdf` comes to the vertex before
    /// it.
    pub(in super::super) fn back_to(&self, before: &Vertex<'_>, pdf: f32) -> f32 {
        if self.below.is_walked { self.back_below(pdf) } else { before.by_area(pdf, self.p) }
    }
    /// The same where that is a walk below the surface.
    pub(in super::super) fn back_below(&self, pdf: f32) -> f32 {
        pdf / self.cos(self.wo())
    }
}

impl<'a, P: Probe> Walk<'a, P> {
    /// What below surfaces light walks in.
    pub(in super::super) fn walked_in(&self, bodies: &MediumStack) -> Option<u32> {
        match bodies.fill(&self.cx.scene.media) {
            Fill::Below(material) if self.descent != Descent::Flat => Some(material),
            _ => None,
        }
    }

    /// The same if particles and walks from the eye do alike there.
    pub(in super::super) fn walked_back_in(&self, bodies: &MediumStack) -> Option<u32> {
        let walks_back = |material: u32| self.cx.scene.materials[material as usize].walks_back();
        self.walked_in(bodies).filter(|&material| self.descent != Descent::Adjoint || walks_back(material))
    }

    /// The flight of a walk in these bodies, see [`Flight::below`].
    pub(in super::super) fn below(&self, flight: Flight, bodies: &MediumStack, from: (f32, Asked)) -> Flight {
        match self.walked_back_in(bodies) {
            Some(_) => flight.below(from),
            None => Flight::OF_THE_EYE,
        }
    }

    /// What walks have to do with a surface that a ray met, and may go through.
    pub(in super::super) fn walked_at(&self, ray: &PathRay, crossing: &Crossing) -> Walked {
        if self.descent == Descent::Flat {
            return Walked::default();
        }
        let sides = [BranchKind::Reflection, BranchKind::Transmission];
        Walked {
            is_walked: ray.below.is_some(),
            sides: sides.map(|side| self.walked_in(&crossing.media(side)).is_some()),
            ..Walked::default()
        }
    }

    /// Whether light walks below a surface.
    pub(in super::super) fn is_walked(&self, s: &Shading) -> bool {
        self.descent != Descent::Flat && self.cx.scene.material(s.object).is_walked()
    }

    /// Lets light that a walk brings to the surface leave it in all directions, where facets are narrow; says whether.
    pub(in super::super) fn leave(&self, ray: &PathRay, s: &mut Shading) -> bool {
        let is_walk = ray.below.is_some_and(|below| below.is_scattered);
        let is_even = is_walk && !s.surface.is_outside(s.wo) && self.is_walked(s) && s.bsdf.is_narrow();
        if is_even {
            s.bsdf.leave(s.wo_local);
        }
        is_even
    }

    /// How far a ray of a walk gets, on its way to what it hits.
    pub(in super::super) fn fly_below(
        &mut self,
        ray: &mut PathRay,
        (below, hit): (&Below, Option<&Hit>),
        id: P::Id,
    ) -> Flown {
        let way = span(ray.from, &ray.ray, hit.map_or(f32::INFINITY, |hit| hit.t));
        let flight = below.fly(self.cx.scene, ray, (way, hit), &draws(ray));
        if P::RECORDS {
            self.report_floating(ray, &flight, id);
        }
        ray.lanes = flight.lanes;
        flight
    }

    /// The ray that a particle of the body sends on, which a walk met at parameter `t` where `weight` is left.
    pub(in super::super) fn walk_on(
        &self,
        ray: &PathRay,
        below: &Below,
        (t, weight): (f32, Spectrum),
    ) -> Onward {
        let left = self.arriving(&ray.media, ray.from, &ray.ray, t) * weight;
        let phase = Phase::HenyeyGreenstein(below.inside.phase);
        let mut onward = self.onward(ray, (&phase, ray.ray.at(t)), left);
        onward.child.walk_on(ray, true);
        onward
    }

    /// What a particle that met a surface does if it is to meet something below it, and with which chance it is; `asked` of
    /// the walk that brought it here.
    pub(super) fn parted(
        &self,
        (s, behind): (&Shading<'a>, &MediumStack),
        asked: Asked,
    ) -> Option<(Bsdf<'a>, f32)> {
        if self.descent != Descent::Adjoint || !self.is_walked(s) {
            return None;
        }
        if s.surface.is_outside(s.wo) {
            self.walked_back_in(behind)?;
            return s.bsdf.parted(s.wo_local).map(|(even, share)| (even, 0.5 * share));
        }
        let (mirror, share) = s.bsdf.parted(s.wo_local).filter(|_| s.bsdf.spreads())?;
        match asked {
            Asked::Nothing => Some((mirror, 0.75 * share)),
            Asked::ToScatter => Some((mirror, 1.0)),
            Asked::ToPass => None,
        }
    }

    /// How a particle goes on from a surface, with what it is multiplied with, and what is asked of it below.
    pub(super) fn particle_scattered(
        &self,
        (s, walked): (&Shading<'a>, &mut Walked),
        parted: Option<(Bsdf<'a>, f32)>,
        sampler: &Sampler,
    ) -> Option<(Scattered, Spectrum, Asked)> {
        let Some((even, chance)) = parted else {
            let scattered = s.scattered(sampler)?;
            let weight = match walked.is_even {
                true => scattered.weight * (tilt(s, &scattered) / scattered.compression),
                false => adjoint(s, &scattered),
            };
            return Some((scattered, weight, Asked::Nothing));
        };
        if sampler.fork(ENTRY_BRANCH).d1(Dim::Lobe) >= chance {
            let scattered = s.scattered(sampler)?;
            return Some((scattered, adjoint(s, &scattered) / (1.0 - chance), Asked::ToPass));
        }
        let scattered = even.scatter(s.wo_local, 0.0, sampler.d2(Dim::Scatter))?;
        walked.is_even = scattered.kind == BranchKind::Transmission;
        // The other way round radiance is compressed as much as it is stretched this way.
        let turned = 1.0 / (scattered.compression * scattered.compression);
        let weight = scattered.weight * (tilt(s, &scattered) * turned / chance);
        Some((scattered, weight, Asked::ToScatter))
    }
}

/// What shading normals make of a particle that goes on in a direction by what an eye's ray would.
pub(super) fn tilt(s: &Shading, scattered: &Scattered) -> f32 {
    let d = s.frame.to_world(scattered.wi);
    let [before, after] = [s.wo, d].map(|w| s.surface.n_g.dot(w).abs());
    s.wo_local.z.abs() * after / (before * scattered.wi.z.abs())
}
