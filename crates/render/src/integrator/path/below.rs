//! Paths below surfaces: a walk at random from particle to particle until it finds the boundary and gets through.
//!
//! A walk is no bounce, however long: getting in is one, and so is getting out. It ends by chance as what it carries
//! fades, or after [`Below::MOST_RAYS`] rays. Lights are asked where it gets out, as no straight ray passes the boundary;
//! those below the surface are met by walks only. Lanes share a walk as they do in media.
use durer_accel::Hit;
use durer_core::math::Vector3;
use durer_model::{
    Fill,
    bsdf::BranchKind,
    medium::{Draws, End, Flight},
};

use super::{super::shading::Shading, follow::Follow};
use crate::{Below, MediumStack, PathRay, Scene, media::Crossing, probe::Probe};

/// Rounding errors of a point within which particles do not come near a boundary, and a quarter of what they keep between
/// them.
const NEAR: f32 = 4.0;

impl Below {
    /// Rays of a walk at most.
    pub(crate) const MOST_RAYS: u32 = 10_000;

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

impl<P: Probe> Follow<'_, P> {
    /// Whether light walks in what fills the place.
    pub(super) fn is_below(&self, bodies: &MediumStack) -> bool {
        let cx = self.walk.cx;
        matches!(bodies.fill(&cx.scene.media), Fill::Below(_))
    }

    /// Whether light walks below a surface.
    pub(super) fn is_walked(&self, s: &Shading) -> bool {
        self.walks && self.walk.cx.scene.material(s.object).is_walked()
    }

    /// Lets light that a walk brings to the surface leave it in all directions.
    pub(super) fn leave(&self, ray: &PathRay, s: &mut Shading) {
        let is_walk = ray.below.is_some_and(|below| below.is_scattered);
        if is_walk && !s.surface.is_outside(s.wo) && self.is_walked(s) {
            s.bsdf.leave(s.wo_local);
        }
    }

    /// Makes a ray that leaves a surface on a side one of a walk, if it starts one or goes on with one.
    ///
    /// PERF: apart, as most scenes have no walks (bench render).
    #[inline(never)]
    pub(super) fn below(
        &self,
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
        let cx = self.walk.cx;
        let Fill::Below(material) = crossing.behind.fill(&cx.scene.media) else { return };
        let inside = cx.scene.materials[material as usize].inside(&cx.shade(), &s.surface.texture_at());
        let Some(inside) = inside else { return };
        let off = s.surface.p_error;
        let least = 4.0 * NEAR * off.x.max(off.y).max(off.z);
        child.below = Some(Below { inside: inside.coarsened(least), rays: 0, is_scattered: false });
        child.density = None;
    }
}
