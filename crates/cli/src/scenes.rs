//! `durer scenes`: the scenes in the binary.
use std::fmt::Write;

use durer::builtin::SCENES;
use serde::Serialize;

use crate::exit::{Exit, emit, emit_json};

const EXAMPLES: &str = "\
Examples:
  durer scenes
  durer scenes --json
  durer render whitted

JSON: an array of {\"name\", \"about\"}; the first is the scene used where none is named.";

/// Lists the built-in scenes, with a line each.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// As JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Line {
    name: &'static str,
    about: &'static str,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    if args.json {
        let lines: Vec<_> = SCENES.iter().map(|s| Line { name: s.name, about: s.doc }).collect();
        emit_json(&lines)?;
        return Ok(Exit::Done);
    }
    let width = SCENES.iter().map(|s| s.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for scene in SCENES {
        writeln!(text, "{:width$}  {}", scene.name, scene.doc)?;
    }
    emit(&text)?;
    Ok(Exit::Done)
}
