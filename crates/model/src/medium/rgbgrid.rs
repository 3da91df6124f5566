//! A box of stuff whose coefficients stand in the file as colours, value by value.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Phase, Volume, glow::Glow, grid::Grid, matter::Matter, uniformgrid::Size, volume::Field};

/// The word `rgbgrid`.
#[derive(Clone, Copy, Debug)]
pub struct RgbGrid;

/// Coefficients on a grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Colored {
    what: What,
    scale: f32,
}

/// What the grids are of.
#[derive(Clone, Debug, PartialEq)]
enum What {
    /// Both coefficients; 1 everywhere where none are given.
    Coefficients { sigma_a: Option<Grid<Color>>, sigma_s: Option<Grid<Color>> },
    /// Their sum, and the share of scattering in it: between the points of the grids their product is none of straight lines.
    Shares { sigma_t: Grid<Color>, albedo: Grid<Color> },
}

impl Colored {
    /// At a point of the unit cube.
    pub(super) fn at(&self, p: [f32; 3]) -> Matter {
        let of = |grid: &Option<Grid<Color>>| grid.as_ref().map_or(Color::WHITE, |grid| grid.at(p));
        let matter = match &self.what {
            What::Coefficients { sigma_a, sigma_s } => Matter { sigma_a: of(sigma_a), sigma_s: of(sigma_s) },
            What::Shares { sigma_t, albedo } => {
                let (all, share) = (sigma_t.at(p), albedo.at(p));
                let [sigma_a, sigma_s] = [share.map(|v| 1.0 - v), share].map(|share| all * share);
                Matter { sigma_a, sigma_s }
            }
        };
        matter.scaled(self.scale)
    }
    pub(super) fn scatters(&self) -> bool {
        let is_any = |grid: &Grid<Color>| grid.values().iter().any(|c| *c != Color::BLACK);
        let scatters = match &self.what {
            What::Coefficients { sigma_s, .. } => sigma_s.as_ref().is_none_or(is_any),
            What::Shares { sigma_t, albedo } => is_any(sigma_t) && is_any(albedo),
        };
        self.scale > 0.0 && scatters
    }
    /// How many values along each axis.
    pub(super) fn size(&self) -> [usize; 3] {
        match &self.what {
            What::Coefficients { sigma_a, sigma_s } => {
                sigma_a.as_ref().or(sigma_s.as_ref()).map_or([1; 3], Grid::size)
            }
            What::Shares { sigma_t, .. } => sigma_t.size(),
        }
    }
    /// No component of both coefficients together is larger where these values are mixed.
    pub(super) fn most_in(&self, span: [[i64; 2]; 3]) -> f32 {
        let largest = |c: &Color| c.rgb.into_iter().fold(0.0, f32::max);
        let of = |grid: &Option<Grid<Color>>| grid.as_ref().map_or(1.0, |grid| grid.most_in(span, largest));
        let most = match &self.what {
            What::Coefficients { sigma_a, sigma_s } => of(sigma_a) + of(sigma_s),
            What::Shares { sigma_t, .. } => sigma_t.most_in(span, largest),
        };
        most * self.scale
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
                "sigma_t",
                ParamType::Colors,
                ParamDefault::Unset,
                "nx ny nz extinction coefficients, in 1/m: together with \"albedo\" instead of the two others.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "albedo",
                ParamType::Colors,
                ParamDefault::Unset,
                "The share of \"sigma_t\" that is scattering, on a grid of its own size in the same box. At each point both are \
                 looked up and multiplied.",
            )
            .range(0.0, 1.0),
            Size::along("albedonx", 0, "Values of \"albedo\" along x; 0 for as many as \"nx\"."),
            Size::along("albedony", 0, "The same along y."),
            Size::along("albedonz", 0, "The same along z."),
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
            Phase::VALUES,
            Phase::PARTS,
            Phase::WEIGHTS,
            Phase::SIZE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let size = Size::read(args);
        let corners = Size::corners(args);
        let [nx, ny, nz] = ["albedonx", "albedony", "albedonz"].map(|name| args.int(name) as usize);
        let or = |own: usize, other: usize| if own == 0 { other } else { own };
        let of_albedo = [or(nx, size[0]), or(ny, size[1]), or(nz, size[2])];
        let mut grid = |name: &str, size: [usize; 3]| {
            let values: Vec<Color> =
                args.floats(name).as_chunks::<3>().0.iter().map(|&rgb| Color { rgb }).collect();
            Size::grid(args, name, size, values)
        };
        let [sigma_a, sigma_s, sigma_t, sent] =
            ["sigma_a", "sigma_s", "sigma_t", "Le"].map(|name| grid(name, size));
        let albedo = grid("albedo", of_albedo);
        let has_both = sigma_t.is_some() && albedo.is_some();
        let has_either = sigma_a.is_some() || sigma_s.is_some();
        if sigma_t.is_some() != albedo.is_some() || has_both && has_either {
            let message =
                "rgbgrid needs \"sigma_t\" and \"albedo\" together, without \"sigma_a\" and \"sigma_s\"";
            args.error("sigma_t", message);
        } else if !has_both && sigma_a.is_none() && (sigma_s.is_none() || sent.is_some()) {
            args.error(
                "sigma_a",
                "rgbgrid needs the parameter \"rgb sigma_a\" or \"rgb sigma_s\", for \"Le\" the first",
            );
        }
        let what = match (sigma_t, albedo) {
            (Some(sigma_t), Some(albedo)) => What::Shares { sigma_t, albedo },
            _ => What::Coefficients { sigma_a, sigma_s },
        };
        let colored = Colored { what, scale: args.float(Matter::SCALE.name) };
        let glow = Glow::painted(sent, args.float(Glow::SCALE.name));
        let phase = Phase::read(args);
        args.is_sound().then(|| Volume::new(Field::Colored(colored), glow, phase).within(corners))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_two_grids_are_multiplied_where_they_are_met() {
        let grid = |size, values: &[f32]| {
            let colors = values.iter().map(|v| Color::gray(*v)).collect();
            Grid::new(size, colors).expect("as many values as the size says").clamped(true)
        };
        let what = What::Shares {
            sigma_t: grid([2, 1, 1], &[1.0, 3.0]),
            albedo: grid([4, 1, 1], &[0.2, 0.2, 0.6, 0.6]),
        };
        let colored = Colored { what, scale: 10.0 };
        // Halfway 2 and 0.4; products at the points would give 1.0 of scattering there.
        let middle = colored.at([0.5, 0.5, 0.5]);
        assert!((middle.sigma_s.rgb[0] - 8.0).abs() < 1e-5 && (middle.sigma_a.rgb[1] - 12.0).abs() < 1e-5);
        let end = colored.at([1.0, 0.5, 0.5]);
        assert!((end.sigma_s.rgb[2] - 18.0).abs() < 1e-5 && (end.sigma_a.rgb[0] - 12.0).abs() < 1e-5);
        assert_eq!((colored.size(), colored.most_in([[0, 1], [0, 0], [0, 0]])), ([2, 1, 1], 30.0));
        assert!(colored.scatters());
    }
}
