//! Light tracing: particles from the lights, each connected to the camera wherever it scatters.
//!
//! A particle's power `P` at a point of the scene that the camera sees in direction `d` adds
//! `P f |wo n_s| / |wo n_g| |d n_g| I` to the picture at the point's place, with the camera's importance `I` there (Veach
//! 1997, section 8.3.2; Dutré, Lafortune and Willems 1993). Caustics are found where paths from the eye look for them in
//! vain. What is seen in a mirror or through glass is not: nothing can be connected there. Lights themselves, the sky, and
//! what glows in media are seen by eye rays. In media there are no cosines: a particle there adds `P f I`, with what is left
//! on the way to the camera.
use durer_core::spectrum::Spectrum;
use durer_scene::{Args, Kind, Schema};

use super::{
    Integrator, PATH_DEPTH, Particles, ROULETTE_DEPTH, Start, Transport,
    below::Descent,
    vertices::{Stamina, straight_on},
    walk::{Rules, Walk, span},
};
use crate::{
    Contribution, PathRay, SampleCx, Value,
    probe::{Probe, RayKind, StopReason},
};

/// The light tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTracing {
    rules: Rules,
    roulette_depth: u32,
}

impl Kind for LightTracing {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "light",
        aliases: &["lightpath"],
        doc: "Light tracing: particles from the lights, seen by the camera where surfaces and media scatter them. Good at \
              caustics; shows nothing in mirrors and through glass.",
        params: &[PATH_DEPTH, ROULETTE_DEPTH],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let rules = Rules { max_depth: args.int("maxdepth") as u32, ..Rules::PATH };
        Some(Box::new(Self { rules, roulette_depth: args.int("roulettedepth") as u32 }))
    }
}

impl Transport for LightTracing {
    fn depth_limit(&self) -> Option<u32> {
        Some(self.rules.max_depth)
    }
    fn walks(&self) -> bool {
        true
    }
    fn particles(&self) -> Particles {
        Particles::All
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let mut walk = Walk::in_media(&self.rules, cx, probe, Descent::Mirrored);
        let (ray, kind, is_eye) = match start {
            Start::Eye(ray) => (PathRay { media: cx.scene.start, ..*ray }, RayKind::Eye, true),
            Start::Again(node) => (node.path, node.kind, false),
        };
        let id = walk.probe.ray(parent, &ray, kind);
        out.value = Value::Radiance(seen(&mut walk, ray, id));
        if is_eye && cx.scene.view.is_connectible() {
            let stamina = Stamina { vertices: self.rules.max_depth, sure: self.roulette_depth };
            if let Some(particle) = walk.particle(&ray, stamina, id) {
                for index in 0..particle.vertices.len() {
                    let sighting = walk.sighting(&particle, index, id);
                    out.splats.extend(sighting.map(|sighting| sighting.splat));
                }
            }
        }
        out.rays = walk.rays;
        out.imbalances = walk.imbalances;
    }
}

/// What an eye ray sees of lights themselves, and of what glows on the way.
fn seen<P: Probe>(walk: &mut Walk<'_, P>, mut ray: PathRay, id: P::Id) -> Spectrum {
    if let Some(reason) = walk.reason_to_stop(&ray) {
        walk.probe.stop(id, reason, ray.throughput);
        walk.probe.result(id, Spectrum::BLACK);
        return Spectrum::BLACK;
    }
    walk.rays += 1;
    let cx = walk.cx;
    let hit = match walk.heeds_media {
        true => cx.scene.closest_boundary(cx, &ray.ray, walk.probe, id),
        false => cx.scene.closest(cx, &ray.ray, walk.probe, id),
    };
    let (passed, sent) = floated(walk, &ray, hit.map_or(f32::INFINITY, |hit| hit.t), id);
    let Some(hit) = hit else {
        let left = walk.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY) * passed;
        let far =
            cx.scene.far.iter().map(|&light| cx.scene.lights[light as usize].escaped(cx.basis, ray.ray.d));
        let sky = left * far.fold(Spectrum::BLACK, |sum, light| sum + light) + sent;
        walk.probe.local(id, sky);
        walk.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        walk.probe.result(id, sky);
        return sky;
    };
    let met =
        walk.meet(&mut ray, (&hit, passed), |walk, s| walk.probe.surface(id, s.object, &hit, &s.surface));
    let emission = met.as_ref().map_or(sent, |(s, _, left)| *left * s.sent_out() + sent);
    walk.probe.local(id, emission);
    if let Some((s, crossing, left)) = met {
        // Below surfaces light is left to particles.
        let is_open = walk.walked_in(&crossing.behind).is_none();
        let passed = if is_open { left * s.bsdf.passed(s.wo_local) } else { Spectrum::BLACK };
        if passed.is_black() {
            walk.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
            walk.probe.result(id, emission);
            return emission;
        }
        ray = straight_on(&ray, (&s, &crossing), passed);
    }
    let next = walk.probe.ray(id, &ray, RayKind::Passing);
    let radiance = emission + ray.weight * seen(walk, ray, next);
    walk.probe.result(id, radiance);
    radiance
}

/// What floats on the way of a ray to parameter `t` lets pass of what is behind, and sends out.
fn floated<P: Probe>(walk: &mut Walk<'_, P>, ray: &PathRay, t: f32, id: P::Id) -> (Spectrum, Spectrum) {
    if !walk.heeds_media {
        return (Spectrum::ONE, Spectrum::BLACK);
    }
    let Some(volume) = walk.volume(&ray.media) else { return (Spectrum::ONE, Spectrum::BLACK) };
    let flight = walk.see(volume, ray, span(ray.from, &ray.ray, t));
    if P::RECORDS {
        walk.report_floating(ray, &flight, id);
    }
    (flight.weight, flight.sent)
}
