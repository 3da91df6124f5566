//! White: what it is under daylight, and how colours look to those who take another light for white.
use glam::{DMat3, DVec3};

use super::{
    cie::XYZ,
    light_color::planck,
    observer::{RANGE, rec709},
};

/// Chromaticity x, y of D65, the white of Rec. 709.
pub const D65: [f64; 2] = [0.3127, 0.329];

/// X, Y, Z of a chromaticity at Y = 1.
pub fn tristimulus([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// X, Y, Z of linear Rec. 709.
pub fn xyz_from_rec709() -> DMat3 {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| rec709(axis).into());
    DMat3::from_cols(columns[0], columns[1], columns[2]).inverse()
}

/// What X, Y, Z under one white become for those who are used to another: Bradford's sharpened cones (Lam 1985) are scaled, each
/// by itself.
pub fn adaptation([from, to]: [[f64; 2]; 2]) -> DMat3 {
    let cones =
        DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);
    let [from, to] = [from, to].map(|white| cones * tristimulus(white));
    cones.inverse() * DMat3::from_diagonal(to / from) * cones
}

/// Chromaticity of daylight of a temperature in kelvin, as pbrt-v4 and most cameras name it: the CIE's D series (CIE 15:2004,
/// section 3.1), in which D65 is 6504 K since the constant of Planck's law was measured better; below 4000 K, where there is
/// no daylight, that of a black body.
pub fn daylight(kelvin: f64) -> [f64; 2] {
    let t = kelvin * 1.4388 / 1.4380;
    if t < 4000.0 {
        return blackbody(t);
    }
    let series = |a: f64, b: f64, c: f64, d: f64| ((a / t + b) / t + c) / t + d;
    let x = match t <= 7000.0 {
        true => series(-4.6070e9, 2.9678e6, 0.09911e3, 0.244_063),
        false => series(-2.0064e9, 1.9018e6, 0.24748e3, 0.237_040),
    };
    [x, (-3.0 * x + 2.870) * x - 0.275]
}

fn blackbody(kelvin: f64) -> [f64; 2] {
    let kelvin = kelvin as f32;
    let mut sum = DVec3::ZERO;
    for (i, seen) in XYZ.iter().enumerate() {
        let power = libm::exp(planck(kelvin, f64::from(RANGE.0) + i as f64) - planck(kelvin, 550.0));
        sum += DVec3::from_array(seen.map(f64::from)) * power;
    }
    let all = sum.element_sum();
    [sum.x / all, sum.y / all]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_is_where_the_cie_has_it() {
        // D50, D55, D65 and D75 (CIE 15:2004, table T.3), illuminant A and a glow of 2000 K on the Planckian locus.
        let known = [
            (5000.0, [0.3457, 0.3585]),
            (5500.0, [0.3324, 0.3474]),
            (6500.0, D65),
            (7500.0, [0.2990, 0.3149]),
            (2854.0, [0.4476, 0.4074]),
            (2000.0, [0.5267, 0.4133]),
        ];
        for (kelvin, expected) in known {
            let got = daylight(kelvin);
            for (got, expected) in got.iter().zip(expected) {
                assert!((got - expected).abs() < 4e-4, "{kelvin} K: {got} {expected}");
            }
        }
    }

    #[test]
    fn white_becomes_white_and_grey_keeps_its_luminance() {
        let whites = [daylight(3000.0), D65];
        let adapted = adaptation(whites) * tristimulus(whites[0]);
        assert!(adapted.abs_diff_eq(tristimulus(D65), 1e-12), "{adapted}");
        let d65 = xyz_from_rec709() * DVec3::ONE;
        assert!(d65.abs_diff_eq(tristimulus(D65), 1e-3), "{d65}");
    }
}
