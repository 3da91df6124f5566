//! What becomes of the place between texel centres, and of footprints.
use durer_core::math::float::{exp, ln};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// How an image is looked up.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Filter {
    /// The texel that the point lies in.
    Point,
    /// Between the four nearest.
    Bilinear,
    /// The same in the two copies whose texels are as wide as the footprint is long, and between them.
    Trilinear,
    /// Elliptical weighted average.
    Ewa {
        /// The longer axis by the shorter one, at most.
        most: f32,
        /// The weight for each `xT V^-1 x`, see [`weights`].
        weights: Box<[f32; WEIGHTS]>,
    },
}

/// Entries of the table of weights.
pub(super) const WEIGHTS: usize = 128;

pub(super) const FILTER: ParamSpec = ParamSpec::new(
    "filter",
    ParamType::Choice(&["bilinear", "point", "trilinear", "ewa", "EWA"]),
    ParamDefault::Text("bilinear"),
    "Between texel centres: interpolate, or take the nearest (point). trilinear and ewa average over the footprint of a \
     sample too, with smaller copies of the image; ewa keeps what is seen at grazing angles sharper.",
);
pub(super) const MAX_ANISOTROPY: ParamSpec = ParamSpec::float(
    "maxanisotropy",
    8.0,
    "Of the ewa filter: how many times as long as wide a footprint may be; wider ones are blurred along it.",
)
.range(1.0, 256.0);

impl Filter {
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        match args.text("filter") {
            "point" => Self::Point,
            "trilinear" => Self::Trilinear,
            "ewa" | "EWA" => Self::Ewa { most: args.float("maxanisotropy"), weights: Box::new(weights()) },
            _ => Self::Bilinear,
        }
    }
    /// Whether it needs smaller copies.
    pub(super) fn has_levels(&self) -> bool {
        matches!(self, Self::Trilinear | Self::Ewa { .. })
    }
}

/// A Gaussian of the squared radius, lowered so that it ends at the rim: `exp(-2 r²) - exp(-2)` (Greene and Heckbert 1986,
/// "Creating Raster Omnimax Images from Multiple Perspective Views Using the Elliptical Weighted Average Filter").
fn weights() -> [f32; WEIGHTS] {
    std::array::from_fn(|i| exp(-2.0 * i as f32 / (WEIGHTS - 1) as f32) - exp(-2.0))
}

/// The weight at a squared radius; 0 beyond the rim.
pub(super) fn weight(weights: &[f32; WEIGHTS], r2: f32) -> f32 {
    weights.get((r2 * WEIGHTS as f32) as usize).copied().unwrap_or(0.0)
}

/// The number of the copy, a fraction, whose texels are `width` of the image's texels wide; 0 is the image.
pub(crate) fn level(width: f32) -> f32 {
    if width > 1.0 { ln(width) * std::f32::consts::LOG2_E } else { 0.0 }
}
