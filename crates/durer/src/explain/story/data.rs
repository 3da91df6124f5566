//! What ray casting shows of the nearest hit.
use crate::{Prepared, Show};

use super::super::{
    Sample,
    explanation::Paragraph,
    words::{degrees_of, number},
};

/// A sentence on what the numbers of a data picture mean here.
pub(super) fn shown(prepared: &Prepared, show: Show, sample: &Sample) -> Paragraph {
    let [a, b, c] = sample.rgb.map(number);
    let eye = sample.tree.nodes.first();
    let hit = eye.and_then(|n| n.hit.as_ref());
    let mut sentences = Vec::new();
    if let Some(hit) = hit {
        let object = prepared.scene.object(hit.object);
        let side = if hit.from_outside { "outside" } else { "inside" };
        sentences.push(format!(
            "The eye ray meets the {side} of \"{}\" (material \"{}\") after {} m, {} degrees off its normal.",
            object.name,
            prepared.material_name(object.material),
            number(f64::from(hit.hit.t)),
            degrees_of(f64::from(hit.cos))
        ));
    } else {
        sentences.push("The eye ray leaves the scene without meeting anything.".to_owned());
    }
    sentences.push(match show {
        Show::Cost => format!(
            "The picture shows what finding that took: {a} tests of primitives and {b} nodes of the hierarchy."
        ),
        _ if !sample.has_value => {
            format!("The picture shows {} where something is hit: here it has no value.", show.word())
        }
        Show::Depth => format!(
            "The picture shows depth: {a} m along the camera's axis, beside it {b} m along the ray."
        ),
        Show::Normal => format!(
            "The picture shows the shading normal in world space, turned towards the eye: x {a}, y {b}, z {c}."
        ),
        Show::Uv => format!("The picture shows surface coordinates: u = {a}, v = {b}."),
        Show::Id => format!("The picture shows the number of the object: {a}, counted from 1."),
        Show::Albedo | Show::Shading => String::new(),
    });
    sentences.retain(|s| !s.is_empty());
    Paragraph { about: "ray", node: Some(0), is_detail: false, sentences }
}
