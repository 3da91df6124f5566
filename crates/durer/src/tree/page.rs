//! What the page of a ray tree holds: the trees of a pixel, all its values, the scene around them.
use std::io::Write;

use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::GzEncoder};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    compare::Comparison,
    document::Tree,
    ghost::GhostScene,
    number::{Number, Rgb},
    picture::Thumbnail,
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
    /// What the picture holds of the pixel.
    pub mean: Rgb,
    /// The picture, small.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<Thumbnail>,
    /// The scene's geometry, coarse.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<GhostScene>,
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
    /// The page's data as JSON, in the compact form: without what is null or an empty list.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer.
    pub fn compact(&self) -> serde_json::Result<String> {
        let mut value: Value = serde_json::from_str(&serde_json::to_string(self)?)?;
        drop_nothing(&mut value);
        serde_json::to_string(&value)
    }

    /// The page's data as the HTML file holds it: compact JSON, packed by gzip, in base64.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer and of packing.
    pub fn packed(&self) -> Result<Vec<u8>, serde_json::Error> {
        let text = self.compact()?;
        let mut packer = GzEncoder::new(Vec::new(), Compression::best());
        let packed = packer.write_all(text.as_bytes()).and_then(|()| packer.finish());
        let packed = packed.map_err(serde_json::Error::io)?;
        Ok(STANDARD.encode(packed).into_bytes())
    }
}

/// Takes out what says nothing, at any depth; lists keep their length.
fn drop_nothing(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            keys.values_mut().for_each(drop_nothing);
            keys.retain(|_, v| !v.is_null() && !v.as_array().is_some_and(Vec::is_empty));
        }
        Value::Array(list) => list.iter_mut().for_each(drop_nothing),
        _ => {}
    }
}
