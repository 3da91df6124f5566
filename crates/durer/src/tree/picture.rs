//! The picture, small and rendered in a moment: for orientation.
use std::sync::atomic::AtomicBool;

use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};

use crate::{
    Output, Prepared, Show,
    film::{Developed, ToneMap, develop, develop_data},
    image::encode_png,
    integrator::Cast,
};

/// Most pixels of a row or column.
const LARGEST: u32 = 320;
/// Rows and columns of pixels that tell what a picture costs.
const SOUNDINGS: u32 = 4;
/// Most rays a sample, on average.
const MOST_RAYS: u64 = 200;

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
        let Developed { width, height, rgb8 } = match job.integrator.output() {
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

/// Whether a few pixels' first samples take more rays than a small picture may.
fn is_costly(prepared: &Prepared) -> bool {
    let mut job = prepared.job();
    job.settings.samples = 1;
    let (width, height) = (prepared.scene.view.width, prepared.scene.view.height);
    let mut pixels = 0;
    let mut rays = 0;
    // One after another: the first costly one ends it.
    for (x, y) in (0..SOUNDINGS).flat_map(|y| (0..SOUNDINGS).map(move |x| (x, y))) {
        let at = |i: u32, n: u32| ((2 * i + 1) * n / (2 * SOUNDINGS)).min(n.saturating_sub(1));
        let counted = job.count(&[[at(x, width), at(y, height)]], &AtomicBool::new(false));
        pixels += 1;
        rays += counted.counters.all_rays();
        if rays > SOUNDINGS as u64 * SOUNDINGS as u64 * MOST_RAYS {
            return true;
        }
    }
    rays > pixels * MOST_RAYS
}
