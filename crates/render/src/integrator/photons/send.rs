//! Particles of a pass, and the photons that they leave behind.
use std::ops::Range;

use durer_core::{
    math::{Point3, Ray, Vector3},
    sampling::Sampler,
};

use super::{Gathering, Photon};
use crate::{
    PathRay, SampleCx,
    integrator::{
        shading::Shading,
        vertices::{Place, Stamina},
        walk::{Rules, Walk},
    },
    probe::NoProbe,
};

/// What some particles did.
#[derive(Clone, Debug, Default)]
pub struct Sent {
    /// What they left behind, in their order.
    pub photons: Vec<Photon>,
    /// Rays traced for it.
    pub rays: u64,
}

/// Sends a range of the particles of a pass at one moment; `sampler` gives each its numbers.
pub fn send(
    cx: &SampleCx<'_>,
    gathering: &Gathering,
    (time, particles): (f32, Range<u32>),
    sampler: impl Fn(u32) -> Sampler,
) -> Sent {
    let rules = Rules { max_depth: gathering.max_depth, ..Rules::PATH };
    // What comes to the last surface was scattered by all others: it may be gathered there.
    let stamina = Stamina { vertices: gathering.max_depth, sure: gathering.roulette_depth };
    let mut sent = Sent::default();
    for number in particles {
        let mut probe = NoProbe;
        let mut walk = Walk::new(&rules, cx, &mut probe);
        let nowhere = Ray { time, ..Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0)) };
        let particle = walk.particle(&PathRay::eye(nowhere, sampler(number)), stamina, ());
        sent.rays += walk.rays;
        for (bounces, vertex) in (0..).zip(particle.iter().flat_map(|particle| &particle.vertices)) {
            // They see no media.
            let (Place::Surface(s, _), power) = (&vertex.place, vertex.arriving) else { continue };
            // Straight light is asked for from the eye.
            if bounces > 0 && is_gathered(cx, s) && power.is_finite() && !power.is_black() {
                sent.photons.push(Photon {
                    p: s.surface.p,
                    wi: s.wo,
                    n: s.surface.n_g,
                    power,
                    bounces,
                    is_collapsed: vertex.path.is_collapsed,
                });
            }
        }
    }
    sent
}

/// Whether what arrives is gathered on one of the sides that it is scattered to: what is clear may be matte on its outside
/// only.
fn is_gathered(cx: &SampleCx<'_>, s: &Shading) -> bool {
    let mut surface = s.surface;
    let mut behind = || cx.scene.material(s.object).bsdf(&cx.shade(), &mut surface, -s.wo);
    s.bsdf.is_broad() || s.bsdf.is_frosted() && behind().is_broad()
}
