//! Which meshes the nodes ask for, and all of them decoded at the same time. Primitives with the same accessors in the
//! same pose share one mesh, whatever their materials.
use std::{collections::HashMap, sync::Arc};

use durer_scene::Mesh;
use rayon::prelude::*;

use super::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    primitive::{self, Mode},
    skin::Skin,
};

/// What a node adds to its mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Pose {
    /// Weights of the morph targets; those that are missing are 0.
    pub(super) weights: Vec<f32>,
    /// Index of the skin.
    pub(super) skin: Option<usize>,
}

/// One mesh to be made.
pub(super) struct Wish<'a> {
    /// The primitive.
    pub(super) primitive: Element<'a>,
    /// How indices become triangles.
    pub(super) mode: Mode,
    /// The texture coordinates to read.
    pub(super) sets: [usize; 2],
    /// Morph targets and their weights, none of which is 0.
    pub(super) targets: Vec<(Element<'a>, f32)>,
    /// Index of the skin that bends it.
    pub(super) skin: Option<usize>,
}

/// A mesh asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    /// Which, in the order of [`Meshes::build`].
    pub(super) number: usize,
    /// The skin that places it, instead of its node.
    pub(super) skin: Option<usize>,
}

/// Meshes asked for so far.
#[derive(Default)]
pub(super) struct Meshes<'a> {
    numbers: HashMap<Vec<usize>, usize>,
    wishes: Vec<Wish<'a>>,
}

/// Attributes of which there is one, in the order of the key.
const SINGLE: [&str; 4] = ["POSITION", "NORMAL", "TANGENT", "COLOR_0"];

/// The accessors of an attribute set, as numbers that tell meshes apart: 0 for one that is missing.
fn accessors<'a>(attributes: &Element<'a>, sets: [usize; 2], key: &mut Vec<usize>) -> Checked<()> {
    let coordinates = sets.map(|set| format!("TEXCOORD_{set}"));
    for name in SINGLE.into_iter().chain(coordinates.iter().map(String::as_str)) {
        key.push(match attributes.get(name)? {
            Some(reference) => reference.index()?.saturating_add(1),
            None => 0,
        });
    }
    Ok(())
}

impl<'a> Meshes<'a> {
    /// Asks for the mesh of a primitive; `None` if there is nothing to draw.
    pub(super) fn ask(
        &mut self,
        document: &Document<'a>,
        primitive: &Element<'a>,
        sets: [usize; 2],
        pose: &Pose,
    ) -> Checked<Option<Asked>> {
        let Some(mode) = primitive::mode(document, primitive)? else {
            return Ok(None);
        };
        let attributes = primitive.required("attributes")?;
        let mut key = vec![mode as usize];
        accessors(&attributes, sets, &mut key)?;
        key.push(match primitive.get("indices")? {
            Some(reference) => reference.index()?.saturating_add(1),
            None => 0,
        });
        let mut skin = pose.skin;
        match (skin, attributes.get("JOINTS_0")?) {
            (Some(skin), Some(reference)) => key.extend([skin, reference.index()?]),
            (Some(_), None) => {
                document.warn(primitive, "a mesh with a skin, but without JOINTS_0, is not bent by it");
                skin = None;
            }
            (None, _) => {}
        }
        let mut targets = Vec::new();
        for (target, &weight) in primitive.list("targets")?.into_iter().zip(&pose.weights) {
            if weight != 0.0 {
                accessors(&target, sets, &mut key)?;
                key.push(weight.to_bits() as usize);
                targets.push((target, weight));
            }
        }
        let next = self.wishes.len();
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.wishes.push(Wish { primitive: primitive.clone(), mode, sets, targets, skin });
        }
        Ok(Some(Asked { number, skin }))
    }

    /// Makes all meshes, by number; `None` where there is nothing to draw, or something was wrong with it.
    pub(super) fn build(
        self,
        document: &Document<'a>,
        buffers: &Buffers<'a>,
        skins: &HashMap<usize, Skin>,
    ) -> Vec<Option<Arc<Mesh>>> {
        let jobs: Vec<_> = self.wishes.into_iter().map(|wish| (document.apart(), wish)).collect();
        let made: Vec<_> = jobs
            .into_par_iter()
            .map(|(own, wish)| {
                if own.is_exhausted() {
                    return (None, own);
                }
                let mesh = own.keep(primitive::build(&own, buffers, &wish, skins)).flatten();
                (mesh.map(Arc::new), own)
            })
            .collect();
        let keep = |(mesh, own)| {
            document.absorb(own);
            mesh
        };
        made.into_iter().map(keep).collect()
    }
}
