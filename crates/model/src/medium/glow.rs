//! What a volume sends out by itself: the same colour everywhere, or that of a black body as hot as the place.
use durer_core::{
    glam::DAffine3,
    math::{Point3, Transform},
    spectrum::{Basis, Color, LightColor, Spectrum},
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType, Voxels};

use super::grid::{Grid, between};

/// Colder places send no light that anybody sees, in K (as in pbrt-v4).
const COLDEST: f32 = 100.0;
/// Temperatures for which colours are known beforehand.
const STEPS: usize = 1024;

/// Radiance that stuff at a place sends out where it cannot be seen through.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Glow {
    color: Color,
    /// Factor at each place; 1 if there is none.
    scale: Option<Grid<f32>>,
    /// A colour for each place that `color` is multiplied with.
    painted: Option<Grid<Color>>,
    /// How hot each place is: what `color` is multiplied with.
    heat: Option<Heat>,
}

/// Temperatures as given.
#[derive(Clone, Debug, PartialEq)]
enum Degrees {
    Dense(Grid<f32>),
    /// In a cube of their own, which is where the volume's is or elsewhere.
    Sparse(Box<(Voxels, Transform)>),
}

/// How hot each place is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Heat {
    /// Temperatures as given.
    field: Degrees,
    /// Kelvins of 0, and of one degree as given.
    offset: f32,
    scale: f32,
    /// Colours of temperatures from 0 K to the hottest, in equal steps.
    colors: Vec<Color>,
    hottest: f32,
}

impl Heat {
    pub(super) const OFFSET: ParamSpec =
        ParamSpec::float("temperatureoffset", 0.0, "Temperature, as given, that is 0 K.");
    /// pbrt's other word for the offset.
    pub(super) const CUTOFF: ParamSpec = ParamSpec::new(
        "temperaturecutoff",
        ParamType::Float,
        ParamDefault::Unset,
        "Another word for \"temperatureoffset\".",
    );
    pub(super) const SCALE: ParamSpec =
        ParamSpec::float("temperaturescale", 1.0, "Kelvins of one degree as given.").unit("K");

    /// Reads offset and scale.
    pub(super) fn degrees(args: &Args<'_>) -> (f32, f32) {
        let cutoff = args.optional_float(Self::CUTOFF.name);
        let offset = args.optional_float(Self::OFFSET.name).or(cutoff).unwrap_or(0.0);
        (offset, args.float(Self::SCALE.name))
    }
    /// Of temperatures as given.
    pub(super) fn new(grid: Grid<f32>, degrees: (f32, f32)) -> Self {
        let most = grid.values().iter().copied().fold(0.0, f32::max);
        Self::of(Degrees::Dense(grid), most, degrees)
    }
    /// The same, of voxels in a cube of their own.
    pub(super) fn sparse(voxels: Voxels, degrees: (f32, f32), own_from_cube: &DAffine3) -> Self {
        let most = voxels.most();
        let placed = Box::new((voxels, Transform::from_f64(own_from_cube)));
        Self::of(Degrees::Sparse(placed), most, degrees)
    }
    fn of(field: Degrees, most: f32, (offset, scale): (f32, f32)) -> Self {
        let hottest = ((most - offset) * scale).max(-offset * scale);
        let hottest = if hottest.is_finite() { hottest.max(0.0) } else { 0.0 };
        let colors = (0..=STEPS).map(|i| LightColor::glow(hottest * i as f32 / STEPS as f32).color).collect();
        Self { field, offset, scale, colors, hottest }
    }
    fn at(&self, p: [f32; 3]) -> Color {
        let degrees = match &self.field {
            Degrees::Dense(grid) => grid.at(p),
            Degrees::Sparse(placed) => {
                let (voxels, own_from_cube) = &**placed;
                let own = own_from_cube.point(Point3::new(p[0], p[1], p[2]));
                between(voxels.size, own.to_array(), |index| voxels.value(index))
            }
        };
        let kelvin = (degrees - self.offset) * self.scale;
        if kelvin <= COLDEST || self.hottest <= 0.0 {
            return Color::BLACK;
        }
        let step = (kelvin / self.hottest).min(1.0) * STEPS as f32;
        let (below, rest) = ((step as usize).min(STEPS - 1), step - (step as usize).min(STEPS - 1) as f32);
        self.colors[below] * (1.0 - rest) + self.colors[below + 1] * rest
    }
}

impl Glow {
    pub(super) const COLOR: ParamSpec = ParamSpec::color(
        "Le",
        [0.0; 3],
        "Radiance that it sends out where it cannot be seen through: what is added on a way is sigma_a times this.",
    )
    .unit("W/(m² sr)")
    .range(0.0, f32::INFINITY);
    pub(super) const SCALE: ParamSpec =
        ParamSpec::float("Lescale", 1.0, "Factor of \"Le\".").range(0.0, f32::INFINITY);

    /// Nothing.
    pub(super) const DARK: Self = Self { color: Color::BLACK, scale: None, painted: None, heat: None };

    /// The same everywhere.
    pub(super) fn even(color: Color) -> Self {
        Self { color, ..Self::DARK }
    }
    /// A colour for each place, times a factor.
    pub(super) fn painted(colors: Option<Grid<Color>>, scale: f32) -> Self {
        let color = if colors.is_some() { Color::gray(scale) } else { Color::BLACK };
        Self { color, painted: colors, ..Self::DARK }
    }
    /// Times what a grid says.
    pub(super) fn scaled(self, scale: Option<Grid<f32>>) -> Self {
        Self { scale, ..self }
    }
    /// That of black bodies, of which the strongest wavelength sends 1, times the colour; nothing if nothing is hot.
    pub(super) fn hot(self, heat: Option<Heat>) -> Self {
        let color = if heat.is_some() { self.color } else { Color::BLACK };
        Self { heat, color, ..self }
    }
    pub(super) fn is_dark(&self) -> bool {
        self.color == Color::BLACK
    }
    /// At a point of the unit cube that the volume fills.
    pub(super) fn at(&self, basis: Basis, p: [f32; 3]) -> Spectrum {
        if self.is_dark() {
            return Spectrum::BLACK;
        }
        let color = self.heat.as_ref().map_or(self.color, |heat| self.color * heat.at(p));
        let color = self.painted.as_ref().map_or(color, |grid| color * grid.at(p));
        basis.emission(color * self.scale.as_ref().map_or(1.0, |grid| grid.at(p)))
    }
}
