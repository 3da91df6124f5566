//! Edges between the eye's walk and a particle's, and what each path counts for.
use durer_core::{math::Vector3, spectrum::Spectrum};

use super::{
    super::vertices::{End, Particle, Vertex, towards},
    eye::EyeWalk,
    weight::{Densities, Edges},
};
use crate::{
    Contribution, Splat,
    probe::{Choice, ChosenBy, Probe},
};

impl<'a, P: Probe> EyeWalk<'a, P> {
    /// Joins the particle's vertices to the camera.
    pub(super) fn splat(&mut self, id: P::Id, out: &mut Contribution) {
        let Some(particle) = self.particle.filter(|_| self.walk.cx.scene.view.is_connectible()) else {
            return;
        };
        for index in 0..particle.vertices.len() {
            let s = particle.vertices[index].order + 2;
            if self.own.ways.weight(s, 1, || 1.0) == 0.0 {
                continue;
            }
            let Some(sighting) = self.walk.sighting(particle, index, id) else { continue };
            let share = || {
                let vertex = &particle.vertices[index];
                let cos = vertex.cos(sighting.d);
                let mut densities =
                    self.light_part(particle, index, (sighting.d, sighting.seen.importance * cos));
                densities.is_seen = true;
                densities.share(s)
            };
            let weight = self.own.ways.weight(s, 1, share);
            out.splats.push(Splat { radiance: sighting.splat.radiance * weight, ..sighting.splat });
        }
    }

    /// Adds what the particle's vertices send to a vertex of the eye's walk.
    pub(super) fn join(
        &mut self,
        vertex: &Vertex<'a>,
        there: f32,
        (id, radiance): (P::Id, Spectrum),
    ) -> Spectrum {
        let Some(particle) = self.particle.filter(|_| vertex.is_connectible()) else { return radiance };
        let t = self.vertices.len() + 2;
        let mut sum = radiance;
        for index in 0..particle.vertices.len() {
            let s = particle.vertices[index].order + 2;
            // Bounces: all vertices but the ends.
            if s + t - 2 > self.own.rules.max_depth as usize {
                break;
            }
            if self.own.ways.weight(s, t, || 1.0) == 0.0 {
                continue;
            }
            sum += self.edge(vertex, there, (particle, index), id);
        }
        sum
    }

