//! The family of cubic splines of Mitchell and Netravali (1988, "Reconstruction Filters in Computer Graphics",
//! equation 8), over two radii from the middle to each side.
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `mitchell`.
#[derive(Clone, Copy, Debug)]
pub struct Mitchell {
    b: f32,
    c: f32,
    radius: f32,
}

impl Profile for Mitchell {
    fn at(&self, x: f32) -> f32 {
        let Self { b, c, radius } = *self;
        let x = 2.0 * x / radius;
        let [a3, a2, a1, a0] = if x < 1.0 {
            [12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b]
        } else {
            [-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c]
        };
        if x < 2.0 { (((a3 * x + a2) * x + a1) * x + a0) / 6.0 } else { 0.0 }
    }
}

const THIRD: f32 = 1.0 / 3.0;

impl Kind for Mitchell {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "mitchell",
        aliases: &[],
        doc: "Cubic splines: sharp edges at the price of faint halos. Needs 16 samples or more.",
        params: &[
            x_radius(2.0),
            y_radius(2.0),
            ParamSpec::float("B", THIRD, "How far the spline smooths.").range(0.0, 2.0),
            ParamSpec::float("C", THIRD, "How far it overshoots.").range(0.0, 2.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let (b, c, radius) = (args.float("B"), args.float("C"), radii(args));
        let [x, y] = radius.map(|radius| Self { b, c, radius });
        args.is_sound().then(|| Filter::new(x, y, radius))
    }
}
