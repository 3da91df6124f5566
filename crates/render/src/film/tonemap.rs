//! Tone mapping: scene light of any brightness to what a display can show. Both sides are linear Rec. 709.
//!
//! | word | formula | source |
//! |---|---|---|
//! | `none` | c clipped to `[0, 1]` | |
//! | `agx` | inset, log2, sigmoid, outset: see below | Sobotka, AgX and AgX-S2O3 (2022) |
//! | `pbr-neutral` | c - f; a peak above 0.76 is compressed, then whitened | Khronos, PBR Neutral Specification |
//! | `aces` | A_out fit(A_in c), fit(v) = (v (v + a) - b) / (v (c v + d) + e) | Hill, fit of ACES RRT + sRGB ODT |
//! | `reinhard` | c / (1 + L), L = luminance | Reinhard et al. 2002, eq. 3; `--exposure` is its key a / L_w |
//!
//! AgX, step by step:
//! 1. inset: every chromaticity moves a fifth of its way to white, c' = 0.8 c + 0.2 s, where s is the X + Y + Z of c
//!    against that of white (S2O3's `AgX_compressed_matrix(0.2)` in closed form);
//! 2. x = log2(c' / 0.18), from `[-10, 6.5]` to `[0, 1]`;
//! 3. the sigmoid of Jed Smith through (0, 0), (10 / 16.5, 1/2) with slope 2, and (1, 1), powers 3 (toe) and 3.25
//!    (shoulder): display code values;
//! 4. these decoded by the sRGB curve, so that our sRGB encoding gives greys the code values of Sobotka's table;
//! 5. outset: the inverse of 1, in linear light as later versions of AgX do it (the first ended at 3). No look.
//!
//! Limits: no gamut mapping; what leaves the display's gamut is clipped per channel. Hill's fit has no exposure of its
//! own (some viewers divide by 0.6). Greys stay grey to the bit.
use durer_core::{
    math::float::{lerp, ln, pow, sqr},
    spectrum::Color,
};

#[cfg(test)]
mod tests;

/// How scene light becomes display light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Clip.
    #[default]
    None,
    /// AgX: film-like, bright colours go to white.
    Agx,
    /// Khronos PBR Neutral: keeps base colours below 0.8 as they are.
    PbrNeutral,
    /// The ACES reference look, as fitted by Hill.
    Aces,
    /// Reinhard's global operator on luminance.
    Reinhard,
}

impl ToneMap {
    /// All, in the order of [`ToneMap::WORDS`].
    pub const ALL: [Self; 5] = [Self::None, Self::Agx, Self::PbrNeutral, Self::Aces, Self::Reinhard];
    /// The words for them.
    pub const WORDS: [&'static str; 5] = ["none", "agx", "pbr-neutral", "aces", "reinhard"];

    /// From its word; `None` for a word that names no tone map.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().position(|w| *w == word).map(|i| Self::ALL[i])
    }
    /// The word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// Display light in `[0, 1]` for scene light `rgb`, both linear Rec. 709.
    ///
    /// Negative light and NaN count as none, infinite light as the brightest: the driver reports them, a picture must
    /// not break on them.
    #[must_use]
    pub fn apply(self, rgb: [f32; 3]) -> [f32; 3] {
        self.with_agx(rgb, agx_channel)
    }

    /// [`ToneMap::apply`] made ready for many pixels: the same, but AgX comes from a table, off by less than 2e-4.
    pub(super) fn prepared(self) -> impl Fn([f32; 3]) -> [f32; 3] {
        let table = if self == Self::Agx { agx_table() } else { Vec::new() };
        move |rgb| self.with_agx(rgb, |v| looked_up(&table, v))
    }

    fn with_agx(self, rgb: [f32; 3], channel: impl Fn(f32) -> f32) -> [f32; 3] {
        let rgb = rgb.map(bounded);
        let display = match self {
            Self::None => rgb,
            Self::Agx => agx(rgb, channel),
            Self::PbrNeutral => pbr_neutral(rgb),
            Self::Aces => aces(rgb),
            Self::Reinhard => {
                let below_one = 1.0 / (1.0 + Color { rgb }.luminance());
                rgb.map(|v| v * below_one)
            }
        };
        display.map(|v| v.clamp(0.0, 1.0))
    }
}

/// The brightest light any map is asked about; its square is far from overflow.
const BRIGHTEST: f32 = 1e16;

fn bounded(v: f32) -> f32 {
    if v > 0.0 { v.min(BRIGHTEST) } else { 0.0 }
}

/// Matrix times colour for rows that sum to one, given without their diagonals: a grey comes out as the same bits.
fn mixed(off: [[f32; 2]; 3], [r, g, b]: [f32; 3]) -> [f32; 3] {
    [
        r + off[0][0] * (g - r) + off[0][1] * (b - r),
        g + off[1][0] * (r - g) + off[1][1] * (b - g),
        b + off[2][0] * (r - b) + off[2][1] * (g - b),
    ]
}

