//! `Film`: as the description has it, in another size.
use durer_scene::{FilmDesc, LayersDesc};

use super::value::quoted;

/// The line of a film for a picture of this size, of which a part is wanted.
pub(super) fn line(film: &FilmDesc, [width, height]: [u32; 2], crop: Option<[u32; 4]>) -> String {
    let told =
        |name: &str, v: Option<f32>| v.map(|v| format!(" \"float {name}\" [ {v} ]")).unwrap_or_default();
    let (kind, layers) = match film.layers {
        Some(LayersDesc::Surfaces(space)) => {
            ("gbuffer", format!(" \"string coordinatesystem\" [ {} ]", quoted(space.word())))
        }
        Some(LayersDesc::Buckets { count, range: [low, high] }) => (
            "spectral",
            format!(
                " \"integer nbuckets\" [ {count} ] \"float lambdamin\" [ {low} ] \"float lambdamax\" [ {high} ]"
            ),
        ),
        None => (if film.spectral { "spectral" } else { "rgb" }, String::new()),
    };
    [
        format!("Film \"{kind}\" \"integer xresolution\" [ {width} ] \"integer yresolution\" [ {height} ]"),
        told("diagonal", film.diagonal_mm),
        told("iso", film.iso),
        told("exposuretime", film.exposure_seconds),
        told("whitebalance", film.white_balance),
        told("maxcomponentvalue", film.max_component_value),
        crop.map(|[x0, x1, y0, y1]| format!(" \"integer pixelbounds\" [ {x0} {x1} {y0} {y1} ]"))
            .unwrap_or_default(),
        layers,
        film.filename
            .as_ref()
            .map(|file| format!(" \"string filename\" [ {} ]", quoted(file)))
            .unwrap_or_default(),
    ]
    .concat()
}
