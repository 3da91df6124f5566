//! Options that several commands share, what they mean to the library, and how to say them again.
mod distribution;
mod overlay;
mod scene;

use clap::{
    Args, ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use durer::{
    Options, Shadows, Show,
    accel::{Engine, Preset},
    drive::{Adaptive, Antialias, MAX_SPLITS, SmallObjects},
    film::Tile,
    integrator::INTEGRATORS,
    sampling::SamplerKind,
    spectrum::Carried,
};

use distribution::DistributionOptions;
pub(crate) use scene::SceneOptions;

use crate::value::{crop, fraction, positive, whole};

/// How hits are found: what a word of `--accel` stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Search {
    word: &'static str,
    about: &'static str,
    engine: Engine,
    preset: Preset,
}

/// All of them. The second is the default.
const SEARCHES: [Search; 4] = [
    Search {
        word: "fast",
        about: "A hierarchy of boxes that is built sooner and searched more slowly",
        engine: Engine::Bvh,
        preset: Preset::Fast,
    },
    Search {
        word: "balanced",
        about: "A hierarchy of boxes for most pictures",
        engine: Engine::Bvh,
        preset: Preset::Balanced,
    },
    Search {
        word: "high",
        about: "A hierarchy of boxes for pictures that take minutes",
        engine: Engine::Bvh,
        preset: Preset::High,
    },
    Search {
        word: "none",
        about: "Every primitive is tested with every ray",
        engine: Engine::BruteForce,
        preset: Preset::Balanced,
    },
];
const DEFAULT_SEARCH: &str = SEARCHES[1].word;

/// The words of `--antialias`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Strategy {
    /// As many in every pixel, spread over it
    Supersample,
    /// At the corners of squares, shared by neighbours, that are split where they differ (Whitted 1980)
    Adaptive,
}

/// Something that is done or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Switch {
    On,
    Off,
}

/// Size of the picture and samples of its pixels.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Film")]
pub(crate) struct FilmOptions {
    /// Pixels per row; alone it keeps the scene's aspect ratio [default: the scene's, else 1280].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=65536), allow_negative_numbers = true)]
    width: Option<u32>,
    /// Rows [default: the scene's, else 720].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=65536), allow_negative_numbers = true)]
    height: Option<u32>,
    /// Factor on width and height.
    #[arg(long, value_name = "F", value_parser = positive, allow_negative_numbers = true)]
    scale: Option<f32>,
    /// Samples per pixel [default: the scene's, else 64; data pictures 1].
    #[arg(long, alias = "samples", value_name = "N", value_parser = whole(1..=u32::MAX), allow_negative_numbers = true)]
    spp: Option<u32>,
    /// How samples become random numbers: docs/samplers.md compares [default: the scene's, else zsobol].
    #[arg(long, value_name = "KIND", value_parser = sampler())]
    sampler: Option<SamplerKind>,
    /// Where the samples of a pixel lie [default: supersample].
    #[arg(long, value_name = "HOW", value_enum)]
    antialias: Option<Strategy>,
    /// How many times a pixel is split at most, with --antialias adaptive; small objects are looked for so far
    /// [default: 4].
    #[arg(long, value_name = "N", value_parser = whole(0..=MAX_SPLITS), allow_negative_numbers = true)]
    #[arg(requires = "antialias")]
    aa_depth: Option<u32>,
    /// A square is split if the largest difference between its corners, where 0 is black and 1 white to the eye,
    /// times the 1.5th power of its edge in pixels is larger than this, with --antialias adaptive [default: 1/14].
    #[arg(long, value_name = "F", value_parser = fraction, allow_negative_numbers = true)]
    #[arg(requires = "antialias")]
    aa_threshold: Option<f32>,
    /// Whether squares are split until objects are met that lie between the rays, with --antialias adaptive
    /// [default: on].
    #[arg(long, value_name = "WHETHER", value_enum, requires = "antialias")]
    aa_small_objects: Option<Switch>,
    /// The part to render, in pixels from the upper left corner; the rest stays black.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop, allow_hyphen_values = true)]
    crop: Option<Tile>,
    /// Changes every random number [default: 0].
    #[arg(long, value_name = "N", value_parser = whole(0..=u64::MAX), allow_negative_numbers = true)]
    seed: Option<u64>,
}

