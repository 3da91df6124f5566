//! The way of one path, hit by hit.
//!
//! A path is followed without recursion, and its radiance summed from the far end to the eye, as the recorder folds it.
use durer_accel::Hit;
use durer_core::{math::Ray, sampling::Dim, spectrum::Spectrum};
use durer_model::{
    bsdf::{BranchKind, Scattered},
    medium::Flight,
    texture::Habit,
};

use super::{
    super::{
        photons::Photons,
        shading::Shading,
        walk::{Parts, Walk},
    },
    Course,
};
use crate::{
    Contribution, Lit, PathRay, SampleCx, Value,
    footprint::Onlooker,
    media::{Boundary, Crossing},
    probe::{Choice, Limit, Probe, RayKind, StopReason, TreeNode},
};

/// PERF: hits of a path that are kept without asking for memory (bench render).
const CHAIN: usize = 16;
/// Scattered rays use this branch of the sampler, those that go straight on the next: each bounce has numbers of its own.
pub(super) const SCATTER_BRANCH: u32 = 1 << 15;

/// A hit of a path.
struct Link<Id> {
    id: Id,
    /// All that arrives there but by the next ray.
    radiance: Spectrum,
    /// What the next ray's radiance is multiplied with.
    weight: Spectrum,
}

/// What a hit leaves to do: its own radiance, and which ray follows, in the place of the one that hit.
pub(super) struct Step {
    pub(super) radiance: Spectrum,
    pub(super) next: Option<RayKind>,
}

impl Step {
    /// Nothing follows.
    pub(super) fn end(radiance: Spectrum) -> Self {
        Self { radiance, next: None }
    }
}

/// The state of one path.
pub(super) struct Follow<'a, P: Probe> {
    pub(super) course: &'a Course,
    pub(super) walk: Walk<'a, P>,
    /// Whether there are surfaces below which light is followed.
    pub(super) walks: bool,
    /// Those of the pass, if light is gathered.
    pub(super) photons: Option<&'a Photons>,
    /// Light was gathered: what a spread ray meets now is asked for its own light only.
    pub(super) has_gathered: bool,
}

impl<'a, P: Probe> Follow<'a, P> {
    pub(super) fn new(course: &'a Course, cx: &'a SampleCx<'a>, probe: &'a mut P) -> Self {
        let heeds_media = course.heeds_media && !cx.scene.volumes.is_empty();
        let walks = !course.direct_only && cx.scene.media.are_walked();
        let walk = Walk { heeds_media, ..Walk::new(&course.rules, cx, probe) };
        Self { course, walk, walks, photons: None, has_gathered: false }
    }

    /// Follows the path of an eye ray, which starts in the bodies that the camera is in.
    pub(super) fn sample(mut self, ray: &PathRay, parent: P::Id, out: &mut Contribution) {
        let ray = PathRay { media: self.walk.cx.scene.start, ..*ray };
        out.value = Value::Radiance(self.trace(&ray, RayKind::Eye, parent));
        out.rays = self.walk.rays;
        out.imbalances = self.walk.imbalances;
    }

    /// Follows a recorded ray once more.
    pub(super) fn again(mut self, node: &TreeNode, parent: P::Id, out: &mut Contribution) {
        let radiance = match &node.light {
            Some(event) => {
                self.walk.send_shadow(&node.path, event.light, (event.point, event.unoccluded), parent)
            }
            None => match node.limit.filter(|_| node.stop == Some(StopReason::Roulette)) {
                Some(limit) => {
                    self.report_roulette((&node.path, node.kind), limit, parent);
                    Spectrum::BLACK
                }
                None => self.trace(&node.path, node.kind, parent),
            },
        };
        out.value = Value::Radiance(radiance);
    }

    /// Radiance arriving along a ray.
    fn trace(&mut self, ray: &PathRay, kind: RayKind, mut parent: P::Id) -> Spectrum {
        let mut links: [Option<Link<P::Id>>; CHAIN] = std::array::from_fn(|_| None);
        let mut more: Vec<Link<P::Id>> = Vec::new();
        // PERF: one ray that becomes the next, instead of copies (bench render).
        let (mut ray, mut next) = (*ray, Some(kind));
        let mut radiance = Spectrum::BLACK;
        let mut count = 0;
        while let Some(kind) = next {
            let id = self.walk.probe.ray(parent, &ray, kind);
            let step = self.step(&mut ray, id);
            let weight = step.next.map_or(Spectrum::BLACK, |_| ray.weight);
            let link = Link { id, radiance: step.radiance, weight };
            match links.get_mut(count) {
                Some(place) => *place = Some(link),
                None => more.push(link),
            }
            count += 1;
            (parent, next) = (id, step.next);
        }
        for link in more.iter().rev().chain(links.iter().rev().flatten()) {
            radiance = link.radiance + link.weight * radiance;
            self.walk.probe.result(link.id, radiance);
        }
        radiance
    }

