//! The ideal low-pass filter under Lanczos' window: `f(x) = sinc(x) sinc(x / tau)` with `sinc(x) = sin(pi x) / (pi x)`
//! (Duchon 1979, "Lanczos Filtering in One and Two Dimensions"; pbrt's parameters).
use std::f32::consts::PI;

use durer_core::math::float::sin;
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `sinc`.
#[derive(Clone, Copy, Debug)]
pub struct Sinc {
    tau: f32,
}

fn sinc(x: f32) -> f32 {
    // Below, the series' first term is all that f32 sees.
    if x < 1e-4 { 1.0 } else { sin(PI * x) / (PI * x) }
}

impl Profile for Sinc {
    fn at(&self, x: f32) -> f32 {
        sinc(x) * sinc(x / self.tau)
    }
}

impl Kind for Sinc {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "sinc",
        aliases: &[],
        doc: "Lanczos' windowed sinc: the sharpest edges, with rings around them. Needs 16 samples or more.",
        params: &[
            x_radius(4.0),
            y_radius(4.0),
            ParamSpec::float("tau", 3.0, "Where the window ends.").unit("px").above(0.0, 32.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let (tau, radius) = (args.float("tau"), radii(args));
        args.is_sound().then(|| Filter::new(Self { tau }, Self { tau }, radius))
    }
}
