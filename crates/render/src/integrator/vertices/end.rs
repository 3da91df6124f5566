//! The end of a path at a light.
use durer_core::math::{Point3, Vector3};
use durer_model::light::{Leaving, LightCx, LightHit, LightSample, Source};

use super::{Vertex, falloff, towards};
use crate::{LightSampler, Lit, SampleCx};

/// A point of a light, as a path ends there.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct End {
    /// Its index in the scene.
    pub(in super::super) light: usize,
    /// What it is.
    pub(in super::super) source: Source,
    /// Where; of light from far away a point on its way.
    pub(in super::super) p: Point3,
}

impl End {
    /// Whether rays can meet it.
    pub(in super::super) fn is_met(&self) -> bool {
        matches!(self.source, Source::Surface(_) | Source::Far)
    }
    /// Whether it has no extent, so that it counts as a light without density.
    pub(in super::super) fn is_sharp(&self) -> bool {
        !self.is_met()
    }
    fn hit(&self) -> Option<LightHit> {
        match self.source {
            Source::Surface(hit) => Some(hit),
            _ => None,
        }
    }
    /// Unit direction from a vertex to it, if it is far away along `d`.
    fn direction(&self, from: &Vertex<'_>, d: Vector3) -> Vector3 {
        match self.source {
            Source::Far | Source::Parallel => d,
            Source::Point | Source::Surface(_) => towards(from.p, self.p).0,
        }
    }
    /// A density of directions from `from` to here: by area, or of far light as it is.
    pub(in super::super) fn by_area(&self, pdf: f32, from: Point3) -> f32 {
        match &self.source {
            Source::Surface(hit) => pdf * falloff(from, hit.p, hit.n),
            Source::Far => pdf,
            // Nothing comes here by chance.
            Source::Point | Source::Parallel => 0.0,
        }
    }

    /// Densities with which a particle begins here and comes to the vertex `first`, in direction `d` from there: of the
    /// place of the light by area (of far light of the direction), and of the vertex by area.
    pub(in super::super) fn begun(&self, cx: &SampleCx<'_>, first: &Vertex<'_>, d: Vector3) -> [f32; 2] {
        let d = self.direction(first, d);
        let at = first.p;
        let (scene, asked) = (cx.scene, LightCx { basis: cx.basis, time: first.time() });
        let chance = scene.emitter_chance(self.light);
        if chance == 0.0 {
            return [0.0; 2];
        }
        let leaving = Leaving { p: self.hit().map_or(at, |hit| hit.p), hit: self.hit(), d: -d };
        let [place, direction] = scene.lights[self.light].emission_pdf(&asked, &scene.extent, &leaving);
        match self.source {
            Source::Far | Source::Parallel => [chance * direction, place * first.cos(d)],
            Source::Point | Source::Surface(_) => [chance * place, first.by_area(direction, self.p)],
        }
    }

    /// Density with which the light is asked at vertex `first`, which a walk from direction `wo` came to, in the same
    /// measure as the first of [`End::begun`]. `d` leads there.
    pub(in super::super) fn asked(
        &self,
        cx: &SampleCx<'_>,
        (first, wo): (&Vertex<'_>, Vector3),
        d: Vector3,
        by: LightSampler,
    ) -> f32 {
        let lit: Lit = first.lit(wo);
        let chance = cx.scene.light_chance(by, &lit, self.light);
        if chance == 0.0 {
            return 0.0;
        }
        let asked = LightCx { basis: cx.basis, time: first.time() };
        let light = &cx.scene.lights[self.light];
        match &self.source {
            Source::Point | Source::Parallel => chance,
            Source::Surface(hit) => chance * light.pdf(&asked, lit.p, hit) * falloff(lit.p, hit.p, hit.n),
            Source::Far => chance * light.pdf_escaped(&asked, lit.p, d),
        }
    }

    /// What a vertex sampled of a light.
    pub(in super::super) fn sampled(light: usize, sample: &LightSample, from: &Vertex<'_>) -> Self {
        let at = from.p;
        let (source, p) = match (sample.on, sample.point, sample.pdf) {
            (Some(hit), _, _) => (Source::Surface(hit), hit.p),
            (None, Some(point), _) => (Source::Point, point),
            (None, None, Some(_)) => (Source::Far, at),
            (None, None, None) => (Source::Parallel, at),
        };
        Self { light, source, p }
    }
}
