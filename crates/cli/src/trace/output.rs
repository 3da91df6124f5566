//! The files that `-o` asks for: checked before the work, written after it.
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, anyhow};
use durer::tree::{Format, Page};

use crate::{
    exit::{WrongUsage, tell},
    options::TalkOptions,
    output::check_writable,
};

/// A file that can be written.
pub(super) struct Output {
    path: PathBuf,
    pub(super) format: Format,
}

/// The files asked for.
pub(super) fn outputs(asked: &[PathBuf]) -> anyhow::Result<Vec<Output>> {
    let mut outputs: Vec<Output> = Vec::new();
    for path in asked {
        if path.is_dir() {
            anyhow::bail!(
                "{} is a folder: name a file in it, such as {}",
                path.display(),
                path.join("tree.html").display()
            );
        }
        let format = Format::of(path).map_err(WrongUsage)?;
        check_writable(path)?;
        if format == Format::Html && !durer_page::is_built() {
            return Err(anyhow!("{}: {}", path.display(), durer_page::NotBuilt));
        }
        if outputs.iter().any(|o| o.path == *path) {
            return Err(WrongUsage(format!("{}: is named twice as an output", path.display())).into());
        }
        outputs.push(Output { path: path.clone(), format });
    }
    Ok(outputs)
}

/// The page with its first trees only: those that were asked for, and with what was asked of them. Times, which are never
/// the same twice, are for the page alone.
pub(super) fn only(page: &Page, trees: usize, walks: u32) -> Page {
    let mut only = page.clone();
    for node in only.trees.iter_mut().flat_map(|t| &mut t.nodes) {
        node.ns = None;
        if node.id >= walks as usize {
            node.walk.clear();
        }
    }
    only.trees.truncate(trees);
    if let Some(other) = &mut only.other {
        other.trees.truncate(trees);
    }
    only
}

/// Writes all files; complains about those that cannot be written. True if there were none of these.
pub(super) fn write(outputs: &[Output], page: &Page, shown: &Page, talk: &TalkOptions) -> bool {
    let mut all = true;
    for Output { path, format } in outputs {
        let page = if format.is_page() { page } else { shown };
        match bytes(*format, page).and_then(|bytes| store(path, &bytes)) {
            Ok(()) if talk.quiet => {}
            Ok(()) => tell(&format!("wrote {}", path.display())),
            Err(error) => {
                all = false;
                tell(&format!("error: {}: {error:#}", path.display()));
            }
        }
    }
    all
}

fn bytes(format: Format, page: &Page) -> anyhow::Result<Vec<u8>> {
    let bytes = format.write(page).map_err(|e| anyhow!(e))?;
    match format {
        Format::Html => Ok(durer_page::html(&bytes)?.into_bytes()),
        _ => Ok(bytes),
    }
}

fn store(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    fs::write(path, bytes).context("cannot be written")
}
