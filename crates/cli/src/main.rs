//! `durer`, a ray tracer that lets you look inside: the command line.
//!
//! One file per command. stdout is for results (paths, tables, JSON); progress, warnings and errors go to stderr.
#![forbid(unsafe_code)]

mod completions;
mod convert;
mod cost;
mod draw;
mod exit;
mod explain;
mod frames;
mod info;
mod interrupt;
mod load;
mod man;
mod number;
mod options;
mod output;
mod progress;
mod render;
mod report;
mod scenes;
mod stats;
mod trace;
mod usage;
mod value;
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use exit::Exit;

const EXAMPLES: &str = "\
Examples:
  durer render                            the built-in scene, to whitted.png
  durer render room.glb -o room.exr       a file of your own, as linear floats
  durer view room.glb --open              watch it render, walk through it, change it
  durer trace room.glb --pixel 320,240    the rays that made that pixel, as a tree
  durer explain room.glb --pixel 320,240  the same in words, with the formulas
  durer cost room.glb                     what its picture costs, and where to save
  durer draw room.glb                     its lines, to room.svg
  durer convert room.glb room.pbrt        the same scene in another format
  durer info room.glb                     what is in the file, and what is odd about it

Exit status:
  0    done
  1    failed: a scene that cannot be read, a file that cannot be written
  2    wrong usage: an unknown word, or a value that an option does not take or this
       scene does not have (--camera, --pixel, --sample, --crop)
  130  interrupted from the keyboard";

/// A ray tracer that lets you look inside.
#[derive(Parser)]
#[command(name = "durer", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Render(Box<render::Args>),
    View(Box<view::Args>),
    Trace(Box<trace::Args>),
    Explain(Box<explain::Args>),
    Cost(Box<cost::Args>),
    Draw(Box<draw::Args>),
    Convert(Box<convert::Args>),
    Info(Box<info::Args>),
    Scenes(scenes::Args),
    Completions(completions::Args),
    Man(man::Args),
}

fn main() -> ExitCode {
    durer::hush_decoders();
    let words: Vec<_> = std::env::args_os().collect();
    let cli = match Cli::try_parse_from(&words) {
        Ok(cli) => cli,
        Err(error) => {
            let words: Vec<String> = words.iter().map(|w| w.to_string_lossy().into_owned()).collect();
            return usage::explain(&error, &words);
        }
    };
    let done = match cli.command {
        Command::Render(args) => render::run(&args),
        Command::View(args) => view::run(&args),
        Command::Trace(args) => trace::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Draw(args) => draw::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Scenes(args) => scenes::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    };
    done.unwrap_or_else(|error| Exit::of_error(&error)).into()
}
