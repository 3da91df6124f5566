//! Images of MTL materials.
//!
//! Paths are relative to the MTL file. Of one that leads nowhere or out of the scene's folder, the last name is tried
//! beside the MTL file and beside the OBJ file. An image that is not there or cannot be read is a warning: the model can
//! be seen without it.
use std::collections::{BTreeMap, HashMap};

use durer_core::glam::DAffine3;
use durer_scene::{AssetError, Assets, Image, ImageData, Node, Params, TextureDesc, TextureValue};
use rayon::prelude::*;

use super::{
    library::last_name,
    mtl::{Map, Material},
};
use crate::{
    FileAssets,
    import::{Imported, text::Complaint},
};

/// Images that cannot be had, of which each is told.
const MOST_FAILED: usize = 16;

/// What a texture is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// A colour times a factor.
    Color([f32; 3]),
    /// A number times a factor.
    Scalar(f32),
    /// The same; of an image with an alpha channel that is meant.
    Opacity(f32),
    Normal,
    /// A normal map if it looks like one: many programs write `map_Bump` for both.
    Bump,
}

/// An image that was read.
#[derive(Clone, Debug)]
struct Known {
    path: String,
    alpha: bool,
    bluish: bool,
}

/// An image that could not be had.
struct Lost {
    error: AssetError,
    /// Where it was looked for.
    advice: Option<String>,
}

/// The images, and the textures made of them so far.
pub(super) struct Textures {
    images: HashMap<(String, String), Result<Known, Lost>>,
    names: HashMap<String, String>,
    heights: BTreeMap<String, ()>,
    /// In the order in which they were asked for.
    pub(super) list: Vec<TextureDesc>,
}

impl Textures {
    /// Reads all images of `materials`, given with their folders, at the same time.
    pub(super) fn load(materials: &[(Material, String)], imported: &Imported) -> Self {
        let assets = &imported.assets;
        let all = materials.iter().flat_map(|(m, folder)| m.maps.iter().map(move |(_, map)| (folder, map)));
        let mut keys: Vec<_> = all.map(|(folder, map)| (folder.clone(), map.file.clone())).collect();
        keys.sort_unstable();
        keys.dedup();
        let images = keys.into_par_iter().map(|(folder, file)| {
            let found = find(assets, &folder, &file).and_then(|path| {
                let image = assets.image(&path)?;
                Ok(Known { path, alpha: image.channels % 2 == 0, bluish: is_normal_map(&image) })
            });
            let found = found.map_err(|error| Lost { advice: assets.advice(&error), error });
            ((folder, file), found)
        });
        Self { images: images.collect(), names: HashMap::new(), heights: BTreeMap::new(), list: Vec::new() }
    }

    /// The name of the texture that `map` makes; `None` if its image could not be had.
    pub(super) fn texture(&mut self, map: &Map, folder: &str, role: Role) -> Option<String> {
        let key = (folder.to_owned(), map.file.clone());
        let known = self.images.get(&key)?.as_ref().ok()?;
        if role == Role::Bump && !known.bluish {
            self.heights.insert(map.file.clone(), ());
            return None;
        }
        let params = Params::new().string("filename", &known.path);
        let scalar = |params: Params, channel: &str, factor: f32| {
            let params =
                params.string("encoding", "linear").string("channel", map.channel.unwrap_or(channel));
            (TextureValue::Float, if factor == 1.0 { params } else { params.float("scale", factor) })
        };
        let (value, mut params) = match role {
            Role::Color(factor) => {
                let params = params.string("encoding", "sRGB");
                (TextureValue::Color, if factor == [1.0; 3] { params } else { params.rgb("factor", factor) })
            }
            Role::Normal | Role::Bump => (TextureValue::Color, params.string("encoding", "linear")),
            Role::Scalar(factor) => scalar(params, "luminance", factor),
            Role::Opacity(factor) => scalar(params, if known.alpha { "a" } else { "luminance" }, factor),
        };
        if map.clamp {
            params = params.string("wrap", "clamp");
        }
        for (names, [u, v], default) in
            [(["uscale", "vscale"], map.scale, 1.0), (["udelta", "vdelta"], map.offset, 0.0)]
        {
            for (name, value) in names.into_iter().zip([u, v]) {
                if value != default {
                    params = params.float(name, value);
                }
            }
        }
        let node = Node::new("imagemap", params);
        let name = format!("texture:{}", self.list.len());
        let known = self.names.entry(format!("{value:?} {:?}", node.params)).or_insert_with(|| {
            self.list.push(TextureDesc {
                name: name.clone(),
                value,
                node,
                world_from_texture: DAffine3::IDENTITY,
            });
            name
        });
        Some(known.clone())
    }