/// sRGB to AP1 with the saturation of the RRT, and back with that of the ODT. The diagonals complete the rows to one;
/// they are as published but for the last of the second, 1.07602, whose row sums to 0.99999.
const ACES_IN: [[f32; 2]; 3] = [[0.35458, 0.04823], [0.07600, 0.01566], [0.02840, 0.13383]];
const ACES_OUT: [[f32; 2]; 3] = [[-0.53108, -0.07367], [-0.10208, -0.00605], [-0.00327, -0.07276]];

fn aces(rgb: [f32; 3]) -> [f32; 3] {
    let fit =
        |v: f32| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
    mixed(ACES_OUT, mixed(ACES_IN, rgb).map(|v| fit(v.max(0.0))))
}

fn pbr_neutral(rgb: [f32; 3]) -> [f32; 3] {
    const F90: f32 = 0.04;
    const COMPRESSION_START: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;
    let least = rgb.into_iter().fold(f32::INFINITY, f32::min);
    let offset = if least <= 2.0 * F90 { least - sqr(least) / (4.0 * F90) } else { F90 };
    let base = rgb.map(|v| v - offset);
    let peak = base.into_iter().fold(0.0, f32::max);
    if peak <= COMPRESSION_START {
        return base;
    }
    let new_peak = 1.0 - sqr(1.0 - COMPRESSION_START) / (peak + 1.0 - 2.0 * COMPRESSION_START);
    let colourful = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    let (scale, white) = (new_peak / peak * colourful, new_peak * (1.0 - colourful));
    base.map(|v| v * scale + white)
}

/// How far AgX moves chromaticities to white.
const AGX_INSET: f32 = 0.2;
/// Stops below and above middle grey 0.18 that AgX shows.
const AGX_STOPS: [f32; 2] = [10.0, 6.5];
/// (X + Y + Z) of the Rec. 709 primaries as shares of that of white D65.
const WHITE_SHARE: [f32; 3] = [0.211_994_65, 0.392_150_83, 0.395_854_53];

/// AgX, with `channel` for steps (2) to (4).
fn agx(rgb: [f32; 3], channel: impl Fn(f32) -> f32) -> [f32; 3] {
    let white = |c: [f32; 3]| WHITE_SHARE[0] * c[0] + WHITE_SHARE[1] * c[1] + WHITE_SHARE[2] * c[2];
    let s = white(rgb);
    let formed = rgb.map(|v| channel((1.0 - AGX_INSET) * v + AGX_INSET * s));
    let s = white(formed);
    formed.map(|v| (v - AGX_INSET * s) / (1.0 - AGX_INSET))
}

/// Steps (2) to (4) of AgX: linear to linear, `[0, inf)` to `[0, 1]`, rising.
fn agx_channel(v: f32) -> f32 {
    let [below, above] = AGX_STOPS;
    let stops = ln(v.max(f32::MIN_POSITIVE) / 0.18) * std::f32::consts::LOG2_E;
    let x = ((stops + below) / (below + above)).clamp(0.0, 1.0);
    srgb_decode(agx_sigmoid(x))
}

/// y = 1/2 -+ d (1 + q e^p)^(-1/p), where d = 2 |x - x0| is the line through the pivot, e = |x - x0| / w the way to the
/// end of the toe or shoulder of width w, and q = (4 w)^p - 1 makes it end at 0 or 1.
fn agx_sigmoid(x: f32) -> f32 {
    let [below, above] = AGX_STOPS;
    let pivot = below / (below + above);
    if x < pivot {
        let e = (pivot - x) / pivot;
        0.5 - 2.0 * (pivot - x) * pow(1.0 + 13.247_155 * e * e * e, -1.0 / 3.0)
    } else {
        let e = (x - pivot) / (1.0 - pivot);
        0.5 + 2.0 * (x - pivot) * pow(1.0 + 3.383_697_3 * e * e * e * e.sqrt().sqrt(), -1.0 / 3.25)
    }
}

/// The table of [`agx_channel`] starts here, below the darkest it shows, and has an entry every 65536 floats: 128 to
/// the octave for 18 octaves.
const TABLE_FROM: f32 = 1.0 / 8192.0;
const TABLE_SHIFT: u32 = 16;
const TABLE_CELLS: u32 = 18 << 7;

fn agx_table() -> Vec<f32> {
    let start = TABLE_FROM.to_bits();
    (0..=TABLE_CELLS).map(|i| agx_channel(f32::from_bits(start + (i << TABLE_SHIFT)))).collect()
}

/// Linear interpolation: inside an octave the bits of a float are linear in it.
fn looked_up(table: &[f32], v: f32) -> f32 {
    let last = (TABLE_CELLS << TABLE_SHIFT) - 1;
    let place = v.max(TABLE_FROM).to_bits().wrapping_sub(TABLE_FROM.to_bits()).min(last);
    let cell = (place >> TABLE_SHIFT) as usize;
    let way = (place & ((1 << TABLE_SHIFT) - 1)) as f32 / (1 << TABLE_SHIFT) as f32;
    lerp(way, table[cell], table[cell + 1])
}

/// Linear light of a code value in `[0, 1]`: the inverse of the sRGB curve (IEC 61966-2-1).
fn srgb_decode(code: f32) -> f32 {
    if code <= 0.04045 { code / 12.92 } else { pow((code + 0.055) / 1.055, 2.4) }
}
