//! Reconstruction filters: how far from its pixel a sample may lie, and what it counts for there.
//!
//! Samples are spread as the filter asks instead of being weighed by all pixels around (Ernst, Stamminger and Greiner
//! 2006, "Filter Importance Sampling"): a sample touches its own pixel only, and its weight is 1 but for rounding, or -1
//! in a negative lobe. The pixel is `sum w v / sum w`. All filters are products of a profile in x and one in y, even
//! functions both. A new filter is one file here and one line in [`FILTERS`].

mod axis;
mod blackmanharris;
mod r#box;
mod gaussian;
mod mitchell;
mod sinc;
mod triangle;

use std::fmt::Debug;

use durer_core::math::Point2;
use durer_scene::{Args, Entry, ParamSpec};

use axis::Axis;
pub use blackmanharris::BlackmanHarris;
pub use r#box::Box;
pub use gaussian::Gaussian;
pub use mitchell::Mitchell;
pub use sinc::Sinc;
pub use triangle::Triangle;

/// One direction of a filter.
pub trait Profile: Debug + Send + Sync {
    /// The filter at a distance in `[0, radius]`, in pixels, from its middle. Not normalised.
    fn at(&self, x: f32) -> f32;
}

/// A filter ready to place samples.
#[derive(Debug)]
pub struct Filter {
    x: Axis,
    y: Axis,
}

/// Where a sample lies, and what it counts for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// From the pixel's middle, in pixels.
    pub offset: [f32; 2],
    /// Factor on the sample in the pixel's sum and in its sum of weights.
    pub weight: f32,
}

impl Filter {
    fn new(x: impl Profile + 'static, y: impl Profile + 'static, radius: [f32; 2]) -> Self {
        Self { x: Axis::new(x, radius[0]), y: Axis::new(y, radius[1]) }
    }
    /// All of the pixel and nothing else.
    pub fn pixel() -> Self {
        Self::new(Box, Box, [0.5; 2])
    }
    /// What a scene that names none gets: pbrt-v4's Gaussian.
    pub fn usual() -> Self {
        Gaussian::filter([1.5; 2], 0.5)
    }
    /// How far from the pixel's middle samples lie at most, in pixels.
    pub fn radius(&self) -> [f32; 2] {
        [self.x.radius(), self.y.radius()]
    }
    /// The filter at an offset from the middle, in pixels; its integral is 1.
    pub fn at(&self, offset: [f32; 2]) -> f32 {
        self.x.at(offset[0]) * self.y.at(offset[1])
    }
    /// Whether samples may have negative weights. Few of them in a pixel could cancel each other then.
    pub fn has_negative_lobes(&self) -> bool {
        self.x.is_negative_somewhere() || self.y.is_negative_somewhere()
    }
    /// The sample of `u` in `[0, 1)²`: evenly spread points become samples of density `|f|`, in the same order in x and y.
    /// The centre goes to the middle of the pixel.
    #[inline]
    pub fn sample(&self, u: Point2) -> FilterSample {
        let ((x, wx), (y, wy)) = (self.x.sample(u.x), self.y.sample(u.y));
        FilterSample { offset: [x, y], weight: wx * wy }
    }
}

/// All kinds of filter.
pub const FILTERS: &[Entry<Filter>] = &[
    Entry::of::<BlackmanHarris>(),
    Entry::of::<Box>(),
    Entry::of::<Gaussian>(),
    Entry::of::<Mitchell>(),
    Entry::of::<Sinc>(),
    Entry::of::<Triangle>(),
];

const fn x_radius(default: f32) -> ParamSpec {
    ParamSpec::float("xradius", default, "How far the filter reaches from the pixel's middle in x.")
        .unit("px")
        .above(0.0, 32.0)
}

const fn y_radius(default: f32) -> ParamSpec {
    ParamSpec::float("yradius", default, "The same in y.").unit("px").above(0.0, 32.0)
}

/// The two radii.
fn radii(args: &mut Args<'_>) -> [f32; 2] {
    ["xradius", "yradius"].map(|name| args.float(name))
}