    fn step(&mut self, ray: &mut PathRay, id: P::Id) -> Step {
        let walk = &mut self.walk;
        if let Some(reason) = walk.reason_to_stop(ray) {
            if P::RECORDS {
                walk.report_limit(ray, reason, id);
            }
            walk.probe.stop(id, reason, ray.throughput);
            return Step::end(Spectrum::BLACK);
        }
        walk.rays += 1;
        if walk.heeds_media || ray.below.is_some() {
            return self.step_in_media(ray, id);
        }
        match walk.cx.scene.closest(walk.cx, &ray.ray, walk.probe, id) {
            Some(hit) => self.shade(ray, &hit, (None, id)),
            None => Step::end(self.escape(ray, None, id)),
        }
    }

    /// What happens where a ray met something, behind what floats on its way.
    pub(super) fn shade(
        &mut self,
        ray: &mut PathRay,
        hit: &Hit,
        (flight, id): (Option<&Flight>, P::Id),
    ) -> Step {
        let walk = &mut self.walk;
        let onlooker = Onlooker::of(ray, Habit::AsPbrt);
        let mut s = match self.walks {
            true => Shading::open(walk.cx, &ray.ray, hit, onlooker),
            false => Shading::at(walk.cx, &ray.ray, hit, Some(onlooker)),
        };
        walk.probe.surface(id, s.object, hit, &s.surface);
        let mut crossing = walk.cross(&ray.media, &mut s, hit.t);
        if self.course.hides(ray) && walk.cx.scene.object(s.object).light.is_some() {
            crossing.boundary = Boundary::Passed;
        }
        let mut arriving = walk.arriving(&ray.media, ray.from, &ray.ray, hit.t);
        if let Some(flight) = flight {
            arriving *= flight.weight;
        }
        match crossing.boundary {
            Boundary::Passed => {
                let sent = flight.map_or(Spectrum::BLACK, |flight| flight.sent);
                if P::RECORDS {
                    walk.report_passed(ray, &crossing, arriving, id);
                    walk.probe.local(id, sent);
                }
                let beyond = s.surface.spawn(ray.ray.d, ray.ray.time);
                *ray = ray.passing((s.surface.p, beyond), arriving, crossing.behind, hit.t);
                if walk.heeds_media {
                    ray.sampler = ray.sampler.fork(SCATTER_BRANCH + 1);
                }
                return Step { radiance: sent, next: Some(RayKind::Passing) };
            }
            Boundary::Between(eta) => s.bsdf.set_eta(s.wo_local, eta),
            Boundary::Own => {}
        }
        self.leave(ray, &mut s);
        if self.course.regularize && ray.is_blurred {
            s.bsdf.regularize();
        }
        let own = arriving * (s.emission + self.lamp(ray, &s));
        // PERF: where nothing floats nothing is added (bench render).
        let emission = flight.map_or(own, |flight| own + flight.sent);
        if crossing.disperses && !ray.is_collapsed {
            ray.is_collapsed = true;
            arriving *= self.walk.cx.basis.collapse();
        }
        s.bsdf.dim(arriving);
        if P::RECORDS {
            let black = Spectrum::BLACK;
            let parts = Parts { arrived: arriving, emission: own, ambient: black, blurred_sky: black };
            self.report_hit(ray, (&s, &crossing), &parts, id);
        }
        let is_last = self.has_gathered || self.course.direct_only && ray.density.is_some();
        let gathers = !is_last && self.gathers(ray, &s);
        // PERF: where nothing is gathered nothing is added (bench render).
        let emission = if gathers { emission + self.gather(ray, &s, id) } else { emission };
        self.walk.probe.local(id, emission);
        if is_last {
            return Step { radiance: emission, next: self.pass_only(ray, (&s, &crossing), id) };
        }
        let lit = self.lit(&s);
        let radiance = self.light(ray, (&s, &crossing), &lit, (id, emission));
        let next = self.scatter(ray, (&s, &crossing), &lit, id);
        // What goes straight on was not scattered here, and has the density of a bounce before.
        self.has_gathered |=
            gathers && matches!(next, Some(RayKind::GlossyReflection | RayKind::GlossyRefraction));
        Step { radiance, next }
    }

    /// Where light is wanted, as lights are chosen by it.
    fn lit(&self, s: &Shading) -> Lit {
        let n = (!s.bsdf.is_frosted()).then(|| s.surface.n_s.face_forward(s.wo));
        Lit { p: s.surface.p, n, time: s.time }
    }

