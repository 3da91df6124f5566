//! Pictures of few pixels of small scenes, compared as a whole and pixel by pixel.
use durer::{Options, Prepared};

use crate::{render, scene};

/// A camera that looks at what stands around the origin.
pub const AHEAD: &str = "LookAt 0 2 -6  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 40";
/// The plainest filter.
pub const BOX: &str = "PixelFilter \"box\"";
/// Coloured things on a floor of 16 m²: a matte ball and one of rough metal.
pub const THINGS: &str = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n\
    Shape \"bilinearmesh\" \"point3 P\" [-2 0 -2  -2 0 2  2 0 -2  2 0 2]\n\
    Material \"diffuse\" \"rgb reflectance\" [0.2 0.5 0.8]\n\
    AttributeBegin Translate -0.6 0.5 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n\
    Material \"conductor\" \"float roughness\" 0.4\n\
    AttributeBegin Translate 0.7 0.4 0.3 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n";
/// A disk above the floor.
pub const LAMP: &str = "AttributeBegin Translate 0.5 2.6 -0.5 Rotate 90 1 0 0\nMaterial \"diffuse\"\n\
    AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] Shape \"disk\" \"float radius\" 0.6 AttributeEnd\n";

/// A picture of 12 x 8 pixels under an integrator as a file names it.
pub fn picture(view: &str, integrator: &str, world: &str, samples: u32) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{view}\nIntegrator {integrator}\n\
         WorldBegin\n{world}"
    );
    scene(&text, &Options { samples: Some(samples), ..Options::default() })
}

/// The means of all pixels.
pub fn means(scene: &Prepared) -> Vec<[f64; 3]> {
    render(scene).film.pixels().iter().map(|p| p.mean().map(f64::from)).collect()
}

/// The mean of all pixels and channels.
pub fn total(pixels: &[[f64; 3]]) -> f64 {
    pixels.iter().flatten().sum::<f64>() / (3 * pixels.len()) as f64
}

/// The relative difference of all light, and that of pixels (root mean square, by the mean).
pub fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> (f64, f64) {
    let (all, other) = (total(a), total(b));
    let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
    (other / all - 1.0, (squares.sum::<f64>() / (3 * a.len()) as f64).sqrt() / all)
}

/// Two integrators, with the same parameters, make the same picture of more than darkness, within the limits of
/// [`difference`].
///
/// # Panics
/// If they do not.
pub fn agree(
    name: &str,
    (words, parameters): ([&str; 2], &str),
    view: &str,
    world: &str,
    samples: u32,
    limits: (f64, f64),
) {
    let [first, second] =
        words.map(|word| means(&picture(view, &format!("\"{word}\" {parameters}"), world, samples)));
    let (bias, error) = difference(&first, &second);
    assert!(total(&first) > 1e-3, "{name} is dark");
    assert!(
        bias.abs() < limits.0 && error < limits.1,
        "{name}: {bias}, pixels {error}\n{first:?}\n{second:?}"
    );
}
