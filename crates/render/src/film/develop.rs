//! From the means of a film to the 8-bit picture that is looked at.
//!
//! Light: c 2^EV, [`ToneMap`], the sRGB curve (IEC 61966-2-1: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) - 0.055),
//! rounded to the nearest of 256. The rounded curve is a staircase; its 255 steps are computed in f64 when this is
//! compiled, and looking one up gives what rounding the formula gives for every f32.
//!
//! Data pictures (depth, normals, uv, ids) are scaled for the eye as [`develop_data`] says, without the curve. What was
//! not hit is black.
use durer_core::math::float::pow;

use super::ToneMap;
use crate::integrator::{Show, Survey};

#[cfg(test)]
mod tests;

/// An 8-bit picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Developed {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue of every pixel, row by row from the top: code values of sRGB, or scaled data.
    pub rgb8: Vec<u8>,
}

impl Developed {
    /// # Panics
    /// If `pixels` is not the number of pixels of the picture.
    fn new(width: u32, height: u32, pixels: impl ExactSizeIterator<Item = [u8; 3]>) -> Self {
        assert_eq!(
            pixels.len(),
            width as usize * height as usize,
            "pixels of a picture of {width} x {height}"
        );
        let mut rgb8 = Vec::with_capacity(3 * pixels.len());
        pixels.for_each(|p| rgb8.extend_from_slice(&p));
        Self { width, height, rgb8 }
    }
}

/// Depths along the camera's axis that a depth picture shows, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Nearest hit: white.
    pub near: f32,
    /// Farthest hit: [`DepthRange::FAR_LEVEL`].
    pub far: f32,
}

impl DepthRange {
    /// Code value of the farthest hit; above that of a miss, 0.
    pub const FAR_LEVEL: u8 = 32;

    /// The range of the finite depths; `None` where there are none.
    fn of(data: &[Option<[f32; 3]>]) -> Option<Self> {
        let depths = data.iter().flatten().map(|d| d[0]).filter(|d| d.is_finite());
        depths.fold(None, |range, d| {
            let Self { near, far } = range.unwrap_or(Self { near: d, far: d });
            Some(Self { near: near.min(d), far: far.max(d) })
        })
    }

    /// Code value of a depth: linear between the ends; 0 for a depth that is not finite.
    fn level(self, depth: f32) -> u8 {
        if !depth.is_finite() {
            return 0;
        }
        let span = self.far - self.near;
        let way = if span > 0.0 { (depth - self.near) / span } else { 0.0 };
        255 - (way * f32::from(255 - Self::FAR_LEVEL)).round() as u8
    }
}

/// A data picture for the eye.
#[derive(Clone, Debug, PartialEq)]
pub struct DataPicture {
    /// What is looked at.
    pub picture: Developed,
    /// Of depth pictures in which something was hit.
    pub depth: Option<DepthRange>,
    /// Of cost pictures: tests of a white pixel. One in 200 has more.
    pub white_tests: Option<f32>,
}

/// Develops light: `rgb` is linear Rec. 709, one colour per pixel, row by row; `exposure_ev` brightens it by that many
/// stops.
///
/// # Panics
/// If `rgb` does not have `width * height` colours.
pub fn develop(width: u32, height: u32, rgb: &[[f32; 3]], exposure_ev: f32, tonemap: ToneMap) -> Developed {
    let gain = pow(2.0, exposure_ev);
    let displayed = tonemap.prepared();
    let pixels = rgb.iter().map(|c| displayed(c.map(|v| v * gain)).map(srgb8));
    Developed::new(width, height, pixels)
}

/// Develops the data that a ray cast shows, `None` for pixels that hit nothing; these are black.
///
/// | show | data | picture |
/// |---|---|---|
/// | depth | metres along the axis, first | near white to far dark, linear; the range comes with it |
/// | normal | unit vector | (n + 1) / 2: x red, y green, z blue |
/// | uv | coordinates | fractional parts in red and green |
/// | id | whole number, first | a colour of its own, the same in every picture |
/// | cost | tests of primitives, first, and of boxes | their sum, from none (black) to nearly the most (white), through blue, red and yellow |
/// | shading, albedo | linear light | as [`develop`] at 0 EV without tone map |
///
/// # Panics
/// If `data` does not have `width * height` entries.
pub fn develop_data(show: Show, width: u32, height: u32, data: &[Option<[f32; 3]>]) -> DataPicture {
    let depth = if show == Show::Depth { DepthRange::of(data) } else { None };
    let tests = |v: &[f32; 3]| v[0] + v[1];
    let white = if show == Show::Cost { nearly_most(data, tests).max(1.0) } else { 0.0 };
    let pixel = |v: [f32; 3]| match show {
        Show::Cost => heat(tests(&v) / white),
        Show::Depth => [depth.map_or(0, |range| range.level(v[0])); 3],
        Show::Normal => v.map(|n| unit8(0.5 * n + 0.5)),
        Show::Uv => [unit8(v[0] - v[0].floor()), unit8(v[1] - v[1].floor()), 0],
        Show::Id => id_colour(v[0].round() as u32),
        Show::Shading | Show::Albedo => ToneMap::None.apply(v).map(srgb8),
    };
    let picture = Developed::new(width, height, data.iter().map(|v| v.map_or([0; 3], pixel)));
    DataPicture { picture, depth, white_tests: (show == Show::Cost).then_some(white) }
}

