//! The spectra that pbrt-v4 knows by name, and some more indices ([`super::index()`]): a colour and one number for rays that
//! carry red, green and blue, and a curve where one is known.
//!
//! Indices of refraction and absorption are given at 611.4, 549.1 and 464.2 nm, the dominant wavelengths of the Rec. 709
//! primaries, and at 587.6 nm: metals as measured by Palik 1985 and Querry 1985, glasses as in their makers' catalogues.
//! Illuminants are given by their CIE 1931 chromaticity (CIE 15:2004, tables T.3 and T.8; ACES: SMPTE ST 2065-1).
use super::{
    Color, Curve, HELIUM_D, HUES, LightColor,
    illuminant::illuminant,
    index::{index, index_curve, index_names},
    metal::curve,
    sampled::chromatic,
};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Named {
    /// Linear Rec. 709; of an illuminant at luminance 1.
    pub color: Color,
    /// At 587.6 nm; of an illuminant 1.
    pub number: f32,
}

/// Values at the three wavelengths and at 587.6 nm.
const INDICES: &[(&str, [f32; 4])] = &[
    ("glass-BK7", [1.5159, 1.5186, 1.5241, 1.5168]),
    ("glass-BAF10", [1.6684, 1.6731, 1.6831, 1.67]),
    ("glass-FK51A", [1.4859, 1.4878, 1.4917, 1.4866]),
    ("glass-LASF9", [1.8472, 1.856, 1.8751, 1.8503]),
    ("glass-F5", [1.6703, 1.6772, 1.6923, 1.6727]),
    ("glass-F10", [1.7254, 1.7337, 1.7522, 1.7283]),
    ("glass-F11", [1.7813, 1.7913, 1.8138, 1.7847]),
    ("glass-SF5", [1.6703, 1.6772, 1.6923, 1.6727]),
    ("glass-SF10", [1.7254, 1.7337, 1.7522, 1.7283]),
    ("glass-SF11", [1.7813, 1.7913, 1.8138, 1.7847]),
    ("metal-Ag-eta", [0.1279, 0.1251, 0.1401, 0.1207]),
    ("metal-Ag-k", [3.8159, 3.3322, 2.6062, 3.6383]),
    ("metal-Al-eta", [1.2549, 0.9547, 0.6582, 1.1357]),
    ("metal-Al-k", [7.3842, 6.6757, 5.6435, 7.1194]),
    ("metal-Au-eta", [0.2044, 0.3547, 1.3798, 0.2425]),
    ("metal-Au-k", [3.0346, 2.6997, 1.8279, 2.964]),
    ("metal-Cu-eta", [0.3167, 0.9649, 1.1573, 0.5043]),
    ("metal-Cu-k", [3.1108, 2.5776, 2.4539, 2.7823]),
    ("metal-CuZn-eta", [0.4516, 0.529, 0.9545, 0.4619]),
    ("metal-CuZn-k", [3.3575, 2.7563, 1.9141, 3.135]),
    ("metal-MgO-eta", [1.736, 1.7405, 1.7503, 1.7375]),
    ("metal-MgO-k", [0.0; 4]),
    ("metal-TiO2-eta", [2.8886, 2.9563, 3.1196, 2.9124]),
    ("metal-TiO2-k", [0.0; 4]),
];

/// Chromaticities x, y.
const ILLUMINANTS: &[(&str, [f64; 2])] = &[
    ("stdillum-A", [0.447_58, 0.407_45]),
    ("stdillum-D50", [0.345_67, 0.358_51]),
    ("stdillum-D65", [0.312_72, 0.329_03]),
    ("stdillum-F1", [0.3131, 0.3371]),
    ("stdillum-F2", [0.3721, 0.3751]),
    ("stdillum-F3", [0.4091, 0.3941]),
    ("stdillum-F4", [0.4402, 0.4031]),
    ("stdillum-F5", [0.3138, 0.3452]),
    ("stdillum-F6", [0.3779, 0.3882]),
    ("stdillum-F7", [0.3129, 0.3292]),
    ("stdillum-F8", [0.3458, 0.3586]),
    ("stdillum-F9", [0.3741, 0.3727]),
    ("stdillum-F10", [0.3458, 0.3588]),
    ("stdillum-F11", [0.3805, 0.3769]),
    ("stdillum-F12", [0.437, 0.4042]),
    ("illum-acesD60", [0.321_68, 0.337_67]),
];

/// The spectrum called `name`.
pub fn named(name: &str) -> Option<Named> {
    if let Some((_, [r, g, b, number])) = INDICES.iter().find(|n| n.0 == name) {
        return Some(Named { color: Color::new(*r, *g, *b), number: *number });
    }
    if index_names().any(|known| known == name) {
        let [r, g, b, yellow] =
            [HUES[0], HUES[1], HUES[2], HELIUM_D].map(|nm| index(name, nm).unwrap_or(1.0) as f32);
        return Some(Named { color: Color::new(r, g, b), number: yellow });
    }
    let (_, [x, y]) = ILLUMINANTS.iter().find(|n| n.0 == name)?;
    Some(Named { color: chromatic(*x, *y), number: 1.0 })
}

/// The index or extinction called `name` over wavelengths; `None` if it is none.
pub fn named_curve(name: &str) -> Option<Curve> {
    index_curve(name).or_else(|| Some(Curve::nearest(&curve(name)?)))
}

/// The light called `name`: in red, green and blue by its chromaticity, over wavelengths by its curve if that is known.
pub fn named_light(name: &str) -> Option<LightColor> {
    let color = named(name)?.color;
    Some(match illuminant(name) {
        Some(power) => LightColor::measured(&power).seen_as(color),
        None => color.into(),
    })
}

/// The few points of a curve of indices that are known by name: wavelengths (nm) and values in turn, rising.
pub(super) fn waves(name: &str) -> Option<[f32; 8]> {
    let (_, [r, g, b, yellow]) = INDICES.iter().find(|n| n.0 == name)?;
    Some([464.2, *b, 549.1, *g, 587.6, *yellow, 611.4, *r])
}

/// All names.
pub fn spectrum_names() -> impl Iterator<Item = &'static str> {
    INDICES.iter().map(|n| n.0).chain(index_names()).chain(ILLUMINANTS.iter().map(|n| n.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_once_and_daylight_is_white() {
        for (i, name) in spectrum_names().enumerate() {
            assert_eq!(spectrum_names().position(|n| n == name), Some(i), "{name}");
            assert!(
                named(name).is_some_and(|n| n.color.rgb.iter().all(|v| v.is_finite() && *v >= 0.0)),
                "{name}"
            );
        }
        let white = named("stdillum-D65").expect("D65").color;
        assert!(white.rgb.iter().all(|v| (v - 1.0).abs() < 2e-3), "{white:?}");
        // Incandescent light is orange.
        let [r, g, b] = named("stdillum-A").expect("A").color.rgb;
        assert!(r > 1.5 && g < 1.0 && b < 0.4, "{r} {g} {b}");
        assert_eq!(named("glass-BK7").map(|n| n.number), Some(1.5168));
        assert_eq!(named("metal-Unobtainium-eta"), None);
    }
}
