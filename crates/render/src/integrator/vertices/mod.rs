//! Points that a walk through the scene scatters at, from the eye or from a light: what light tracing and bidirectional
//! path tracing share.
//!
//! Densities of vertices on surfaces are by area, `p(x') = p(w) |n' w| / d²` (Veach 1997, section 8.2.2.2), in media by volume,
//! without the cosine and without what the medium's density has to do with it: a way between two vertices lets as much
//! pass in either sense, and what scatters at a place does so for both walks. What an edge that joins two walks lets pass is
//! left out too, as in pbrt-v4: shares still sum to 1.
//!
//! The density of a sharp direction per projected solid angle is the same infinite one in both senses, so that it falls out
//! of all shares: it counts as 1, or as the cosine per solid angle. The chances of passing surfaces that are not there count
//! as 1 too. Particles are scattered by the adjoint of what eye rays are: `f*(wo, wi) = f(wi, wo)`, which is not symmetric
//! through interfaces, `|wo n_s| / |wo n_g|` for shading normals (section 5.3.2).
//!
//! A walk below a surface is an edge between the points where it gets in and out, to which nothing can be joined
//! (`below.rs`).
mod begun;
mod below;
mod end;
mod onward;
mod particle;
mod vertex;

use durer_accel::Hit;
use durer_core::{
    math::{Normal3, Point3, Ray, Vector3},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::BranchKind,
    medium::{self, Phase},
    texture::Habit,
};

use super::{
    below::Descent,
    shading::Shading,
    walk::{Walk, span},
};
use crate::{
    PathRay,
    footprint::Onlooker,
    media::{Boundary, Crossing},
    probe::{Probe, RayKind, StopReason},
};

pub(super) use below::Walked;
pub(super) use end::End;
pub(super) use onward::{Onward, chosen};
pub(super) use particle::{Particle, Stamina};
pub(super) use vertex::{Place, Vertex};

/// Scattered rays use this branch of the sampler, those that go straight on the next: as those of paths.
pub(super) const SCATTER_BRANCH: u32 = 1 << 15;
/// What of the sampler begins a particle.
const EMISSION_BRANCH: u32 = SCATTER_BRANCH + 2;
/// What of the sampler connects to the lens.
const LENS_BRANCH: u32 = SCATTER_BRANCH + 3;

/// What chose the direction to the next vertex.
#[derive(Clone, Copy, Debug)]
pub(super) enum Flight {
    /// A density of directions, 1/sr.
    Direction(f32),
    /// A density of parallel rays over the plane across them, 1/m².
    Place(f32),
    /// The camera.
    Camera,
    /// A walk below a surface: the density with which it came in, by the cosine there, and what is asked of it.
    Below(f32, Asked),
}

impl Flight {
    /// What no particle does: so likely that all other ways count for nothing.
    pub(super) const OF_THE_EYE: Self = Self::Below(f32::MAX, Asked::Nothing);

    /// That of a walk below a surface which began by this flight where the cosine is `cos`, and of which that is asked.
    fn below(self, (cos, asked): (f32, Asked)) -> Self {
        match self {
            Self::Direction(pdf) => Self::Below(pdf / cos, asked),
            Self::Place(pdf) => Self::Below(pdf, asked),
            Self::Camera => Self::Below(1.0, asked),
            Self::Below(..) => self,
        }
    }
    /// What is asked of it.
    fn asked(self) -> Asked {
        if let Self::Below(_, asked) = self { asked } else { Asked::Nothing }
    }
    /// The same of which that is asked.
    fn asking(self, asked: Asked) -> Self {
        if let Self::Below(pdf, _) = self { Self::Below(pdf, asked) } else { self }
    }
}

/// What is asked of a particle's walk below a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    /// Nothing.
    Nothing,
    /// To meet something there before it leaves.
    ToScatter,
    /// To meet nothing.
    ToPass,
}

/// Cosine by distance², of a surface of unit normal `n` at `to` seen from `from`.
pub(super) fn falloff(from: Point3, to: Point3, n: Normal3) -> f32 {
    let d = to - from;
    let squared = d.length_squared();
    n.dot(d).abs() / (squared * squared.sqrt())
}

/// Unit direction and distance.
pub(super) fn towards(from: Point3, to: Point3) -> (Vector3, f32) {
    let d = to - from;
    let distance = d.length();
    (d / distance, distance)
}

