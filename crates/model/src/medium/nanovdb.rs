//! A cloud of another program, in OpenVDB's file: pbrt's medium `nanovdb`, which durer reads from `.vdb` files.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Phase, Volume,
    glow::{Glow, Heat},
    matter::Matter,
    volume::Field,
};

/// The word `nanovdb`.
#[derive(Clone, Copy, Debug)]
pub struct NanoVdb;

impl Kind for NanoVdb {
    type Output = Volume;
    const SCHEMA: Schema = Schema {
        name: "nanovdb",
        aliases: &["openvdb"],
        doc: "Stuff as dense as a grid of an OpenVDB file says, and as hot as another.",
        params: &[
            ParamSpec::new("filename", ParamType::File, ParamDefault::Required, "The file, .vdb."),
            ParamSpec::new(
                "grid",
                ParamType::Text,
                ParamDefault::Text("density"),
                "Name of the grid of densities.",
            ),
            ParamSpec::new(
                "temperaturegrid",
                ParamType::Text,
                ParamDefault::Text("temperature"),
                "Name of the grid of temperatures, if the file has one.",
            ),
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
            Heat::OFFSET,
            Heat::CUTOFF,
            Heat::SCALE,
            Glow::SCALE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let matter = Matter::read(args);
        let phase = Phase::read(args);
        let names = args.grids("filename")?;
        let wanted = args.text("grid");
        if !names.iter().any(|name| name == wanted) {
            let known = durer_scene::listed(&names.iter().map(String::as_str).collect::<Vec<_>>());
            args.error("grid", format!("the file has no grid called \"{wanted}\"; it has: {known}"));
            return None;
        }
        let density = args.voxels("filename", wanted)?;
        let hot = args.text("temperaturegrid");
        let heat = match names.iter().any(|name| name == hot) {
            true => {
                let voxels = args.voxels("filename", hot)?;
                let from_cube = voxels.world_from_cube.inverse() * density.world_from_cube;
                Some(Heat::sparse(voxels, Heat::degrees(args), &from_cube))
            }
            false => None,
        };
        let placed = density.world_from_cube;
        let glow = Glow::even(Color::gray(args.float(Glow::SCALE.name))).hot(heat);
        let field = Field::Sparse(matter, density);
        args.is_sound().then(|| Volume::new(field, glow, phase).at_place(placed))
    }
}
