//! glTF 2.0 and GLB (Khronos glTF 2.0 specification, ISO/IEC 12113).
//!
//! The file is read as plain JSON with checks of our own: every complaint carries the JSON pointer of its cause, every
//! index and range is checked before use, and what a file may unpack to is bounded by the size of its buffers.
//! Skins and morph targets are drawn as the nodes and weights of the file leave them; animations are not played yet.
//! What takes time is done in parallel: buffers are read, then all primitives are decoded at the same time.

mod accessor;
mod buffer;
mod camera;
mod container;
mod document;
mod element;
mod extension;
mod instance;
mod json;
mod layers;
mod material;
mod mesh;
mod morph;
mod node;
mod place;
mod primitive;
mod skin;
mod structure;
mod texture;

use std::path::Path;

use durer_scene::{Limits, Location, SceneDesc, counted};

use self::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    material::Looks,
    node::Hierarchy,
    place::Walk,
    texture::Textures,
};
use super::Imported;
use crate::{FileAssets, assets::read_file};

/// Reads the file at `path`.
pub(super) fn read(path: &Path, imported: &mut Imported) {
    let file = path.display().to_string();
    let limits = imported.assets.limits();
    if let Err(message) = parse(path, &file, limits, imported) {
        imported.diagnostics.error(Location::Path { file, pointer: String::new() }, message);
    }
}

fn parse(path: &Path, file: &str, limits: Limits, imported: &mut Imported) -> Result<(), String> {
    let bytes = read_file(path, file, limits).map_err(|e| e.to_string())?;
    let chunks = container::split(&bytes)?;
    let value = json::parse(chunks.json)?;
    let document = Document::new(Element::root(&value), file);
    if let Err(fault) = import(&document, chunks.bin, imported) {
        document.error(fault);
    }
    imported.diagnostics.append(document.into_complaints());
    Ok(())
}

fn import<'a>(document: &Document<'a>, bin: Option<&'a [u8]>, imported: &mut Imported) -> Checked<()> {
    check_version(document)?;
    extension::check(document)?;
    if document.has_errors() {
        return Ok(());
    }
    structure::check(document)?;
    let nodes = Hierarchy::read(document)?;
    let buffers = Buffers::load(document, bin, &imported.assets)?;
    buffers.check(document)?;
    document.set_budget(buffers.total());
    let desc = &mut imported.desc;
    let looks = looks(document, &buffers, &mut imported.assets, desc)?;
    let roots = roots(document, &nodes)?;
    Walk::new(document, &buffers, &nodes, &looks).run(&roots, desc)?;
    desc.materials = looks.list;
    buffers.warn_of_unused(document)?;
    let animations = document.root.list("animations")?;
    if let Some(first) = animations.first() {
        let message = match animations.len() {
            1 => "1 animation is not played: the scene is drawn at rest".to_owned(),
            n => format!("{n} animations are not played: the scene is drawn at rest"),
        };
        document.warn(first, message);
    }
    Ok(())
}

fn looks<'a>(
    document: &Document<'a>,
    buffers: &Buffers<'a>,
    assets: &mut FileAssets,
    desc: &mut SceneDesc,
) -> Checked<Looks> {
    let mut textures = Textures::new(document, buffers, assets);
    let looks = Looks::read(document, &mut textures);
    desc.textures = textures.list;
    looks
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