/// Develops what samples are like, from nothing (black) to nearly the most (white) in the colours of heat; with the number of
/// a white pixel.
///
/// # Panics
/// If `data` does not have `width * height` entries.
pub fn develop_survey(
    survey: Survey,
    width: u32,
    height: u32,
    data: &[Option<[f32; 3]>],
) -> (Developed, f32) {
    let white = nearly_most(data, |v| survey.number(*v));
    let shade = |v: [f32; 3]| if white > 0.0 { heat(survey.number(v) / white) } else { heat(0.0) };
    (Developed::new(width, height, data.iter().map(|v| v.map_or([0; 3], shade))), white)
}

/// `[0, 1]` to 0..=255, without a curve; NaN gives 0.
fn unit8(v: f32) -> u8 {
    (v * 255.0).round() as u8
}

/// The colour of an object's number: hues by the golden ratio, so that neighbours lie far apart; saturation and value
/// of a hash, so that hues that come close later still differ.
fn id_colour(id: u32) -> [u8; 3] {
    let hue = id.wrapping_mul(0x9E37_79B9) as f32 / (1u64 << 32) as f32;
    let mut hash = (id ^ (id >> 16)).wrapping_mul(0x7FEB_352D);
    hash = (hash ^ (hash >> 15)).wrapping_mul(0x846C_A68B);
    let part = |shift: u32| (hash >> shift & 0xFF) as f32 / 255.0;
    let (saturation, value) = (0.5 + 0.5 * part(24), 0.65 + 0.35 * part(16));
    // HSV: a channel is full within a sixth of a turn of its own hue, and gone beyond a third.
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|own| {
        let turn = (hue - own + 1.5).fract() - 0.5;
        let share = (2.0 - 6.0 * turn.abs()).clamp(0.0, 1.0);
        unit8(value * (1.0 - saturation + saturation * share))
    })
}

/// The number that one pixel in 200 exceeds: a few rays along edges would make all others dark. 0 if there is none.
fn nearly_most(data: &[Option<[f32; 3]>], number: impl Fn(&[f32; 3]) -> f32) -> f32 {
    let mut numbers: Vec<f32> = data.iter().flatten().map(number).collect();
    numbers.sort_by(f32::total_cmp);
    let rank = numbers.len().saturating_sub(1 + numbers.len() / 200);
    numbers.get(rank).copied().unwrap_or(0.0)
}

/// A colour of heat for `[0, 1]`: lighter is always more, so that it can be read without colours too.
fn heat(v: f32) -> [u8; 3] {
    const COLOURS: [[f32; 3]; 6] = [
        [0., 0., 0.],
        [30., 20., 110.],
        [150., 25., 110.],
        [225., 75., 40.],
        [250., 190., 60.],
        [255., 255., 235.],
    ];
    let place = v.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f32;
    let from = (place as usize).min(COLOURS.len() - 2);
    let way = place - from as f32;
    std::array::from_fn(|i| {
        (COLOURS[from][i] + (COLOURS[from + 1][i] - COLOURS[from][i]) * way).round() as u8
    })
}

/// Code value of linear light: round(255 sRGB(v)), clipped to 0..=255; NaN gives 0.
fn srgb8(v: f32) -> u8 {
    let v = v.max(CELLS_FROM).min(1.0f32.next_down());
    let code = CODES[((v.to_bits() - CELLS_FROM.to_bits()) >> CELL_SHIFT) as usize];
    code + u8::from(v >= STEPS[code as usize])
}

/// `STEPS[k]` is the least f32 whose code is k + 1; no light has code 256.
const STEPS: [f32; 256] = {
    let mut steps = [f32::INFINITY; 256];
    let mut k = 0;
    while k < 255 {
        let exact = srgb_decode((k as f64 + 0.5) / 255.0);
        let near = exact as f32;
        steps[k] = if (near as f64) < exact { near.next_up() } else { near };
        k += 1;
    }
    steps
};

/// Light below this has code 0.
const CELLS_FROM: f32 = 1.0 / 8192.0;
/// Floats with the same bits above these share a cell: 128 cells to the octave, 13 octaves to 1.
const CELL_SHIFT: u32 = f32::MANTISSA_DIGITS - 1 - 7;
const CELLS: usize = 13 << 7;

/// Code of the least float of each cell. Cells are so small that the code rises at most once inside.
static CODES: [u8; CELLS] = {
    let mut codes = [0; CELLS];
    let mut code = 0;
    let mut cell = 0;
    while cell < CELLS {
        let least = f32::from_bits(CELLS_FROM.to_bits() + ((cell as u32) << CELL_SHIFT));
        while least >= STEPS[code as usize] {
            code += 1;
        }
        codes[cell] = code;
        cell += 1;
    }
    codes
};

/// Inverse of the sRGB curve for code values in `[0, 1]`.
const fn srgb_decode(code: f64) -> f64 {
    if code <= 0.04045 {
        return code / 12.92;
    }
    // x^2.4 = x^2 (x^2)^(1/5); the root by Newton's method from above, where it falls to the root.
    let square = (code + 0.055) / 1.055 * ((code + 0.055) / 1.055);
    let mut root = 1.0;
    let mut i = 0;
    while i < 40 {
        root = 0.8 * root + 0.2 * square / (root * root * root * root);
        i += 1;
    }
    square * root
}