/// How light is followed.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Light transport")]
pub(crate) struct TransportOptions {
    /// The light transport [default: the scene's, else path].
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(integrators()))]
    integrator: Option<String>,
    /// What `--integrator cast` shows of the nearest hit [default: shading].
    #[arg(long, value_name = "WHAT", value_parser = show())]
    show: Option<Show>,
    /// Bounces traced at most; 0 leaves eye and shadow rays [default: the scene's, else 8; 5 for paths in
    /// pbrt files, 10 for whitted and distributed].
    #[arg(long, value_name = "N", value_parser = whole(0u32..=1000), allow_negative_numbers = true)]
    max_depth: Option<u32>,
    /// Stop where a branch's share in the pixel is at or below this [default: the scene's, else 1/512].
    #[arg(long, value_name = "F", value_parser = fraction, allow_negative_numbers = true)]
    min_contribution: Option<f32>,
    /// What transparent things do to light: block it, colour it, or also keep what they reflect [default: the scene's,
    /// else opaque].
    #[arg(long, value_name = "HOW", value_parser = shadows())]
    shadows: Option<Shadows>,
    /// Whether rays carry four wavelengths, other ones for every sample, instead of red, green and blue: measured spectra
    /// count in full, and glass of a curve splits light [default: the scene's, else off].
    #[arg(long, value_name = "WHETHER", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "on")]
    spectral: Option<Switch>,
    /// How hits are found; the picture does not depend on it [default: balanced].
    #[arg(long, value_name = "HOW", default_value = DEFAULT_SEARCH, hide_default_value = true, value_parser = search())]
    accel: Search,
}

/// How much is said on stderr.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub(crate) struct TalkOptions {
    /// Say nothing but errors.
    #[arg(long, short, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say notes too.
    #[arg(long, short)]
    pub(crate) verbose: bool,
}

/// All that decides the value of a pixel sample.
#[derive(Args, Clone, Debug)]
pub(crate) struct SampleOptions {
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
    #[command(flatten)]
    pub(crate) film: FilmOptions,
    #[command(flatten)]
    pub(crate) transport: TransportOptions,
    #[command(flatten)]
    pub(crate) distribution: DistributionOptions,
}

impl Switch {
    fn carried(self) -> Carried {
        match self {
            Self::On => Carried::Wavelengths,
            Self::Off => Carried::Rgb,
        }
    }
}

impl FilmOptions {
    fn antialias(&self) -> Antialias {
        if self.antialias != Some(Strategy::Adaptive) {
            return Antialias::Supersample;
        }
        let usual = Adaptive::default();
        let is_off = self.aa_small_objects == Some(Switch::Off);
        Antialias::Adaptive(Adaptive {
            depth: self.aa_depth.unwrap_or(usual.depth),
            threshold: self.aa_threshold.unwrap_or(usual.threshold),
            small_objects: if is_off { SmallObjects::Ignored } else { SmallObjects::Found },
        })
    }
}

impl SampleOptions {
    /// The wishes in the library's terms.
    pub(crate) fn wishes(&self) -> Options {
        let FilmOptions { width, height, scale, spp, sampler, crop, seed, .. } = self.film;
        let TransportOptions { integrator, show, max_depth, min_contribution, shadows, spectral, accel } =
            self.transport.clone();
        Options {
            integrator,
            show,
            width,
            height,
            scale,
            samples: spp,
            sampler,
            antialias: self.film.antialias(),
            max_depth,
            min_contribution,
            shadows,
            carried: spectral.map(Switch::carried),
            crop,
            engine: accel.engine,
            preset: accel.preset,
            seed,
            distribution: self.distribution.wishes(),
            ..self.scene.wishes()
        }
    }