    /// What could not be read or used, once, with the number of the file that names it first.
    pub(super) fn complaints(mut self, materials: &[(Material, String)]) -> Vec<(usize, Complaint)> {
        let mut all = Vec::new();
        for (material, folder) in materials {
            for (_, map) in &material.maps {
                let key = (folder.clone(), map.file.clone());
                let (message, hint) = match self.images.remove(&key) {
                    Some(Err(Lost { error, advice })) => {
                        (format!("{error}; drawn without this image"), advice)
                    }
                    _ if self.heights.remove(&map.file).is_some() => {
                        let file = &map.file;
                        let message = format!(
                            "{file} holds heights; only normal maps are supported: the surface is drawn smooth"
                        );
                        (message, None)
                    }
                    _ => continue,
                };
                all.push((
                    material.library,
                    Complaint { hint, ..Complaint::error(map.at.clone(), message).warning() },
                ));
            }
        }
        let more = all.len().saturating_sub(MOST_FAILED);
        all.truncate(MOST_FAILED);
        if let (Some((library, last)), true) = (all.last().cloned(), more > 0) {
            let message = format!("{more} more images cannot be used; drawn without them");
            all.push((library, Complaint { hint: None, message, ..last }));
        }
        all
    }
}

/// Where the image is that a file in `folder` calls `file`; the first reason if it is nowhere.
fn find(assets: &FileAssets, folder: &str, file: &str) -> Result<String, AssetError> {
    let within = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    let tried = [within(file), within(last_name(file)), file.to_owned(), last_name(file).to_owned()];
    let mut why = None;
    for path in tried {
        match assets.resolve(&path) {
            Ok(_) => return Ok(path),
            Err(error) => {
                why.get_or_insert(error);
            }
        }
    }
    let tried = [within(file), within(last_name(file)), last_name(file).to_owned()];
    if let Some(path) = tried.iter().find_map(|path| assets.in_other_case(path)) {
        return Ok(path);
    }
    Err(why.unwrap_or_else(|| AssetError::Missing { path: file.to_owned() }))
}

/// True for an image whose mean is the blue of a normal that points straight out.
fn is_normal_map(image: &Image) -> bool {
    let channels = image.channels as usize;
    if channels < 3 {
        return false;
    }
    let pixels = image.width as usize * image.height as usize;
    let step = (pixels / 4096).max(1);
    let mut sum = [0.0_f64; 3];
    for pixel in (0..pixels).step_by(step) {
        for (channel, sum) in sum.iter_mut().enumerate() {
            *sum += value(&image.data, pixel * channels + channel);
        }
    }
    let [r, g, b] = sum.map(|s| s / pixels.div_ceil(step).max(1) as f64);
    (0.4..0.6).contains(&r) && (0.4..0.6).contains(&g) && b > 0.7
}

fn value(data: &ImageData, at: usize) -> f64 {
    match data {
        ImageData::U8(v) => f64::from(v.get(at).copied().unwrap_or_default()) / 255.0,
        ImageData::U16(v) => f64::from(v.get(at).copied().unwrap_or_default()) / 65535.0,
        ImageData::F32(v) => f64::from(v.get(at).copied().unwrap_or_default()),
    }
}
