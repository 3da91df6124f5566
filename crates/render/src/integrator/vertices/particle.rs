//! The way of a particle: from a light through the scene, and from where it scatters to the camera.
use durer_core::{
    math::{Point3, Ray, Vector3},
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::Scattered,
    light::{Emitted, LightCx, Source},
};

use super::{
    super::{
        shading::Shading,
        walk::{Parts, Walk},
    },
    EMISSION_BRANCH, End, Flight, LENS_BRANCH, SCATTER_BRANCH, Vertex, kept, scattered_on, straight_on,
    towards,
};
use crate::{
    PathRay, Sighted, Splat, media,
    probe::{Choice, ChosenBy, Probe, RandomNumbers, RayKind, StopReason},
};

/// Surfaces passed in a row at most.
const MOST_PASSED: u32 = 1000;

/// How long particles go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Stamina {
    /// Vertices at most.
    pub(in super::super) vertices: u32,
    /// Of those, before chance may end the way.
    pub(in super::super) sure: u32,
}

/// A particle's way.
pub(in super::super) struct Particle<'a> {
    /// Where it began.
    pub(in super::super) end: End,
    /// Density of the place where it began, by area (of far light of its direction), with the chance of the light.
    pub(in super::super) own: f32,
    /// Density with which a walk from the first vertex comes there.
    pub(in super::super) other: f32,
    /// Where it scattered.
    pub(in super::super) vertices: Vec<Vertex<'a>>,
}

/// A vertex as the camera sees it.
pub(in super::super) struct Sighting {
    /// Unit direction from the vertex to the lens.
    pub(in super::super) d: Vector3,
    pub(in super::super) seen: Sighted,
    /// Radiance for the picture, not yet weighed.
    pub(in super::super) splat: Splat,
}

