//! The way of a particle: from a light through the scene, and from where it scatters to the camera.
use durer_accel::Hit;
use durer_core::{
    math::{Point3, Vector3},
    sampling::Dim,
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::{BranchKind, Scattered},
    medium::{self, End},
};

use super::{
    super::{
        below::{Descent, descend},
        shading::Shading,
        walk::{Parts, Walk},
    },
    Asked, Flight, LENS_BRANCH, Onward, Place, SCATTER_BRANCH, Vertex,
    begun::Begun,
    below::tilt,
    end, kept, straight_on, towards,
};
use crate::{
    Below, PathRay, Sighted, Splat,
    media::Crossing,
    probe::{Choice, ChosenBy, Probe, RayKind, StopReason},
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

impl Stamina {
    /// Room for the vertices of most walks.
    ///
    /// PERF: asks for memory once (bench render).
    pub(in super::super) fn room<'a>(&self) -> Vec<Vertex<'a>> {
        Vec::with_capacity(self.vertices.min(8) as usize)
    }
}

/// A particle's way.
pub(in super::super) struct Particle<'a> {
    /// Where it began.
    pub(in super::super) end: end::End,
    /// Density of the place where it began, by area (by volume where a medium glows, of far light of its direction), with the
    /// chance of the light.
    pub(in super::super) own: f32,
    /// Density with which a walk from the first vertex comes there.
    pub(in super::super) other: f32,
    /// Where it scattered.
    pub(in super::super) vertices: Vec<Vertex<'a>>,
    /// How many of them are on its way: all but those where a walk below a surface went on below.
    pub(in super::super) length: usize,
}

