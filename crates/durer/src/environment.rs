//! A picture of the surroundings in place of those of the scene.
//!
//! It stands as in three.js, Blender and their kin: the top of the picture is +y, its middle +x, and somebody who looks
//! there sees +z at the right. In a left-handed world (pbrt's, unless it is mirrored) he sees -z there, so that no picture
//! appears mirrored.
use std::{borrow::Cow, path::Path};

use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Motion,
};
use durer_io::FileAssets;
use durer_model::light::SURROUNDINGS;
use durer_scene::{
    AssetError, Assets, Data, Diagnostics, LightDesc, Location, Node, Param, Params, SceneDesc, ValueType,
};

use crate::Options;

/// The description with the surroundings that the options ask for; `None` after a complaint.
pub(crate) fn within<'a>(
    desc: &'a SceneDesc,
    options: &Options,
    assets: &mut FileAssets,
    diagnostics: &mut Diagnostics,
) -> Option<Cow<'a, SceneDesc>> {
    match &options.environment {
        Some(file) => surround(desc, file, assets, diagnostics).map(Cow::Owned),
        None => Some(Cow::Borrowed(desc)),
    }
}

/// `desc` with the picture of `file` around it; its bytes become part of `assets`. `None` if it cannot be read, which was
/// then complained about.
pub(crate) fn surround(
    desc: &SceneDesc,
    file: &Path,
    assets: &mut FileAssets,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    // Messages are about what the user typed, not about the scene. No scene has a file of such a name.
    let name = format!("--env {}", file.display());
    let at = Location::Path { file: name.clone(), pointer: String::new() };
    match bytes(file, assets) {
        Ok(bytes) => assets.insert(&name, bytes),
        Err(reason) => {
            diagnostics
                .error(at, format!("{name}: {reason}"))
                .hint("expected an EXR, HDR, PFM, PNG, JPEG, BMP or TGA picture of the surroundings");
            return None;
        }
    }
    let mut params = Params::new();
    let data = Data::Strings(vec![name.clone()]);
    params.push(Param { name: "filename".to_owned(), ty: ValueType::String, data, at: at.clone() });
    let mut lit = desc.clone();
    lit.lights.retain(|light| !SURROUNDINGS.contains(&light.node.kind.as_str()));
    lit.lights.push(LightDesc {
        name: "environment".to_owned(),
        node: Node { at, ..Node::new("infinite", params) },
        world_from_light: Motion::still(world_from_picture(desc)),
    });
    Some(lit)
}

/// The picture's file, wherever it is: it was named by the user and not by a scene.
fn bytes(file: &Path, assets: &FileAssets) -> Result<std::sync::Arc<[u8]>, String> {
    let found = file.canonicalize().map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => "file not found".to_owned(),
        _ => e.to_string(),
    })?;
    if found.is_dir() {
        return Err("is a folder; name a picture in it".to_owned());
    }
    let (Some(folder), Some(name)) = (found.parent(), found.file_name()) else {
        return Err("not a file".to_owned());
    };
    let name = name.to_str().ok_or("its name is not text (UTF-8)")?;
    FileAssets::new(folder.to_owned(), assets.limits()).bytes(name).map_err(|error| match error {
        AssetError::Missing { .. } => "file not found".to_owned(),
        AssetError::Outside { .. } => "leads out of its folder".to_owned(),
        AssetError::Io { reason, .. }
        | AssetError::Format { reason, .. }
        | AssetError::Unsupported { reason, .. }
        | AssetError::Limits { reason, .. } => reason,
    })
}

/// The placement of the picture's own space (z up, the left edge at +x, turning by +y).
fn world_from_picture(desc: &SceneDesc) -> DAffine3 {
    // Camera space is left-handed: a camera placed without mirroring stands in a left-handed world.
    let camera = desc.cameras.first().map(|c| c.world_from_camera.at(0.0).matrix3.determinant());
    let right = if camera.is_some_and(|d| d > 0.0) { -DVec3::Z } else { DVec3::Z };
    DAffine3::from_mat3(DMat3::from_cols(-DVec3::X, -right, DVec3::Y))
}
