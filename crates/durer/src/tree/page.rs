//! What the page of a ray tree holds: the trees of a pixel, all its values, the scene around them.
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
    /// What the picture holds of the pixel; of a number that is none nothing.
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
    /// Bytes of packed data that leave room for the page's program below 2 MB.
    pub const ROOM: usize = 1_150_000;

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
        serde_json::to_string(&self.lean(Lean::Nothing)?)
    }

    fn lean(&self, lean: Lean) -> serde_json::Result<Value> {
        let mut value: Value = serde_json::from_str(&serde_json::to_string(self)?)?;
        let own = value.get_mut("trees").and_then(Value::as_array_mut);
        own.into_iter().flatten().skip(lean.whole()).for_each(lighten);
        let other = value.pointer_mut("/other/trees").and_then(Value::as_array_mut);
        other.into_iter().flatten().skip(lean.whole()).for_each(lighten);
        drop_nothing(&mut value);
        Ok(value)
    }

    /// The page's data as the HTML file holds it: compact JSON, packed by gzip, in base64. If that is more than `most`
    /// bytes, trees lose details: first those of other samples, then all, then there are fewer of other samples.
    ///
    /// # Errors
    /// None that data of ours leads to; those of the JSON writer and of packing.
    pub fn packed(&self, most: usize) -> serde_json::Result<Vec<u8>> {
        for lean in [Lean::Nothing, Lean::Others, Lean::All] {
            let packed = pack(&self.lean(lean)?)?;
            if packed.len() <= most {
                return Ok(packed);
            }
        }
        let mut fewer = self.clone();
        loop {
            let kept = fewer.trees.len().div_ceil(2);
            fewer.trees.truncate(kept);
            let packed = pack(&fewer.lean(Lean::All)?)?;
            if packed.len() <= most || kept <= 1 {
                return Ok(packed);
            }
        }
    }
}

/// Which trees lose details.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lean {
    Nothing,
    /// All but the first.
    Others,
    All,
}

impl Lean {
    /// How many trees are left whole.
    fn whole(self) -> usize {
        match self {
            Self::Nothing => usize::MAX,
            Self::Others => 1,
            Self::All => 0,
        }
    }
}

fn pack(value: &Value) -> serde_json::Result<Vec<u8>> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    serde_json::to_writer(&mut packer, value)?;
    let packed = packer.finish().map_err(serde_json::Error::io)?;
    Ok(STANDARD.encode(packed).into_bytes())
}

/// Details that a tree can do without.
const DETAILS: [&str; 8] = ["walk", "sampler", "triangle", "barycentric", "ns", "uv", "ambient", "emission"];
/// The same of lists, which become empty.
const LISTS: [&str; 3] = ["random", "textures", "lobes"];
/// Significant digits of numbers of such a tree.
const DIGITS: usize = 6;

/// Takes details and digits from a tree.
fn lighten(tree: &mut Value) {
    let nodes = tree.get_mut("nodes").and_then(Value::as_array_mut);
    for node in nodes.into_iter().flatten() {
        if let Some(keys) = node.as_object_mut() {
            keys.retain(|key, _| !DETAILS.contains(&key.as_str()));
            for key in LISTS {
                keys.insert(key.to_owned(), Value::Array(Vec::new()));
            }
            if keys.get("normal") == keys.get("geometric_normal") {
                keys.remove("geometric_normal");
            }
        }
        round(node);
    }
}

fn round(value: &mut Value) {
    match value {
        Value::Object(keys) => keys.values_mut().for_each(round),
        Value::Array(list) => list.iter_mut().for_each(round),
        Value::Number(number) if number.is_f64() => {
            let rounded = number.as_f64().map(|v| format!("{v:.*e}", DIGITS - 1));
            let rounded = rounded.and_then(|v| v.parse().ok()).and_then(serde_json::Number::from_f64);
            *number = rounded.unwrap_or_else(|| number.clone());
        }
        _ => {}
    }
}

/// Takes out what says nothing, at any depth; lists keep their length.
fn drop_nothing(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            keys.values_mut().for_each(drop_nothing);
            keys.retain(|_, v| !v.is_null());
        }
        Value::Array(list) => list.iter_mut().for_each(drop_nothing),
        _ => {}
    }
}
