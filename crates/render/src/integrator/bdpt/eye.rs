//! The eye's walk, and what arrives at each of its vertices.
use durer_core::{math::Point3, sampling::Dim, spectrum::Spectrum};
use durer_model::{
    bsdf::BranchKind,
    light::{LightCx, LightHit, Source},
    medium::{self, Phase},
};

use super::{
    super::{
        below::{Descent, descend},
        shading::{LIGHT_BRANCH, Shading},
        vertices::{
            Asked, End, Flight, Onward, Particle, Place, SCATTER_BRANCH, Vertex, Walked, chosen, kept,
            straight_on,
        },
        walk::{Parts, Walk},
    },
    Bidirectional,
};
use crate::{
    Contribution, PathRay, Value,
    media::Crossing,
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
    /// Where it begins, at the lens.
    pub(super) origin: Point3,
    /// Where it scattered so far.
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
        let cx = self.walk.cx;
        let hit = match self.walk.heeds_media {
            true => cx.scene.closest_boundary(cx, &ray.ray, self.walk.probe, id),
            false => cx.scene.closest(cx, &ray.ray, self.walk.probe, id),
        };
        let (mut passed, mut sent) = (Spectrum::ONE, Spectrum::BLACK);
        let t = hit.map_or(f32::INFINITY, |hit| hit.t);
        if let Some(below) = ray.below {
            let flown = self.walk.fly_below(&mut ray, (&below, hit.as_ref()), id);
            if let medium::End::Scattered(t) = flown.end {
                let onward = self.walk.walk_on(&ray, &below, (t, flown.weight));
                return self.follow(onward, Spectrum::BLACK, ray.throughput, id);
            }
            passed = flown.weight;
        } else if let Some((floated, phase)) = self.walk.float(&mut ray, t) {
            sent = self.glow(&ray, *flight, (floated.sent, t));
            if P::RECORDS {
                self.walk.report_floating(&ray, &medium::Flight { sent, ..floated }, id);
            }
            if let medium::End::Scattered(t) = floated.end {
                return self.deflect(&ray, (phase, t, floated.weight), sent, (flight, id));
            }
            passed = floated.weight;
        }
        let Some(hit) = hit else {
            return Step::end(self.escape(&ray, (passed, sent), *flight, id));
        };
        let met = self.walk.meet(&mut ray, (&hit, passed), |walk, s| {
            walk.probe.surface(id, s.object, &hit, &s.surface);
        });
        let Some((mut s, crossing, left)) = met else {
            self.walk.probe.local(id, sent);
            return Step { radiance: sent, next: Some((ray, RayKind::Passing)) };
        };
        let is_even = self.walk.leave(&ray, &mut s);
        s.bsdf.dim(left);
        let mut walked = self.walk.walked_at(&ray, &crossing);
        walked.is_even = is_even;
        self.shade((ray, s, crossing), (left, sent, walked), (flight, id))
    }

    /// What happens at a surface, before which the medium has `sent` light.
    fn shade(
        &mut self,
        (ray, s, crossing): (PathRay, Shading<'a>, Crossing),
        (left, sent, mut walked): (Spectrum, Spectrum, Walked),
        (flight, id): (&mut Flight, P::Id),
    ) -> Step {
        let (cx, p) = (self.walk.cx, s.surface.p);
        // Who begins in a body, and sees it clear, is alone with that.
        let is_clear = ray.below.is_none() && self.walk.walked_in(&ray.media).is_some();
        let from = if is_clear { Flight::OF_THE_EYE } else { *flight };
        let own = self.density(from, &ray, (p, s.surface.n_g.dot(s.wo).abs()));
        let emission = left * self.met(&s, (own, walked.is_walked), id);
        if P::RECORDS {
            let black = Spectrum::BLACK;
            let parts = Parts { arrived: left, emission, ambient: black, blurred_sky: black };
            self.walk.report_shaded(&ray, (&s, &crossing), &parts, id);
        }
        let emission = emission + sent;
        self.walk.probe.local(id, emission);
        let sampler = ray.sampler.fork(SCATTER_BRANCH);
        let scattered = s.scattered(&sampler);
        if let Some(through) = scattered.filter(|scattered| scattered.passes) {
            let mut next = straight_on(&ray, (&s, &crossing), through.weight);
            if ray.below.is_some() || self.walk.walked_in(&crossing.behind).is_some() {
                descend(cx, &ray, (&s, &crossing), BranchKind::Transmission, &mut next);
                *flight = Flight::OF_THE_EYE;
            }
            if P::RECORDS {
                self.walk.probe.chosen(&chosen(&s, &through, (&sampler, 0.0)));
            }
            return Step { radiance: emission, next: Some((next, RayKind::sharp(BranchKind::Transmission))) };
        }
        // Of what is there in part only the rest was met.
        let there = 1.0 / (1.0 - s.bsdf.passing_chance(s.wo_local));
        let keeps_side = self.walk.is_walked(&s);
        let onward = scattered.map(|scattered| {
            let drawn = (&scattered, scattered.weight, keeps_side);
            let mut onward = Onward::of::<P>(&ray, (&s, &crossing), drawn, &sampler);
            if self.walk.descent != Descent::Flat {
                descend(cx, &ray, (&s, &crossing), scattered.kind, &mut onward.child);
            }
            onward
        });
        walked.is_glance =
            walked.is_walked && scattered.is_some_and(|scattered| scattered.kind == BranchKind::Reflection);
        let end = match P::ACTIVE && s.bsdf.is_black() {
            true => StopReason::Absorbed,
            false => StopReason::OpaqueNoChildren,
        };
        let vertex = Vertex { own, below: walked, ..Vertex::new(Place::Surface(s, crossing), p, left, ray) };
        self.go_on(vertex, onward.ok_or(end), (there, emission), (flight, id))
    }

    /// What happens at a particle that a ray met at parameter `t`, before which the medium has `sent` light.
    fn deflect(
        &mut self,
        ray: &PathRay,
        (phase, t, weight): (&'a Phase, f32, Spectrum),
        sent: Spectrum,
        (flight, id): (&mut Flight, P::Id),
    ) -> Step {
        // The body absorbs what the volume in it does not.
        let left = self.walk.arriving(&ray.media, ray.from, &ray.ray, t) * weight;
        self.walk.probe.local(id, sent);
        let (vertex, onward) = self.walk.deflected(ray, (phase, t), left);
        let own = self.density(*flight, ray, (vertex.p, 1.0));
        // A way of no length, by rounding, has no density.
        if left.is_black() || !own.is_finite() {
            self.walk.probe.stop(id, StopReason::Absorbed, Spectrum::BLACK);
            return Step::end(sent);
        }
        self.go_on(Vertex { own, ..vertex }, Ok(onward), (1.0, sent), (flight, id))
    }

    /// Density with which a ray of the walk comes to a place, with the cosine there.
    pub(super) fn density(&self, flight: Flight, ray: &PathRay, to: (Point3, f32)) -> f32 {
        let from = self.vertices.last().map_or(self.origin, |before| before.p);
        self.walk.density(flight, (from, &ray.ray), to)
    }

    /// Joins a vertex to lights and to the particle, of which the share that is `there` was met, and follows the walk, if
    /// it does not end there.
    fn go_on(
        &mut self,
        mut vertex: Vertex<'a>,
        onward: Result<Onward, StopReason>,
        (there, radiance): (f32, Spectrum),
        (flight, id): (&mut Flight, P::Id),
    ) -> Step {
        let radiance = self.light(&vertex, there, (id, radiance));
        let radiance = self.join(&vertex, there, (id, radiance));
        let onward = match onward {
            Ok(onward) => onward,
            Err(reason) => {
                self.walk.probe.stop(id, reason, Spectrum::BLACK);
                return Step::end(radiance);
            }
        };
        let share = vertex.path.throughput;
        if !vertex.below.is_glance {
            let [pdf, back] = vertex.go_on(&onward);
            *flight = Flight::Direction(pdf);
            if onward.child.below.is_some() {
                let cos = vertex.cos(onward.child.ray.d);
                *flight = self.walk.below(*flight, &onward.child.media, (cos, Asked::Nothing));
            }
            if let Some(before) = self.vertices.last_mut() {
                before.other = vertex.back_to(before, back);
            }
            self.vertices.push(vertex);
        }
        self.follow(onward, radiance, share, id)
    }

    /// Follows the next ray of the walk, of which the one before has this share of the pixel, if chance lets it.
    fn follow(&mut self, onward: Onward, radiance: Spectrum, share: Spectrum, id: P::Id) -> Step {
        let Onward { mut child, kind, told, .. } = onward;
        let is_sure = child.depth <= self.own.roulette_depth && child.below.is_none();
        let kept = if is_sure { 1.0 } else { kept(child.throughput.max() / child.compression) };
        let u = if kept < 1.0 { child.sampler.d1(Dim::Roulette) } else { 0.0 };
        let lives = u < kept;
        if let Some(told) = told {
            self.walk.probe.chosen(&Choice { kept: if lives { kept } else { 1.0 }, ..told });
        }
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
        child.throughput = share * child.weight;
        Step { radiance, next: Some((child, kind)) }
    }

    /// What the surface that was met sends along the ray, by the share of having met it, which was done with density `own`, by
    /// a walk below a surface or not.
    fn met(&mut self, s: &Shading, own: (f32, bool), id: P::Id) -> Spectrum {
        let t = self.vertices.len() + 2;
        let weight = self.own.ways.weight(0, t, || 1.0);
        let Some(lamp) = s.lamp.filter(|lamp| !lamp.radiance.is_black()) else {
            return s.emission * weight;
        };
        let LightHit { p, .. } = lamp.hit;
        let end = End { light: lamp.light as usize, source: Source::Surface(lamp.hit), p };
        let share = self.own.ways.weight(0, t, || self.share_of_met(&end, -s.wo, own));
        if P::RECORDS {
            let other = self.vertices.last().map_or(0.0, |before| {
                let lit = before.lit(before.wo());
                let chance = self.walk.cx.scene.light_chance(self.own.light_sampler, &lit, end.light);
                chance * s.lamp_pdf(self.walk.cx, &lamp, lit.p)
            });
            self.walk.probe.met_light(id, other, share);
        }
        s.emission * weight + lamp.radiance * share
    }

    /// What surrounds the scene sends along a ray that left it, of which the share `passed` gets through, and what the medium
    /// has sent.
    fn escape(
        &mut self,
        ray: &PathRay,
        (passed, sent): (Spectrum, Spectrum),
        flight: Flight,
        id: P::Id,
    ) -> Spectrum {
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
                let share = || match ray.below {
                    // No particle from there comes into a body without its surface.
                    Some(_) => 1.0,
                    None => self.share_of_met(&end, ray.ray.d, (own, false)),
                };
                sky += radiance * self.own.ways.weight(0, t, share);
            }
        }
        let sky = self.walk.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY) * passed * sky + sent;
        self.walk.probe.local(id, sky);
        self.walk.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }

    /// Adds the light of one lamp that a vertex asks for.
    fn light(&mut self, vertex: &Vertex<'a>, there: f32, (id, radiance): (P::Id, Spectrum)) -> Spectrum {
        let ray = &vertex.path;
        if ray.depth >= self.own.rules.max_depth || !vertex.is_connectible() {
            return radiance;
        }
        let scene = self.walk.cx.scene;
        let choosing = ray.sampler.fork(LIGHT_BRANCH);
        let lit = vertex.lit(vertex.wo());
        let chosen = scene.choose_light(self.own.light_sampler, &lit, || choosing.d1(Dim::LightChoice));
        let Some(chosen) = chosen else { return radiance };
        let asked = LightCx { basis: self.walk.cx.basis, time: vertex.time() };
        let Some(sample) = scene.lights[chosen.light].sample(&asked, lit.p, &choosing) else {
            return radiance;
        };
        let (f, cos) = vertex.seen(&asked.basis, sample.wi, sample.pdf.is_none());
        if f.is_black() {
            return radiance;
        }
        let end = End::sampled(chosen.light, &sample, vertex);
        let t = self.vertices.len() + 2;
        let share = || self.share_of_asked(&end, vertex, sample.wi, (chosen.chance, sample.pdf));
        let share = self.own.ways.weight(1, t, share);
        let weight = f * (cos * share * there / chosen.chance);
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
                cos: Some(cos),
                pdf: sample.pdf,
                other_pdf: sample.pdf.map(|_| vertex.pdf(vertex.wo(), sample.wi)),
                mis: Some(share),
                random: sample.pdf.map(|_| RandomNumbers::two(Dim::Light, u.to_array())),
                ..Choice::sharp()
            });
        }
        let path = vertex.shadow_path(&self.walk, chosen.light, weight, &sample);
        let arriving = (sample.point, sample.weight);
        radiance + weight * self.walk.send_shadow(&path, chosen.light as u32, arriving, id)
    }
}