impl<'a, P: Probe> Walk<'a, P> {
    /// How far a ray gets among what floats on its way to parameter `t`, and how that scatters; `None` where nothing floats.
    pub(super) fn float(&self, ray: &mut PathRay, t: f32) -> Option<(medium::Flight, &'a Phase)> {
        if !self.heeds_media {
            return None;
        }
        let volume = self.volume(&ray.media)?;
        let flight = self.fly(volume, ray, span(ray.from, &ray.ray, t));
        ray.lanes = flight.lanes;
        Some((flight, volume.phase()))
    }

    /// The surface of a hit, ready to scatter, with what is left along the ray, of which `passed` is what floats there lets
    /// by; `None` if it is none and the ray goes on beyond it.
    pub(super) fn meet(
        &mut self,
        ray: &mut PathRay,
        (hit, passed): (&Hit, Spectrum),
        announce: impl FnOnce(&mut Self, &Shading),
    ) -> Option<(Shading<'a>, Crossing, Spectrum)> {
        let onlooker = Onlooker::of(ray, Habit::AsPbrt);
        let mut s = match self.descent {
            Descent::Flat => Shading::at(self.cx, &ray.ray, hit, Some(onlooker)),
            Descent::Mirrored | Descent::Adjoint => Shading::open(self.cx, &ray.ray, hit, onlooker),
        };
        announce(self, &s);
        let crossing = self.cross(&ray.media, &mut s, hit.t);
        let left = self.arriving(&ray.media, ray.from, &ray.ray, hit.t) * passed;
        match crossing.boundary {
            Boundary::Passed => {
                let beyond = s.surface.spawn(ray.ray.d, ray.ray.time);
                *ray = ray.passing((s.surface.p, beyond), left, crossing.behind, hit.t);
                if self.heeds_media {
                    ray.sampler = ray.sampler.fork(SCATTER_BRANCH + 1);
                }
                return None;
            }
            Boundary::Between(eta) => s.bsdf.set_eta(s.wo_local, eta),
            Boundary::Own => {}
        }
        if crossing.disperses && !ray.is_collapsed {
            ray.is_collapsed = true;
            return Some((s, crossing, left * self.cx.basis.collapse()));
        }
        Some((s, crossing, left))
    }

    /// Density by area, or volume, with which a ray of a walk, which left `from` by this flight, comes to a place where the
    /// cosine is `cos`.
    pub(super) fn density(
        &self,
        flight: Flight,
        (from, ray): (Point3, &Ray),
        (p, cos): (Point3, f32),
    ) -> f32 {
        let d = p - from;
        match flight {
            Flight::Direction(pdf) => pdf * cos / d.length_squared(),
            Flight::Place(pdf) => pdf * cos,
            Flight::Camera => self.cx.scene.view.importance(ray.d, d.length(), ray.time) * cos,
            Flight::Below(pdf, _) => pdf,
        }
    }

    /// What passes of `sent` light from a point to a vertex, or from a vertex to the camera, in direction `d` from the
    /// vertex: announced as a ray with this `weight` in the result of `parent`.
    pub(super) fn joint(
        &mut self,
        vertex: &Vertex<'_>,
        (to, d): (Point3, Vector3),
        (weight, sent): (Spectrum, Spectrum),
        parent: P::Id,
    ) -> Spectrum {
        let (ray, media) = vertex.way_to(to, d);
        let path = PathRay { media, ..vertex.path.child((vertex.p, ray), weight, LENS_BRANCH) };
        let id = self.probe.ray(parent, &path, RayKind::Connection);
        let passage = self.way(&path, Some(to), id);
        let arriving = sent * passage.share;
        let reason = if passage.share.is_black() { passage.end } else { StopReason::HitLight };
        self.probe.local(id, arriving);
        self.probe.stop(id, reason, Spectrum::BLACK);
        self.probe.result(id, arriving);
        arriving
    }
}

/// The ray straight on behind a surface of which nothing was met: no bounce, but with random numbers of its own.
pub(super) fn straight_on(
    parent: &PathRay,
    (s, crossing): (&Shading, &Crossing),
    weight: Spectrum,
) -> PathRay {
    let ray = s.surface.spawn(parent.ray.d, parent.ray.time);
    let media = crossing.media(BranchKind::Transmission);
    let walked = (s.surface.p - parent.ray.o).length();
    let sampler = parent.sampler.fork(SCATTER_BRANCH + 1);
    PathRay { sampler, ..parent.passing((s.surface.p, ray), weight, media, walked) }
}

/// A walk that has gone this far ends by chance: the probability that it goes on.
pub(super) fn kept(carried: f32) -> f32 {
    // What carries more than at first goes on, and so does what cannot be told.
    if carried < 1.0 { carried } else { 1.0 }
}
