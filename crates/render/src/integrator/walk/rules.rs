//! What an integrator asks of the recursion, and the parameters that say it.
use std::num::NonZeroU32;

use durer_model::bsdf::Straight;
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use crate::PathRay;

/// What an integrator asks of the recursion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Rules {
    /// Bounces traced at most.
    pub(in super::super) max_depth: u32,
    /// A branch whose share in the pixel is at or below this is not traced.
    pub(in super::super) min_contribution: f32,
    /// How shadow rays pass transparent things; `None` if they do not.
    pub(in super::super) straight: Option<Straight>,
    /// Metres at which nothing is left of a mirrored or refracted ray; infinite if they do not fade.
    pub(in super::super) attenuation_distance: f32,
    /// Shadow rays to each light with extent; 0: one to its middle.
    pub(in super::super) shadow_rays: u32,
    /// Which lights get them.
    pub(in super::super) lights: Lights,
    /// Rays drawn from each lobe that spreads; `None`: its sharp direction stands for it.
    pub(in super::super) gloss_rays: Option<NonZeroU32>,
}

/// Which lights get shadow rays from a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lights {
    /// All of them.
    #[default]
    All,
    /// One for each ray, chosen in proportion to what it could send: one more dimension of what is distributed.
    One,
}

impl Lights {
    /// All words, in the order of the variants.
    pub const WORDS: [&'static str; 2] = ["all", "one"];

    /// The word in files and on the command line.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
    /// The variant of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::All, Self::One].into_iter().find(|l| l.word() == word)
    }
}

/// What transparent things do to light on its straight way to a surface. Nothing bends it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadows {
    /// They block it, as opaque things do.
    #[default]
    Opaque,
    /// They colour it: each surface by what it transmits, each body by what it absorbs.
    Tinted,
    /// The same, less what each surface reflects.
    Fresnel,
}

impl Shadows {
    /// All words, in the order of the variants.
    pub const WORDS: [&'static str; 3] = ["opaque", "tinted", "fresnel"];

    /// The word in files and on the command line.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
    /// The variant of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Opaque, Self::Tinted, Self::Fresnel].into_iter().find(|s| s.word() == word)
    }
    /// How surfaces are passed; `None` if they are not.
    fn straight(self) -> Option<Straight> {
        match self {
            Self::Opaque => None,
            Self::Tinted => Some(Straight::Tinted),
            Self::Fresnel => Some(Straight::Fresnel),
        }
    }
}

impl Rules {
    /// Those of paths, which end by depth and by chance only: light goes straight through what nothing bends.
    pub(in super::super) const PATH: Self = Self {
        max_depth: 5,
        min_contribution: 0.0,
        straight: Some(Straight::Clear),
        attenuation_distance: f32::INFINITY,
        shadow_rays: 1,
        lights: Lights::One,
        gloss_rays: NonZeroU32::new(1),
    };
    /// The parameter of [`Rules::max_depth`].
    pub(in super::super) const MAX_DEPTH: ParamSpec =
        ParamSpec::new("maxdepth", ParamType::Int, ParamDefault::Int(10), "Bounces traced at most.")
            .unit("bounces")
            .range(0.0, 1000.0);
    /// The parameter of [`Rules::min_contribution`].
    pub(in super::super) const MIN_CONTRIBUTION: ParamSpec = ParamSpec::float(
        "mincontribution",
        1.0 / 512.0,
        "A branch whose share in the pixel is at or below this is not traced.",
    )
    .range(0.0, 1.0);
    /// The parameter of [`Rules::shadows`].
    pub(in super::super) const SHADOWS: ParamSpec = ParamSpec::new(
        "shadows",
        ParamType::Choice(&Shadows::WORDS),
        ParamDefault::Text("opaque"),
        "What transparent things do to light: block it, colour it, or also keep what they reflect.",
    );
    /// The parameter of [`Rules::attenuation_distance`].
    pub(in super::super) const ATTENUATION_DISTANCE: ParamSpec = ParamSpec::new(
        "attenuationdistance",
        ParamType::Float,
        ParamDefault::Unset,
        "Mirrored and refracted rays fade linearly with their length, to nothing here (Whitted 1980); never if left out.",
    )
    .unit("m")
    .range(1e-6, f32::INFINITY);

    /// Whitted's rules, with what the four parameters say.
    pub(in super::super) fn from_args(args: &Args<'_>) -> Self {
        Self {
            max_depth: args.int(Self::MAX_DEPTH.name) as u32,
            min_contribution: args.float(Self::MIN_CONTRIBUTION.name),
            straight: Shadows::from_word(args.text(Self::SHADOWS.name)).unwrap_or_default().straight(),
            attenuation_distance: args
                .optional_float(Self::ATTENUATION_DISTANCE.name)
                .unwrap_or(f32::INFINITY),
            shadow_rays: 1,
            lights: Lights::All,
            gloss_rays: None,
        }
    }

    /// The share that Whitted's linear attenuation leaves of what a ray brings from `t` metres: `max(0, 1 - t / D)`, with
    /// `t` counted from the last bounce.
    ///
    /// It is for mirrored and refracted rays: eye rays are as long as the camera is far, which is no property of the
    /// scene. Rays that leave the scene keep all: infinitely far away it would leave nothing of any sky.
    pub(super) fn attenuation(&self, ray: &PathRay, t: f32) -> f32 {
        match ray.depth {
            0 => 1.0,
            _ => (1.0 - (ray.walked + t) / self.attenuation_distance).max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lead_back() {
        for word in Shadows::WORDS {
            assert_eq!(Shadows::from_word(word).map(Shadows::word), Some(word));
        }
        assert_eq!(Shadows::from_word("soft"), None);
        for word in Lights::WORDS {
            assert_eq!(Lights::from_word(word).map(Lights::word), Some(word));
        }
    }
}
