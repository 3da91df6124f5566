//! The picture, small and rendered in a moment: for orientation.
use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};

use crate::{
    Output, Prepared, Show,
    film::{Developed, ToneMap, develop, develop_data, develop_survey},
    image::{Packing, encode_png},
    integrator::Cast,
};

/// Most pixels of a row or column.
const LARGEST: u32 = 320;
/// Most rays that a tree may come to have.
const MOST_RAYS: f64 = 20_000.0;

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
    /// Takes a few samples here and there; of the scene's shading by casting rays where whole trees would take long.
    pub fn new(prepared: &Prepared) -> Self {
        let mut job = prepared.job();
        let cast = Cast { show: Show::Shading };
        if is_costly(prepared) {
            job.integrator = &cast;
        }
        let (width, height, values) = job.preview(LARGEST);
        let Developed { width, height, rgb8 } = match job.integrator.facts().output {
            Output::Data(show) => develop_data(show, width, height, &values).picture,
            Output::Survey(survey) => develop_survey(survey, width, height, &values).0,
            Output::Radiance => {
                let finite = |v: [f32; 3]| if v.iter().all(|v| v.is_finite()) { v } else { [0.0; 3] };
                let rgb: Vec<[f32; 3]> = values.iter().map(|v| finite(v.unwrap_or_default())).collect();
                develop(width, height, &rgb, 0.0, ToneMap::None)
            }
        };
        let png = encode_png(width, height, &rgb8, Packing::Small).unwrap_or_default();
        Self { png: format!("data:image/png;base64,{}", STANDARD.encode(png)), width, height }
    }
}

/// Whether the rules of the integrator let trees become larger than a small picture may have: no more rays than a full
/// tree has, and of each bounce no more than have a share above the least.
fn is_costly(prepared: &Prepared) -> bool {
    let number = |name: &str| prepared.rules.get(name).and_then(serde_json::Value::as_f64);
    let (Some(depth), Some(least)) = (number("max_depth"), number("min_contribution")) else { return false };
    2f64.powf(depth + 1.0).min(depth / least) > MOST_RAYS
}
