//! The eye's walk, and what arrives at each of its vertices.
use durer_core::{sampling::Dim, spectrum::Spectrum};
use durer_model::{
    bsdf::BranchKind,
    light::{LightCx, LightHit, Source},
};

use super::{
    super::{
        shading::LIGHT_BRANCH,
        vertices::{End, Flight, Particle, SCATTER_BRANCH, Vertex, chosen, kept, scattered_on, straight_on},
        walk::{Parts, Walk},
    },
    Bidirectional,
};
use crate::{
    Contribution, PathRay, Value,
    probe::{Choice, ChosenBy, Limit, Probe, RandomNumbers, RayKind, StopReason},
};

/// A ray of the eye's walk.
struct Link<Id> {
    id: Id,
    /// All that arrives there but by the next ray.
    radiance: Spectrum,
    /// What the next ray's radiance is multiplied with.
    weight: Spectrum,
}

/// A sample on its way.
pub(super) struct EyeWalk<'a, P: Probe> {
    pub(super) own: &'a Bidirectional,
    pub(super) walk: Walk<'a, P>,
    pub(super) particle: Option<&'a Particle<'a>>,
    /// Where the eye's walk scattered so far.
    pub(super) vertices: Vec<Vertex<'a>>,
}

/// What a ray leaves to do: what arrives, and the next ray.
struct Step {
    radiance: Spectrum,
    next: Option<(PathRay, RayKind)>,
}

impl Step {
    fn end(radiance: Spectrum) -> Self {
        Self { radiance, next: None }
    }
}

impl<'a, P: Probe> EyeWalk<'a, P> {
    /// Follows an eye ray; radiance is summed from the far end, as the recorder folds it.
    pub(super) fn trace(&mut self, ray: PathRay, first: P::Id, out: &mut Contribution) {
        let mut links: Vec<Link<P::Id>> = Vec::new();
        let mut flight = Flight::Camera;
        let mut next = Some((ray, RayKind::Eye));
        while let Some((ray, kind)) = next {
            let id = match links.last_mut() {
                None => first,
                Some(link) => {
                    link.weight = ray.weight;
                    self.walk.probe.ray(link.id, &ray, kind)
                }
            };
            let step = self.step(ray, &mut flight, id);
            links.push(Link { id, radiance: step.radiance, weight: Spectrum::BLACK });
            next = step.next;
        }
        let mut radiance = Spectrum::BLACK;
        for (place, link) in links.iter().enumerate().rev() {
            radiance = match place + 1 == links.len() {
                true => link.radiance,
                false => link.radiance + link.weight * radiance,
            };
            self.walk.probe.result(link.id, radiance);
        }
        out.value = Value::Radiance(radiance);
    }

    fn step(&mut self, mut ray: PathRay, flight: &mut Flight, id: P::Id) -> Step {
        if let Some(reason) = self.walk.reason_to_stop(&ray) {
            if P::RECORDS {
                self.walk.report_limit(&ray, reason, id);
            }
            self.walk.probe.stop(id, reason, ray.throughput);
            return Step::end(Spectrum::BLACK);
        }
        self.walk.rays += 1;
        let Some(hit) = self.walk.cx.scene.closest(self.walk.cx, &ray.ray, self.walk.probe, id) else {
            return Step::end(self.escape(&ray, *flight, id));
        };
        let met =
            self.walk.meet(&mut ray, &hit, |walk, s| walk.probe.surface(id, s.object, &hit, &s.surface));
        let Some((mut s, crossing, left)) = met else {
            return Step { radiance: Spectrum::BLACK, next: Some((ray, RayKind::Passing)) };
        };
        s.bsdf.dim(left);
        let from = self.vertices.last().map_or(ray.from, |before| before.s.surface.p);
        let own = self.walk.density(*flight, from, &s);
        let vertex =
            Vertex { s, crossing, arriving: Spectrum::ONE, own, other: 0.0, is_sharp: false, path: ray };
        self.shade(vertex, left, flight, id)
    }

