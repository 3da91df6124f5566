//! A point at which a walk scatters: on a surface, or at a particle of a medium.
//!
//! Surfaces weigh what comes and goes by cosines. Particles have no side: there all of these are 1 (Pauly, Kollig and
//! Keller 2000, "Metropolis Light Transport for Participating Media", section 2).
use durer_core::{
    math::{Point3, Ray, Vector3, error::offset_ray_origin},
    spectrum::{Basis, Spectrum},
};
use durer_model::{
    light::LightSample,
    medium::{Phase, Turn},
};

use super::{
    super::{
        shading::Shading,
        walk::{Walk, between},
    },
    below::Walked,
};
use crate::{Lit, MediumStack, PathRay, media::Crossing, probe::Probe};

/// A point at which a walk scatters.
pub(in super::super) struct Vertex<'a> {
    /// What scatters there.
    pub(in super::super) place: Place<'a>,
    /// Where.
    pub(in super::super) p: Point3,
    /// What arrives, on this side of a surface: power of a particle; from the eye what is left of light at the start of the
    /// ray, unless a surface has its lobes dimmed by that.
    pub(in super::super) arriving: Spectrum,
    /// Density with which the walk comes here, 1/m², at particles 1/m³ by what scatters and is left.
    pub(in super::super) own: f32,
    /// The same of a walk from the other end.
    pub(in super::super) other: f32,
    /// The walk went on in a sharp direction.
    pub(in super::super) is_sharp: bool,
    /// The ray that came here.
    pub(in super::super) path: PathRay,
    /// What walks below the surface have to do with it.
    pub(in super::super) below: Walked,
    /// Vertices before it on its way.
    pub(in super::super) order: usize,
}

