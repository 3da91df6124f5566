//! Values on a grid in space, looked up where surfaces pass through it.
use durer_core::{glam::DAffine3, spectrum::Color};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Texture, TextureAt, mapping::Space};
use crate::{ShadeCx, medium::Grid};

/// Colours or numbers on a grid over the unit cube of texture space, straight lines between them; the outermost ones go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    grid: Grid<Color>,
    space: Space,
}

impl Texture for Volume {
    fn color(&self, _: &ShadeCx<'_>, at: &TextureAt) -> Color {
        self.grid.at(self.space.point(at).to_array().map(|v| v as f32))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.color(cx, at).luminance()
    }
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        self.grid.values().iter().flat_map(|c| c.rgb).fold(0.0, f32::max)
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.space.place(render_from_texture);
    }
    fn bytes(&self) -> u64 {
        size_of_val(self.grid.values()) as u64
    }
}

const fn along(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Int, ParamDefault::Int(1), doc).range(1.0, 65_536.0)
}

impl Kind for Volume {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "volume",
        aliases: &[],
        doc: "Values on a grid in space, in the unit cube of texture space, which the transform places: for surfaces without \
              texture coordinates, and patterns that go through things. Straight lines between; the outermost values go on.",
        params: &[
            ParamSpec::new(
                "values",
                ParamType::Floats,
                ParamDefault::Unset,
                "nx ny nz numbers, or three times as many for linear red, green and blue; x changes fastest. Without them it is \
                 1 everywhere.",
            ),
            along("nx", "Places along x."),
            along("ny", "Places along y."),
            along("nz", "Places along z."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let size = ["nx", "ny", "nz"].map(|name| args.int(name).unsigned_abs() as usize);
        let values = if args.is_set("values") { args.floats("values") } else { &[1.0] };
        let grey = values.iter().map(|v| Color::gray(*v)).collect();
        let colored = || values.as_chunks::<3>().0.iter().map(|&rgb| Color { rgb }).collect();
        let grid = Grid::new(size, grey)
            .or_else(|| values.len().is_multiple_of(3).then(|| Grid::new(size, colored())).flatten());
        let Some(grid) = grid else {
            let [nx, ny, nz] = size;
            let found = values.len();
            if args.is_sound() {
                args.error(
                    "values",
                    format!(
                        "\"values\" has {found} numbers, expected {nx} x {ny} x {nz} or three times as many"
                    ),
                );
            }
            return None;
        };
        let texture = Self { grid: grid.clamped(true), space: Space::WORLD };
        args.is_sound().then(|| Box::new(texture) as Self::Output)
    }
}
