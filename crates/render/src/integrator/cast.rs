//! Ray casting: one ray per sample, and what the lecture shows of the hit: depth, normal, local shading.
use durer_accel::Hit;
use durer_core::spectrum::Spectrum;
use durer_model::{bsdf::Seen, material::GlossRays, texture::Habit};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Integrator, Output, Start, Transport,
    shading::{LIGHT_BRANCH, Shading},
};
use crate::{
    Contribution, MediumStack, PathRay, SampleCx, Value,
    footprint::Onlooker,
    probe::{Counters, Probe, RayKind, Shaded, StopReason},
};

/// What a ray cast shows of the nearest hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// Depth along the camera's axis and along the ray, in metres.
    Depth,
    /// Shading normal in world space, turned towards the eye.
    Normal,
    /// Ambient term and the light of all lights, without shadows.
    #[default]
    Shading,
    /// Colour of the material.
    Albedo,
    /// Surface coordinates.
    Uv,
    /// Number of the object.
    Id,
    /// Tests of primitives and of boxes that finding the hit, or nothing, takes.
    Cost,
}

impl Show {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 7] =
        [Self::Depth, Self::Normal, Self::Shading, Self::Albedo, Self::Uv, Self::Id, Self::Cost];
    /// The words for them.
    pub const WORDS: [&'static str; 7] = ["depth", "normal", "shading", "albedo", "uv", "id", "cost"];

    /// From its word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().position(|w| *w == word).map(|i| Self::ALL[i])
    }
    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

/// Casts one ray and shows the nearest hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cast {
    /// What of it.
    pub show: Show,
}

impl Kind for Cast {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "cast",
        aliases: &[],
        doc: "Ray casting: the nearest hit's depth, normal, local shading, albedo, uv, object id, or what finding it costs.",
        params: &[ParamSpec::new(
            "show",
            ParamType::Choice(&Show::WORDS),
            ParamDefault::Text("shading"),
            "What is shown of the nearest hit.",
        )],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self { show: Show::from_word(args.text("show"))? }))
    }
}

impl Transport for Cast {
    fn bounded(&self) -> Option<GlossRays> {
        Some(GlossRays::Main)
    }
    fn output(&self) -> Output {
        match self.show {
            Show::Shading | Show::Albedo => Output::Radiance,
            show => Output::Data(show),
        }
    }

    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let ray = match start {
            Start::Eye(ray) => ray,
            Start::Again(node) => &node.path,
        };
        let id = probe.ray(parent, ray, RayKind::Eye);
        out.rays = 1;
        let counts = (self.show == Show::Cost).then(|| count(cx, ray));
        out.value = match cx.scene.closest(cx, &ray.ray, probe, id) {
            Some(hit) => {
                let s = Shading::at(cx, &ray.ray, &hit, Some(Onlooker::of(ray, Habit::Asked)));
                probe.surface(id, s.object, &hit, &s.surface);
                if P::RECORDS {
                    probe.shaded(id, &self.shaded(cx, &s));
                }
                probe.stop(id, StopReason::OpaqueNoChildren, Spectrum::BLACK);
                self.hit(cx, ray, &hit, &s)
            }
            None => {
                probe.stop(id, StopReason::MissedScene, Spectrum::BLACK);
                self.miss(cx, ray)
            }
        };
        if let Some(counts) = counts {
            out.value = counts;
        }
        if let Value::Radiance(radiance) = out.value {
            probe.local(id, radiance);
            probe.result(id, radiance);
        }
    }
}

/// Tests of primitives and of boxes on the way to the nearest hit: also of rays that hit nothing.
fn count(cx: &SampleCx<'_>, ray: &PathRay) -> Value {
    let mut counters = Counters::default();
    let id = counters.ray(Default::default(), ray, RayKind::Eye);
    cx.scene.closest(cx, &ray.ray, &mut counters, id);
    Value::Data(Some([counters.primitive_tests as f32, counters.node_tests as f32, 0.0]))
}

impl Cast {
    /// The hit for those who record; what is no light has no parts.
    fn shaded<'s>(&self, cx: &SampleCx<'_>, s: &'s Shading) -> Shaded<'s> {
        let nothing = MediumStack::default();
        let of_light = |part: &dyn Fn() -> Spectrum| match self.show {
            Show::Shading => part(),
            _ => Spectrum::BLACK,
        };
        Shaded {
            wo: s.wo_local,
            bsdf: &s.bsdf,
            before: nothing,
            after: nothing,
            arrived: Spectrum::ONE,
            emission: of_light(&|| s.sent_out()),
            ambient: of_light(&|| s.ambient(cx)),
            blurred_sky: of_light(&|| s.blurred_sky(cx)),
        }
    }

    fn hit(&self, cx: &SampleCx<'_>, ray: &PathRay, hit: &Hit, s: &Shading) -> Value {
        let data = |v: [f32; 3]| Value::Data(Some(v));
        match self.show {
            Show::Depth => data([hit.t * cx.scene.view.cos_to_axis(ray.ray.d, ray.ray.time), hit.t, 0.0]),
            Show::Normal => data(s.surface.n_s.face_forward(s.wo).to_array()),
            Show::Uv => data([s.surface.uv.x, s.surface.uv.y, 0.0]),
            Show::Id => data([s.object.index() as f32 + 1.0, 0.0, 0.0]),
            Show::Albedo => Value::Radiance(s.bsdf.albedo() * cx.basis.white()),
            Show::Cost => Value::Data(None),
            Show::Shading => {
                let mut radiance = s.sent_out() + s.ambient(cx) + s.blurred_sky(cx);
                let lamps = if s.bsdf.is_sharp() { &[] } else { &cx.scene.lamps[..] };
                for light in lamps.iter().map(|&light| light as usize) {
                    if let Some((weight, sample)) =
                        s.light(cx, light, &ray.sampler.fork(LIGHT_BRANCH + light as u32), |_| Seen::Branches)
                    {
                        radiance += weight * sample.weight;
                    }
                }
                Value::Radiance(radiance)
            }
        }
    }

    fn miss(&self, cx: &SampleCx<'_>, ray: &PathRay) -> Value {
        match self.show {
            Show::Shading => Value::Radiance(cx.scene.escaped(cx.basis, ray.ray.d)),
            Show::Albedo => Value::Radiance(Spectrum::BLACK),
            _ => Value::Data(None),
        }
    }
}