    /// The words after `durer trace` that replay a sample of a render with these options. Names every field, so that a
    /// new option cannot be forgotten here.
    pub(crate) fn replay(&self, pixel: [u32; 2], sample: u32) -> String {
        // A crop changes no sample.
        let FilmOptions {
            width,
            height,
            scale,
            spp,
            sampler,
            antialias,
            aa_depth,
            aa_threshold,
            aa_small_objects,
            crop: _,
            seed,
        } = &self.film;
        let TransportOptions { integrator, show, max_depth, min_contribution, shadows, spectral, accel } =
            &self.transport;
        let scene = quoted(&self.scene.scene);
        let mut words = vec![scene, format!("--pixel {},{} --sample {sample}", pixel[0], pixel[1])];
        let mut say = |name: &str, value: Option<String>| {
            words.extend(value.map(|v| format!("--{name} {}", quoted(&v))));
        };
        self.scene.words().into_iter().for_each(|(name, value)| say(name, value));
        say("width", width.map(|v| v.to_string()));
        say("height", height.map(|v| v.to_string()));
        say("scale", scale.map(|v| v.to_string()));
        say("spp", spp.map(|v| v.to_string()));
        say("sampler", sampler.map(|v| v.word().to_owned()));
        let word = |value: Option<PossibleValue>| value.map(|v| v.get_name().to_owned());
        say("antialias", word(antialias.and_then(|v| v.to_possible_value())));
        say("aa-depth", aa_depth.map(|v| v.to_string()));
        say("aa-threshold", aa_threshold.map(|v| v.to_string()));
        say("aa-small-objects", word(aa_small_objects.and_then(|v| v.to_possible_value())));
        say("seed", seed.map(|v| v.to_string()));
        say("integrator", integrator.clone());
        say("show", show.map(|v| v.word().to_owned()));
        say("max-depth", max_depth.map(|v| v.to_string()));
        say("min-contribution", min_contribution.map(|v| v.to_string()));
        say("shadows", shadows.map(|v| v.word().to_owned()));
        words.extend(
            spectral.map(|v| if v == Switch::On { "--spectral" } else { "--spectral=off" }.to_owned()),
        );
        let mut say = |name: &str, value: Option<String>| {
            words.extend(value.map(|v| format!("--{name} {}", quoted(&v))));
        };
        say("accel", Some(accel.word.to_owned()).filter(|word| word != DEFAULT_SEARCH));
        self.distribution.words().into_iter().for_each(|(name, value)| say(name, value));
        if self.scene.lenient {
            words.push("--lenient".to_owned());
        }
        words.join(" ")
    }
}

/// As a shell takes it for one word.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,:=+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

fn integrators() -> Vec<PossibleValue> {
    INTEGRATORS.iter().map(|e| PossibleValue::new(e.schema.name).help(e.schema.doc)).collect()
}

fn sampler() -> impl TypedValueParser<Value = SamplerKind> {
    let words = SamplerKind::ALL.map(SamplerKind::word);
    PossibleValuesParser::new(words).try_map(|word| SamplerKind::from_word(&word).ok_or("unknown"))
}

fn show() -> impl TypedValueParser<Value = Show> {
    PossibleValuesParser::new(Show::WORDS).try_map(|word| Show::from_word(&word).ok_or("unknown"))
}

fn shadows() -> impl TypedValueParser<Value = Shadows> {
    PossibleValuesParser::new(Shadows::WORDS).try_map(|word| Shadows::from_word(&word).ok_or("unknown"))
}

impl Search {
    fn value(self) -> PossibleValue {
        let value = PossibleValue::new(self.word).help(self.about);
        // What it was called when there was but one hierarchy.
        if self.word == DEFAULT_SEARCH { value.alias("bvh") } else { value }
    }
}

fn search() -> impl TypedValueParser<Value = Search> {
    PossibleValuesParser::new(SEARCHES.map(Search::value))
        .try_map(|word| SEARCHES.into_iter().find(|s| s.value().matches(&word, false)).ok_or("unknown"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_words_are_quoted() {
        assert_eq!(quoted("a/b-c.glb"), "a/b-c.glb");
        assert_eq!(quoted("my scene's"), r"'my scene'\''s'");
    }
}
