//! Points that a walk through the scene scatters at, from the eye or from a light: what light tracing and bidirectional
//! path tracing share.
//!
//! Densities of vertices are by area, `p(x') = p(w) |n' w| / d²` (Veach 1997, section 8.2.2.2). The density of a sharp direction
//! per projected solid angle is the same infinite one in both senses, so that it falls out of all shares: it counts as 1,
//! or as the cosine per solid angle. The chances of passing surfaces that are not there count as 1 too. Particles are scattered by the adjoint of what eye rays are:
//! `f*(wo, wi) = f(wi, wo)`, which is not symmetric through interfaces, `|wo n_s| / |wo n_g|` for shading normals (section
//! 5.3.2).
mod end;
mod particle;

use durer_accel::Hit;
use durer_core::{
    math::{Normal3, Point3, Ray, Vector3, error::offset_ray_origin},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::{BranchKind, Scattered},
    texture::Habit,
};

use super::{shading::Shading, walk::Walk};
use crate::{
    Lit, PathRay,
    footprint::Onlooker,
    media::{Boundary, Crossing},
    probe::{Probe, RayKind, StopReason},
};

pub(super) use end::End;
pub(super) use particle::{Particle, Stamina, chosen};

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
}

/// A surface at which a walk scatters.
pub(super) struct Vertex<'a> {
    pub(super) s: Shading<'a>,
    pub(super) crossing: Crossing,
    /// What arrives: power of a particle, or the share of an eye ray in the pixel; on this side of the surface.
    pub(super) arriving: Spectrum,
    /// Density with which the walk comes here, 1/m².
    pub(super) own: f32,
    /// The same of a walk from the other end.
    pub(super) other: f32,
    /// The walk went on in a sharp direction.
    pub(super) is_sharp: bool,
    /// The ray that came here.
    pub(super) path: PathRay,
}

impl Vertex<'_> {
    /// Density with which a walk that comes from direction `from` goes on along `to`, 1/sr; both point away.
    pub(super) fn pdf(&self, from: Vector3, to: Vector3) -> f32 {
        let (from, to) = (self.s.frame.to_local(from), self.s.frame.to_local(to));
        self.s.bsdf.eval_with_pdf(from, to).1
    }
    /// A density of directions from `from` to here by area.
    pub(super) fn by_area(&self, pdf: f32, from: Point3) -> f32 {
        let d = self.s.surface.p - from;
        let squared = d.length_squared();
        pdf * self.s.surface.n_g.dot(d).abs() / (squared * squared.sqrt())
    }
    /// Densities of a direction that the walk goes on in, 1/sr, and of the way back from there: of sharp ones, which have no
    /// `pdf`, the cosines.
    pub(super) fn there_and_back(&self, pdf: Option<f32>, d: Vector3) -> [f32; 2] {
        match pdf {
            Some(pdf) => [pdf, self.pdf(d, self.s.wo)],
            None => [d, self.s.wo].map(|w| self.s.surface.n_g.dot(w).abs()),
        }
    }
    /// Where lights are wanted that shine here, as one sees it who looks from direction `wo`.
    pub(super) fn lit(&self, wo: Vector3) -> Lit {
        let n = (!self.s.bsdf.is_frosted()).then(|| self.s.surface.n_s.face_forward(wo));
        Lit { p: self.s.surface.p, n, time: self.s.time }
    }
    /// Whether anything can be connected to it.
    pub(super) fn is_connectible(&self) -> bool {
        !self.s.bsdf.is_sharp()
    }
    /// What of a particle's power here is radiance towards unit direction `d`, per projected solid angle; `is_first` if
    /// it comes straight from a light without extent.
    pub(super) fn sent(&self, d: Vector3, is_first: bool) -> Spectrum {
        let (to, from) = (self.s.frame.to_local(d), self.s.wo_local);
        let f = match is_first {
            true => self.s.bsdf.eval_radiance(to, from),
            false => self.s.bsdf.eval_with_pdf(to, from).0,
        };
        self.arriving * f * self.tilt()
    }
    /// What the shading normal makes of particles that come here.
    fn tilt(&self) -> f32 {
        self.s.wo_local.z.abs() / self.s.surface.n_g.dot(self.s.wo).abs()
    }
    /// The end of a ray that comes from direction `d`: this side of the surface by more than rounding.
    pub(super) fn beside(&self, d: Vector3) -> Point3 {
        let surface = &self.s.surface;
        offset_ray_origin(surface.p, surface.p_error, surface.n_g, d)
    }
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
    /// The surface of a hit, ready to scatter, with what is left along the ray; `None` if it is none and the ray goes on
    /// beyond it.
    pub(super) fn meet(
        &mut self,
        ray: &mut PathRay,
        hit: &Hit,
        announce: impl FnOnce(&mut Self, &Shading),
    ) -> Option<(Shading<'a>, Crossing, Spectrum)> {
        let mut s = Shading::at(self.cx, &ray.ray, hit, Some(Onlooker::of(ray, Habit::AsPbrt)));
        announce(self, &s);
        let crossing = self.cross(&ray.media, &mut s, hit.t);
        let left = self.arriving(&ray.media, ray.from, &ray.ray, hit.t);
        match crossing.boundary {
            Boundary::Passed => {
                let beyond = s.surface.spawn(ray.ray.d, ray.ray.time);
                *ray = ray.passing((s.surface.p, beyond), left, crossing.behind, hit.t);
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

    /// Density by area with which a ray that left `from` comes to `s`.
    pub(super) fn density(&self, flight: Flight, from: Point3, s: &Shading) -> f32 {
        let cos = s.surface.n_g.dot(s.wo).abs();
        let d = s.surface.p - from;
        match flight {
            Flight::Direction(pdf) => pdf * cos / d.length_squared(),
            Flight::Place(pdf) => pdf * cos,
            Flight::Camera => self.cx.scene.view.importance(-s.wo, d.length(), s.time) * cos,
        }
    }

    /// What passes of `sent` light from a point to a vertex, or from a vertex to the camera, in direction `d` from the
    /// vertex: announced as a ray with this `weight` in the result of `parent`.
    pub(super) fn joint(
        &mut self,
        vertex: &Vertex,
        (to, d): (Point3, Vector3),
        (weight, sent): (Spectrum, Spectrum),
        parent: P::Id,
    ) -> Spectrum {
        let ray = vertex.s.surface.spawn_to(to, vertex.s.time);
        let media = vertex.crossing.media(vertex.s.side_of(d));
        let path = PathRay { media, ..vertex.path.child((vertex.s.surface.p, ray), weight, LENS_BRANCH) };
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

/// The ray in a scattered direction, with the share that is left of it before any index of refraction or normal counts.
pub(super) fn scattered_on(
    parent: &PathRay,
    (s, crossing): (&Shading, &Crossing),
    scattered: &Scattered,
    weight: Spectrum,
) -> PathRay {
    let d = s.frame.to_world(scattered.wi);
    let d = if scattered.pdf.is_none() { s.keep_side(d, scattered.kind) } else { d };
    let ray: Ray = s.surface.spawn(d.normalize(), parent.ray.time);
    PathRay {
        media: crossing.media(scattered.kind),
        density: scattered.pdf,
        compression: parent.compression * scattered.compression,
        ..parent.child((s.surface.p, ray), weight, SCATTER_BRANCH)
    }
}

/// A walk that has gone this far ends by chance: the probability that it goes on.
pub(super) fn kept(carried: f32) -> f32 {
    // What carries more than at first goes on, and so does what cannot be told.
    if carried < 1.0 { carried } else { 1.0 }
}
