//! What the command line asks for.
use std::path::PathBuf;

use crate::{
    load,
    ours::{Isa, Mode},
};
use anyhow::{Context, bail};

/// Choices of a run.
#[derive(Debug)]
pub struct Options {
    /// The program made of `embree_peer.c`.
    pub peer: PathBuf,
    /// Embree's shared library.
    pub embree: PathBuf,
    /// Folder of test files.
    pub assets: PathBuf,
    /// Where files are exchanged.
    pub folder: PathBuf,
    /// JSON instead of tables.
    pub json: bool,
    /// Pixels along an edge of the picture whose rays are traced.
    pub edge: u32,
    /// How often everything is timed.
    pub runs: usize,
    /// Scenes by name.
    pub scenes: Vec<String>,
    /// Instructions that this machine has.
    pub isas: Vec<Isa>,
    /// Kinds of kernels.
    pub modes: Vec<Mode>,
    /// Numbers of threads, each 1 or 2.
    pub threads: Vec<usize>,
    /// Builds are timed too.
    pub builds: bool,
}

impl Options {
    /// From the words behind the program's name.
    ///
    /// # Errors
    /// A word that means nothing, or a value that is missing or wrong.
    pub fn parse(words: impl IntoIterator<Item = String>) -> anyhow::Result<Self> {
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
            modes: Mode::ALL.to_vec(),
            threads: vec![1, 2],
            builds: true,
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
                "--mode" => {
                    let names = list(&value()?, |name| Mode::ALL.iter().any(|mode| mode.name() == name))?;
                    options.modes.retain(|mode| names.iter().any(|name| name == mode.name()));
                }
                "--threads" => {
                    let numbers = list(&value()?, |number| ["1", "2"].contains(&number))?;
                    options.threads.retain(|n| numbers.contains(&n.to_string()));
                }
                "--without-builds" => options.builds = false,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(words: &str) -> anyhow::Result<Options> {
        Options::parse(words.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn options_are_read() {
        let options =
            parse("--quick --runs 7 --isa portable,avx2 --scenes terrain --json").expect("good options");
        assert_eq!((options.edge, options.runs, options.json), (256, 7, true));
        assert_eq!(options.scenes, ["terrain"]);
        assert_eq!(options.isas.last(), Some(&Isa::Portable));
        assert!(!options.isas.contains(&Isa::Avx512));
        let less = parse("--mode fast --threads 2 --without-builds").expect("good options");
        assert_eq!((less.modes, less.threads, less.builds), (vec![Mode::Fast], vec![2], false));
        let usual = parse("").expect("no options");
        assert_eq!((usual.edge, usual.runs, usual.scenes.len()), (512, 5, load::names().count()));
    }

    #[test]
    fn wrong_options_are_refused() {
        for words in ["--runs 0", "--runs", "--scenes teapot", "--isa sse", "--threads 3", "--fast"] {
            assert!(parse(words).is_err(), "{words}");
        }
    }
}