/// What scatters at a vertex.
#[allow(clippy::large_enum_variant, reason = "most are surfaces, and few are kept")]
pub(in super::super) enum Place<'a> {
    /// A surface.
    Surface(Shading<'a>, Crossing),
    /// A particle that floats.
    Particle(&'a Phase),
}

impl<'a> Vertex<'a> {
    /// One that `path` came to, with what arrives there.
    pub(in super::super) fn new(place: Place<'a>, p: Point3, arriving: Spectrum, path: PathRay) -> Self {
        Self {
            place,
            p,
            arriving,
            own: 0.0,
            other: 0.0,
            is_sharp: false,
            path,
            below: Walked::default(),
            order: 0,
        }
    }
    /// Unit direction back along the ray that came here.
    pub(in super::super) fn wo(&self) -> Vector3 {
        -self.path.ray.d
    }
    /// From the ray that came here to unit direction `to`.
    fn turn(&self, to: Vector3) -> Turn {
        Turn { p: self.p, from: self.path.ray.d, to }
    }
    /// The moment, in seconds.
    pub(in super::super) fn time(&self) -> f32 {
        self.path.ray.time
    }
    /// What a density along direction `d` is multiplied with by what stands across the ray here: a cosine.
    pub(in super::super) fn cos(&self, d: Vector3) -> f32 {
        match &self.place {
            Place::Surface(s, _) => s.surface.n_g.dot(d).abs(),
            Place::Particle(_) => 1.0,
        }
    }
    /// Density with which a walk that comes from direction `from` goes on along `to`, 1/sr; both point away.
    pub(in super::super) fn pdf(&self, from: Vector3, to: Vector3) -> f32 {
        match &self.place {
            Place::Surface(s, _) if self.is_crossed(s, from, to) => self.crossing_pdf(s, from, to),
            Place::Surface(s, _) => s.pdf(from, to),
            Place::Particle(phase) => phase.density(&Turn { p: self.p, from: -from, to }),
        }
    }
    /// A density of directions from `from` to here by area, or by volume.
    pub(in super::super) fn by_area(&self, pdf: f32, from: Point3) -> f32 {
        let d = self.p - from;
        let squared = d.length_squared();
        match &self.place {
            Place::Surface(s, _) => pdf * s.surface.n_g.dot(d).abs() / (squared * squared.sqrt()),
            Place::Particle(_) => pdf / squared,
        }
    }
    /// Densities of a direction that the walk goes on in, 1/sr, and of the way back from there: of sharp ones, which have no
    /// `pdf`, the cosines.
    pub(in super::super) fn there_and_back(&self, pdf: Option<f32>, d: Vector3) -> [f32; 2] {
        match pdf {
            Some(_) if self.goes_below(d) => [self.pdf(self.wo(), d), self.pdf(d, self.wo())],
            Some(pdf) => [pdf, self.pdf(d, self.wo())],
            None => [d, self.wo()].map(|w| self.cos(w)),
        }
    }
    /// Where lights are wanted that shine here, as one sees it who looks from direction `wo`.
    pub(in super::super) fn lit(&self, wo: Vector3) -> Lit {
        let n = match &self.place {
            // As from below.
            Place::Surface(s, _) if self.below.is_even && self.is_crossed(s, s.wo, wo) => None,
            Place::Surface(s, _) => (!s.bsdf.is_frosted()).then(|| s.surface.n_s.face_forward(wo)),
            Place::Particle(_) => None,
        };
        Lit { p: self.p, n, time: self.time() }
    }
    /// Whether anything can be connected to it.
    pub(in super::super) fn is_connectible(&self) -> bool {
        match &self.place {
            Place::Surface(s, _) => !s.bsdf.is_sharp(),
            Place::Particle(_) => true,
        }
    }
    /// What of radiance from unit direction `d` goes back along an eye's ray, 1/sr, and the cosine that counts besides;
    /// `is_first` if it comes straight from a light without extent.
    pub(in super::super) fn seen(&self, basis: &Basis, d: Vector3, is_first: bool) -> (Spectrum, f32) {
        match &self.place {
            _ if self.is_below(d) => (Spectrum::BLACK, 0.0),
            Place::Surface(s, _) => {
                let wi = s.frame.to_local(d);
                (s.radiance((s.wo_local, wi), is_first), wi.z.abs())
            }
            Place::Particle(phase) => (self.arriving * deflected(phase, basis, &self.turn(d)), 1.0),
        }
    }
    /// What of a particle's power here is radiance towards unit direction `d`, per projected solid angle; `is_first` if
    /// it comes straight from a light without extent.
    pub(in super::super) fn sent(&self, basis: &Basis, d: Vector3, is_first: bool) -> Spectrum {
        match &self.place {
            _ if self.is_below(d) => Spectrum::BLACK,
            Place::Surface(s, _) => {
                // What the shading normal makes of particles that come here.
                let tilt = s.wo_local.z.abs() / s.surface.n_g.dot(s.wo).abs();
                let to = s.frame.to_local(d);
                let f = match self.below.is_even && self.below.is_walked {
                    true => s.bsdf.eval(s.wo_local, to),
                    false => s.radiance((to, s.wo_local), is_first),
                };
                self.arriving * f * tilt
            }
            // Radiance goes the other way.
            Place::Particle(phase) => self.arriving * deflected(phase, basis, &self.turn(d).back()),
        }
    }
    /// The end of a ray that comes from direction `d`: this side of a surface by more than rounding.
    pub(in super::super) fn beside(&self, d: Vector3) -> Point3 {
        match &self.place {
            Place::Surface(s, _) => offset_ray_origin(self.p, s.surface.p_error, s.surface.n_g, d),
            Place::Particle(_) => self.p,
        }
    }
    /// The way to a point in direction `d`, and the bodies that it starts in.
    pub(super) fn way_to(&self, to: Point3, d: Vector3) -> (Ray, MediumStack) {
        match &self.place {
            Place::Surface(s, crossing) => {
                (s.surface.spawn_to(to, self.time()), crossing.media(s.side_of(d)))
            }
            Place::Particle(_) => (between(self.p, to, self.time()), self.path.media),
        }
    }
    /// The ray to a light.
    pub(in super::super) fn shadow_path<P: Probe>(
        &self,
        walk: &Walk<'_, P>,
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
    ) -> PathRay {
        match &self.place {
            Place::Surface(s, crossing) => walk.shadow_path(&self.path, (s, crossing), light, weight, sample),
            Place::Particle(_) => walk.shadow_path_at(&self.path, self.p, light, weight, sample),
        }
    }
}

/// What a particle sends on by this turn, 1/sr.
fn deflected(phase: &Phase, basis: &Basis, turn: &Turn) -> Spectrum {
    phase.tint(basis, turn) * phase.density(turn)
}
