//! Distributed ray tracing (Cook, Porter and Carpenter 1984): the rays that antialiasing needs anyway are distributed over
//! whatever blurs a picture: time, lens, area of lights, gloss and translucency.
//!
//! Two ways to combine n1, n2, ... rays of the effects in one pixel:
//! - **nested**: every combination. A pixel takes `aa * time * lens` eye rays, each hit `shadow` rays to every light and
//!   `gloss` rays per lobe.
//! - **shared**: one sample set for all dimensions. A pixel takes the largest of the numbers, and every sample has its own
//!   moment, lens point, light point and direction ("these can serve double duty"): fuzzy effects cost no extra rays.
//!
//! An effect with zero rays is frozen: the middle of the shutter time, the centre of the lens, the middle of the light, the
//! mirror direction.
use std::num::NonZeroU32;

use durer_model::material::GlossRays;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    EyeSamples, Integrator, Start, Transport,
    walk::{Lights, Rules, Walk},
};
use crate::{Contribution, SampleCx, probe::Probe};

/// How the rays of several effects are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Every combination.
    Nested,
    /// One sample set for all.
    #[default]
    Shared,
}

impl Sampling {
    /// The words for them.
    pub const WORDS: [&'static str; 2] = ["nested", "shared"];

    /// From its word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Nested, Self::Shared].into_iter().find(|s| s.word() == word)
    }
    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

/// Cook's integrator. Numbers of rays are for one pixel sample, hit and light or lobe; 0 freezes an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distributed {
    rules: Rules,
    /// Rays to each light with extent.
    pub shadow_rays: u32,
    /// Rays about each mirrored or refracted direction that spreads.
    pub gloss_rays: u32,
    /// Moments.
    pub time_samples: u32,
    /// Points of the lens.
    pub lens_samples: u32,
    /// Points of the pixel; the samples per pixel if `None`.
    pub aa_samples: Option<u32>,
    /// How they are combined.
    pub sampling: Sampling,
}

const fn rays(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Int, ParamDefault::Int(1), doc).unit("rays").range(0.0, 65536.0)
}

impl Kind for Distributed {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "distributed",
        aliases: &["cook"],
        doc: "Distributed ray tracing: soft shadows, gloss, translucency, motion blur and depth of field by distributing \
              rays (Cook, Porter and Carpenter 1984).",
        params: &[
            Rules::MAX_DEPTH,
            Rules::MIN_CONTRIBUTION,
            Rules::SHADOWS,
            Rules::ATTENUATION_DISTANCE,
            rays("shadowrays", "Rays to each light with extent; 0: to its middle only, for hard shadows."),
            ParamSpec::new(
                "lights",
                ParamType::Choice(&Lights::WORDS),
                ParamDefault::Text("all"),
                "all: shadow rays to every light; one: to one, chosen in proportion to what it could send.",
            ),
            rays("glossrays", "Rays about each blurred direction; 0: the sharp one only."),
            rays("timesamples", "Moments in the time the shutter is open; 0: its middle only."),
            rays("lenssamples", "Points of the lens; 0: its centre only, a pinhole."),
            ParamSpec::new(
                "aasamples",
                ParamType::Int,
                ParamDefault::Unset,
                "Points of the pixel; the samples per pixel if left out.",
            )
            .unit("rays")
            .range(1.0, 65536.0),
            ParamSpec::new(
                "sampling",
                ParamType::Choice(&Sampling::WORDS),
                ParamDefault::Text("shared"),
                "nested: every combination of the samples above; shared: one sample set that serves all effects.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let sampling = Sampling::from_word(args.text("sampling"))?;
        let count = |name: &str| args.int(name) as u32;
        let (shadow_rays, gloss_rays) = (count("shadowrays"), count("glossrays"));
        let (time_samples, lens_samples) = (count("timesamples"), count("lenssamples"));
        let aa_samples = args.is_set("aasamples").then(|| count("aasamples"));
        let at_hits = |n: u32| if sampling == Sampling::Shared { n.min(1) } else { n };
        let rules = Rules {
            shadow_rays: at_hits(shadow_rays),
            lights: Lights::from_word(args.text("lights"))?,
            gloss_rays: NonZeroU32::new(at_hits(gloss_rays)),
            ..Rules::from_args(args)
        };
        Some(Box::new(Self {
            rules,
            shadow_rays,
            gloss_rays,
            time_samples,
            lens_samples,
            aa_samples,
            sampling,
        }))
    }
}

impl Transport for Distributed {
    fn bounded(&self) -> Option<GlossRays> {
        Some(if self.rules.gloss_rays.is_some() { GlossRays::Drawn } else { GlossRays::Main })
    }
    fn depth_limit(&self) -> Option<u32> {
        Some(self.rules.max_depth)
    }
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        let (time, lens, aa) = (self.time_samples, self.lens_samples, self.aa_samples.unwrap_or(asked));
        match self.sampling {
            Sampling::Nested => {
                EyeSamples { total: aa.saturating_mul(time.max(1)).saturating_mul(lens.max(1)), time, lens }
            }
            Sampling::Shared => EyeSamples {
                total: [aa, time, lens, self.shadow_rays, self.gloss_rays].into_iter().fold(1, u32::max),
                time: time.min(1),
                lens: lens.min(1),
            },
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
        Walk::new(&self.rules, cx, probe).start(start, parent, out);
    }
}
