//! Which extensions are read, which only change the looks of what we draw without them, and which we must refuse.
use durer_scene::nearest_word;

use super::{
    document::Document,
    element::{Checked, Element},
};

/// Read completely, or as far as a picture shows.
const READ: &[&str] = &[
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
];

/// Known to change no picture: data about the scene.
const HARMLESS: &[&str] = &["KHR_xmp", "KHR_xmp_json_ld"];

/// Not read: materials look simpler. A scene that only uses one is drawn without it.
const LOOKS_ONLY: &[&str] = &["KHR_materials_pbrSpecularGlossiness"];

/// Not read, and data is missing without them; with a way out.
const REFUSED: &[(&str, &str)] =
    &[("EXT_texture_avif", "convert the textures: `gltf-transform png in.glb out.glb`")];

fn known() -> impl Iterator<Item = &'static str> {
    READ.iter().chain(HARMLESS).chain(LOOKS_ONLY).copied().chain(REFUSED.iter().map(|(name, _)| *name))
}

/// Refuses documents that require what we do not read; lists optional extensions that are ignored, as a warning where
/// the picture lacks something.
pub(super) fn check(document: &Document<'_>) -> Checked<()> {
    let required = document.root.list("extensionsRequired")?;
    for element in &required {
        document.keep(require(element));
    }
    let mut ignored = Vec::new();
    for element in document.root.list("extensionsUsed")? {
        let name = element.text()?;
        let needed = required.iter().any(|r| r.text() == Ok(name));
        if !needed && !READ.contains(&name) && !ignored.contains(&name) {
            ignored.push(name);
        }
    }
    let Some(list) = document.root.get("extensionsUsed")? else { return Ok(()) };
    let (looks, others): (Vec<&str>, Vec<&str>) =
        ignored.into_iter().partition(|name| LOOKS_ONLY.contains(name));
    if !looks.is_empty() {
        let message =
            format!("materials look simpler without what durer does not read: {}", looks.join(", "));
        document.warn(&list, message);
    }
    if !others.is_empty() {
        document.note(&list, format!("optional extensions that durer ignores: {}", others.join(", ")));
    }
    Ok(())
}

fn require(element: &Element<'_>) -> Checked<()> {
    let name = element.text()?;
    if READ.contains(&name) || HARMLESS.contains(&name) {
        return Ok(());
    }
    let mut fault =
        element.fault(format!("the file requires the extension {name}, which durer does not read"));
    fault.hint = Some(match REFUSED.iter().find(|(refused, _)| *refused == name) {
        Some((_, way_out)) => (*way_out).to_owned(),
        None if LOOKS_ONLY.contains(&name) => {
            "to see the scene without it, move it from extensionsRequired to extensionsUsed".to_owned()
        }
        None => match nearest_word(name, known()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("export the scene without it; durer reads {}", READ.join(", ")),
        },
    });
    Err(fault)
}
