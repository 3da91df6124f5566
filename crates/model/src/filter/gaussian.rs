//! A bell curve lowered so that it ends at zero: `f(x) = exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)` (Physically Based
//! Rendering, 4th edition, section 8.8.4).
use durer_core::math::float::exp;
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `gaussian`.
#[derive(Clone, Copy, Debug)]
pub struct Gaussian {
    /// `1 / 2 s^2`.
    steepness: f32,
    /// The bell curve at the radius.
    edge: f32,
}

impl Gaussian {
    fn new(radius: f32, sigma: f32) -> Self {
        let steepness = 0.5 / (sigma * sigma);
        Self { steepness, edge: exp(-radius * radius * steepness) }
    }
    pub(super) fn filter(radius: [f32; 2], sigma: f32) -> Filter {
        let [x, y] = radius.map(|radius| Self::new(radius, sigma));
        Filter::new(x, y, radius)
    }
}

impl Profile for Gaussian {
    fn at(&self, x: f32) -> f32 {
        (exp(-x * x * self.steepness) - self.edge).max(0.0)
    }
}

impl Kind for Gaussian {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "gaussian",
        aliases: &[],
        doc: "A bell curve that ends at zero: smooth edges without halos. What scenes without a filter get.",
        params: &[
            x_radius(1.5),
            y_radius(1.5),
            ParamSpec::float("sigma", 0.5, "Standard deviation of the bell curve.")
                .unit("px")
                .above(0.0, 32.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let (radius, sigma) = (radii(args), args.float("sigma"));
        args.is_sound().then(|| Self::filter(radius, sigma))
    }
}
