//! `durer man`: manual pages, made from the same words as `--help`.
use std::path::PathBuf;

use anyhow::Context;
use clap::CommandFactory;

use crate::{
    Cli,
    exit::{Exit, emit},
};

const EXAMPLES: &str = "\
Examples:
  durer man | man -l -
  durer man --dir ~/.local/share/man/man1";

/// Prints the manual page.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Writes a page for durer and one for each command into this folder instead.
    #[arg(long, value_name = "FOLDER")]
    dir: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    if let Some(folder) = &args.dir {
        let place = || format!("{}: cannot be written", folder.display());
        std::fs::create_dir_all(folder).with_context(place)?;
        clap_mangen::generate_to(Cli::command(), folder).with_context(place)?;
        emit(&format!("{}\n", folder.display()))?;
        return Ok(Exit::Done);
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(Cli::command()).render(&mut page)?;
    emit(&String::from_utf8(page)?)?;
    Ok(Exit::Done)
}
