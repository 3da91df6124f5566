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
    /// Weights of the morph targets, by moment, of which there is one if they do not change; those that are missing are 0.
    pub(super) weights: Vec<Vec<f32>>,
    /// Index of the skin.
    pub(super) skin: Option<usize>,
}

/// One mesh to be made.
pub(super) struct Wish<'a> {
    /// What tells it from others.
    key: Key,
    /// The primitive.
    pub(super) primitive: Element<'a>,
    /// How indices become triangles.
    pub(super) mode: Mode,
    /// The texture coordinates to read.
    pub(super) sets: [usize; 2],
    /// Morph targets and their weights by moment, not all of which are 0.
    pub(super) targets: Vec<(Element<'a>, Vec<f32>)>,
    /// Index of the skin that bends it.
    pub(super) skin: Option<usize>,
}

/// Accessors, weights and skin as numbers.
type Key = Vec<usize>;

/// Meshes that were made before and are the same whenever they are looked at.
pub(super) type Known = HashMap<Key, Option<Arc<Mesh>>>;

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
    numbers: HashMap<Key, usize>,
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
        for (index, target) in primitive.list("targets")?.into_iter().enumerate() {
            let of = |weights: &Vec<f32>| weights.get(index).copied().unwrap_or(0.0);
            let weights: Vec<f32> = pose.weights.iter().map(of).collect();
            if weights.iter().any(|w| *w != 0.0) {
                accessors(&target, sets, &mut key)?;
                key.extend(weights.iter().map(|w| w.to_bits() as usize));
                targets.push((target, weights));
            }
        }
        let next = self.wishes.len();
        let number = *self.numbers.entry(key.clone()).or_insert(next);
        if number == next {
            self.wishes.push(Wish { key, primitive: primitive.clone(), mode, sets, targets, skin });
        }
        Ok(Some(Asked { number, skin }))
    }

    /// Makes all meshes, by number; `None` where there is nothing to draw, or something was wrong with it. Those that no skin
    /// bends are taken from `known`, which is left with those that were of use.
    pub(super) fn build(
        self,
        (document, buffers): (&Document<'a>, &Buffers),
        (skins, times): (&HashMap<usize, Skin>, &[f32]),
        known: &mut Known,
    ) -> Vec<Option<Arc<Mesh>>> {
        let before = std::mem::take(known);
        let jobs: Vec<_> = self.wishes.into_iter().map(|wish| (document.apart(), wish)).collect();
        let made: Vec<_> = jobs
            .into_par_iter()
            .map(|(own, wish)| {
                if let Some(mesh) = before.get(&wish.key) {
                    return (mesh.clone(), own, wish);
                }
                if own.is_exhausted() {
                    return (None, own, wish);
                }
                let mesh = own.keep(primitive::build(&own, buffers, &wish, (skins, times))).flatten();
                (mesh.map(Arc::new), own, wish)
            })
            .collect();
        let mut all = Vec::with_capacity(made.len());
        for (mesh, own, wish) in made {
            document.absorb(own);
            // Weights stand in the key, joints do not; nor do the moments of a shape that changes.
            if wish.skin.is_none() && mesh.as_ref().is_none_or(|mesh| mesh.is_still()) {
                known.insert(wish.key, mesh.clone());
            }
            all.push(mesh);
        }
        all
    }
}
