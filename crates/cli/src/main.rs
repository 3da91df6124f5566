//! `durer`, a ray tracer that lets you look inside: the command line.
//!
//! One file per command. stdout is for results (paths, tables, JSON); progress, warnings and errors go to stderr.
#![forbid(unsafe_code)]

mod completions;
mod exit;
mod info;
mod interrupt;
mod load;
mod man;
mod number;
mod options;
mod output;
mod picture;
mod progress;
mod render;
mod report;
mod scenes;
mod stats;
mod trace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use exit::Exit;

const EXAMPLES: &str = "\
Examples:
  durer render                            the built-in scene, to whitted.png
  durer render room.glb -o room.exr       a file of your own, as linear floats
  durer trace room.glb --pixel 320,240    why that pixel has its colour, ray by ray
  durer info room.glb                     what is in the file, and what is odd about it

Exit status: 0 done; 1 failed (bad scene, unwritable file); 2 wrong usage; 130 interrupted.";

/// A ray tracer that lets you look inside.
#[derive(Parser)]
#[command(name = "durer", version, after_help = EXAMPLES, disable_help_subcommand = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Render(render::Args),
    Trace(trace::Args),
    Info(info::Args),
    Scenes(scenes::Args),
    Completions(completions::Args),
    Man(man::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Trace(args) => trace::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Scenes(args) => scenes::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    };
    done.unwrap_or_else(|error| Exit::of_error(&error)).into()
}
