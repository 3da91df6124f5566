//! The same everywhere: fog, milk, coloured water.
use durer_scene::{Args, Kind, Schema};

use super::{Phase, Volume, glow::Glow, matter::Matter, volume::Field};

/// The word `homogeneous`.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous;

impl Kind for Homogeneous {
    type Output = Volume;
    const SCHEMA: Schema = Schema {
        name: "homogeneous",
        aliases: &[],
        doc: "The same everywhere: fog, milk, coloured water. Where it only absorbs nothing is left to chance.",
        params: &[
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
            Glow::SCALE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let matter = Matter::read(args);
        let glow = Glow::even(args.color(Glow::COLOR.name) * args.float(Glow::SCALE.name));
        let phase = Phase::read(args);
        args.is_sound().then(|| Volume::new(Field::Even(matter), glow, phase))
    }
}
