//! A box of stuff whose density stands in the file, value by value.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Phase, Volume,
    glow::{Glow, Heat},
    grid::{Grid, Mixed},
    matter::Matter,
    volume::Field,
};

/// The word `uniformgrid`.
#[derive(Clone, Copy, Debug)]
pub struct UniformGrid;

/// The size of a grid in a file.
pub(super) struct Size;

impl Size {
    pub(super) const fn along(name: &'static str, usual: i32, doc: &'static str) -> ParamSpec {
        ParamSpec::new(name, ParamType::Int, ParamDefault::Int(usual), doc).range(usual as f32, 65_536.0)
    }
    pub(super) const X: ParamSpec = Self::along("nx", 1, "Values along x, which changes fastest.");
    pub(super) const Y: ParamSpec = Self::along("ny", 1, "Values along y.");
    pub(super) const Z: ParamSpec = Self::along("nz", 1, "Values along z.");
    pub(super) const LOW: ParamSpec =
        ParamSpec::new("p0", ParamType::Point3, ParamDefault::Triple([0.0; 3]), "A corner of the box, m.");
    pub(super) const HIGH: ParamSpec =
        ParamSpec::new("p1", ParamType::Point3, ParamDefault::Triple([1.0; 3]), "The opposite corner, m.");

    pub(super) const EDGES: ParamSpec = ParamSpec::new(
        "edges",
        ParamType::Choice(&["fade", "clamp"]),
        ParamDefault::Text("fade"),
        "Whether the box fades over its last half step, as in pbrt-v4, or the outermost values go on to its sides.",
    );

    /// Reads it.
    pub(super) fn read(args: &Args<'_>) -> [usize; 3] {
        ["nx", "ny", "nz"].map(|name| args.int(name).unsigned_abs() as usize)
    }
    /// The corners of the box, the smaller coordinates first; complains if it is flat.
    pub(super) fn corners(args: &mut Args<'_>) -> [[f32; 3]; 2] {
        let (a, b) = (args.triple("p0"), args.triple("p1"));
        let low = std::array::from_fn(|i| f32::min(a[i], b[i]));
        let high: [f32; 3] = std::array::from_fn(|i| f32::max(a[i], b[i]));
        if (0..3).any(|i| high[i] <= low[i]) {
            args.error("p1", "\"p0\" and \"p1\" span no box: it is flat");
        }
        [low, high]
    }
    /// The grid of the values of parameter `name`; `None` if there are none.
    pub(super) fn grid<T: Mixed>(
        args: &mut Args<'_>,
        name: &str,
        size: [usize; 3],
        values: Vec<T>,
    ) -> Option<Grid<T>> {
        if values.is_empty() {
            return None;
        }
        let count = values.len();
        let grid = Grid::new(size, values);
        if grid.is_none() {
            let [x, y, z] = size;
            args.error(name, format!("\"{name}\" has {count} values, expected {x} x {y} x {z}"));
        }
        let clamped = args.text(Self::EDGES.name) == "clamp";
        grid.map(|grid| grid.clamped(clamped))
    }
}

impl Kind for UniformGrid {
    type Output = Volume;
    const SCHEMA: Schema = Schema {
        name: "uniformgrid",
        aliases: &[],
        doc: "A box of stuff whose density is given on a grid: smoke, clouds, and with temperatures fire.",
        params: &[
            ParamSpec::new(
                "density",
                ParamType::Floats,
                ParamDefault::Required,
                "nx ny nz factors of the coefficients.",
            )
            .range(0.0, f32::INFINITY),
            Size::X,
            Size::Y,
            Size::Z,
            Size::LOW,
            Size::HIGH,
            Size::EDGES,
            Matter::PRESET,
            Matter::SIGMA_A,
            Matter::SIGMA_S,
            Matter::SCALE,
            Matter::G,
            Phase::WHICH,
            Phase::VALUES,
            Phase::PARTS,
            Phase::WEIGHTS,
            Phase::SIZE,
            Glow::COLOR,
            ParamSpec::new(
                "Lescale",
                ParamType::Floats,
                ParamDefault::Unset,
                "nx ny nz factors of what is sent out.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "temperature",
                ParamType::Floats,
                ParamDefault::Unset,
                "nx ny nz temperatures: places send what black bodies do, of which the strongest wavelength sends 1.",
            ),
            Heat::OFFSET,
            Heat::CUTOFF,
            Heat::SCALE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let size = Size::read(args);
        let corners = Size::corners(args);
        let matter = Matter::read(args);
        let [density, temperature, scale] = ["density", "temperature", "Lescale"].map(|name| {
            let values = args.floats(name).to_vec();
            Size::grid(args, name, size, values)
        });
        let color = args.color(Glow::COLOR.name);
        if temperature.is_some() && args.is_set(Glow::COLOR.name) {
            args.error("Le", "\"Le\" and \"temperature\" both say what is sent out: give one of them");
        }
        let glow = match temperature.map(|grid| Heat::new(grid, Heat::degrees(args))) {
            None => Glow::even(color),
            heat => Glow::even(Color::WHITE).hot(heat),
        };
        let glow = glow.scaled(scale);
        let phase = Phase::read(args);
        let Some(density) = density else {
            if args.is_sound() {
                args.error("density", "\"density\" is empty");
            }
            return None;
        };
        args.is_sound().then(|| Volume::new(Field::Dense(matter, density), glow, phase).within(corners))
    }
}
