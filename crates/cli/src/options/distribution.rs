//! Options of `--integrator distributed`: how many rays each effect gets, and how they are combined.
use clap::{
    Args,
    builder::{PossibleValuesParser, TypedValueParser},
};
use durer::{
    Distribution,
    integrator::{Lights, Sampling},
};

use crate::value::whole;

/// Rays per effect.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Distribution (--integrator distributed)")]
pub(crate) struct DistributionOptions {
    /// Rays to each light with extent, per hit; 0: hard shadows [default: the scene's, else 1].
    #[arg(long, value_name = "N", value_parser = whole(0u32..=65536), allow_negative_numbers = true)]
    shadow_rays: Option<u32>,
    /// all: shadow rays to every light; one: to one light, chosen in proportion to what it could send [default: the
    /// scene's, else all].
    #[arg(long, value_name = "WHICH", value_parser = lights())]
    lights: Option<Lights>,
    /// Rays about each blurred direction, per hit; 0: sharp reflections [default: the scene's, else 1].
    #[arg(long, value_name = "N", value_parser = whole(0u32..=65536), allow_negative_numbers = true)]
    gloss_rays: Option<u32>,
    /// Moments in the time the shutter is open; 0: no motion blur [default: the scene's, else 1].
    #[arg(long, value_name = "N", value_parser = whole(0u32..=65536), allow_negative_numbers = true)]
    time_samples: Option<u32>,
    /// Points of the lens; 0: a pinhole [default: the scene's, else 1].
    #[arg(long, value_name = "N", value_parser = whole(0u32..=65536), allow_negative_numbers = true)]
    lens_samples: Option<u32>,
    /// Points of the pixel [default: the scene's, else --spp].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=65536), allow_negative_numbers = true)]
    aa_samples: Option<u32>,
    /// nested: every combination of the numbers above; shared: one sample set that serves all effects, as many as the
    /// largest of them [default: the scene's, else shared].
    #[arg(long, value_name = "HOW", value_parser = sampling())]
    sampling: Option<Sampling>,
}

fn lights() -> impl TypedValueParser<Value = Lights> {
    PossibleValuesParser::new(Lights::WORDS).try_map(|word| Lights::from_word(&word).ok_or("unknown"))
}

fn sampling() -> impl TypedValueParser<Value = Sampling> {
    PossibleValuesParser::new(Sampling::WORDS).try_map(|word| Sampling::from_word(&word).ok_or("unknown"))
}

impl DistributionOptions {
    /// The wishes in the library's terms.
    pub(super) fn wishes(&self) -> Distribution {
        let Self { shadow_rays, lights, gloss_rays, time_samples, lens_samples, aa_samples, sampling } =
            *self;
        Distribution { shadow_rays, lights, gloss_rays, time_samples, lens_samples, aa_samples, sampling }
    }
    /// Option names with their values, as they were given.
    pub(super) fn words(&self) -> [(&'static str, Option<String>); 7] {
        let Self { shadow_rays, lights, gloss_rays, time_samples, lens_samples, aa_samples, sampling } =
            *self;
        let number = |n: Option<u32>| n.map(|n| n.to_string());
        [
            ("shadow-rays", number(shadow_rays)),
            ("lights", lights.map(|l| l.word().to_owned())),
            ("gloss-rays", number(gloss_rays)),
            ("time-samples", number(time_samples)),
            ("lens-samples", number(lens_samples)),
            ("aa-samples", number(aa_samples)),
            ("sampling", sampling.map(|s| s.word().to_owned())),
        ]
    }
}
