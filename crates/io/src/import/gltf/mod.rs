//! glTF 2.0 and GLB (Khronos glTF 2.0 specification, ISO/IEC 12113).
//!
//! The file is read as plain JSON with checks of our own: every complaint carries the JSON pointer of its cause, every
//! index and range is checked before use, and what a file may unpack to is bounded by the size of its buffers.
//! Skins, morph targets and animations are not applied yet.

mod accessor;
mod buffer;
mod camera;
mod container;
mod document;
mod element;
mod extension;
mod material;
mod mesh;
mod node;
mod texture;

use std::path::Path;

use durer_scene::{Limits, Location};
use serde_json::Value;

use self::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    mesh::Meshes,
    node::{NodeRef, Walk},
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
    let value: Value = serde_json::from_slice(chunks.json).map_err(|e| format!("not valid JSON: {e}"))?;
    let document = Document::new(Element::root(&value), file.to_owned(), limits);
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
    let buffers = Buffers::load(document, bin, &imported.assets)?;
    document.set_budget(buffers.total());
    let desc = &mut imported.desc;
    desc.materials = materials(document, &buffers, &mut imported.assets, &mut desc.textures)?;
    let roots = roots(document)?;
    let mut walk = Walk { document, buffers: &buffers, meshes: Meshes::new(document, &buffers), desc };
    let walked = walk.run(roots);
    let meshes = std::mem::take(&mut walk.meshes.list);
    desc.meshes = meshes;
    let animations = document.root.list("animations")?;
    if let Some(first) = animations.first() {
        document.note(first, format!("animations are not played yet: {}", animations.len()));
    }
    walked
}

fn materials<'a>(
    document: &Document<'a>,
    buffers: &Buffers<'a>,
    assets: &mut FileAssets,
    list: &mut Vec<durer_scene::TextureDesc>,
) -> Checked<Vec<durer_scene::NamedNode>> {
    let mut textures = Textures::new(document, buffers, assets);
    let materials = material::materials(document, &mut textures);
    *list = textures.list;
    materials
}

fn check_version(document: &Document<'_>) -> Checked<()> {
    let asset = document.root.required("asset")?;
    let version = asset.required("version")?;
    let text = version.text()?;
    let numbers = text.split_once('.').map(|(a, b)| (a.parse::<u32>(), b.parse::<u32>()));
    match numbers {
        Some((Ok(2), Ok(_))) => {}
        Some((Ok(_), Ok(_))) => {
            let mut fault = version.fault(format!("durer reads glTF 2, but this file is glTF {text}"));
            fault.hint = Some("export the scene as glTF 2.0".to_owned());
            return Err(fault);
        }
        _ => return Err(version.fault(format!("expected a version such as \"2.0\", found \"{text}\""))),
    }
    match asset.get("minVersion")? {
        Some(least) if least.text()? != "2.0" => {
            Err(least.fault(format!("the file needs glTF {}, durer reads 2.0", least.text()?)))
        }
        _ => Ok(()),
    }
}

/// The indices of the nodes at the top: those of the scene the file opens with, else of the first scene, else all
/// nodes that are no other's child.
fn roots<'a>(document: &Document<'a>) -> Checked<Vec<NodeRef<'a>>> {
    let scene = match document.member(&document.root, "scene", "scenes")? {
        Some(scene) => Some(scene),
        None => document.root.list_item("scenes", 0)?,
    };
    match scene {
        Some(scene) => scene.list("nodes")?.into_iter().map(NodeRef::parse).collect(),
        None => {
            document.warn(&document.root, "the file holds no scene; all of its nodes are drawn");
            orphans(document)
        }
    }
}

fn orphans<'a>(document: &Document<'a>) -> Checked<Vec<NodeRef<'a>>> {
    let nodes = document.root.list("nodes")?;
    let mut orphan = vec![true; nodes.len()];
    for node in &nodes {
        for child in node.list("children")? {
            if let Some(orphan) = orphan.get_mut(child.index()?) {
                *orphan = false;
            }
        }
    }
    let free = nodes.into_iter().enumerate().zip(orphan).filter(|(_, orphan)| *orphan);
    Ok(free.map(|((index, at), _)| NodeRef { index, at }).collect())
}
