//! How the numbers of an image stand for linear values.
use durer_core::math::float::pow;
use durer_scene::{Args, ImageData};

use super::srgb;

/// How colours are stored. Alpha is always linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Encoding {
    /// As they are.
    Linear,
    /// By the curve of IEC 61966-2-1.
    Srgb,
    /// The linear value is the stored one to this power; negative values become 0.
    Gamma(f32),
}

impl Encoding {
    /// What the parameter `encoding` says of an image; without it pbrt's habit: files of 8 bits and PNG are sRGB. `None`
    /// after a complaint.
    pub(crate) fn read(args: &mut Args<'_>, data: &ImageData) -> Option<Self> {
        let word = args.text("encoding").trim();
        let gamma = || match word.strip_prefix("gamma ")?.trim().parse() {
            Ok(gamma) if gamma > 0.0 && f32::is_finite(gamma) => Some(Self::Gamma(gamma)),
            _ => None,
        };
        let known = match word {
            "" => {
                let is_png = args.text("filename").to_ascii_lowercase().ends_with(".png");
                let encoded = match data {
                    ImageData::U8(_) => true,
                    ImageData::U16(_) => is_png,
                    ImageData::F32(_) => false,
                };
                Some(if encoded { Self::Srgb } else { Self::Linear })
            }
            "sRGB" => Some(Self::Srgb),
            "linear" => Some(Self::Linear),
            _ => gamma(),
        };
        if known.is_none() {
            let message =
                format!("\"encoding\" is \"{word}\", expected sRGB, linear, or gamma with a number above 0");
            args.error("encoding", message);
        }
        known
    }

    /// The linear value of a stored one.
    pub(super) fn decode(self, stored: f64) -> f32 {
        match self {
            Self::Linear => stored as f32,
            Self::Srgb => srgb::decode(stored),
            Self::Gamma(gamma) => pow(stored.max(0.0) as f32, gamma),
        }
    }
    /// The linear values of all bytes.
    pub(super) fn table(self) -> [f32; 256] {
        match self {
            Self::Linear => std::array::from_fn(|byte| byte as f32 / 255.0),
            Self::Srgb => srgb::table(),
            Self::Gamma(_) => std::array::from_fn(|byte| self.decode(byte as f64 / 255.0)),
        }
    }
}
