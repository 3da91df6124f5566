//! What floats: the volumes of a description, and which of them are on the two sides of surfaces.
use durer_core::glam::DAffine3;
use durer_model::{Fill, Hull, Medium, Volume, material::Material, medium::MEDIA};
use durer_scene::{CameraDesc, Data, MediumRef, ShapeDesc};

use super::nodes::Builder;
use crate::MediumStack;

/// What the file says of the place where the camera is.
pub(super) fn around(camera: &CameraDesc) -> Option<Fill> {
    camera.media.map(|sides| fill(sides.outside))
}

fn fill(medium: Option<MediumRef>) -> Fill {
    medium.map_or(Fill::Nothing, |medium| Fill::Volume(medium.index() as u32))
}

/// What is behind the surface of a shape, and before it: what its material says, which has `inside` inside, and what the
/// shape says itself. Below surfaces that light walks in there is nothing but what it walks in.
pub(super) fn medium(
    shape: &ShapeDesc,
    (number, material): (u32, &dyn Material),
    inside: Option<&Option<Fill>>,
) -> Option<Medium> {
    let walked = material.is_walked().then_some(Fill::Below(number));
    let hull = if material.is_nothing() { Hull::Open } else { Hull::Sheet };
    let inside = walked.or(inside.copied().flatten());
    let own = match (material.medium(), inside) {
        (Some(own), inside) => Some(Medium { inside, ..own }),
        (None, Some(_)) => Some(Medium { inside, ..Medium::sides(hull) }),
        (None, None) => None,
    };
    let Some(sides) = shape.media else { return own };
    let own = own.unwrap_or_else(|| Medium::sides(hull));
    let inside = walked.unwrap_or_else(|| fill(sides.inside));
    Some(Medium { inside: Some(inside), outside: Some(fill(sides.outside)), ..own })
}

impl Builder<'_> {
    /// The volumes that could be built, in their places.
    pub(super) fn volumes(&mut self, render_from_world: &DAffine3) -> Vec<Volume> {
        let mut all = Vec::new();
        for medium in &self.desc.media {
            if all.len() == MediumStack::MOST_VOLUMES {
                let most = MediumStack::MOST_VOLUMES;
                self.diagnostics.error(medium.node.at.clone(), format!("more than {most} media"));
                break;
            }
            // Others go by the number.
            let mut volume = self.build(MEDIA, "medium", &medium.node, &[]).unwrap_or_else(Volume::nothing);
            if !volume.place(&(*render_from_world * medium.world_from_medium)) {
                self.diagnostics.error(medium.node.at.clone(), "the medium's transform cannot be inverted");
            }
            all.push(volume);
        }
        all
    }

    /// What the materials say that floats inside, by the names of media.
    pub(super) fn insides(&mut self) -> Vec<Option<Fill>> {
        let desc = self.desc;
        let named = |node: &durer_scene::Node| -> Option<(String, durer_scene::Location)> {
            let param = node.params.get(Medium::INSIDE.name)?;
            match &param.data {
                Data::Strings(words) => Some((words.first()?.clone(), param.at.clone())),
                _ => None,
            }
        };
        let mut insides = Vec::new();
        for material in &desc.materials {
            let fill = named(&material.node).and_then(|(word, at)| {
                let place = desc.media.iter().position(|medium| medium.name == word);
                if place.is_none() {
                    let names = desc.media.iter().map(|medium| medium.name.as_str());
                    self.diagnostics.unknown(at, "medium", &word, names);
                }
                place
            });
            insides.push(fill.map(|place| Fill::Volume(place as u32)));
        }
        insides
    }
}