    fn shade(&mut self, mut vertex: Vertex<'a>, left: Spectrum, flight: &mut Flight, id: P::Id) -> Step {
        let emission = left * self.met(&vertex, id);
        if P::RECORDS {
            let black = Spectrum::BLACK;
            let parts = Parts { arrived: left, emission, ambient: black, blurred_sky: black };
            self.walk.report_shaded(&vertex.path, (&vertex.s, &vertex.crossing), &parts, id);
        }
        self.walk.probe.local(id, emission);
        let ray = vertex.path;
        let sampler = ray.sampler.fork(SCATTER_BRANCH);
        let bsdf = &vertex.s.bsdf;
        let choice = if bsdf.has_choice() { sampler.d1(Dim::Lobe) } else { 0.0 };
        let scattered = bsdf.scatter(vertex.s.wo_local, choice, sampler.d2(Dim::Scatter));
        if let Some(through) = scattered.filter(|scattered| scattered.passes) {
            let next = straight_on(&ray, (&vertex.s, &vertex.crossing), through.weight);
            if P::RECORDS {
                self.walk.probe.chosen(&chosen(&vertex.s, &through, (&sampler, 0.0)));
            }
            return Step { radiance: emission, next: Some((next, RayKind::sharp(BranchKind::Transmission))) };
        }
        // Of what is there in part only the rest was met.
        let there = 1.0 / (1.0 - bsdf.passing_chance(vertex.s.wo_local));
        let radiance = self.light(&vertex, there, (id, emission));
        let radiance = self.join(&vertex, there, (id, radiance));
        let Some(scattered) = scattered else {
            let reason = match P::ACTIVE && vertex.s.bsdf.is_black() {
                true => StopReason::Absorbed,
                false => StopReason::OpaqueNoChildren,
            };
            self.walk.probe.stop(id, reason, Spectrum::BLACK);
            return Step::end(radiance);
        };
        let d = vertex.s.frame.to_world(scattered.wi);
        vertex.is_sharp = scattered.pdf.is_none();
        let [pdf, back] = vertex.there_and_back(scattered.pdf, d);
        *flight = Flight::Direction(pdf);
        if let Some(before) = self.vertices.last_mut() {
            before.other = before.by_area(back, vertex.s.surface.p);
        }
        let mut child = scattered_on(&ray, (&vertex.s, &vertex.crossing), &scattered, scattered.weight);
        let kind = match scattered.pdf {
            None => RayKind::sharp(scattered.kind),
            Some(_) => RayKind::drawn(scattered.kind),
        };
        let is_sure = child.depth <= self.own.roulette_depth;
        let kept = if is_sure { 1.0 } else { kept(child.throughput.max() / child.compression) };
        let u = if kept < 1.0 { sampler.d1(Dim::Roulette) } else { 0.0 };
        let lives = u < kept;
        if P::RECORDS {
            let other = vertex.pdf(d, vertex.s.wo);
            let told = chosen(&vertex.s, &scattered, (&sampler, other));
            self.walk.probe.chosen(&Choice { kept: if lives { kept } else { 1.0 }, ..told });
        }
        self.vertices.push(vertex);
        if !lives {
            if P::ACTIVE {
                let refused = self.walk.probe.ray(id, &child, kind);
                self.walk.probe.limit(refused, Limit { value: u, threshold: kept });
                self.walk.probe.stop(refused, StopReason::Roulette, Spectrum::BLACK);
                self.walk.probe.result(refused, Spectrum::BLACK);
            }
            return Step::end(radiance);
        }
        child.weight = child.weight / kept;
        child.throughput = ray.throughput * child.weight;
        Step { radiance, next: Some((child, kind)) }
    }

