//! A box of stuff whose coefficients stand in the file as colours, value by value.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Phase, Volume, glow::Glow, grid::Grid, matter::Matter, uniformgrid::Size, volume::Field};

/// The word `rgbgrid`.
#[derive(Clone, Copy, Debug)]
pub struct RgbGrid;

/// Coefficients on a grid; 1 everywhere where none are given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Colored {
    sigma_a: Option<Grid<Color>>,
    sigma_s: Option<Grid<Color>>,
    scale: f32,
}

impl Colored {
    /// At a point of the unit cube.
    pub(super) fn at(&self, p: [f32; 3]) -> Matter {
        let of = |grid: &Option<Grid<Color>>| grid.as_ref().map_or(Color::WHITE, |grid| grid.at(p));
        Matter { sigma_a: of(&self.sigma_a), sigma_s: of(&self.sigma_s) }.scaled(self.scale)
    }
    pub(super) fn scatters(&self) -> bool {
        let is_any = |grid: &Grid<Color>| grid.values().iter().any(|c| *c != Color::BLACK);
        self.scale > 0.0 && self.sigma_s.as_ref().is_none_or(is_any)
    }
    /// How many values along each axis.
    pub(super) fn size(&self) -> [usize; 3] {
        self.sigma_a.as_ref().or(self.sigma_s.as_ref()).map_or([1; 3], Grid::size)
    }
    /// No component of both coefficients together is larger where these values are mixed.
    pub(super) fn most_in(&self, span: [[i64; 2]; 3]) -> f32 {
        let largest = |c: &Color| c.rgb.into_iter().fold(0.0, f32::max);
        let of = |grid: &Option<Grid<Color>>| grid.as_ref().map_or(1.0, |grid| grid.most_in(span, largest));
        (of(&self.sigma_a) + of(&self.sigma_s)) * self.scale
    }
}

impl Kind for RgbGrid {
    type Output = Volume;
    const SCHEMA: Schema = Schema {
        name: "rgbgrid",
        aliases: &[],
        doc: "A box of stuff whose coefficients are given on a grid as colours.",
        params: &[
            ParamSpec::new(
                "sigma_a",
                ParamType::Colors,
                ParamDefault::Unset,
                "nx ny nz absorption coefficients, in 1/m; 1 if there are none.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "sigma_s",
                ParamType::Colors,
                ParamDefault::Unset,
                "nx ny nz scattering coefficients, in 1/m; 1 if there are none.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "Le",
                ParamType::Colors,
                ParamDefault::Unset,
                "nx ny nz radiances that are sent out; they need \"sigma_a\".",
            )
            .range(0.0, f32::INFINITY),
            Glow::SCALE,
            Size::X,
            Size::Y,
            Size::Z,
            Size::LOW,
            Size::HIGH,
            Size::EDGES,
            Matter::SCALE,
            Matter::G,
            Phase::WHICH,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let size = Size::read(args);
        let corners = Size::corners(args);
        let [sigma_a, sigma_s, sent] = ["sigma_a", "sigma_s", "Le"].map(|name| {
            let values: Vec<Color> =
                args.floats(name).as_chunks::<3>().0.iter().map(|&rgb| Color { rgb }).collect();
            Size::grid(args, name, size, values)
        });
        if sigma_a.is_none() && (sigma_s.is_none() || sent.is_some()) {
            args.error(
                "sigma_a",
                "rgbgrid needs the parameter \"rgb sigma_a\" or \"rgb sigma_s\", for \"Le\" the first",
            );
        }
        let colored = Colored { sigma_a, sigma_s, scale: args.float(Matter::SCALE.name) };
        let glow = Glow::painted(sent, args.float(Glow::SCALE.name));
        let phase = Phase::read(args);
        args.is_sound().then(|| Volume::new(Field::Colored(colored), glow, phase).within(corners))
    }
}
