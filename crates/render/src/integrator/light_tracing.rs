//! Light tracing: particles from the lights, each connected to the camera wherever it scatters.
//!
//! A particle's power `P` at a point of the scene that the camera sees in direction `d` adds
//! `P f |wo n_s| / |wo n_g| |d n_g| I` to the picture at the point's place, with the camera's importance `I` there (Veach
//! 1997, section 8.3.2; Dutré, Lafortune and Willems 1993). Caustics are found where paths from the eye look for them in
//! vain. What is seen in a mirror or through glass is not: nothing can be connected there. Lights themselves, and the sky,
//! are seen by eye rays.
use durer_core::spectrum::Spectrum;
use durer_scene::{Args, Kind, Schema};

use super::{
    Integrator, PATH_DEPTH, Particles, ROULETTE_DEPTH, Start, Transport,
    vertices::{Stamina, straight_on},
    walk::{Rules, Walk},
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
        doc: "Light tracing: particles from the lights, seen by the camera where they are scattered. Good at caustics; shows \
              nothing in mirrors and through glass.",
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
        let mut walk = Walk::new(&self.rules, cx, probe);
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

/// What an eye ray sees of lights themselves.
fn seen<P: Probe>(walk: &mut Walk<'_, P>, mut ray: PathRay, id: P::Id) -> Spectrum {
    if let Some(reason) = walk.reason_to_stop(&ray) {
        walk.probe.stop(id, reason, ray.throughput);
        walk.probe.result(id, Spectrum::BLACK);
        return Spectrum::BLACK;
    }
    walk.rays += 1;
    let Some(hit) = walk.cx.scene.closest(walk.cx, &ray.ray, walk.probe, id) else {
        let left = walk.arriving(&ray.media, ray.from, &ray.ray, f32::INFINITY);
        let far = walk
            .cx
            .scene
            .far
            .iter()
            .map(|&light| walk.cx.scene.lights[light as usize].escaped(walk.cx.basis, ray.ray.d));
        let sky = left * far.fold(Spectrum::BLACK, |sum, light| sum + light);
        walk.probe.local(id, sky);
        walk.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        walk.probe.result(id, sky);
        return sky;
    };
    let met = walk.meet(&mut ray, &hit, |walk, s| walk.probe.surface(id, s.object, &hit, &s.surface));
    let (emission, weight) = match met {
        None => (Spectrum::BLACK, ray.weight),
        Some((s, crossing, left)) => {
            let emission = left * s.sent_out();
            walk.probe.local(id, emission);
            let passed = left * s.bsdf.passed(s.wo_local);
            if passed.is_black() {
                walk.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
                walk.probe.result(id, emission);
                return emission;
            }
            ray = straight_on(&ray, (&s, &crossing), passed);
            (emission, passed)
        }
    };
    let next = walk.probe.ray(id, &ray, RayKind::Passing);
    let radiance = emission + weight * seen(walk, ray, next);
    walk.probe.result(id, radiance);
    radiance
}
