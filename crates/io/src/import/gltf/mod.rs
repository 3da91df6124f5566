//! glTF 2.0 and GLB (Khronos glTF 2.0 specification, ISO/IEC 12113).
//!
//! The file is read as plain JSON with checks of our own: every complaint carries the JSON pointer of its cause, every
//! index and range is checked before use, and what a file may unpack to is bounded by the size of its buffers.
//! An animation, if one is played, leaves nodes and weights as they are at the moments that a picture needs (`stance.rs`);
//! what else it changes is written into the document before that is read (`reel.rs`).
//! What takes time is done in parallel: buffers are read, then all primitives are decoded at the same time.

mod accessor;
mod animation;
mod buffer;
mod camera;
mod container;
mod document;
mod draco;
mod element;
mod extension;
mod instance;
mod json;
mod kept;
mod layers;
mod luminaire;
mod material;
mod mesh;
mod meshopt;
mod morph;
mod node;
mod place;
mod primitive;
mod reel;
mod skin;
mod stance;
mod structure;
mod surround;
mod texture;
mod variant;

use std::{path::Path, sync::Arc};

use durer_scene::{Location, counted};

pub use self::reel::Reel;
use self::{
    animation::Animation,
    buffer::{Buffers, Chunk},
    document::Document,
    element::{Checked, Element},
    node::Hierarchy,
};
use super::{Imported, Reading};
use crate::assets::read_file;

/// Reads the file at `path`.
pub(super) fn read(path: &Path, reading: &Reading, imported: &mut Imported) {
    let file = path.display().to_string();
    if let Err(message) = parse(path, &file, reading, imported) {
        imported.diagnostics.error(Location::Path { file, pointer: String::new() }, message);
    }
}

fn parse(path: &Path, file: &str, reading: &Reading, imported: &mut Imported) -> Result<(), String> {
    let bytes = Arc::new(read_file(path, file, reading.limits).map_err(|e| e.to_string())?);
    let chunks = container::split(&bytes)?;
    let mut value = json::parse(chunks.json)?;
    let bin = chunks.bin.map(|range| Chunk { bytes: Arc::clone(&bytes), range });
    let document = Document::new(Element::root(&value), file);
    let loaded = document.keep(load(&document, bin.as_ref(), imported)).flatten();
    let animation = match &loaded {
        Some(buffers) => document.keep(Animation::read(&document, buffers, &reading.play)).flatten(),
        None => None,
    };
    let stories =
        document.keep(animation::told(&document, &reading.play, reading.moment)).unwrap_or_default();
    let variants = document.keep(variant::names(&document)).unwrap_or_default();
    let worn = match &reading.variant {
        Some(wanted) if !variants.is_empty() => document.keep(variant::chosen(&document, &variants, wanted)),
        _ => None,
    };
    let sound = !document.has_errors();
    (imported.desc.animations, imported.desc.variants) = (stories, variants);
    imported.diagnostics.append(document.into_complaints());
    if let Some(buffers) = loaded.filter(|_| sound) {
        if let Some(worn) = worn {
            variant::wear(&mut value, worn);
        }
        let mut reel = Reel::new(file, value, buffers, animation);
        reel.open(reading.moment, imported);
        imported.reel = reel.animation.is_some().then_some(reel);
    }
    Ok(())
}

/// Checks the document and loads its buffers; `None` after a complaint.
fn load(document: &Document<'_>, bin: Option<&Chunk>, imported: &mut Imported) -> Checked<Option<Buffers>> {
    check_version(document)?;
    extension::check(document)?;
    if document.has_errors() {
        return Ok(None);
    }
    structure::check(document)?;
    let buffers = Buffers::load(document, bin, &imported.assets)?;
    buffers.check(document)?;
    document.set_budget(buffers.total());
    Ok(Some(buffers))
}

fn check_version(document: &Document<'_>) -> Checked<()> {
    let missing = || document.root.fault("this is no glTF 2.0 file: it has no \"asset\"");
    let asset = document.root.get("asset")?.ok_or_else(missing)?;
    let version = asset.required("version")?;
    let text = version.text()?;
    let major = text.split_once('.').map(|(major, _)| major.parse::<u32>());
    let digits = |c: char| c.is_ascii_digit() || c == '.';
    match major {
        Some(Ok(2)) if text.chars().all(digits) => {}
        Some(Ok(_)) => {
            let mut fault = version.fault(format!("durer reads glTF 2, but this file is glTF {text}"));
            fault.hint = Some("export the scene as glTF 2.0".to_owned());
            return Err(fault);
        }
        _ => return Err(version.fault(format!("expected a version such as \"2.0\", found \"{text}\""))),
    }
    match asset.get("minVersion")? {
        Some(least) if least.text()? != "2.0" => {
            let asked = least.text()?;
            let message =
                format!("the file asks for glTF {asked}; durer reads 2.0, what is newer is left out");
            match asked.split_once('.') {
                Some(("2", _)) => document.warn(&least, message),
                _ => return Err(least.fault(message)),
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

fn no_scene(document: &Document<'_>) -> Checked<String> {
    let (nodes, meshes) = (document.root.list("nodes")?.len(), document.root.list("meshes")?.len());
    Ok(match (nodes, meshes) {
        (0, 1..) => {
            format!("the file has 0 nodes and {} that no node uses", counted(meshes, "mesh"))
        }
        (0, 0) => "the file has no nodes and no meshes".to_owned(),
        _ => "the file holds no scene; all of its nodes are drawn".to_owned(),
    })
}

/// The indices of the nodes at the top: those of the scene the file opens with, else of the first scene, else all
/// nodes that are no other's child.
fn roots<'a>(document: &Document<'a>, nodes: &Hierarchy<'a>) -> Checked<Vec<usize>> {
    let scenes = document.root.list("scenes")?;
    let number = document.root.index_or("scene", 0)?;
    if let (Some(scene), true) = (scenes.get(number), scenes.len() > 1) {
        document.note(scene, format!("the file holds {} scenes; scene {number} is drawn", scenes.len()));
    }
    match scenes.get(number) {
        Some(scene) => scene.list("nodes")?.iter().map(|reference| nodes.index(reference)).collect(),
        None => {
            document.warn(&document.root, no_scene(document)?);
            Ok(nodes.roots.clone())
        }
    }
}
