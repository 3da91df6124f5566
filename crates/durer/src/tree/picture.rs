//! The picture, small and rendered in a moment: for orientation.
use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};

use crate::{
    Output, Prepared,
    film::{Developed, ToneMap, develop, develop_data},
    image::encode_png,
};

/// Most pixels of a row or column.
const LARGEST: u32 = 320;

/// A small picture of the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Thumbnail {
    /// A PNG file as a `data:` address.
    pub png: String,
    /// Its pixels per row.
    pub width: u32,
    /// Its rows.
    pub height: u32,
}

impl Thumbnail {
    /// Takes a few samples here and there.
    pub fn new(prepared: &Prepared) -> Self {
        let (width, height, values) = prepared.job().preview(LARGEST);
        let Developed { width, height, rgb8 } = match prepared.integrator.output() {
            Output::Data(show) => develop_data(show, width, height, &values).picture,
            Output::Radiance => {
                let finite = |v: [f32; 3]| if v.iter().all(|v| v.is_finite()) { v } else { [0.0; 3] };
                let rgb: Vec<[f32; 3]> = values.iter().map(|v| finite(v.unwrap_or_default())).collect();
                develop(width, height, &rgb, 0.0, ToneMap::None)
            }
        };
        let png = encode_png(width, height, &rgb8).unwrap_or_default();
        Self { png: format!("data:image/png;base64,{}", STANDARD.encode(png)), width, height }
    }
}