impl<'a, P: Probe> Walk<'a, P> {
    /// Sends a particle at the moment of an eye ray, by numbers of its sample. `None` if no light sends any, or what was
    /// chosen is black.
    pub(in super::super) fn particle(
        &mut self,
        eye: &PathRay,
        stamina: Stamina,
        id: P::Id,
    ) -> Option<Particle<'a>> {
        let scene = self.cx.scene;
        let sampler = eye.sampler.apart(EMISSION_BRANCH);
        let chosen = scene.choose_emitter(|| sampler.d1(Dim::LightChoice))?;
        let time = eye.ray.time;
        let asked = LightCx { basis: self.cx.basis, time };
        let u = [sampler.d2(Dim::Light), sampler.d2(Dim::Scatter)];
        let begun = scene.lights[chosen.light].emit(&asked, &scene.extent, u)?;
        let (own, flight) = match begun.source {
            Source::Point | Source::Surface(_) => (begun.pdf_place, Flight::Direction(begun.pdf_direction)),
            Source::Parallel | Source::Far => (begun.pdf_direction, Flight::Place(begun.pdf_place)),
        };
        let p = match begun.source {
            Source::Surface(hit) => hit.p,
            _ => begun.p,
        };
        let end = End { light: chosen.light, source: begun.source, p };
        let mut particle = Particle { end, own: own * chosen.chance, other: 0.0, vertices: Vec::new() };
        let ray = self.first_ray(eye, &begun, (time, chosen.chance));
        if P::RECORDS {
            self.probe.chosen(&Choice {
                by: ChosenBy::Light,
                chance: chosen.chance,
                pdf: Some(begun.pdf_direction),
                random: Some(RandomNumbers::two(Dim::Scatter, u[1].to_array())),
                ..Choice::sharp()
            });
        }
        if ray.throughput.is_finite() {
            self.follow_particle(ray, (flight, p), stamina, &mut particle, id);
        }
        Some(particle)
    }

    fn first_ray(&self, eye: &PathRay, begun: &Emitted, (time, chance): (f32, f32)) -> PathRay {
        let ray = Ray { time, ..Ray::new(begun.p, begun.d) };
        let media = match begun.source {
            Source::Point | Source::Surface(_) => media::around(self.cx.scene, &ray),
            Source::Parallel | Source::Far => Default::default(),
        };
        let power = begun.power() / chance;
        let sampler = eye.sampler.apart(EMISSION_BRANCH);
        // Not the first depth: that is for what is seen directly.
        PathRay { media, weight: power, throughput: power, depth: 1, ..PathRay::eye(ray, sampler) }
    }

    fn follow_particle(
        &mut self,
        mut ray: PathRay,
        (mut flight, mut from): (Flight, Point3),
        stamina: Stamina,
        particle: &mut Particle<'a>,
        mut parent: P::Id,
    ) {
        let start = ray.throughput.max();
        while (particle.vertices.len() as u32) < stamina.vertices && ray.passed <= MOST_PASSED {
            self.rays += 1;
            let id = self.announce(&ray, parent);
            parent = id;
            let Some(hit) = self.cx.scene.closest_in_the_way(self.cx, &ray.ray, false, (self.probe, id))
            else {
                self.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
                return;
            };
            let before = ray.media;
            let met = self.meet(&mut ray, &hit, |walk, s| walk.probe.surface(id, s.object, &hit, &s.surface));
            let Some((s, crossing, left)) = met else { continue };
            if P::RECORDS {
                let black = Spectrum::BLACK;
                let parts = Parts { arrived: left, emission: black, ambient: black, blurred_sky: black };
                self.report_shaded(&PathRay { media: before, ..ray }, (&s, &crossing), &parts, id);
            }
            // Whoever looks at the back of something one-sided does not see it.
            if self.cx.scene.material(s.object).is_one_sided() && !s.surface.is_outside(s.wo) {
                self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
                return;
            }
            let sampler = ray.sampler.fork(SCATTER_BRANCH);
            let choice = if s.bsdf.has_choice() { sampler.d1(Dim::Lobe) } else { 0.0 };
            let scattered = s.bsdf.scatter(s.wo_local, choice, sampler.d2(Dim::Scatter));
            if let Some(through) = scattered.filter(|scattered| scattered.passes) {
                ray = straight_on(&ray, (&s, &crossing), left * through.weight);
                continue;
            }
            let own = self.density(flight, from, &s);
            let there = 1.0 - s.bsdf.passing_chance(s.wo_local);
            let arriving = ray.throughput * left / there;
            from = s.surface.p;
            let mut vertex = Vertex { s, crossing, arriving, own, other: 0.0, is_sharp: false, path: ray };
            let next = scattered.and_then(|scattered| {
                let weight = adjoint(&vertex.s, &scattered);
                let d = vertex.s.frame.to_world(scattered.wi);
                vertex.is_sharp = scattered.pdf.is_none();
                let [pdf, back] = vertex.there_and_back(scattered.pdf, d);
                flight = Flight::Direction(pdf);
                particle.came_back(&vertex, back);
                (!weight.is_black() && weight.is_finite())
                    .then(|| scattered_on(&ray, (&vertex.s, &vertex.crossing), &scattered, left * weight))
            });
            if let Some(scattered) = scattered.filter(|_| P::RECORDS) {
                let other = vertex.pdf(vertex.s.frame.to_world(scattered.wi), vertex.s.wo);
                self.probe.chosen(&chosen(&vertex.s, &scattered, (&sampler, other)));
            }
            particle.vertices.push(vertex);
            let Some(child) = next else {
                self.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
                return;
            };
            ray = child;
            if particle.vertices.len() as u32 > stamina.sure {
                let kept = kept(ray.throughput.max() / start);
                if kept < 1.0 && sampler.d1(Dim::Roulette) >= kept {
                    self.probe.stop(id, StopReason::Roulette, Spectrum::BLACK);
                    return;
                }
                ray.throughput = ray.throughput / kept;
            }
        }
    }

    /// Tells of a part of the way, which brings nothing to the pixel by itself.
    fn announce(&mut self, ray: &PathRay, parent: P::Id) -> P::Id {
        let black = Spectrum::BLACK;
        let id =
            self.probe.ray(parent, &PathRay { weight: black, throughput: black, ..*ray }, RayKind::Photon);
        self.probe.result(id, black);
        id
    }

    /// How the camera sees a vertex of a particle, and what it brings there; `None` if it does not, or nothing.
    pub(in super::super) fn sighting(
        &mut self,
        particle: &Particle,
        index: usize,
        id: P::Id,
    ) -> Option<Sighting> {
        let vertex = &particle.vertices[index];
        if !vertex.is_connectible() {
            return None;
        }
        let view = &self.cx.scene.view;
        let p = vertex.s.surface.p;
        let lens = vertex.path.sampler.fork(LENS_BRANCH).d2(Dim::Lens);
        let seen = view.sees(p, lens, vertex.s.time)?;
        let film = seen.film;
        let reach = view.filter.radius();
        let is_near = |x: f32, size: u32, reach: f32| x >= -reach && x <= size as f32 + reach;
        if !is_near(film.x, view.width, reach[0]) || !is_near(film.y, view.height, reach[1]) {
            return None;
        }
        let (d, _) = towards(p, seen.from);
        let is_first = index == 0 && particle.end.is_sharp();
        let cos = vertex.s.surface.n_g.dot(d).abs();
        let radiance = vertex.sent(d, is_first) * (cos * seen.importance);
        if radiance.is_black() {
            return None;
        }
        if P::RECORDS {
            self.probe.chosen(&Choice { by: ChosenBy::Joined, ..Choice::sharp() });
        }
        let radiance = self.joint(vertex, (seen.from, d), (Spectrum::BLACK, radiance), id);
        (!radiance.is_black()).then_some(Sighting { d, seen, splat: Splat { film, radiance } })
    }
}

