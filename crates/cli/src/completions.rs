//! `durer completions`: scripts with which a shell completes our words.
use clap::CommandFactory;
use clap_complete::{Shell, generate};

use crate::{
    Cli,
    exit::{Exit, emit},
};

const EXAMPLES: &str = "\
Examples:
  durer completions bash > ~/.local/share/bash-completion/completions/durer
  durer completions zsh > ~/.zfunc/_durer
  durer completions fish > ~/.config/fish/completions/durer.fish";

/// Prints the completion script of a shell.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Which shell.
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let mut script = Vec::new();
    generate(args.shell, &mut Cli::command(), "durer", &mut script);
    emit(&String::from_utf8(script)?)?;
    Ok(Exit::Done)
}
