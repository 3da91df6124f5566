//! The tent: `f(x) = r - |x|`.
use durer_scene::{Args, Kind, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `triangle`.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    radius: f32,
}

impl Profile for Triangle {
    fn at(&self, x: f32) -> f32 {
        self.radius - x
    }
}

impl Kind for Triangle {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "triangle",
        aliases: &["tent"],
        doc: "Falls evenly from the middle to zero.",
        params: &[x_radius(2.0), y_radius(2.0)],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let radius = radii(args);
        let [x, y] = radius.map(|radius| Self { radius });
        args.is_sound().then(|| Filter::new(x, y, radius))
    }
}
