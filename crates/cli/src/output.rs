//! Where pictures go: checked before the work, so that no night's render ends in a typing error.
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, bail};
use durer::{
    image::{PictureFormat, WRITERS, writer_for},
    scene::nearest_word,
};

use crate::exit::WrongUsage;

/// A file that can be written.
#[derive(Clone, Debug)]
pub(crate) struct Destination {
    pub(crate) path: PathBuf,
    pub(crate) format: PictureFormat,
    /// The path without detours, to tell files apart.
    place: PathBuf,
}

impl Destination {
    /// A file of the same format in the same folder.
    pub(crate) fn called(&self, path: PathBuf) -> Self {
        Self { path, ..self.clone() }
    }
}

/// The destinations asked for, or `SCENE-STEM.png` in the current folder.
pub(crate) fn destinations(asked: &[PathBuf], scene: &str) -> anyhow::Result<Vec<Destination>> {
    let default = [default_path(scene)];
    let paths = if asked.is_empty() { &default } else { asked };
    let destinations: Vec<_> =
        paths.iter().map(|path| destination(path, &default[0])).collect::<anyhow::Result<_>>()?;
    for (index, destination) in destinations.iter().enumerate() {
        if destinations[..index].iter().any(|d| d.place == destination.place) {
            let message = format!("{}: is named twice as an output", destination.path.display());
            return Err(WrongUsage(message).into());
        }
    }
    Ok(destinations)
}

pub(crate) fn default_path(scene: &str) -> PathBuf {
    let mut name = Path::new(scene).file_stem().unwrap_or("picture".as_ref()).to_owned();
    name.push(".png");
    name.into()
}

fn destination(path: &Path, default: &Path) -> anyhow::Result<Destination> {
    if path.is_dir() {
        let example = path.join(default);
        bail!("{} is a folder: name the picture, such as {}", path.display(), example.display());
    }
    let writer = writer_for(path).map_err(|_| WrongUsage(no_format(path)))?;
    check_writable(path)?;
    let place = std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).components().collect();
    Ok(Destination { path: path.to_owned(), format: writer.format, place })
}

/// Why the name of a picture names no format, and what to do.
fn no_format(path: &Path) -> String {
    let known: Vec<String> = WRITERS.iter().flat_map(|w| w.suffixes).map(|s| format!(".{s}")).collect();
    let known = known.join(" or ");
    let shown = path.display();
    match path.extension() {
        None => format!("{shown}: the name does not say which format\n  help: add {known} to the name"),
        Some(suffix) => {
            let suffix = suffix.to_string_lossy();
            let near = nearest_word(&suffix, WRITERS.iter().flat_map(|w| w.suffixes).copied());
            let help = near.map_or_else(|| format!("use {known}"), |near| format!("did you mean .{near}?"));
            format!("{shown}: pictures are not written as .{suffix}\n  help: {help}")
        }
    }
}

/// Complains unless a file of this name can be made. Pictures are written under another name first and renamed, so the
/// folder is what must be writable.
pub(crate) fn check_writable(path: &Path) -> anyhow::Result<()> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        bail!("{}: there is no folder {}", path.display(), folder.display());
    }
    if path.is_dir() {
        bail!("{} is a folder: name a file in it", path.display());
    }
    let probe = folder.join(format!(".durer-{}.probe", std::process::id()));
    let made = fs::File::create(&probe).with_context(|| format!("{}: cannot be written", path.display()));
    // A leftover of no bytes is the lesser evil.
    let _ = fs::remove_file(&probe);
    made.map(drop)
}