    /// Puts the ray that follows a hit in the place of the one that hit, if chance lets it.
    fn scatter(
        &mut self,
        parent: &mut PathRay,
        (s, crossing): (&Shading, &Crossing),
        lit: &Lit,
        id: P::Id,
    ) -> Option<RayKind> {
        let sampler = parent.sampler.fork(SCATTER_BRANCH);
        let Some(scattered) = s.scattered(&sampler) else {
            let reason = match P::ACTIVE && s.bsdf.is_black() {
                true => StopReason::Absorbed,
                false => StopReason::OpaqueNoChildren,
            };
            self.walk.probe.stop(id, reason, Spectrum::BLACK);
            return None;
        };
        let mut child = self.child(parent, (s, crossing), lit, &scattered);
        let kind = match scattered.pdf {
            None => RayKind::sharp(scattered.kind),
            Some(_) => RayKind::drawn(scattered.kind),
        };
        let kept = self.kept(&child);
        let u = if kept < 1.0 { sampler.d1(Dim::Roulette) } else { 0.0 };
        let lives = u < kept;
        if P::RECORDS {
            self.report_scatter(&sampler, (s, &scattered), if lives { kept } else { 1.0 });
        }
        if !lives {
            if P::ACTIVE {
                self.report_roulette((&child, kind), Limit { value: u, threshold: kept }, id);
            }
            return None;
        }
        child.weight = child.weight / kept;
        child.throughput = parent.throughput * child.weight;
        *parent = child;
        Some(kind)
    }

    /// The ray straight on behind a surface of which nothing else is followed.
    fn pass_only(
        &mut self,
        parent: &mut PathRay,
        (s, crossing): (&Shading, &Crossing),
        id: P::Id,
    ) -> Option<RayKind> {
        let weight = s.bsdf.passed(s.wo_local);
        if weight.is_black() {
            self.walk.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
            return None;
        }
        if P::RECORDS {
            self.walk.probe.chosen(&Choice::sharp());
        }
        *parent = straight_on(parent, (s, crossing), weight);
        Some(RayKind::sharp(BranchKind::Transmission))
    }

    /// The ray in a scattered direction.
    fn child(
        &self,
        parent: &PathRay,
        (s, crossing): (&Shading, &Crossing),
        lit: &Lit,
        scattered: &Scattered,
    ) -> PathRay {
        let time = parent.ray.time;
        let weight = scattered.weight;
        if scattered.passes {
            let mut on = straight_on(parent, (s, crossing), weight);
            if self.walks {
                self.below(parent, (s, crossing), BranchKind::Transmission, &mut on);
            }
            return on;
        }
        let d = s.frame.to_world(scattered.wi);
        // As in pbrt-v4, shading normals decide where spread directions go, whatever the true surface says: where they are
        // wrong altogether, no light is lost that is there all around (the floor of buddha-fractal).
        let keeps_side = scattered.pdf.is_none() || self.is_walked(s);
        let d = if keeps_side { s.keep_side(d, scattered.kind) } else { d };
        let ray: Ray = s.surface.spawn(d.normalize(), time);
        let spreads = scattered.pdf.is_some();
        let mut child = PathRay {
            media: crossing.media(scattered.kind),
            density: scattered.pdf,
            lit: *lit,
            compression: parent.compression * scattered.compression,
            is_blurred: parent.is_blurred || spreads,
            ..parent.child((s.surface.p, ray), weight, SCATTER_BRANCH)
        };
        if self.walks {
            self.below(parent, (s, crossing), scattered.kind, &mut child);
        }
        child
    }

    /// The probability with which a path goes on: what it carries, but for what the index of refraction does to radiance.
    pub(super) fn kept(&self, child: &PathRay) -> f32 {
        if child.depth <= self.course.roulette_depth && child.below.is_none() {
            return 1.0;
        }
        let carried = child.throughput.max() / child.compression;
        // Paths that carry more than the eye ray go on, and so do those whose share cannot be told.
        if carried < 1.0 { carried } else { 1.0 }
    }
}

/// The ray straight on behind a surface: no bounce, but with random numbers of its own.
fn straight_on(parent: &PathRay, (s, crossing): (&Shading, &Crossing), weight: Spectrum) -> PathRay {
    let ray = s.surface.spawn(parent.ray.d, parent.ray.time);
    let media = crossing.media(BranchKind::Transmission);
    let walked = (s.surface.p - parent.ray.o).length();
    let sampler = parent.sampler.fork(SCATTER_BRANCH + 1);
    PathRay { sampler, ..parent.passing((s.surface.p, ray), weight, media, walked) }
}
