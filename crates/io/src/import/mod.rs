//! Scene files in: bytes to [`SceneDesc`] and [`Diagnostics`].
//!
//! A new format is one file here and one line in [`FORMATS`].

mod color;
mod content;
mod gltf;
mod mitsuba;
mod obj;
pub mod pbrt;
pub(crate) mod ply;
mod polygon;
mod polygon_grid;
mod reading;
mod stl;
mod text;
mod unify;

use std::path::{Path, PathBuf};

use durer_scene::{Diagnostics, Limits, Location, SceneDesc, Sources};

pub use gltf::Reel;
pub use reading::{Moment, Play, Reading};

use crate::FileAssets;

/// What an importer makes of a file. The description is complete only if `diagnostics` holds no error.
#[derive(Debug)]
pub struct Imported {
    /// The scene.
    pub desc: SceneDesc,
    /// Where its images are.
    pub assets: FileAssets,
    /// The texts that spans point into.
    pub sources: Sources,
    /// Complaints.
    pub diagnostics: Diagnostics,
    /// The file as it can be read at other moments; `None` if `desc` holds all of them, or nothing moves.
    pub reel: Option<Reel>,
}

impl Imported {
    /// An empty scene whose files lie below `folder`.
    pub fn new(folder: PathBuf, limits: Limits) -> Self {
        Self {
            desc: SceneDesc::default(),
            assets: FileAssets::new(folder, limits),
            sources: Sources::default(),
            diagnostics: Diagnostics::default(),
            reel: None,
        }
    }

    /// Brings the description to another moment, if it holds but one of several. What is at rest stays as it was: the same
    /// meshes, in the same places.
    pub fn turn_to(&mut self, moment: Moment) {
        if let Some(mut reel) = self.reel.take() {
            reel.show(moment, self);
            self.reel = Some(reel);
        }
    }
}

/// A scene file format.
pub struct Format {
    /// What people call it.
    pub name: &'static str,
    /// Suffixes in lower case, without dot.
    pub suffixes: &'static [&'static str],
    /// Reads a file of this format.
    read: fn(&Path, &Reading, &mut Imported),
}

/// The formats we read.
pub const FORMATS: &[Format] = &[
    Format { name: "glTF 2.0", suffixes: &["gltf", "glb"], read: gltf::read },
    Format { name: "pbrt", suffixes: &["pbrt"], read: |path, _, imported| pbrt::read(path, imported) },
    Format { name: "Mitsuba", suffixes: &["xml"], read: mitsuba::read },
    Format { name: "Wavefront OBJ", suffixes: &["obj"], read: |path, _, imported| obj::read(path, imported) },
    Format { name: "PLY", suffixes: &["ply"], read: |path, _, imported| ply::read(path, imported) },
    Format { name: "STL", suffixes: &["stl"], read: |path, _, imported| stl::read(path, imported) },
];

/// Reads the scene file at `path`, in any letter case of its suffix, behind which `.gz` may stand. Never fails: what
/// went wrong is in [`Imported::diagnostics`].
pub fn open(path: &Path, reading: impl Into<Reading>) -> Imported {
    let reading = reading.into();
    let folder = path.parent().unwrap_or_else(|| Path::new("")).to_owned();
    let mut imported = Imported::new(folder, reading.limits);
    if let Some(root) = &reading.root
        && let Err(message) = imported.assets.widen(root)
    {
        imported.diagnostics.error(Location::None, message);
        return imported;
    }
    let unpacked = if suffix(path) == "gz" { path.with_extension("") } else { path.to_owned() };
    imported.desc.name = unpacked.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let suffix = suffix(&unpacked);
    let format = FORMATS.iter().find(|f| f.suffixes.contains(&suffix.as_str()));
    let packed = unpacked != path;
    if let Some(wrong) = content::check(path, packed, format.map(|f| f.name)) {
        let file = path.display().to_string();
        imported.diagnostics.error(Location::Path { file, pointer: String::new() }, wrong);
        return imported;
    }
    match format {
        Some(format) => (format.read)(path, &reading, &mut imported),
        None => {
            let known: Vec<_> = FORMATS.iter().flat_map(|f| f.suffixes).map(|s| format!(".{s}")).collect();
            let message = format!("{}: not a scene format durer reads", path.display());
            imported.diagnostics.error(Location::None, message).hint(format!(
                "expected a file ending in {}; it may be packed with gzip (.gz)",
                known.join(", ")
            ));
        }
    }
    imported
}

/// In lower case, without dot.
fn suffix(path: &Path) -> String {
    path.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default()
}
