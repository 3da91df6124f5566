//! Textures with the sizes of their images, and what these take.
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use durer::{
    FileAssets,
    scene::{Assets, Data, Image, ImageData, Node, SceneDesc},
};
use serde::Serialize;

/// A texture. What concerns its image is `None` if it has none, or it could not be read.
#[derive(Serialize)]
pub(super) struct TextureFacts<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    pub(super) image: Option<&'a str>,
    pub(super) width: Option<u32>,
    pub(super) height: Option<u32>,
    pub(super) channels: Option<u32>,
    /// Per channel, as decoded.
    pub(super) bits: Option<u32>,
}

/// All textures of a description; without sizes where nothing was compiled, as then no image was decoded.
pub(super) fn of<'a>(desc: &'a SceneDesc, assets: Option<&FileAssets>) -> Vec<TextureFacts<'a>> {
    let mut known = BTreeMap::new();
    let facts = |texture: &'a durer::scene::TextureDesc| {
        let name = text(&texture.node, "filename");
        let image = name.zip(assets).and_then(|(name, assets)| {
            // Many textures may share an image.
            *known.entry(name).or_insert_with(|| assets.image(name).ok().map(|image| size(&image)))
        });
        TextureFacts {
            name: &texture.name,
            kind: &texture.node.kind,
            image: name,
            width: image.map(|i| i[0]),
            height: image.map(|i| i[1]),
            channels: image.map(|i| i[2]),
            bits: image.map(|i| i[3]),
        }
    };
    desc.textures.iter().map(facts).collect()
}

/// Bytes of the decoded images that textures and lights name.
pub(super) fn image_bytes(desc: &SceneDesc, assets: &FileAssets) -> u64 {
    let nodes = desc.textures.iter().map(|t| &t.node).chain(desc.lights.iter().map(|l| &l.node));
    let names: BTreeSet<&str> = nodes.filter_map(|node| text(node, "filename")).collect();
    let images = names.into_iter().filter_map(|name| assets.image(name).ok());
    images.map(|image: Arc<Image>| bytes(&image)).sum()
}

fn text<'a>(node: &'a Node, param: &str) -> Option<&'a str> {
    match &node.params.get(param)?.data {
        Data::Strings(texts) => texts.first().map(String::as_str),
        _ => None,
    }
}

/// Width, height, channels, bits per channel.
fn size(image: &Image) -> [u32; 4] {
    let bits = match image.data {
        ImageData::U8(_) => 8,
        ImageData::U16(_) => 16,
        ImageData::F32(_) => 32,
    };
    [image.width, image.height, image.channels, bits]
}

fn bytes(image: &Image) -> u64 {
    let length = match &image.data {
        ImageData::U8(v) => size_of_val(v.as_slice()),
        ImageData::U16(v) => size_of_val(v.as_slice()),
        ImageData::F32(v) => size_of_val(v.as_slice()),
    };
    length as u64
}
