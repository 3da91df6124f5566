//! The mean over a rectangle: `f(x) = 1`.
use durer_scene::{Args, Kind, Schema};

use super::{Filter, Profile, radii, x_radius, y_radius};

/// The word `box`.
#[derive(Clone, Copy, Debug)]
pub struct Box;

impl Profile for Box {
    fn at(&self, _x: f32) -> f32 {
        1.0
    }
}

impl Kind for Box {
    type Output = Filter;
    const SCHEMA: Schema = Schema {
        name: "box",
        aliases: &[],
        doc: "The mean over a rectangle. Sharp, with stairs along moving edges; a radius of 0.5 is the pixel.",
        params: &[x_radius(0.5), y_radius(0.5)],
    };
    fn build(args: &mut Args<'_>) -> Option<Filter> {
        let radius = radii(args);
        args.is_sound().then(|| Filter::new(Self, Self, radius))
    }
}
