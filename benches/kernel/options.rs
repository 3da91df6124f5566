//! What the command line asks for.
use std::path::PathBuf;

use anyhow::{Context, bail};
use durer_benches::{load, ours::Isa};

/// Choices of a run.
#[derive(Debug)]
pub(crate) struct Options {
    /// The program made of `embree_peer.c`.
    pub(crate) peer: PathBuf,
    /// Embree's shared library.
    pub(crate) embree: PathBuf,
    /// Folder of test files.
    pub(crate) assets: PathBuf,
    /// Where files are exchanged.
    pub(crate) folder: PathBuf,
    /// JSON instead of tables.
    pub(crate) json: bool,
    /// Pixels along an edge of the picture whose rays are traced.
    pub(crate) edge: u32,
    /// How often everything is timed.
    pub(crate) runs: usize,
    /// Scenes by name.
    pub(crate) scenes: Vec<String>,
    /// Instructions that this machine has.
    pub(crate) isas: Vec<Isa>,
}

impl Options {
    /// From the words behind the program's name.
    pub(crate) fn parse(words: impl IntoIterator<Item = String>) -> anyhow::Result<Self> {
        let mut options = Self {
            peer: PathBuf::new(),
            embree: PathBuf::new(),
            assets: PathBuf::new(),
            folder: PathBuf::new(),
            json: false,
            edge: 512,
            runs: 5,
            scenes: load::names().map(str::to_owned).collect(),
            isas: Isa::ALL.to_vec(),
        };
        let (mut quick, mut runs) = (false, None);
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().with_context(|| format!("{word} wants a value"));
            match word.as_str() {
                "--peer" => options.peer = value()?.into(),
                "--embree" => options.embree = value()?.into(),
                "--assets" => options.assets = value()?.into(),
                "--folder" => options.folder = value()?.into(),
                "--json" => options.json = true,
                "--quick" => quick = true,
                "--runs" => {
                    let count = value()?.parse().ok().filter(|n| *n > 0);
                    runs = Some(count.context("--runs wants a number of at least 1")?);
                }
                "--scenes" => {
                    options.scenes = list(&value()?, |name| load::names().any(|known| known == name))?
                }
                "--isa" => {
                    let names = list(&value()?, |name| Isa::ALL.iter().any(|isa| isa.name() == name))?;
                    options.isas.retain(|isa| names.iter().any(|name| name == isa.name()));
                }
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        if quick {
            options.edge = 256;
        }
        options.runs = runs.unwrap_or(if quick { 3 } else { 5 });
        options.isas.retain(|isa| isa.is_here());
        Ok(options)
    }
}

/// Names between commas, each one that is known.
fn list(words: &str, is_known: impl Fn(&str) -> bool) -> anyhow::Result<Vec<String>> {
    let names: Vec<String> = words.split(',').map(str::to_owned).collect();
    match names.iter().find(|name| !is_known(name)) {
        Some(name) => bail!("nothing is called \"{name}\""),
        None => Ok(names),
    }
}
