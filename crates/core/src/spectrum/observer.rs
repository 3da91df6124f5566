//! The CIE 1931 standard observer as linear Rec. 709 sees with it, and the standard illuminant D65.
//!
//! The matching functions of red, green and blue are those of the CIE, times the matrix of IEC 61966-2-1, and times three
//! factors next to 1 for which D65 is exactly white: light of D65 at luminance 1 is (1, 1, 1).
use super::cie::{D65, XYZ};

/// First and last wavelength that integrals take, in nm.
pub(super) const RANGE: (i32, i32) = (360, 830);

/// Wavelengths of a table with a value each nanometre.
pub(super) const COUNT: usize = (RANGE.1 - RANGE.0) as usize + 1;

/// Linear Rec. 709 components of CIE XYZ (IEC 61966-2-1).
pub(super) const fn rec709([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.240_969_941_904_521 * x - 1.537_383_177_570_093 * y - 0.498_610_760_293 * z,
        -0.969_243_636_280_87 * x + 1.875_967_501_507_72 * y + 0.041_555_057_407_175 * z,
        0.055_630_079_696_993 * x - 0.203_976_958_888_97 * y + 1.056_971_514_242_878 * z,
    ]
}

/// What a radiance of 1 per nanometre adds to red, green and blue; `RANGE`, each nanometre. Of a light that is 1 at all
/// wavelengths they give luminance 1.
pub(super) const MATCHING: [[f32; 3]; COUNT] = matching();

/// D65 at luminance 1; `RANGE`, each nanometre.
pub(super) const DAYLIGHT: [f32; COUNT] = daylight();

/// D65 as it is tabulated, straight lines between.
const fn tabulated(i: usize) -> f64 {
    let below = if i / 10 < D65.len() - 1 { i / 10 } else { D65.len() - 2 };
    let u = (i - 10 * below) as f64 / 10.0;
    D65[below] as f64 * (1.0 - u) + D65[below + 1] as f64 * u
}

/// Sums of the matching function y, and of it under D65.
const fn luminance() -> (f64, f64) {
    let (mut sum, mut under, mut i) = (0.0, 0.0, 0);
    while i < COUNT {
        sum += XYZ[i][1] as f64;
        under += XYZ[i][1] as f64 * tabulated(i);
        i += 1;
    }
    (sum, under)
}

const fn daylight() -> [f32; COUNT] {
    let (sum, under) = luminance();
    let (mut table, mut i) = ([0.0; COUNT], 0);
    while i < COUNT {
        table[i] = (tabulated(i) * sum / under) as f32;
        i += 1;
    }
    table
}

const fn matching() -> [[f32; 3]; COUNT] {
    let daylight = daylight();
    let (mut table, mut white, mut i) = ([[0.0; 3]; COUNT], [0.0; 3], 0);
    while i < COUNT {
        let [x, y, z] = XYZ[i];
        table[i] = rec709([x as f64, y as f64, z as f64]);
        let mut c = 0;
        while c < 3 {
            white[c] += table[i][c] * daylight[i] as f64;
            c += 1;
        }
        i += 1;
    }
    let (mut scaled, mut i) = ([[0.0; 3]; COUNT], 0);
    while i < COUNT {
        let [r, g, b] = table[i];
        scaled[i] = [(r / white[0]) as f32, (g / white[1]) as f32, (b / white[2]) as f32];
        i += 1;
    }
    scaled
}

/// Where a wavelength in nm lies in a table of each nanometre: the entry before it and the way to the next, in `[0, 1]`.
/// Wavelengths outside are those of its ends.
#[inline]
pub(super) fn place(nm: f32) -> (usize, f32) {
    let at = (nm - RANGE.0 as f32).clamp(0.0, (COUNT - 1) as f32);
    let below = (at as usize).min(COUNT - 2);
    (below, at - below as f32)
}

/// The matching functions of red, green and blue at a wavelength in nm.
#[inline]
pub(super) fn rgb(nm: f32) -> [f32; 3] {
    let (i, u) = place(nm);
    std::array::from_fn(|c| MATCHING[i][c] * (1.0 - u) + MATCHING[i + 1][c] * u)
}

/// D65 at luminance 1, at a wavelength in nm.
#[inline]
pub(super) fn d65(nm: f32) -> f32 {
    let (i, u) = place(nm);
    DAYLIGHT[i] * (1.0 - u) + DAYLIGHT[i + 1] * u
}
