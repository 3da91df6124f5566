//! Units: a scene in millimetres where metres are expected is a thousand times too large for its lamps.
use durer_scene::SceneDesc;

use super::{Finding, exposure::Trouble};
use crate::Prepared;

/// Metres across beyond which a scene that lamps light is likely not in metres.
const LARGE: f64 = 300.0;
/// The same, below.
const SMALL: f64 = 0.03;

/// Whether the size of the scene explains its light: lamps fade with the square of the distance.
pub(super) fn units(desc: &SceneDesc, prepared: &Prepared, trouble: Trouble) -> Option<Finding> {
    // Lamps with extent and skies look alike at every scale.
    let fades = |kind: &str| matches!(kind, "point" | "spot" | "projection" | "goniometric" | "ies");
    let has_lamp = desc.lights.iter().any(|light| fades(&light.node.kind));
    let bounds = prepared.scene.accel.bounds();
    let size = f64::from((bounds.max - bounds.min).length());
    let (is_off, unit, factor) = match trouble {
        Trouble::Dark => (size > LARGE, "millimetres", "0.001 0.001 0.001"),
        Trouble::Bright => (size < SMALL, "metres", "1000 1000 1000"),
    };
    if !has_lamp || !is_off {
        return None;
    }
    let much = if trouble == Trouble::Dark { "large" } else { "small" };
    let size = short(size);
    let message = format!(
        "the scene is {size} m across: {much} for its lamps, whose light fades with the square of the distance"
    );
    Some(Finding::warning(message).remedy(match trouble {
        Trouble::Dark => format!("if the file counts in {unit}, put \"Scale {factor}\" before all shapes, camera and lights"),
        Trouble::Bright => {
            format!("if the lamps were set for a scene in {unit}, put \"Scale {factor}\" before all shapes and lights")
        }
    }))
}

/// A number in three digits.
pub(super) fn short(v: f64) -> String {
    let digits = if v == 0.0 { 0 } else { 2 - v.abs().log10().floor() as i32 };
    let factor = 10f64.powi(digits);
    // The shortest decimal of the rounded number; no minus before 0.
    format!("{}", (v * factor).round() / factor + 0.0)
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!([0.0, -0.0, 1234.5, -0.012_345, 3.0].map(short), ["0", "0", "1230", "-0.0123", "3"]);
    }
}
