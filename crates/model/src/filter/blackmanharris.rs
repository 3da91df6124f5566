//! The window of four cosines with the lowest side lobes (Harris 1978, "On the Use of Windows for Harmonic Analysis",
//! table I), as a filter.
use std::f32::consts::PI;

use durer_core::math::float::cos;
use durer_scene::{Args, Kind, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `blackmanharris`.
#[derive(Clone, Copy, Debug)]
pub struct BlackmanHarris {
    radius: f32,
}

impl Profile for BlackmanHarris {
    fn at(&self, x: f32) -> f32 {
        // About the middle, not about the left end: the signs of the odd terms are turned.
        let c = cos(PI * x / self.radius);
        let (c2, c3) = (2.0 * c * c - 1.0, (4.0 * c * c - 3.0) * c);
        (0.35875 + 0.48829 * c + 0.14128 * c2 + 0.01168 * c3).max(0.0)
    }
}

impl Kind for BlackmanHarris {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "blackmanharris",
        aliases: &[],
        doc: "A sum of cosines, much like a Gaussian.",
        params: &[x_radius(1.5), y_radius(1.5)],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let radius = radii(args);
        let [x, y] = radius.map(|radius| Self { radius });
        args.is_sound().then(|| Filter::new(x, y, radius))
    }
}
