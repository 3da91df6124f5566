//! Averages of a function of elevation over lobes of directions, tabulated when a light is built.
//!
//! Ambient: the cosine-weighted mean over the hemisphere about the normal (irradiance / pi). Glossy: the directions that a
//! GGX surface mirrors when it is seen along its normal, weighted by their cosine (Karis 2013, "Real Shading in Unreal
//! Engine 4", the pre-filtered environment map, with its assumption n = v = r). Alpha 0 does not blur.
use std::f32::consts::PI;

use durer_core::math::float::{cos, lerp, sqr};

/// Nodes over the sine of elevation, -1 to 1; odd, so that one is the horizon.
const HEIGHTS: usize = 65;
/// Nodes over the square root of alpha, 0 to 1.
const BLURS: usize = 9;
/// Rings and points per half ring of a lobe.
const RINGS: usize = 24;

type Row = [f32; HEIGHTS];

/// A blurred function of the sine of elevation.
#[derive(Clone, Debug)]
pub(super) struct SkyBlur {
    ambient: Row,
    glossy: [Row; BLURS],
}

/// Directions at one angle to the lobe's axis.
struct Ring {
    cos: f32,
    sin: f32,
    weight: f32,
}

fn cosine_ring(u: f32) -> Ring {
    Ring { cos: (1.0 - u).sqrt(), sin: u.sqrt(), weight: 1.0 }
}

fn glossy_ring(u: f32, alpha: f32) -> Ring {
    // Twice the angle whose tangent squared GGX distributes like this.
    let tan2 = sqr(alpha) * u / (1.0 - u);
    let cos = (1.0 - tan2) / (1.0 + tan2);
    Ring { cos, sin: 2.0 * tan2.sqrt() / (1.0 + tan2), weight: cos.max(0.0) }
}

fn midpoint(i: usize) -> f32 {
    (i as f32 + 0.5) / RINGS as f32
}

fn blurred(f: fn(f32) -> f32, ring: impl Fn(f32) -> Ring) -> Row {
    let azimuths: [f32; RINGS] = std::array::from_fn(|j| cos(PI * midpoint(j)));
    std::array::from_fn(|node| {
        let s = 2.0 * node as f32 / (HEIGHTS - 1) as f32 - 1.0;
        let horizontal = (1.0 - sqr(s)).max(0.0).sqrt();
        let (mut sum, mut weights) = (0.0, 0.0);
        for i in 0..RINGS {
            let Ring { cos, sin, weight } = ring(midpoint(i));
            let mean = azimuths.iter().map(|a| f(s * cos + horizontal * sin * a)).sum::<f32>() / RINGS as f32;
            sum += mean * weight;
            weights += weight;
        }
        sum / weights
    })
}

fn read(row: &Row, s: f32) -> f32 {
    let x = (s.clamp(-1.0, 1.0) + 1.0) * 0.5 * (HEIGHTS - 1) as f32;
    let i = (x as usize).min(HEIGHTS - 2);
    lerp(x - i as f32, row[i], row[i + 1])
}

impl SkyBlur {
    /// Tabulates `f`, a function of the sine of elevation.
    pub(super) fn of(f: fn(f32) -> f32) -> Self {
        let alpha = |i: usize| sqr(i as f32 / (BLURS - 1) as f32);
        Self {
            ambient: blurred(f, cosine_ring),
            glossy: std::array::from_fn(|i| blurred(f, |u| glossy_ring(u, alpha(i)))),
        }
    }
    /// Mean over the cosine lobe about a normal at sine `s` of elevation.
    pub(super) fn ambient(&self, s: f32) -> f32 {
        read(&self.ambient, s)
    }
    /// Mean over the glossy lobe of roughness `alpha` in `[0, 1]` about a direction at sine `s` of elevation.
    pub(super) fn glossy(&self, s: f32, alpha: f32) -> f32 {
        let x = alpha.clamp(0.0, 1.0).sqrt() * (BLURS - 1) as f32;
        let i = (x as usize).min(BLURS - 2);
        lerp(x - i as f32, read(&self.glossy[i], s), read(&self.glossy[i + 1], s))
    }
}
