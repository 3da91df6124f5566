//! What is said of a pixel: numbers, sentences and findings, for whoever shows them.
use serde::Serialize;

use super::{Finding, Part};

/// The version of the document.
pub const VERSION: u32 = 1;

/// Why a pixel has its colour.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Version of this document: 1.
    pub version: u32,
    /// The scene, as the user named it.
    pub scene: String,
    /// The integrator's registered word.
    pub integrator: String,
    /// Column and row; 0,0 is the upper left pixel.
    pub pixel: [u32; 2],
    /// How many samples the pixel has.
    pub samples: u32,
    /// The samples that are explained: all, evenly chosen ones of many, or the one that was asked for.
    pub explained: Vec<u32>,
    /// The one whose rays are followed in detail.
    pub sample: u32,
    /// What is explained: the pixel's mean, or the sample's value. Linear RGB, or the numbers of a data picture.
    pub rgb: [f64; 3],
    /// By what happens at the first surface. The parts sum to the mean of the explained samples; empty for data pictures.
    pub parts: Vec<Part>,
    /// By where light comes from. The same sum.
    pub sources: Vec<Part>,
    /// What samples have in common, and do not; `None` if one is explained.
    pub spread: Option<Spread>,
    /// At most so much of linear RGB is missing because rays were given up: their shares times the largest radiance in the
    /// scene. `None` if there is no bound.
    pub missing: Option<[f64; 3]>,
    /// Why there is no bound; `None` if there is one.
    pub no_bound: Option<String>,
    /// The text.
    pub paragraphs: Vec<Paragraph>,
    /// What is wrong. Empty unless the renderer or the scene has a fault.
    pub findings: Vec<SampleFinding>,
}

/// How samples differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Standard deviation of the luminance.
    pub deviation: f64,
    /// The sample of the largest luminance, and that.
    pub brightest: (u32, f64),
    /// The sample of the smallest luminance, and that.
    pub darkest: (u32, f64),
    /// Samples that are infinite or NaN: the film leaves them out.
    pub bad: Vec<u32>,
}

/// Sentences about one thing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Paragraph {
    /// What about: `pixel`, `samples`, `ray`, `sources`, `cut` or `findings`.
    pub about: &'static str,
    /// The ray that it tells of, in the tree of [`Explanation::sample`].
    pub node: Option<u32>,
    /// Only for those who want to know more.
    pub is_detail: bool,
    /// The sentences, each with its full stop.
    pub sentences: Vec<String>,
}

/// A finding, and the sample that it was found in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleFinding {
    /// The sample.
    pub sample: u32,
    /// What is wrong.
    #[serde(flatten)]
    pub finding: Finding,
    /// How many of the explained samples have it.
    pub samples: usize,
}

impl Explanation {
    /// The paragraphs as text, each in one line: those for everybody, or all.
    pub fn text(&self, with_details: bool) -> String {
        let shown = self.paragraphs.iter().filter(|p| with_details || !p.is_detail);
        shown.map(|p| p.sentences.join(" ")).collect::<Vec<_>>().join("\n\n")
    }
}
