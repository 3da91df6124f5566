//! `durer info`: what is in a scene, what it costs, and what is odd about it.

mod camera;
mod facts;
mod memory;
mod text;
mod texture;

use durer::scene::Missing;

use crate::{
    exit::{Exit, emit, emit_json, harmless},
    load::{Loaded, load},
    options::{SceneOptions, TalkOptions},
    report,
};
use facts::Info;
use text::Detail;

const EXAMPLES: &str = "\
Examples:
  durer info room.glb
  durer info room.glb -v
  durer info room.glb --json | jq .counts

JSON: an object with version 1; scene, format, counts, bounds, cameras, lights,
materials, textures, film, integrator, render, isa, memory, seconds, doctor,
complaints, diagnostics. What could not be found out because of errors is null. Within a
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
    /// All names, and what the acceleration structure holds.
    #[arg(long, short)]
    verbose: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    // A library of materials has nothing to draw, but can be looked into.
    let wishes = durer::Options { nothing: Missing::Warn, layers: true, ..args.scene.wishes() };
    let mut loaded = load(&args.scene.scene, &wishes);
    let failed = loaded.prepared.is_none();
    if failed {
        report::print(&args.scene.scene, &loaded.imported, &TalkOptions { quiet: false, verbose: true });
    }
    let doctor = examine(&mut loaded);
    let info = Info::new(&args.scene, &loaded, &doctor);
    if args.json {
        emit_json(&info)?;
    } else if !failed {
        let detail = if args.verbose { Detail::Full } else { Detail::Brief };
        emit(&harmless(&text::table(&info, &loaded.imported, detail)))?;
    }
    Ok(if failed { loaded.failure } else { Exit::Done })
}

/// Puts what the scene doctor finds among the diagnostics; returns his sentences.
fn examine(loaded: &mut Loaded) -> Vec<String> {
    let Some(prepared) = &loaded.prepared else { return Vec::new() };
    let found = durer::doctor::examine(&loaded.imported.desc, prepared);
    found.iter().for_each(|finding| finding.tell(&mut loaded.imported.diagnostics));
    found.into_iter().map(|finding| finding.message).collect()
}