/// What a ray of a particle led to.
#[allow(clippy::large_enum_variant, reason = "made once for each ray, and never kept")]
enum Met {
    /// Another vertex, and how it goes on from there if it does.
    Scattered(Option<Onward>),
    /// Nothing: it goes on behind.
    Passed,
    /// Its end.
    Ended,
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
        let begun = self.begin(eye, stamina)?;
        if P::RECORDS {
            self.probe.chosen(&begun.told);
        }
        let Begun { mut particle, ray, flight, .. } = begun;
        if ray.throughput.is_finite() {
            self.follow_particle(ray, flight, stamina, &mut particle, id);
        }
        Some(particle)
    }

    fn follow_particle(
        &mut self,
        mut ray: PathRay,
        mut flight: Flight,
        stamina: Stamina,
        particle: &mut Particle<'a>,
        mut parent: P::Id,
    ) {
        let start = ray.throughput.max();
        while (particle.length as u32) < stamina.vertices && ray.passed <= MOST_PASSED {
            self.rays += 1;
            let id = self.announce(&ray, parent);
            parent = id;
            let onward = match self.particle_meets(&mut ray, &mut flight, particle, id) {
                Met::Scattered(onward) => onward,
                Met::Passed => continue,
                Met::Ended => return,
            };
            let Some(Onward { child, told, .. }) = onward.filter(Onward::brings_something) else {
                self.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
                return;
            };
            if let Some(told) = told {
                self.probe.chosen(&told);
            }
            let sampler = ray.sampler.fork(SCATTER_BRANCH);
            ray = child;
            if particle.length as u32 > stamina.sure || ray.below.is_some() {
                let kept = kept(ray.throughput.max() / start);
                if kept < 1.0 && sampler.d1(Dim::Roulette) >= kept {
                    self.probe.stop(id, StopReason::Roulette, Spectrum::BLACK);
                    return;
                }
                ray.throughput = ray.throughput / kept;
            }
        }
    }

    /// Follows a particle to what scatters it next.
    fn particle_meets(
        &mut self,
        ray: &mut PathRay,
        flight: &mut Flight,
        particle: &mut Particle<'a>,
        id: P::Id,
    ) -> Met {
        let cx = self.cx;
        let hit = cx.scene.closest_in_the_way(cx, &ray.ray, self.heeds_media, (self.probe, id));
        let mut passed = Spectrum::ONE;
        if !self.begin_below(ray, hit.as_ref(), (particle, flight)) {
            self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
            return Met::Ended;
        }
        if let Some(below) = ray.below {
            if below.rays > Below::MOST_RAYS {
                self.probe.stop(id, StopReason::DepthLimit, Spectrum::BLACK);
                return Met::Ended;
            }
            let flown = self.fly_below(ray, (&below, hit.as_ref()), id);
            if let End::Scattered(t) = flown.end {
                if flight.asked() == Asked::ToPass {
                    self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
                    return Met::Ended;
                }
                *flight = flight.asking(Asked::Nothing);
                return Met::Scattered(Some(self.walk_on(ray, &below, (t, flown.weight))));
            }
            passed = flown.weight;
        } else if let Some((floated, phase)) = self.float(ray, hit.map_or(f32::INFINITY, |hit| hit.t)) {
            if P::RECORDS {
                // What the medium sends out is seen from the eye.
                self.report_floating(ray, &medium::Flight { sent: Spectrum::BLACK, ..floated }, id);
            }
            if let End::Scattered(t) = floated.end {
                let left = self.arriving(&ray.media, ray.from, &ray.ray, t) * floated.weight;
                let (vertex, onward) = self.deflected(ray, (phase, t), left);
                let own = self.density(*flight, (particle.last(), &ray.ray), (vertex.p, 1.0));
                if !own.is_finite() {
                    // A way of no length, by rounding: it has no density.
                    self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
                    return Met::Ended;
                }
                let vertex = Vertex { arriving: ray.throughput * left, own, ..vertex };
                return particle.add(vertex, (Some(onward.skewed(ray, phase)), Asked::Nothing), flight);
            }
            passed = floated.weight;
        }
        let Some(hit) = hit else {
            self.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
            return Met::Ended;
        };
        let before = ray.media;
        let announce = |walk: &mut Self, s: &Shading| walk.probe.surface(id, s.object, &hit, &s.surface);
        let Some((s, crossing, left)) = self.meet(ray, (&hit, passed), announce) else { return Met::Passed };
        if P::RECORDS {
            let black = Spectrum::BLACK;
            let parts = Parts { arrived: left, emission: black, ambient: black, blurred_sky: black };
            self.report_shaded(&PathRay { media: before, ..*ray }, (&s, &crossing), &parts, id);
        }
        // Whoever looks at the back of something one-sided does not see it.
        if cx.scene.material(s.object).is_one_sided() && !s.surface.is_outside(s.wo) {
            self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
            return Met::Ended;
        }
        self.particle_turns((ray, s, crossing), left, (particle, flight), id)
    }

    /// What becomes of a particle at a surface, before which `left` of it is left.
    fn particle_turns(
        &mut self,
        (ray, mut s, crossing): (&mut PathRay, Shading<'a>, Crossing),
        left: Spectrum,
        (particle, flight): (&mut Particle<'a>, &mut Flight),
        id: P::Id,
    ) -> Met {
        let mut walked = self.walked_at(ray, &crossing);
        walked.is_even = self.descent == Descent::Mirrored && self.leave(ray, &mut s);
        let sampler = ray.sampler.fork(SCATTER_BRANCH);
        let before = flight.asked();
        let parted = self.parted((&s, &crossing.behind), before);
        let real = parted.as_ref().map_or(1.0, |(_, chance)| 1.0 - chance);
        let there = 1.0 - s.bsdf.passing_chance(s.wo_local) * real;
        let scattered = self.particle_scattered((&s, &mut walked), parted, &sampler);
        if let Some((through, ..)) = scattered.filter(|(scattered, ..)| scattered.passes) {
            let mut on = straight_on(ray, (&s, &crossing), left * through.weight);
            if ray.below.is_some() || self.walked_in(&crossing.behind).is_some() {
                if self.descent == Descent::Adjoint {
                    // Light is left to the eye that gets in or out through holes.
                    self.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
                    return Met::Ended;
                }
                descend(self.cx, ray, (&s, &crossing), BranchKind::Transmission, &mut on);
            }
            *ray = on;
            return Met::Passed;
        }
        let arriving = ray.throughput * left / there;
        let is_closed = self.walked_in(&crossing.behind) != self.walked_back_in(&crossing.behind);
        let scattered =
            scattered.filter(|(scattered, ..)| !is_closed || scattered.kind == BranchKind::Reflection);
        let asked = scattered.map_or(Asked::Nothing, |(.., asked)| asked);
        let keeps_side = self.is_walked(&s);
        let onward = scattered.map(|(scattered, weight, _)| {
            let weight = left * weight;
            let mut onward =
                Onward::of::<P>(ray, (&s, &crossing), (&scattered, weight, keeps_side), &sampler);
            if self.descent != Descent::Flat {
                descend(self.cx, ray, (&s, &crossing), scattered.kind, &mut onward.child);
            }
            onward
        });
        let goes_on_below = ray.below.is_some()
            && scattered.is_some_and(|(scattered, ..)| scattered.kind == BranchKind::Reflection);
        if goes_on_below && !s.surface.is_outside(s.wo) && before == Asked::Nothing {
            *flight = flight.asking(asked);
        }
        if before == Asked::ToScatter {
            // It is not to leave yet.
            return if goes_on_below { Met::Scattered(onward) } else { Met::Ended };
        }
        let p = s.surface.p;
        let to = (p, s.surface.n_g.dot(s.wo).abs());
        let own = self.density(*flight, (particle.last(), &ray.ray), to);
        walked.is_glance = goes_on_below;
        let vertex = Vertex::new(Place::Surface(s, crossing), p, arriving, *ray);
        particle.add(Vertex { own, below: walked, ..vertex }, (onward, asked), flight)
    }

    /// Makes the first ray of a particle one of a walk, if it begins in a body that light walks in, as that is where the ray
    /// would meet its surface. False if the particle ends.
    fn begin_below(
        &self,
        ray: &mut PathRay,
        hit: Option<&Hit>,
        (particle, flight): (&Particle<'_>, &mut Flight),
    ) -> bool {
        if ray.below.is_some() || self.walked_in(&ray.media).is_none() {
            return true;
        }
        let is_first = particle.length == 0 && ray.passed == 0;
        let (Some(material), Some(hit), true) = (self.walked_back_in(&ray.media), hit, is_first) else {
            return false;
        };
        ray.below = Below::at(self.cx, material, &self.cx.scene.surface(&ray.ray, hit).1);
        *flight = self.below(*flight, &ray.media, (particle.end.cos(ray.ray.d), Asked::Nothing));
        true
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
        particle: &Particle<'_>,
        index: usize,
        id: P::Id,
    ) -> Option<Sighting> {
        let vertex = &particle.vertices[index];
        if !vertex.is_connectible() {
            return None;
        }
        let view = &self.cx.scene.view;
        let p = vertex.p;
        let lens = vertex.path.sampler.fork(LENS_BRANCH).d2(Dim::Lens);
        let seen = view.sees(p, lens, vertex.time())?;
        let film = seen.film;
        let reach = view.filter.radius();
        let is_near = |x: f32, size: u32, reach: f32| x >= -reach && x <= size as f32 + reach;
        if !is_near(film.x, view.width, reach[0]) || !is_near(film.y, view.height, reach[1]) {
            return None;
        }
        let (d, _) = towards(p, seen.from);
        let is_first = vertex.order == 0 && particle.end.is_sharp();
        let sent = vertex.sent(&self.cx.basis, d, is_first);
        let radiance = sent * (vertex.cos(d) * seen.importance);
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

impl<'a> Particle<'a> {
    /// Where it scattered last on its way, or began.
    fn last(&self) -> Point3 {
        self.way(self.vertices.len()).next_back().map_or(self.end.p, |vertex| vertex.p)
    }

    /// The vertices on its way before the one of this index.
    pub(in super::super) fn way(&self, index: usize) -> impl DoubleEndedIterator<Item = &Vertex<'a>> {
        self.vertices[..index].iter().filter(|vertex| !vertex.below.is_glance)
    }

    /// Adds a vertex, from which it goes `onward` by a new `flight`, of which something is `asked`.
    fn add(
        &mut self,
        mut vertex: Vertex<'a>,
        (onward, asked): (Option<Onward>, Asked),
        flight: &mut Flight,
    ) -> Met {
        vertex.order = self.length;
        if vertex.below.is_glance {
            self.vertices.extend(vertex.is_connectible().then_some(vertex));
            return Met::Scattered(onward);
        }
        if let Some(onward) = &onward {
            let [pdf, back] = vertex.go_on(onward);
            *flight = Flight::Direction(pdf);
            if onward.child.below.is_some() {
                // It goes on where particles do only.
                *flight = flight.below((vertex.cos(onward.child.ray.d), asked));
            }
            self.came_back(&vertex, back);
        }
        self.length += 1;
        self.vertices.push(vertex);
        Met::Scattered(onward)
    }

    /// Notes with which density a walk comes from a vertex to what is before it, by that of the direction.
    fn came_back(&mut self, from: &Vertex<'_>, pdf: f32) {
        let p = from.p;
        match self.vertices.iter_mut().rev().find(|vertex| !vertex.below.is_glance) {
            Some(before) => before.other = from.back_to(before, pdf),
            None if from.below.is_walked => self.other = from.back_below(pdf),
            None => self.other = self.end.by_area(pdf, p),
        }
    }
}

/// What a particle is multiplied with that goes on in a scattered direction.
pub(super) fn adjoint(s: &Shading, scattered: &Scattered) -> Spectrum {
    let d = s.frame.to_world(scattered.wi);
    let [before, after] = [s.wo, d].map(|w| s.surface.n_g.dot(w).abs());
    match scattered.pdf {
        Some(pdf) => {
            let f = s.bsdf.eval_with_pdf(scattered.wi, s.wo_local).0;
            f * (s.wo_local.z.abs() / before * after / pdf)
        }
        None => scattered.weight * (tilt(s, scattered) / scattered.compression),
    }
}
