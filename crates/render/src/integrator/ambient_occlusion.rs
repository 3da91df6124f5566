//! Ambient occlusion: how much of the sky a place would see (Zhukov, Iones and Kronin 1998; the cosine-weighted share of
//! the hemisphere that is free up to a distance). No light and no material counts.
use std::f32::consts::{FRAC_1_PI, TAU};

use durer_core::{
    math::{
        Frame, Point2, Ray, Vector3,
        float::{cos, sin, sqr},
    },
    sampling::{Dim, cosine_hemisphere},
    spectrum::Spectrum,
};
use durer_model::Surface;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Integrator, Start, Transport};
use crate::{
    Contribution, PathRay, SampleCx, Value,
    probe::{Choice, ChosenBy, Probe, RandomNumbers, RayKind, StopReason},
};

/// The integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// Directions are drawn in proportion to their cosine, else evenly.
    by_cosine: bool,
    /// Metres beyond which nothing occludes.
    max_distance: f32,
}

impl Kind for AmbientOcclusion {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "ambientocclusion",
        aliases: &["ao", "ambient-occlusion"],
        doc: "The share of a uniform sky that each place sees.",
        params: &[
            ParamSpec::new(
                "cossample",
                ParamType::Bool,
                ParamDefault::Bool(true),
                "Directions in proportion to their cosine, for less noise; else evenly.",
            ),
            ParamSpec::new(
                "maxdistance",
                ParamType::Float,
                ParamDefault::Unset,
                "What is farther away does not occlude; everything does if left out.",
            )
            .unit("m")
            .range(0.0, f32::INFINITY),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let max_distance = args.optional_float("maxdistance").unwrap_or(f32::INFINITY);
        Some(Box::new(Self { by_cosine: args.bool("cossample"), max_distance }))
    }
}

/// A direction about +z, its weight, and its density, 1/sr.
fn draw(by_cosine: bool, u: Point2) -> (Vector3, f32, f32) {
    if by_cosine {
        let w = cosine_hemisphere(u);
        return (w, 1.0, w.z * FRAC_1_PI);
    }
    let (z, phi) = (1.0 - u.x, TAU * u.y);
    let r = (1.0 - sqr(z)).max(0.0).sqrt();
    (Vector3::new(r * cos(phi), r * sin(phi), z), 2.0 * z, 1.0 / TAU)
}

impl AmbientOcclusion {
    /// What arrives along a ray, and how many were traced: from the eye what the place is worth, else 1 if it is free.
    fn follow<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: &PathRay,
        kind: RayKind,
        parent: P::Id,
        probe: &mut P,
    ) -> (Spectrum, u64) {
        let id = probe.ray(parent, ray, kind);
        let hit = cx.scene.closest(cx, &ray.ray, probe, id);
        let (radiance, more) = match hit {
            Some(hit) => {
                let (object, surface) = cx.scene.surface(&ray.ray, &hit);
                probe.surface(id, object, &hit, &surface);
                probe.local(id, Spectrum::BLACK);
                match kind {
                    RayKind::Eye => self.free_share(cx, ray, &surface, id, probe),
                    _ => {
                        probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
                        (Spectrum::BLACK, 0)
                    }
                }
            }
            None => {
                let sky = if kind == RayKind::Eye { Spectrum::BLACK } else { cx.basis.white() };
                probe.local(id, sky);
                probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
                (sky, 0)
            }
        };
        probe.result(id, radiance);
        (radiance, 1 + more)
    }

    fn free_share<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: &PathRay,
        surface: &Surface,
        id: P::Id,
        probe: &mut P,
    ) -> (Spectrum, u64) {
        let n = surface.n_s.face_forward(-ray.ray.d);
        let u = ray.sampler.d2(Dim::Scatter);
        let (wi, weight, pdf) = draw(self.by_cosine, u);
        let d = Frame::from_z(n).to_world(wi);
        let stays = surface.n_g.dot(d) * surface.n_g.dot(-ray.ray.d) > 0.0;
        let spawned = Ray { t_max: self.max_distance, ..surface.spawn(d, ray.ray.time) };
        let weight = Spectrum::splat(weight);
        let child = ray.child((surface.p, spawned), weight, 0);
        if P::RECORDS {
            probe.chosen(&Choice {
                by: ChosenBy::Lobe,
                lobe: Some("diffuse"),
                cos: Some(wi.z),
                pdf: Some(pdf),
                f: (wi.z > 0.0).then(|| weight * (pdf / wi.z)),
                random: Some(RandomNumbers::two(Dim::Scatter, [u.x, u.y])),
                ..Choice::sharp()
            });
        }
        if !stays {
            let refused = probe.ray(id, &child, RayKind::GlossyReflection);
            probe.stop(refused, StopReason::BelowHorizon, child.throughput);
            probe.result(refused, Spectrum::BLACK);
            return (Spectrum::BLACK, 0);
        }
        let (free, rays) = self.follow(cx, &child, RayKind::GlossyReflection, id, probe);
        (weight * free, rays)
    }
}

impl Transport for AmbientOcclusion {
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let (ray, kind) = match start {
            Start::Eye(ray) => (ray, RayKind::Eye),
            Start::Again(node) => (&node.path, node.kind),
        };
        let (radiance, rays) = self.follow(cx, ray, kind, parent, probe);
        out.value = Value::Radiance(radiance);
        out.rays = rays;
    }
}
