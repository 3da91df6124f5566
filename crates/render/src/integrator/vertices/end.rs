//! The end of a path at a light.
use durer_core::math::{Point3, Vector3};
use durer_model::light::{Leaving, LightCx, LightHit, LightSample, Source, UNIFORM};

use super::{Vertex, falloff, towards};
use crate::{LightSampler, Lit, SampleCx, emitters::Emitter};

/// A point of a light, or of a medium that glows, as a path ends there.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct End {
    /// Its index in the scene, among the lights or the volumes.
    pub(in super::super) light: usize,
    /// What it is.
    pub(in super::super) source: Source,
    /// Where; of light from far away a point on its way.
    pub(in super::super) p: Point3,
}

impl End {
    /// Whether rays can meet it.
    pub(in super::super) fn is_met(&self) -> bool {
        matches!(self.source, Source::Surface(_) | Source::Far | Source::Glow(_))
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
            Source::Point | Source::Surface(_) | Source::Glow(_) => towards(from.p, self.p).0,
        }
    }
    /// A density of directions from `from` to here: by area, of what glows by volume, or of far light as it is.
    pub(in super::super) fn by_area(&self, pdf: f32, from: Point3) -> f32 {
        match &self.source {
            Source::Surface(hit) => pdf * falloff(from, hit.p, hit.n),
            Source::Far => pdf,
            Source::Glow(met) => pdf * met / (self.p - from).length_squared(),
            // Nothing comes here by chance.
            Source::Point | Source::Parallel => 0.0,
        }
    }

    /// The density with which a walk meets this place by volume, if it comes here by area with density `pdf`.
    pub(in super::super) fn by_volume(&self, pdf: f32) -> f32 {
        if let Source::Glow(met) = self.source { pdf * met } else { pdf }
    }

    /// Densities with which a particle begins here and comes to the vertex `first`, in direction `d` from there: of the
    /// place of the light by area (of what glows by volume, of far light of the direction), and of the vertex by area.
    pub(in super::super) fn begun(&self, cx: &SampleCx<'_>, first: &Vertex<'_>, d: Vector3) -> [f32; 2] {
        let d = self.direction(first, d);
        let at = first.p;
        let (scene, asked) = (cx.scene, LightCx { basis: cx.basis, time: first.time() });
        let emitter = match self.source {
            Source::Glow(_) => Emitter::Glow(self.light),
            _ => Emitter::Light(self.light),
        };
        // All who join walks heed media.
        let chance = scene.emitter_chance(true, emitter);
        if chance == 0.0 {
            return [0.0; 2];
        }
        if let Emitter::Glow(volume) = emitter {
            let places = scene.glowing(volume);
            let place = places.map_or(0.0, |places| places.density(&scene.volumes[volume], self.p));
            return [chance * place, first.by_area(UNIFORM, self.p)];
        }
        let leaving = Leaving { p: self.hit().map_or(at, |hit| hit.p), hit: self.hit(), d: -d };
        let [place, direction] = scene.lights[self.light].emission_pdf(&asked, &scene.extent, &leaving);
        match self.source {
            Source::Far | Source::Parallel => [chance * direction, place * first.cos(d)],
            Source::Point | Source::Surface(_) | Source::Glow(_) => {
                [chance * place, first.by_area(direction, self.p)]
            }
        }
    }

    /// The same of a particle that begins in a body that light walks in, along `d`: the second is that of [`Flight::Below`].
    pub(in super::super) fn begun_below(&self, cx: &SampleCx<'_>, d: Vector3, time: f32) -> [f32; 2] {
        let Source::Surface(hit) = self.source else { return [0.0; 2] };
        let chance = cx.scene.emitter_chance(true, Emitter::Light(self.light));
        let asked = LightCx { basis: cx.basis, time };
        let leaving = Leaving { p: hit.p, hit: Some(hit), d };
        let [place, direction] = cx.scene.lights[self.light].emission_pdf(&asked, &cx.scene.extent, &leaving);
        [chance * place, direction / self.cos(d)]
    }
    /// The cosine by which it sends out light along `d`.
    pub(super) fn cos(&self, d: Vector3) -> f32 {
        self.hit().map_or(1.0, |hit| hit.n.dot(d).abs())
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
        if let Source::Glow(_) = self.source {
            // Nobody asks for it.
            return 0.0;
        }
        let lit: Lit = first.lit(wo);
        let chance = cx.scene.light_chance(by, &lit, self.light);
        if chance == 0.0 {
            return 0.0;
        }
        let asked = LightCx { basis: cx.basis, time: first.time() };
        let light = &cx.scene.lights[self.light];
        match &self.source {
            Source::Point | Source::Parallel | Source::Glow(_) => chance,
            Source::Surface(hit) => chance * light.pdf(&asked, lit.p, hit) * falloff(lit.p, hit.p, hit.n),
            Source::Far => chance * light.pdf_escaped(&asked, lit.p, d),
        }
    }

    /// A place of a volume that glows, which is met or chosen.
    pub(in super::super) fn glow(cx: &SampleCx<'_>, volume: usize, p: Point3) -> Self {
        let places = cx.scene.glowing(volume);
        let met = places.map_or(0.0, |places| places.met(&cx.scene.volumes[volume], cx.basis, p));
        Self { light: volume, source: Source::Glow(met), p }
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
