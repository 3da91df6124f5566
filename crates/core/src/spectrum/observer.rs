//! The CIE 1931 standard observer and the standard illuminant D65.
//!
//! The colour matching functions are the multi-lobe fit of Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations
//! to the CIE XYZ Color Matching Functions", JCGT 2(2), equation 4; D65 is tabulated at 10 nm (CIE 15:2004, table T.1).

/// First and last wavelength that integrals take, in nm.
pub(super) const RANGE: (i32, i32) = (360, 830);

/// `exp(-((x - mean) / sigma)^2 / 2)` with another sigma on either side of the mean.
fn lobe(x: f64, mean: f64, below: f64, above: f64) -> f64 {
    let t = (x - mean) / if x < mean { below } else { above };
    libm::exp(-0.5 * t * t)
}

/// The colour matching functions x, y, z at a wavelength in nm.
pub(super) fn xyz(nm: f64) -> [f64; 3] {
    let x = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7)
        - 0.065 * lobe(nm, 501.1, 20.4, 26.2);
    let y = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    let z = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
    [x, y, z]
}

/// Linear Rec. 709 components of CIE XYZ (IEC 61966-2-1).
pub(super) fn rec709([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.240_969_941_904_521 * x - 1.537_383_177_570_093 * y - 0.498_610_760_293 * z,
        -0.969_243_636_280_87 * x + 1.875_967_501_507_72 * y + 0.041_555_057_407_175 * z,
        0.055_630_079_696_993 * x - 0.203_976_958_888_97 * y + 1.056_971_514_242_878 * z,
    ]
}

/// Relative power of D65 from 360 to 780 nm, every 10 nm.
const D65: [f64; 43] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342, 95.788,
    88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213,
    71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054, 63.3828,
];

/// Relative power of D65 at a wavelength in nm; held beyond the table, where the eye sees next to nothing.
pub(super) fn d65(nm: f64) -> f64 {
    let at = ((nm - 360.0) / 10.0).clamp(0.0, (D65.len() - 1) as f64);
    let below = (at as usize).min(D65.len() - 2);
    let u = at - below as f64;
    D65[below] * (1.0 - u) + D65[below + 1] * u
}
