//! KHR_materials_variants: sets of materials that a scene can wear. The chosen one is written into the document before it is
//! read.
use durer_scene::nearest_word;
use serde_json::Value;

use super::{
    document::Document,
    element::{Checked, Element, Fault},
};

const NAME: &str = "KHR_materials_variants";

/// The names of the variants, by index.
pub(super) fn names(document: &Document<'_>) -> Checked<Vec<String>> {
    let Some(extension) = document.root.extension(NAME)? else { return Ok(Vec::new()) };
    Ok(extension.list("variants")?.iter().map(|variant| variant.name().to_owned()).collect())
}

/// The index of the variant of a name, or of one that is an index itself.
pub(super) fn chosen(document: &Document<'_>, names: &[String], wanted: &str) -> Checked<usize> {
    let by_name = names.iter().position(|name| name == wanted);
    let by_index = || wanted.parse::<usize>().ok().filter(|index| *index < names.len());
    if let Some(index) = by_name.or_else(by_index) {
        return Ok(index);
    }
    let near = nearest_word(wanted, names.iter().map(String::as_str));
    let hint = match near {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("there are: {}", names.join(", ")),
    };
    let at: &Element<'_> = &document.root;
    Err(Fault { hint: Some(hint), ..at.fault(format!("no material variant \"{wanted}\"")) })
}

/// Gives each primitive the material that it has in the variant. References were checked.
pub(super) fn wear(document: &mut Value, variant: usize) {
    let meshes = document.get_mut("meshes").and_then(Value::as_array_mut).into_iter().flatten();
    let primitives =
        meshes.filter_map(|mesh| mesh.get_mut("primitives").and_then(Value::as_array_mut)).flatten();
    for primitive in primitives {
        let mappings = primitive.get("extensions").and_then(|all| all.get(NAME)?.get("mappings")?.as_array());
        let is_worn = |mapping: &&Value| {
            let variants = mapping.get("variants").and_then(Value::as_array);
            variants.is_some_and(|list| list.iter().any(|v| v.as_f64() == Some(variant as f64)))
        };
        let material = mappings.and_then(|list| list.iter().find(is_worn)?.get("material").cloned());
        if let (Some(material), Some(members)) = (material, primitive.as_object_mut()) {
            members.insert("material".to_owned(), material);
        }
    }
}
