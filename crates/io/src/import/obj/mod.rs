//! Wavefront OBJ and MTL (Wavefront Technologies, "Object Files (.obj)" and "MTL material format", 1995), as far as
//! programs write them: polygons with positions, texture coordinates and normals, vertex colours, objects, groups,
//! smoothing groups, materials.
//!
//! The text is read twice, each time in pieces by several threads: [`count`] finds how many vertices lie before each
//! piece, so that [`piece`] can resolve every index, also those that count backwards. [`smooth`] makes the normals of
//! smoothing groups, [`assemble`] the meshes, [`mtl`] reads material files, [`material`] and [`texture`] turn them into
//! materials of ours.

mod assemble;
mod corner;
mod library;
mod material;
mod model;
mod mtl;
mod piece;
mod smooth;
mod texture;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use durer_scene::{AssetError, Limits, Location, Mesh};
use rayon::prelude::*;

pub(super) use self::smooth::weighted_normals;
use self::{
    library::Library,
    model::Model,
    piece::{Counts, Piece},
};
use super::{
    Imported,
    text::{Complaint, Part, grouped, is_continued, tell, with_line_feeds},
};
use crate::assets::read_file;

/// Reads the file at `path`.
pub(super) fn read(path: &Path, imported: &mut Imported) {
    let file = path.display().to_string();
    let bytes = match read_file(path, &file, imported.assets.limits()) {
        Ok(bytes) => with_line_feeds(bytes),
        Err(error) => {
            imported.diagnostics.error(Location::None, error.to_string());
            return;
        }
    };
    let complaints = match no_text(&bytes) {
        Some(what) => vec![Complaint::whole(what)],
        None => {
            let text = Part::whole(&bytes);
            let skip = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
            scene(text.split(skip).1, imported)
        }
    };
    tell(complaints, &file, &bytes, imported);
}

/// What the file is, if it is not a text in one byte per character.
fn no_text(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("this is UTF-16; save it as UTF-8"),
        _ if bytes.iter().take(4096).any(|&b| b == 0) => Some("this is a binary file, not a Wavefront OBJ"),
        _ => None,
    }
}

/// The meshes in `bytes`, which messages call `name`, without their materials.
pub(crate) fn meshes(bytes: &[u8], name: &str, limits: Limits) -> Result<Vec<Arc<Mesh>>, AssetError> {
    let bytes = with_line_feeds(bytes.to_vec());
    let fail = |reason| AssetError::Format { path: name.to_owned(), reason };
    if let Some(what) = no_text(&bytes) {
        return Err(fail(what.to_owned()));
    }
    let whole = Part::whole(&bytes);
    let text = whole.split(if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 }).1;
    let mut complaints = Vec::new();
    let mut imported = Imported::new(PathBuf::new(), limits);
    if let Some(model) = model(text, &mut complaints) {
        assemble::shapes(text, model, &Library::default(), &mut complaints, &mut imported);
    }
    match complaints.iter().find(|c| c.severity == durer_scene::Severity::Error) {
        Some(wrong) => Err(fail(wrong.line(&bytes))),
        None => Ok(imported.desc.meshes),
    }
}

fn scene(text: Part<'_>, imported: &mut Imported) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    if let Some(model) = model(text, &mut complaints) {
        let names = library::load(text, &model, &mut complaints, imported);
        assemble::shapes(text, model, &names, &mut complaints, imported);
    }
    complaints
}

/// What a text says; `None` after an error.
fn model(text: Part<'_>, complaints: &mut Vec<Complaint>) -> Option<Model> {
    let cuts = text.pieces(|before, _| !is_continued(before));
    let counts: Vec<Counts> = cuts.par_iter().map(|cut| piece::count(*cut)).collect();
    let total = counts.iter().fold(Counts::default(), |sum, c| sum.plus(c));
    if total.exceeds_indices() {
        complaints.push(Complaint::whole("more vertices than durer can count"));
        return None;
    }
    let mut before = Counts::default();
    let mut starts = Vec::with_capacity(cuts.len());
    for count in &counts {
        starts.push(before);
        before = before.plus(count);
    }
    let pieces: Vec<Piece> =
        cuts.par_iter().zip(starts).map(|(cut, start)| piece::read(*cut, start, total)).collect();
    let mut model = Model::gather(pieces);
    *complaints = grouped(std::mem::take(&mut model.complaints));
    complaints.retain({
        let mut errors = 0;
        move |c| {
            errors += usize::from(c.severity == durer_scene::Severity::Error);
            errors <= durer_scene::Diagnostics::MOST_ERRORS
        }
    });
    if complaints.iter().any(|c| c.severity == durer_scene::Severity::Error) {
        return None;
    }
    smooth::add_normals(&mut model);
    Some(model)
}
