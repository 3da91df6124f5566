//! Light below surfaces: a walk at random from particle to particle until it finds the boundary and gets through.
//!
//! A walk is no bounce, however long: getting in is one, and so is getting out. It ends by chance as what it carries
//! fades, or after [`Below::MOST_RAYS`] rays. Lanes share a walk as they do in media.
use durer_accel::Hit;
use durer_core::math::Vector3;
use durer_model::{
    Fill, Surface,
    bsdf::BranchKind,
    medium::{Draws, End, Flight},
};

use super::shading::Shading;
use crate::{Below, PathRay, SampleCx, Scene, media::Crossing};

/// Rounding errors of a point within which particles do not come near a boundary, and a quarter of what they keep between
/// them.
const NEAR: f32 = 4.0;

/// What walks from both ends make of light below surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Descent {
    /// Nothing: a matte body stands for it.
    Flat,
    /// Particles do what paths do: they get in as they are refracted, and where facets are narrow they leave evenly.
    Mirrored,
    /// Particles do what the eye's walks do, turned round: they get in evenly there, and leave as they are refracted.
    Adjoint,
}

impl Below {
    /// Rays of a walk at most.
    pub(crate) const MOST_RAYS: u32 = 10_000;

    /// A walk that begins in what lies below surfaces of a material, as that is at this place.
    pub(super) fn at(cx: &SampleCx<'_>, material: u32, surface: &Surface) -> Option<Self> {
        let inside = cx.scene.materials[material as usize].inside(&cx.shade(), &surface.texture_at())?;
        let off = surface.p_error;
        let least = 4.0 * NEAR * off.x.max(off.y).max(off.z);
        Some(Self { inside: inside.coarsened(least), rays: 0, is_scattered: false })
    }

    /// How far a ray gets, which has this part of its way to what it hits.
    pub(super) fn fly(
        &self,
        scene: &Scene,
        ray: &PathRay,
        (way, hit): ((f32, f32), Option<&Hit>),
        draws: Draws<'_>,
    ) -> Flight {
        let flight = self.inside.fly(ray.lanes, way, draws);
        let End::Scattered(t) = flight.end else { return flight };
        // NUMERICS: rays that start within rounding errors of the boundary may miss it, and never come back (
        // white_bodies_do_not_leak).
        let end = hit.map_or(f32::INFINITY, |hit| boundary(scene, ray, hit, t));
        Flight { end: End::Scattered(t.min(end).max(0.0)), ..flight }
    }
}

/// The parameter up to which the ray is clear of what it hits, if a particle at `t` may not be.
fn boundary(scene: &Scene, ray: &PathRay, hit: &Hit, t: f32) -> f32 {
    let far = Vector3::from(ray.ray.o.to_array()).abs();
    // PERF: most particles are nowhere near (bench render).
    if (hit.t - t) * 256.0 > hit.t + far.x + far.y + far.z {
        return t;
    }
    let surface = scene.surface(&ray.ray, hit).1;
    let off = surface.n_g.abs().dot(surface.p_error) / surface.n_g.dot(ray.ray.d).abs();
    hit.t - NEAR * off
}

impl PathRay {
    /// Makes this ray the next one of the walk that `parent` belongs to, if it belongs to one.
    pub(super) fn walk_on(&mut self, parent: &Self, is_scattered: bool) {
        let Some(below) = parent.below else { return };
        self.depth = parent.depth;
        self.density = None;
        let is_scattered = below.is_scattered || is_scattered;
        self.below = Some(Below { rays: below.rays + 1, is_scattered, ..below });
    }
}

/// Makes a ray that leaves a surface on a side one of a walk, if it starts one or goes on with one.
pub(super) fn descend(
    cx: &SampleCx<'_>,
    parent: &PathRay,
    (s, crossing): (&Shading, &Crossing),
    kind: BranchKind,
    child: &mut PathRay,
) {
    if kind == BranchKind::Reflection {
        child.walk_on(parent, false);
        return;
    }
    child.below = None;
    let Fill::Below(material) = crossing.behind.fill(&cx.scene.media) else { return };
    if let Some(below) = Below::at(cx, material, &s.surface) {
        child.below = Some(below);
        child.density = None;
    }
}
