//! `durer info`: what is in a scene, what it costs, and what is odd about it.

mod doctor;
mod facts;
mod memory;
mod text;
mod texture;

use durer::scene::Missing;

use crate::{
    exit::{Exit, emit, emit_json, harmless},
    load::load,
    options::{SceneOptions, TalkOptions},
    report,
};
use facts::Info;

const EXAMPLES: &str = "\
Examples:
  durer info room.glb
  durer info room.glb --json | jq .counts

JSON: an object with version 1; scene, format, counts, bounds, cameras, lights,
materials, textures, film, integrator, memory, seconds, doctor, complaints,
diagnostics. What could not be found out because of errors is null. Within a
version keys may be added, none renamed.";

/// Tells what is in a scene: counts, bounds, names, memory, complaints.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneOptions,
    /// As JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    // A library of materials has nothing to draw, but can be looked into.
    let wishes = durer::Options { nothing: Missing::Warn, ..args.scene.wishes() };
    let loaded = load(&args.scene.scene, &wishes);
    let failed = loaded.prepared.is_none();
    if failed {
        report::print(&args.scene.scene, &loaded.imported, &TalkOptions { quiet: false, verbose: true });
    }
    let info = Info::new(&args.scene.scene, &loaded);
    if args.json {
        emit_json(&info)?;
    } else if !failed {
        emit(&harmless(&text::table(&info, &loaded.imported)))?;
    }
    Ok(if failed { Exit::Failed } else { Exit::Done })
}