    /// What the surface that was met sends along the ray, by the share of having met it.
    fn met(&mut self, vertex: &Vertex, id: P::Id) -> Spectrum {
        let t = self.vertices.len() + 2;
        let own = self.own.ways.weight(0, t, || 1.0);
        let Some(lamp) = vertex.s.lamp.filter(|lamp| !lamp.radiance.is_black()) else {
            return vertex.s.emission * own;
        };
        let LightHit { p, .. } = lamp.hit;
        let end = End { light: lamp.light as usize, source: Source::Surface(lamp.hit), p };
        let share = self.own.ways.weight(0, t, || self.share_of_met(&end, -vertex.s.wo, vertex.own));
        if P::RECORDS {
            let other = self.vertices.last().map_or(0.0, |before| {
                let lit = before.lit(before.s.wo);
                let chance = self.walk.cx.scene.light_chance(self.own.light_sampler, &lit, end.light);
                chance * vertex.s.lamp_pdf(self.walk.cx, &lamp, lit.p)
            });
            self.walk.probe.met_light(id, other, share);
        }
        vertex.s.emission * own + lamp.radiance * share
    }

    /// What surrounds the scene sends along a ray that left it.
    fn escape(&mut self, ray: &PathRay, flight: Flight, id: P::Id) -> Spectrum {
        let cx = self.walk.cx;
        let t = self.vertices.len() + 2;
        let own = match flight {
            Flight::Direction(pdf) => pdf,
            _ => 1.0,
        };
        let mut sky = Spectrum::BLACK;
        for &light in cx.scene.far.iter() {
            let radiance = cx.scene.lights[light as usize].escaped(cx.basis, ray.ray.d);
            if !radiance.is_black() {
                let end = End { light: light as usize, source: Source::Far, p: ray.from };
                sky += radiance * self.own.ways.weight(0, t, || self.share_of_met(&end, ray.ray.d, own));
            }
        }
        let sky = self.walk.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY) * sky;
        self.walk.probe.local(id, sky);
        self.walk.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }

    /// Adds the light of one lamp that a vertex asks for.
    fn light(&mut self, vertex: &Vertex, there: f32, (id, radiance): (P::Id, Spectrum)) -> Spectrum {
        let ray = &vertex.path;
        if ray.depth >= self.own.rules.max_depth || !vertex.is_connectible() {
            return radiance;
        }
        let scene = self.walk.cx.scene;
        let choosing = ray.sampler.fork(LIGHT_BRANCH);
        let lit = vertex.lit(vertex.s.wo);
        let chosen = scene.choose_light(self.own.light_sampler, &lit, || choosing.d1(Dim::LightChoice));
        let Some(chosen) = chosen else { return radiance };
        let asked = LightCx { basis: self.walk.cx.basis, time: vertex.s.time };
        let Some(sample) = scene.lights[chosen.light].sample(&asked, lit.p, &choosing) else {
            return radiance;
        };
        let wi = vertex.s.frame.to_local(sample.wi);
        let f = match sample.pdf {
            None => vertex.s.bsdf.eval_radiance(vertex.s.wo_local, wi),
            Some(_) => vertex.s.bsdf.eval_with_pdf(vertex.s.wo_local, wi).0,
        };
        if f.is_black() {
            return radiance;
        }
        let end = End::sampled(chosen.light, &sample, vertex);
        let t = self.vertices.len() + 2;
        let share = || self.share_of_asked(&end, vertex, sample.wi, (chosen.chance, sample.pdf));
        let share = self.own.ways.weight(1, t, share);
        let weight = f * (wi.z.abs() * share * there / chosen.chance);
        if weight.is_black() {
            return radiance;
        }
        if P::RECORDS {
            let u = choosing.d2(Dim::Light);
            self.walk.probe.chosen(&Choice {
                by: ChosenBy::Light,
                chance: chosen.chance,
                light_choice: Some(RandomNumbers::one(Dim::LightChoice, choosing.d1(Dim::LightChoice))),
                f: Some(f * there),
                cos: Some(wi.z.abs()),
                pdf: sample.pdf,
                other_pdf: sample.pdf.map(|_| vertex.pdf(vertex.s.wo, sample.wi)),
                mis: Some(share),
                random: sample.pdf.map(|_| RandomNumbers::two(Dim::Light, u.to_array())),
                ..Choice::sharp()
            });
        }
        let light = self.walk.shadow(ray, (&vertex.s, &vertex.crossing), chosen.light, weight, &sample, id);
        radiance + weight * light
    }
}
