//! `ColorSpace`: colours of other primaries, brought to those of Rec. 709, which are ours.
//!
//! Light keeps its chromaticity. Reflectances keep white: they are adapted to D65, as
//! a white wall is white under the light that the file calls white. Primaries: ITU-R BT.709 and BT.2020, SMPTE RP 431-2 with D65
//! (as Display P3), SMPTE ST 2065-1.
use durer_core::{
    glam::{DMat3, DVec3},
    spectrum::{D65, adaptation, tristimulus},
};
use durer_scene::{Data, Param, ValueType};

/// A space of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ColorSpace {
    pub(super) name: &'static str,
    /// Chromaticities x, y of red, green, blue and white.
    red: [f64; 2],
    green: [f64; 2],
    blue: [f64; 2],
    white: [f64; 2],
}

/// Those of pbrt-v4; ours comes first.
pub(super) const COLOR_SPACES: [ColorSpace; 4] = [
    ColorSpace { name: "srgb", red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: D65 },
    ColorSpace { name: "dci-p3", red: [0.68, 0.32], green: [0.265, 0.69], blue: [0.15, 0.06], white: D65 },
    ColorSpace {
        name: "rec2020",
        red: [0.708, 0.292],
        green: [0.17, 0.797],
        blue: [0.131, 0.046],
        white: D65,
    },
    ColorSpace {
        name: "aces2065-1",
        red: [0.7347, 0.2653],
        green: [0.0, 1.0],
        blue: [0.0001, -0.077],
        white: [0.32168, 0.33767],
    },
];

const OURS: ColorSpace = COLOR_SPACES[0];

/// Whether colours send light or reflect it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    Light,
    Surface,
}

/// Parameters that say how much light is sent out.
const LIGHT: [&str; 3] = ["L", "I", "Le"];

impl ColorSpace {
    pub(super) const SRGB: Self = OURS;

    /// The space of a name.
    pub(super) fn of(name: &str) -> Option<Self> {
        COLOR_SPACES.into_iter().find(|space| space.name == name)
    }

    fn xyz(self) -> DMat3 {
        let [r, g, b] = [self.red, self.green, self.blue].map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
        let primaries = DMat3::from_cols(r, g, b);
        let amounts = primaries.inverse() * tristimulus(self.white);
        primaries * DMat3::from_diagonal(amounts)
    }

    /// To linear Rec. 709.
    fn to_ours(self, of: Of) -> DMat3 {
        let adapted = if of == Of::Surface && self.white != OURS.white {
            adaptation([self.white, OURS.white])
        } else {
            DMat3::IDENTITY
        };
        OURS.xyz().inverse() * adapted * self.xyz()
    }

    /// Turns the colours of a parameter into ours; true if one of them has none: what is below 0, and of a surface above 1, is
    /// cut off.
    pub(super) fn convert(self, param: &mut Param) -> bool {
        let (ValueType::Rgb, Data::Floats(values)) = (param.ty, &mut param.data) else { return false };
        if self == OURS {
            return false;
        }
        let of = if LIGHT.contains(&param.name.as_str()) { Of::Light } else { Of::Surface };
        let to_ours = self.to_ours(of);
        let mut is_cut = false;
        for color in values.chunks_exact_mut(3) {
            let &mut [r, g, b] = color else { continue };
            let exact = to_ours * DVec3::new(r.into(), g.into(), b.into());
            // Negative numbers are somebody else's complaint.
            let least = if r.min(g).min(b) < 0.0 { f64::NEG_INFINITY } else { 0.0 };
            let most = if of == Of::Surface { f64::from(r.max(g).max(b).max(1.0)) } else { f64::INFINITY };
            let kept = exact.clamp(DVec3::splat(least), DVec3::splat(most));
            is_cut |= (kept - exact).abs().max_element() > 1e-4 * most.min(1.0);
            color.copy_from_slice(&kept.as_vec3().to_array());
        }
        is_cut
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: DVec3, b: [f64; 3], within: f64) {
        assert!(a.abs_diff_eq(b.into(), within), "{a} is not {b:?}");
    }

    #[test]
    fn matrices_are_those_of_the_standards() {
        // Lindbloom's sRGB to XYZ, and BT.2087's BT.2020 to BT.709 (its first and second column).
        let xyz = OURS.xyz();
        near(xyz.x_axis, [0.4124, 0.2126, 0.0193], 1e-4);
        near(xyz.y_axis, [0.3576, 0.7152, 0.1192], 1e-4);
        let wide = COLOR_SPACES[2].to_ours(Of::Light);
        near(wide.x_axis, [1.6605, -0.1246, -0.0182], 1e-4);
        near(wide.y_axis, [-0.5876, 1.1329, -0.1006], 1e-4);
    }

    #[test]
    fn white_surfaces_stay_white_and_white_light_keeps_its_colour() {
        for space in COLOR_SPACES {
            near(space.to_ours(Of::Surface) * DVec3::ONE, [1.0; 3], 1e-9);
        }
        let aces = COLOR_SPACES[3];
        // D60 is warmer than D65, at the same luminance.
        let light = aces.to_ours(Of::Light) * DVec3::ONE;
        assert!(light.x > 1.01 && light.z < 0.95, "{light}");
        assert!((light.dot(DVec3::new(0.2126, 0.7152, 0.0722)) - 1.0).abs() < 1e-4);
    }
}
