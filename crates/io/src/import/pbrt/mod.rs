//! The pbrt-v4 scene language (pbrt.org/fileformat-v4), with additions of ours: docs/pbrt-language.md.
//!
//! Text flows one way: [`files`] reads it, [`lexer`] cuts it into tokens, [`input`] and [`params`] read arguments
//! ([`bulk`] long ones), [`parser`] obeys directives ([`placing`], [`settings`], [`mod@option`], [`block`], [`nodes`]), [`world`]
//! collects what they leave. Kinds and their parameters are checked later, against the registry of the model; only `Film` and `Sampler`
//! are checked here.

mod block;
mod bulk;
mod color_space;
mod cutout;
mod directive;
mod files;
mod film;
mod input;
mod integrator;
mod keys;
mod lexer;
mod media;
mod nodes;
mod number;
mod option;
mod params;
mod parser;
mod placement;
mod placing;
mod retired;
mod settings;
mod state;
mod transform;
mod world;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use self::{
    files::{Files, Text},
    parser::Parser,
};
use super::Imported;
use durer_scene::Location;

/// Bounces of pbrt-v4's paths unless a file says how many.
const USUAL_DEPTH: u32 = 5;

/// Reads the file at `path`.
pub(super) fn read(path: &Path, imported: &mut Imported) {
    let Imported { desc, assets, sources, diagnostics, .. } = imported;
    desc.usual_depth = Some(USUAL_DEPTH);
    if let Some((files, text)) = Files::main(path, assets.limits(), sources, diagnostics) {
        Parser::new(text, files, desc, sources, diagnostics).run();
        retired::summarize(path, diagnostics);
    }
}

/// Reads a scene that is no file, such as a built-in one; `name` is what messages call it. It cannot include files.
pub fn read_text(name: &str, text: &str, imported: &mut Imported) {
    let text: Arc<str> = Arc::from(text);
    let Imported { desc, assets, sources, diagnostics, .. } = imported;
    desc.usual_depth = Some(USUAL_DEPTH);
    if !files::spans_fit(&text) {
        diagnostics.error(Location::None, format!("{name}: larger than 4 GiB"));
        return;
    }
    let source = sources.add(name, text.clone());
    let text = Text { source, text, folder: None, path: PathBuf::new() };
    Parser::new(text, Files::none(assets.limits()), desc, sources, diagnostics).run();
}
