//! How a picture is wrapped around the sphere.
//!
//! Latitude-longitude: z is up, the top row is at +z; u runs with the azimuth from +x by +y (pbrt-v3, *Physically Based
//! Rendering*, 3rd edition, section 12.6); or so that the middles of the first and the last row are the poles. Equal area: the octahedral map of Clarberg 2008 ("Fast equal-area mapping of the
//! (hemi)sphere using SIMD"), +z in the middle, -z in the four corners (4th edition, section 12.5.2).
use std::f32::consts::{FRAC_PI_4, PI, TAU};

use durer_core::math::{
    Vector3,
    float::{atan2, cos, sin, sqr},
};

/// The map between picture and sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// Azimuth across, angle from the zenith down.
    LatitudeLongitude,
    /// The same, the first and the last of so many rows in the poles: at least two.
    PoleToPole(u32),
    /// Every texel sees the same solid angle.
    EqualArea,
}

impl Layout {
    /// The words of scene files; `auto` decides by the picture's shape.
    pub(super) const WORDS: &[&str] = &["auto", "latlong", "poletopole", "equalarea"];

    /// The layout of one of [`Self::WORDS`] for a picture of this size.
    pub(super) fn of_word(word: &str, width: u32, height: u32) -> Self {
        match word {
            "latlong" => Self::LatitudeLongitude,
            "poletopole" if height > 1 => Self::PoleToPole(height),
            "poletopole" => Self::LatitudeLongitude,
            "equalarea" => Self::EqualArea,
            _ if width == height => Self::EqualArea,
            _ => Self::LatitudeLongitude,
        }
    }

    /// Place in the picture, `(0, 0)` its upper left corner and `(1, 1)` the lower right one, of unit direction `d`.
    pub(crate) fn uv(self, d: Vector3) -> [f32; 2] {
        match self {
            Self::LatitudeLongitude => {
                let azimuth = atan2(d.y, d.x);
                let turned = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
                let from_zenith = atan2((sqr(d.x) + sqr(d.y)).sqrt(), d.z);
                [turned / TAU, from_zenith / PI]
            }
            Self::PoleToPole(rows) => {
                let [u, v] = Self::LatitudeLongitude.uv(d);
                [u, (v * (rows - 1) as f32 + 0.5) / rows as f32]
            }
            Self::EqualArea => {
                let (x, y) = (d.x.abs(), d.y.abs());
                let r = (1.0 - d.z.abs()).max(0.0).sqrt();
                // The share of an eighth turn, from the x axis.
                let phi = atan2(y, x) / (2.0 * FRAC_PI_4);
                let (mut u, mut v) = (r - phi * r, phi * r);
                if d.z < 0.0 {
                    (u, v) = (1.0 - v, 1.0 - u);
                }
                [0.5 + 0.5 * u.copysign(d.x), 0.5 + 0.5 * v.copysign(d.y)]
            }
        }
    }

    /// The unit direction of a place in the picture.
    pub(crate) fn direction(self, [u, v]: [f32; 2]) -> Vector3 {
        match self {
            Self::LatitudeLongitude => {
                let (azimuth, from_zenith) = (u * TAU, v * PI);
                let r = sin(from_zenith);
                Vector3::new(r * cos(azimuth), r * sin(azimuth), cos(from_zenith))
            }
            Self::PoleToPole(rows) => {
                Self::LatitudeLongitude.direction([u, from_pole(rows, v.into()) as f32])
            }
            Self::EqualArea => {
                let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
                let inside = 1.0 - (x.abs() + y.abs());
                let r = 1.0 - inside.abs();
                let phi = if r > 0.0 { ((y.abs() - x.abs()) / r + 1.0) * FRAC_PI_4 } else { FRAC_PI_4 };
                let out = r * (2.0 - sqr(r)).max(0.0).sqrt();
                let z = (1.0 - sqr(r)).copysign(inside);
                Vector3::new((out * cos(phi)).copysign(x), (out * sin(phi)).copysign(y), z)
            }
        }
    }

    /// The texel that lies at column `x` and row `y`, which may be one outside the picture.
    pub(super) fn wrapped(self, x: i64, y: i64, [width, height]: [u32; 2]) -> (u32, u32) {
        let (w, h) = (i64::from(width), i64::from(height));
        let (x, y) = match self {
            // Beyond a pole lies the same row, half a turn away.
            Self::LatitudeLongitude if y < 0 => (x + w / 2, -1 - y),
            Self::LatitudeLongitude if y >= h => (x + w / 2, 2 * h - 1 - y),
            Self::LatitudeLongitude => (x, y),
            // Beyond them lie those before, half a turn away.
            Self::PoleToPole(_) if y < 0 => (x + w / 2, -y),
            Self::PoleToPole(_) if y >= h => (x + w / 2, 2 * h - 2 - y),
            Self::PoleToPole(_) => (x, y),
            Self::EqualArea => {
                // Beyond an edge lies that edge, turned about its middle.
                let (x, y) = if x < 0 || x >= w { (x.clamp(0, w - 1), h - 1 - y) } else { (x, y) };
                if y < 0 || y >= h { (w - 1 - x, y.clamp(0, h - 1)) } else { (x, y) }
            }
        };
        (x.rem_euclid(w) as u32, y.clamp(0, h - 1) as u32)
    }

    /// The four texels about a place in a picture of this size, with their bilinear weights.
    pub(super) fn corners(self, [u, v]: [f32; 2], size: [u32; 2]) -> [((u32, u32), f32); 4] {
        let (x, y) = (u * size[0] as f32 - 0.5, v * size[1] as f32 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let (x0, y0) = (x0 as i64, y0 as i64);
        let at = |x, y| self.wrapped(x, y, size);
        [
            (at(x0, y0), (1.0 - fx) * (1.0 - fy)),
            (at(x0 + 1, y0), fx * (1.0 - fy)),
            (at(x0, y0 + 1), (1.0 - fx) * fy),
            (at(x0 + 1, y0 + 1), fx * fy),
        ]
    }

    /// The share of the sphere in the rows above height `v` of the picture.
    pub(super) fn share_above(self, v: f64) -> f64 {
        match self {
            // (1 - cos(pi v)) / 2
            Self::LatitudeLongitude => f64::from(sin(0.5 * PI * v as f32)).powi(2),
            Self::PoleToPole(rows) => Self::LatitudeLongitude.share_above(from_pole(rows, v)),
            Self::EqualArea => v,
        }
    }

    /// Roughly the angle across a texel of a picture of that many rows.
    pub(super) fn texel_angle(self, rows: u32) -> f32 {
        match self {
            Self::LatitudeLongitude | Self::PoleToPole(_) => 1.4 * PI / rows as f32,
            Self::EqualArea => 5.0 / rows as f32,
        }
    }
}

/// The angle from the zenith, in units of pi, of height `v` of a picture whose first and last rows are in the poles.
fn from_pole(rows: u32, v: f64) -> f64 {
    ((v * f64::from(rows) - 0.5) / f64::from(rows - 1)).clamp(0.0, 1.0)
}
