//! Standard illuminants as curves: A by its formula, D50 and the lamps of the F series by their tables (CIE 15:2004), D65.
use super::{
    Sampled,
    lamp::LAMPS,
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
        _ => LAMPS.iter().find(|lamp| lamp.0 == name).and_then(|lamp| table(380.0, 5.0, &lamp.1)),
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
        let lamps = LAMPS.iter().map(|lamp| lamp.0);
        for name in lamps.chain(["stdillum-A", "stdillum-D50", "stdillum-D65"]) {
            let curve = illuminant(name).expect("a curve");
            let (got, expected) = (LightColor::measured(&curve).color, named(name).expect("a name").color);
            for (got, expected) in got.rgb.iter().zip(expected.rgb) {
                assert!((got - expected).abs() < 0.01, "{name}: {got} {expected}");
            }
        }
        // CIE 15:2004, table T.1: A at 400 and 700 nm.
        for (nm, expected) in [(400.0, 14.708), (560.0, 100.0), (700.0, 198.261)] {
            assert!((incandescent(nm) - expected).abs() < 1e-3 * expected, "{nm}");
        }
        assert_eq!(illuminant("stdillum-F13"), None);
    }
}
