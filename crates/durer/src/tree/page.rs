//! What the page of a ray tree holds: the trees of a pixel, all its values, the scene around them.
use serde::{Deserialize, Serialize};

use super::{
    compare::Comparison,
    document::Tree,
    ghost::GhostScene,
    number::{Number, Rgb},
    picture::Thumbnail,
    room::{self, Lean, lean},
};

/// All of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Page {
    /// Version of this schema: 1.
    pub version: u32,
    /// The sample that was asked for, then others of the pixel, as many as there is room for.
    pub trees: Vec<Tree>,
    /// The same samples under other settings.
    pub other: Option<Other>,
    /// The value of every sample of the pixel.
    pub values: Vec<Rgb>,
    /// Where and when every sample of the pixel was taken.
    pub dims: Vec<Dimensions>,
    /// What the picture holds of the pixel; of a number that is none nothing.
    pub mean: Rgb,
    /// The picture, small.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<Thumbnail>,
    /// The scene's geometry, coarse.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<GhostScene>,
    /// In the page only: what there was no room for, beside the rays that trees tell of; in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

/// The same samples under other settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Other {
    /// The text of `--diff`.
    pub options: String,
    /// Trees of the same samples as the page's own, in their order; may be fewer.
    pub trees: Vec<Tree>,
    /// What differs between the first two trees.
    pub diff: Comparison,
}

/// Where and when a sample was taken.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Dimensions {
    /// Place in the picture, in pixels.
    pub film: [Number; 2],
    /// Place on the lens in metres; null for a pinhole.
    pub lens: Option<[Number; 2]>,
    /// Moment in seconds.
    pub time: Number,
}

impl Page {
    /// Bytes of packed data that leave room for the page's program below 2 MB.
    pub const ROOM: usize = 1_150_000;
    /// Most rays that the page holds of the samples; of the same under other settings as many.
    pub const RAYS: usize = 10_000;

    /// The document with all keys: the tree, or all of this if it holds several, without the scene.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer.
    pub fn json(&self) -> serde_json::Result<String> {
        match self.trees.as_slice() {
            // What a comparison says refers to both trees.
            [tree] if self.other.is_none() => serde_json::to_string_pretty(tree),
            _ => serde_json::to_string_pretty(&Self { picture: None, scene: None, ..self.clone() }),
        }
    }

    /// The page's data as JSON, in the compact form: without what is null.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer.
    pub fn compact(&self) -> serde_json::Result<String> {
        serde_json::to_string(&lean(self, Lean::Nothing)?)
    }

    /// The page's data as the HTML file holds it: compact JSON, packed by gzip, in base64. If that is more than `most`
    /// bytes, trees lose details: first those of other samples, then all; then rays that add little to the pixel. Of
    /// more than [`Page::RAYS`] rays those go at once.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer and of packing.
    pub fn packed(&self, most: usize) -> serde_json::Result<Vec<u8>> {
        room::packed(self, most)
    }
}
