//! Standard illuminants as curves: A by its formula, D50 and the lamps F2 and F11 by their tables (CIE 15:2004), D65.
//!
//! Of the other lamps of the F series only the chromaticity is known here ([`super::named()`]): their light is as smooth as
//! that of a colour.
use super::{
    Sampled,
    observer::{RANGE, d65},
};

/// D50, from 360 to 780 nm every ten.
#[rustfmt::skip]
const D50: [f32; 43] = [
    23.942, 26.961, 24.488, 29.871, 49.308, 56.513, 60.034, 57.818, 74.825, 87.247, 90.612, 91.368, 95.109,
    91.963, 95.724, 96.613, 97.129, 102.099, 100.755, 102.317, 100.0, 97.735, 98.918, 93.499, 97.688, 99.269,
    99.042, 95.722, 98.857, 95.667, 98.19, 103.003, 99.133, 87.381, 91.604, 92.889, 76.854, 86.511, 92.58,
    78.23, 57.692, 82.923, 78.274,
];

/// F2, a cool white lamp, from 380 to 780 nm every five.
#[rustfmt::skip]
const F2: [f32; 81] = [
    1.18, 1.48, 1.84, 2.15, 3.44, 15.69, 3.85, 3.74, 4.19, 4.62, 5.06, 34.98, 11.81, 6.27, 6.63, 6.93, 7.19,
    7.4, 7.54, 7.62, 7.65, 7.62, 7.62, 7.45, 7.28, 7.15, 7.05, 7.04, 7.16, 7.47, 8.04, 8.88, 10.01, 24.88,
    16.64, 14.59, 16.16, 17.56, 18.62, 21.47, 22.79, 19.29, 18.66, 17.73, 16.54, 15.21, 13.8, 12.36, 10.95,
    9.65, 8.4, 7.32, 6.31, 5.43, 4.68, 4.02, 3.45, 2.96, 2.55, 2.19, 1.89, 1.64, 1.53, 1.27, 1.1, 0.99, 0.88,
    0.76, 0.68, 0.61, 0.56, 0.54, 0.51, 0.47, 0.47, 0.43, 0.46, 0.47, 0.4, 0.33, 0.27,
];

/// F11, a lamp of three narrow bands, from 380 to 780 nm every five.
#[rustfmt::skip]
const F11: [f32; 81] = [
    0.91, 0.63, 0.46, 0.37, 1.29, 12.68, 1.59, 1.79, 2.46, 3.33, 4.49, 33.94, 12.13, 6.95, 7.19, 7.12, 6.72,
    6.13, 5.46, 4.79, 5.66, 14.29, 14.96, 8.97, 4.72, 2.33, 1.47, 1.1, 0.89, 0.83, 1.18, 4.9, 39.59, 72.84,
    32.61, 7.52, 2.83, 1.96, 1.67, 4.43, 11.28, 14.76, 12.73, 9.74, 7.33, 9.72, 55.27, 42.58, 13.18, 13.16,
    12.26, 5.11, 2.07, 2.34, 3.58, 3.01, 2.48, 2.14, 1.54, 1.33, 1.46, 1.94, 2.0, 1.2, 1.35, 4.1, 5.58, 2.51,
    0.57, 0.27, 0.23, 0.21, 0.24, 0.24, 0.2, 0.24, 0.32, 0.26, 0.16, 0.12, 0.09,
];

/// The relative power of the illuminant called `name`, if it is known at more than its chromaticity.
pub(super) fn illuminant(name: &str) -> Option<Sampled> {
    let table = |first: f32, step: f32, values: &[f32]| {
        let pairs = values.iter().enumerate().flat_map(|(i, v)| [first + step * i as f32, *v]);
        Sampled::new(&pairs.collect::<Vec<f32>>()).ok()
    };
    match name {
        "stdillum-A" => {
            let nm: Vec<f32> = (RANGE.0..=RANGE.1).step_by(5).map(|nm| nm as f32).collect();
            Sampled::new(&nm.into_iter().flat_map(|nm| [nm, incandescent(nm)]).collect::<Vec<f32>>()).ok()
        }
        "stdillum-D50" => table(360.0, 10.0, &D50),
        "stdillum-D65" => {
            let values: Vec<f32> = (RANGE.0..=RANGE.1).map(|nm| d65(nm as f32)).collect();
            table(RANGE.0 as f32, 1.0, &values)
        }
        "stdillum-F2" => table(380.0, 5.0, &F2),
        "stdillum-F11" => table(380.0, 5.0, &F11),
        _ => None,
    }
}

/// Illuminant A: 100 at 560 nm (CIE 15:2004, equation 3.1).
fn incandescent(nm: f32) -> f32 {
    let power = |nm: f64| libm::expm1(1.435e7 / (2848.0 * nm));
    let nm = f64::from(nm);
    (100.0 * libm::pow(560.0 / nm, 5.0) * power(560.0) / power(nm)) as f32
}

#[cfg(test)]
mod tests {
    use super::{
        super::{LightColor, named},
        *,
    };

    #[test]
    fn curves_have_the_chromaticity_that_is_tabulated() {
        for name in ["A", "D50", "D65", "F2", "F11"] {
            let name = format!("stdillum-{name}");
            let curve = illuminant(&name).expect("a curve");
            let (got, expected) = (LightColor::measured(&curve).color, named(&name).expect("a name").color);
            for (got, expected) in got.rgb.iter().zip(expected.rgb) {
                assert!((got - expected).abs() < 0.01, "{name}: {got} {expected}");
            }
        }
        // CIE 15:2004, table T.1: A at 400 and 700 nm.
        for (nm, expected) in [(400.0, 14.708), (560.0, 100.0), (700.0, 198.261)] {
            assert!((incandescent(nm) - expected).abs() < 1e-3 * expected, "{nm}");
        }
        assert_eq!(illuminant("stdillum-F7"), None);
    }
}
