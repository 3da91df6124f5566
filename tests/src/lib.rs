//! Shared fixtures of the cross-crate tests.
#![allow(clippy::expect_used, clippy::panic, reason = "a fixture that cannot be made is a failed test")]

pub mod look;
pub mod program;

use std::path::{Path, PathBuf};

use durer::{Imported, Options, Prepared, Rendered, import::pbrt, prepare};

/// A scene in our text language, imported.
pub fn import(text: &str) -> Imported {
    let mut imported = Imported::new(PathBuf::new(), Default::default());
    imported.desc.name = "test".to_owned();
    pbrt::read_text("test.pbrt", text, &mut imported);
    imported
}

/// Something that renders.
///
/// # Panics
/// If the scene has an error.
pub fn prepared(mut imported: Imported, options: &Options) -> Prepared {
    prepare(&mut imported, options).unwrap_or_else(|| panic!("{:#?}", imported.diagnostics))
}

/// A scene in our text language, ready to render.
pub fn scene(text: &str, options: &Options) -> Prepared {
    prepared(import(text), options)
}

/// The whole picture.
pub fn render(prepared: &Prepared) -> Rendered {
    prepared.job().render(Default::default(), &(), &Default::default())
}

/// The bits of every pixel's mean.
pub fn bits(rendered: &Rendered) -> Vec<[u32; 3]> {
    rendered.film.pixels().iter().map(|p| p.mean().map(f32::to_bits)).collect()
}

/// The folder of real files that tests look at, if it is there: `DURER_SHARED`, else `../shared`. Says loudly that the
/// test is skipped if it is not.
pub fn shared(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("DURER_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: {test}: no folder {}; set DURER_SHARED", folder.display());
    None
}