impl Particle<'_> {
    /// Notes with which density a walk comes from a vertex to what is before it, by that of the direction.
    fn came_back(&mut self, from: &Vertex, pdf: f32) {
        let p = from.s.surface.p;
        match self.vertices.last_mut() {
            Some(before) => before.other = before.by_area(pdf, p),
            None => self.other = self.end.by_area(pdf, p),
        }
    }
}

/// How the direction came about that a walk goes on in; `other` is the density of the way back.
pub(in super::super) fn chosen(
    s: &Shading,
    scattered: &Scattered,
    (sampler, other): (&Sampler, f32),
) -> Choice {
    let cos = scattered.wi.z.abs();
    let u = sampler.d2(Dim::Scatter);
    let spread = scattered.pdf.is_some();
    Choice {
        by: if spread { ChosenBy::Lobe } else { ChosenBy::Sharp },
        lobe: s.bsdf.lobes().nth(scattered.lobe).map(|lobe| lobe.name()),
        f: scattered.pdf.filter(|_| cos > 0.0).map(|pdf| scattered.weight * (pdf / cos)),
        cos: spread.then_some(cos),
        pdf: scattered.pdf,
        other_pdf: spread.then_some(other),
        chance: if spread { 1.0 } else { scattered.chance },
        random: spread.then(|| RandomNumbers::two(Dim::Scatter, u.to_array())),
        ..Choice::sharp()
    }
}

/// What a particle is multiplied with that goes on in a scattered direction.
fn adjoint(s: &Shading, scattered: &Scattered) -> Spectrum {
    let d = s.frame.to_world(scattered.wi);
    let [before, after] = [s.wo, d].map(|w| s.surface.n_g.dot(w).abs());
    match scattered.pdf {
        Some(pdf) => {
            let f = s.bsdf.eval_with_pdf(scattered.wi, s.wo_local).0;
            f * (s.wo_local.z.abs() / before * after / pdf)
        }
        None => {
            let tilt = s.wo_local.z.abs() * after / (before * scattered.wi.z.abs());
            scattered.weight * (tilt / scattered.compression)
        }
    }
}
