//! Clouds made of noise, denser below: those of pbrt-v4, so that its scenes look the same.
//!
//! Five octaves of noise, at places that two octaves of its gradient have moved (`wispiness`); they thin out with height,
//! which is 1 at the top, and are 1 everywhere below.
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Phase, Volume, glow::Glow, matter::Matter, uniformgrid::Size, volume::Field};
use crate::texture::noise;

/// The word `cloud`.
#[derive(Clone, Copy, Debug)]
pub struct Cloud;

/// The density of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wisps {
    density: f32,
    wispiness: f32,
    frequency: f32,
    /// Corners of the box.
    corners: [[f32; 3]; 2],
}

impl Wisps {
    /// How much finer each octave is than the one before.
    const LACUNARITY: f64 = 1.99;

    /// At a point of the unit cube, 0 to 1.
    pub(super) fn at(&self, p: [f32; 3]) -> f32 {
        let [low, high] = self.corners;
        let own: [f64; 3] = std::array::from_fn(|i| f64::from(low[i] + (high[i] - low[i]) * p[i]));
        let mut place = own.map(|c| c * f64::from(self.frequency));
        if self.wispiness > 0.0 {
            let (mut strength, mut frequency) = (0.05 * f64::from(self.wispiness), 10.0);
            for _ in 0..2 {
                let slope = slope(place.map(|c| c * frequency));
                place = std::array::from_fn(|i| place[i] + strength * slope[i]);
                strength *= 0.5;
                frequency *= Self::LACUNARITY;
            }
        }
        let (mut sum, mut strength, mut frequency) = (0.0, 0.5, 1.0);
        for _ in 0..5 {
            sum += strength * noise(place.map(|c| c * frequency));
            strength *= 0.5;
            frequency *= Self::LACUNARITY;
        }
        let height = own[1] as f32;
        let wisps = ((1.0 - height) * 4.5 * self.density * sum).clamp(0.0, 1.0);
        (wisps + 2.0 * (0.5 - height).max(0.0)).clamp(0.0, 1.0)
    }
}

/// Differences of noise over a hundredth.
fn slope(p: [f64; 3]) -> [f64; 3] {
    const STEP: f64 = 0.01;
    let here = noise(p);
    std::array::from_fn(|i| {
        let mut there = p;
        there[i] += STEP;
        f64::from(noise(there) - here) / STEP
    })
}

impl Kind for Cloud {
    type Output = Volume;
    const SCHEMA: Schema = Schema {
        name: "cloud",
        aliases: &[],
        doc: "A cloud made of noise in a box: wispy at height 1 of its own space, dense below 0.5.",
        params: &[
            ParamSpec::float("density", 1.0, "Factor of the noise.").range(0.0, f32::INFINITY),
            ParamSpec::float("wispiness", 1.0, "How far noise moves its details.").range(0.0, f32::INFINITY),
            ParamSpec::float("frequency", 5.0, "Details in a unit of its own space."),
            Size::LOW,
            Size::HIGH,
            Matter::SIGMA_A,
            Matter::SIGMA_S,
            Matter::G,
            Phase::WHICH,
            Phase::VALUES,
            Phase::PARTS,
            Phase::WEIGHTS,
            Phase::SIZE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let corners = Size::corners(args);
        let [density, wispiness, frequency] =
            ["density", "wispiness", "frequency"].map(|name| args.float(name));
        let matter =
            Matter { sigma_a: args.color(Matter::SIGMA_A.name), sigma_s: args.color(Matter::SIGMA_S.name) };
        let wisps = Wisps { density, wispiness, frequency, corners };
        let phase = Phase::read(args);
        args.is_sound().then(|| Volume::new(Field::Wisps(matter, wisps), Glow::DARK, phase).within(corners))
    }
}
