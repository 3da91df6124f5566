//! Recursive ray tracing (Whitted 1980, "An improved illumination model for shaded display"):
//!
//! `L = L_e + ambient term + sum over lights of (f cos * light, if its shadow ray arrives) + sum over sharp directions
//! of weight * L(child)`.
//!
//! Diffuse interreflection is left to the ambient term. Unlike in 1980 the ambient term knows the normal (a sky's
//! unoccluded irradiance), and glossy lobes see the sky's blurred mirror image.
use durer_accel::Hit;
use durer_core::spectrum::Spectrum;
use durer_model::{bsdf::BranchKind, light::LightSample};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Integrator, Transport, shading::Shading};
use crate::{
    Contribution, PathRay, SampleCx, Value,
    probe::{LightEvent, Probe, RayKind, StopReason},
};

/// Whitted's integrator with its two stop rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Bounces traced at most.
    pub max_depth: u32,
    /// A branch whose share in the pixel is at or below this is not traced.
    pub min_contribution: f32,
}

impl Kind for Whitted {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "whitted",
        aliases: &[],
        doc: "Recursive ray tracing: ambient term, shadow rays, mirror reflection and refraction (Whitted 1980).",
        params: &[
            ParamSpec::new("maxdepth", ParamType::Int, ParamDefault::Int(10), "Bounces traced at most.")
                .unit("bounces")
                .range(0.0, 1000.0),
            ParamSpec::float(
                "mincontribution",
                1.0 / 512.0,
                "A branch whose share in the pixel is at or below this is not traced.",
            )
            .range(0.0, 1.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let max_depth = args.int("maxdepth") as u32;
        Some(Box::new(Self { max_depth, min_contribution: args.float("mincontribution") }))
    }
}

impl Transport for Whitted {
    fn sample<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: PathRay,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let mut walk = Walk { whitted: self, cx, probe, rays: 0 };
        out.value = Value::Radiance(walk.trace(&ray, RayKind::Eye, parent));
        out.rays = walk.rays;
    }
}

/// The recursion's state: one per sample.
struct Walk<'a, P: Probe> {
    whitted: &'a Whitted,
    cx: &'a SampleCx<'a>,
    probe: &'a mut P,
    rays: u64,
}

impl<P: Probe> Walk<'_, P> {
    /// Radiance arriving along a ray.
    fn trace(&mut self, ray: &PathRay, kind: RayKind, parent: P::Id) -> Spectrum {
        let id = self.probe.ray(parent, ray, kind);
        let radiance = match self.reason_to_stop(ray) {
            Some(reason) => {
                self.probe.stop(id, reason, ray.throughput);
                Spectrum::BLACK
            }
            None => {
                self.rays += 1;
                match self.cx.scene.closest(self.cx, &ray.ray, self.probe, id) {
                    Some(hit) => self.shade(ray, &hit, id),
                    None => self.escape(ray, id),
                }
            }
        };
        self.probe.result(id, radiance);
        radiance
    }

    fn reason_to_stop(&self, ray: &PathRay) -> Option<StopReason> {
        if ray.depth > self.whitted.max_depth {
            Some(StopReason::DepthLimit)
        } else if ray.depth > 0 && ray.throughput.max() <= self.whitted.min_contribution {
            Some(StopReason::ContributionBelowCutoff)
        } else {
            None
        }
    }

    fn escape(&mut self, ray: &PathRay, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let sky = cx.scene.escaped(cx.basis, ray.ray.d);
        self.probe.local(id, sky);
        self.probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
        sky
    }

    fn shade(&mut self, ray: &PathRay, hit: &Hit, id: P::Id) -> Spectrum {
        let cx = self.cx;
        let s = Shading::at(cx, &ray.ray, hit);
        self.probe.surface(id, s.object, hit, &s.surface);
        let mut radiance = s.emission + s.ambient(cx);
        self.probe.local(id, radiance);
        let lamps = if s.bsdf.is_sharp() { &[] } else { cx.scene.lamps.as_slice() };
        for light in lamps.iter().map(|&light| light as usize) {
            let sampler = ray.sampler.fork(LIGHT_BRANCH + light as u32);
            if let Some((weight, sample)) = s.light(cx, light, &sampler) {
                radiance += weight * self.shadow(ray, &s, light, weight, &sample, id);
            }
        }
        self.branches(ray, &s, id, radiance)
    }

    /// Sends the shadow ray; the light that arrives.
    fn shadow(
        &mut self,
        parent: &PathRay,
        s: &Shading,
        light: usize,
        weight: Spectrum,
        sample: &LightSample,
        id: P::Id,
    ) -> Spectrum {
        let cx = self.cx;
        let ray = match sample.point {
            Some(point) => s.surface.spawn_to(point, parent.ray.time),
            None => s.surface.spawn(sample.wi, parent.ray.time),
        };
        let shadow =
            self.probe.ray(id, &parent.child(ray, weight, LIGHT_BRANCH + light as u32), RayKind::Shadow);
        self.rays += 1;
        let visible = !cx.scene.occluded(cx, &ray, self.probe, shadow);
        let event = LightEvent {
            light: light as u32,
            point: sample.point,
            unoccluded: sample.weight,
            visible,
            blocker: if P::RECORDS && !visible { cx.scene.blocker(cx, &ray) } else { None },
        };
        self.probe.light(shadow, &event);
        let (arriving, reason) = match visible {
            true => (sample.weight, StopReason::HitLight),
            false => (Spectrum::BLACK, StopReason::LightOccluded),
        };
        self.probe.local(shadow, arriving);
        self.probe.stop(shadow, reason, Spectrum::BLACK);
        self.probe.result(shadow, arriving);
        arriving
    }

    /// Adds mirrored and refracted rays to `radiance`, in this order: the recorder folds them the same way.
    fn branches(&mut self, parent: &PathRay, s: &Shading, id: P::Id, mut radiance: Spectrum) -> Spectrum {
        let branches = s.bsdf.branches(s.wo_local);
        let mut count = 0;
        for branch in branches.iter() {
            let kind = match branch.kind {
                BranchKind::Reflection => RayKind::Reflection,
                BranchKind::Transmission => RayKind::Refraction,
            };
            let d = s.keep_side(s.frame.to_world(branch.wi), branch.kind).normalize();
            let child = parent.child(s.surface.spawn(d, parent.ray.time), branch.weight, count);
            radiance += branch.weight * self.trace(&child, kind, id);
            count += 1;
        }
        if let Some(weight) = branches.total_internal_reflection {
            let child = parent.child(parent.ray, weight, count);
            let refused = self.probe.ray(id, &child, RayKind::Refraction);
            self.probe.stop(refused, StopReason::TirNoRefraction, child.throughput);
            self.probe.result(refused, Spectrum::BLACK);
        } else if count == 0 {
            self.probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
        }
        radiance
    }
}

/// Shadow rays use sampler branches from here on; sharp directions use those below.
const LIGHT_BRANCH: u32 = 1 << 16;