    /// What one vertex of the particle sends to one of the eye's walk, by the share of this edge.
    fn edge(
        &mut self,
        vertex: &Vertex<'a>,
        there: f32,
        (particle, index): (&Particle<'_>, usize),
        id: P::Id,
    ) -> Spectrum {
        let other = &particle.vertices[index];
        if !other.is_connectible() {
            return Spectrum::BLACK;
        }
        let (d, distance) = towards(vertex.p, other.p);
        let basis = &self.walk.cx.basis;
        let (f, cos) = vertex.seen(basis, d, false);
        if f.is_black() {
            return Spectrum::BLACK;
        }
        let is_first = other.order == 0 && particle.end.is_sharp();
        let mut sent = other.sent(basis, -d, is_first);
        if vertex.path.is_collapsed && other.path.is_collapsed {
            // Both parts count their one wavelength for all four: once is enough.
            sent = sent * 0.25;
        }
        let seen = f * (other.cos(d) * cos * there / (distance * distance));
        if sent.is_black() || !(seen * sent).is_finite() {
            return Spectrum::BLACK;
        }
        let t = self.vertices.len() + 2;
        let share =
            self.own.ways.weight(other.order + 2, t, || self.share_of_edge(vertex, (particle, index), d));
        if P::RECORDS {
            self.walk.probe.chosen(&Choice {
                by: ChosenBy::Joined,
                f: Some(f * there),
                cos: Some(cos),
                pdf: Some(vertex.pdf(vertex.wo(), d)),
                other_pdf: Some(other.pdf(other.wo(), -d)),
                mis: Some(share),
                ..Choice::sharp()
            });
        }
        let weight = seen * share;
        weight * self.walk.joint(vertex, (other.beside(-d), d), (weight, sent), id)
    }

    /// The densities of a particle's vertices up to one, and of the light, where the path goes on in direction `d`; `met` is
    /// the density with which a walk from there comes to that vertex.
    fn light_part(&self, particle: &Particle, index: usize, (d, met): (Vector3, f32)) -> Densities {
        let last = &particle.vertices[index];
        let back = last.pdf(d, last.wo());
        let mut way = particle.way(index).chain([last]);
        let first = way.next().unwrap_or(last);
        let p = last.p;
        let (to_light, from_first) = match way.next() {
            None => (first.wo(), d),
            // It comes from the other side.
            Some(second) if second.below.is_walked => (first.wo(), -first.wo()),
            Some(second) => (first.wo(), -second.wo()),
        };
        let asked = particle.end.asked(self.walk.cx, (first, from_first), to_light, self.own.light_sampler);
        let end = match last.order {
            0 if last.below.is_walked => last.back_below(back),
            0 => particle.end.by_area(back, p),
            _ => particle.other,
        };
        let room = last.order + 2 + self.vertices.len();
        let mut densities = Densities::of_light([particle.own, end], asked, particle.end.is_met(), room);
        for vertex in particle.way(index) {
            let other = match last.order - vertex.order {
                1 => last.back_to(vertex, back),
                _ => vertex.other,
            };
            densities.add(vertex.own, other, Edges::of(vertex.is_sharp, vertex.below.is_walked));
        }
        densities.add(last.own, met, Edges::of(false, last.below.is_walked));
        densities
    }

    /// Adds the vertices of the eye's walk so far, of which the last is met from the light with density `met`, by a walk
    /// that comes from the vertex after it, which may be one below a surface.
    fn add_eye_part(&self, densities: &mut Densities, met: Option<f32>, mut is_walked: bool) {
        let count = self.vertices.len();
        for (i, vertex) in self.vertices.iter().enumerate().rev() {
            let other = if i + 1 == count { met.unwrap_or(vertex.other) } else { vertex.other };
            densities.add(other, vertex.own, Edges::of(vertex.is_sharp, is_walked));
            is_walked = vertex.below.is_walked;
        }
        densities.is_seen = self.walk.cx.scene.view.is_connectible();
    }

    /// The same before a vertex to which a walk from the light comes from direction `d`.
    fn add_before(&self, densities: &mut Densities, (vertex, d): (&Vertex<'_>, Vector3)) {
        let back = |before: &Vertex<'_>| vertex.back_to(before, vertex.pdf(d, vertex.wo()));
        self.add_eye_part(densities, self.vertices.last().map(back), vertex.below.is_walked);
    }

    fn share_of_edge(
        &self,
        vertex: &Vertex<'_>,
        (particle, index): (&Particle<'_>, usize),
        d: Vector3,
    ) -> f32 {
        let other = &particle.vertices[index];
        let (here, there) = (vertex.p, other.p);
        let met = other.by_area(vertex.pdf(vertex.wo(), d), here);
        let mut densities = self.light_part(particle, index, (-d, met));
        let reached = vertex.by_area(other.pdf(other.wo(), -d), there);
        densities.add(reached, vertex.own, Edges::Both);
        self.add_before(&mut densities, (vertex, d));
        densities.share(other.order + 2)
    }

    /// The share of asking for a light, of which direction `d` leads there; with the chance of the light and, of lights with
    /// extent, the density of the direction.
    pub(super) fn share_of_asked(
        &self,
        end: &End,
        vertex: &Vertex<'a>,
        d: Vector3,
        (chance, pdf): (f32, Option<f32>),
    ) -> f32 {
        let here = vertex.p;
        let asked = chance * pdf.map_or(1.0, |pdf| end.by_area(pdf, here));
        let met = end.by_area(vertex.pdf(vertex.wo(), d), here);
        let [begun, reached] = end.begun(self.walk.cx, vertex, d);
        let room = 1 + self.vertices.len();
        let mut densities = Densities::of_light([begun, met], asked, end.is_met(), room);
        densities.add(reached, vertex.own, Edges::Both);
        self.add_before(&mut densities, (vertex, d));
        densities.share(1)
    }

    /// The share of having met a light, in direction `d`, which the walk comes to with density `own`.
    pub(super) fn share_of_met(&self, end: &End, d: Vector3, (own, is_walked): (f32, bool)) -> f32 {
        let Some(vertex) = self.vertices.last() else { return 1.0 };
        let [begun, reached] = match is_walked {
            true => end.begun_below(self.walk.cx, -d, vertex.time()),
            false => end.begun(self.walk.cx, vertex, d),
        };
        let asked = match vertex.is_sharp || is_walked {
            true => 1.0,
            false => end.asked(self.walk.cx, (vertex, vertex.wo()), d, self.own.light_sampler),
        };
        let mut densities = Densities::of_light([begun, own], asked, true, self.vertices.len());
        // The vertex itself is reached from the light; those before it by its own scattering.
        self.add_eye_part(&mut densities, Some(reached), is_walked);
        densities.share(0)
    }
}
