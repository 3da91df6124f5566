//! What a channel of an animation changes: places of nodes, weights of morph targets, or, by a JSON pointer
//! (KHR_animation_pointer), any number of the document that durer reads.
use durer_scene::nearest_word;

use super::curve::Meaning;
use crate::import::gltf::{
    document::Document,
    element::{Checked, Element},
};

/// Whose weights of morph targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::import::gltf) enum Bearer {
    /// Those of a node, by index.
    Node(usize),
    /// Those of a mesh, by index, for nodes that have none of their own.
    Mesh(usize),
}

/// What a channel changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::import::gltf) enum Target {
    /// Of the node of this index.
    Translation(usize),
    /// Of the node of this index.
    Rotation(usize),
    /// Of the node of this index.
    Scale(usize),
    /// All weights, or the one of this index.
    Weights(Bearer, Option<usize>),
    /// Numbers of the document, by the names on the way to them.
    Numbers(Vec<String>),
    /// A truth value of the document.
    Truth(Vec<String>),
}

/// Numbers that pointers may lead to, by the last name on the way, and how many there are.
const NUMBERS: &[(&str, usize)] = &[
    ("alphaCutoff", 1),
    ("anisotropyRotation", 1),
    ("anisotropyStrength", 1),
    ("attenuationColor", 3),
    ("attenuationDistance", 1),
    ("baseColorFactor", 4),
    ("clearcoatFactor", 1),
    ("clearcoatRoughnessFactor", 1),
    ("color", 3),
    ("diffuseTransmissionColorFactor", 3),
    ("diffuseTransmissionFactor", 1),
    ("dispersion", 1),
    ("emissiveFactor", 3),
    ("emissiveStrength", 1),
    ("innerConeAngle", 1),
    ("intensity", 1),
    ("ior", 1),
    ("iridescenceFactor", 1),
    ("iridescenceIor", 1),
    ("iridescenceThicknessMaximum", 1),
    ("iridescenceThicknessMinimum", 1),
    ("metallicFactor", 1),
    ("offset", 2),
    ("outerConeAngle", 1),
    ("roughnessFactor", 1),
    ("sheenColorFactor", 3),
    ("sheenRoughnessFactor", 1),
    ("specularColorFactor", 3),
    ("specularFactor", 1),
    ("thicknessFactor", 1),
    ("transmissionFactor", 1),
    ("xmag", 1),
    ("yfov", 1),
    ("ymag", 1),
];

/// The same, of numbers that change no picture: planes that cut, aspects, shadows that are baked, ranges of lights.
const IDLE: &[&str] = &["aspectRatio", "range", "strength", "zfar", "znear"];

impl Target {
    /// The target of `channel`; `None` if it changes nothing that is seen.
    pub(super) fn read<'a>(document: &Document<'a>, channel: &Element<'a>) -> Checked<Option<Self>> {
        let target = channel.required("target")?;
        let path = target.required("path")?;
        if path.text()? == "pointer" {
            let extension = target.extension("KHR_animation_pointer")?;
            let missing = || target.fault("the path \"pointer\" needs the extension KHR_animation_pointer");
            let pointer = extension.ok_or_else(missing)?.required("pointer")?;
            return Self::pointed(document, &pointer);
        }
        let Some(reference) = target.get("node")? else {
            return Ok(None);
        };
        let node = document.item("nodes", &reference)?;
        let index = reference.index()?;
        let target = match path.text()? {
            "translation" => Self::Translation(index),
            "rotation" => Self::Rotation(index),
            "scale" => Self::Scale(index),
            "weights" => Self::Weights(Bearer::Node(index), None),
            other => {
                let words = "translation, rotation, scale, weights or pointer";
                return Err(path.fault(format!("expected {words}, found \"{other}\"")));
            }
        };
        target.check(&node, &path)?;
        Ok(Some(target))
    }

    /// What a JSON pointer leads to.
    fn pointed<'a>(document: &Document<'a>, pointer: &Element<'a>) -> Checked<Option<Self>> {
        let text = pointer.text()?;
        let names: Vec<String> =
            text.split('/').skip(1).map(|name| name.replace("~1", "/").replace("~0", "~")).collect();
        let nowhere = || pointer.fault(format!("\"{text}\" leads to nothing in this file"));
        if !text.starts_with('/') {
            return Err(nowhere());
        }
        // All but the last must be there: a number that is not written has its default.
        let mut at = document.root.clone();
        let (last, way) = names.split_last().ok_or_else(nowhere)?;
        for name in way {
            at = at.step(name).ok_or_else(nowhere)?;
        }
        let words: Vec<&str> = names.iter().map(String::as_str).collect();
        let index = |text: &str| text.parse::<usize>().map_err(|_| nowhere());
        let target = match words.as_slice() {
            ["nodes", node, "translation"] => Self::Translation(index(node)?),
            ["nodes", node, "rotation"] => Self::Rotation(index(node)?),
            ["nodes", node, "scale"] => Self::Scale(index(node)?),
            ["nodes", node, "weights"] => Self::Weights(Bearer::Node(index(node)?), None),
            ["meshes", mesh, "weights"] => Self::Weights(Bearer::Mesh(index(mesh)?), None),
            ["nodes", node, "weights", weight] => {
                Self::Weights(Bearer::Node(index(node)?), Some(index(weight)?))
            }
            ["meshes", mesh, "weights", weight] => {
                Self::Weights(Bearer::Mesh(index(mesh)?), Some(index(weight)?))
            }
            ["nodes", _, "extensions", "KHR_node_visibility", "visible"] => {
                return Ok(Some(Self::Truth(names)));
            }
            _ if IDLE.contains(&last.as_str()) => return Ok(None),
            _ => return Self::number(document, pointer, names),
        };
        if let ["nodes", node, ..] = words.as_slice() {
            let node = document.root.list_item("nodes", index(node)?)?.ok_or_else(nowhere)?;
            target.check(&node, pointer)?;
        }
        Ok(Some(target))
    }

    fn number<'a>(
        document: &Document<'a>,
        pointer: &Element<'a>,
        names: Vec<String>,
    ) -> Checked<Option<Self>> {
        let last = names.last().map(String::as_str).unwrap_or_default();
        // `rotation` and `scale` are those of texture transforms, or the strength of a normal map.
        let known = NUMBERS.iter().map(|(name, _)| *name).chain(["rotation", "scale"]);
        if known.clone().any(|name| name == last) {
            return Ok(Some(Self::Numbers(names)));
        }
        let near = nearest_word(last, known);
        let near = near.map(|near| format!("; did they mean \"{near}\"?")).unwrap_or_default();
        document.warn(pointer, format!("durer does not animate \"{last}\": it stays as it is{near}"));
        Ok(None)
    }

    /// Whether the node has what is to change.
    fn check<'a>(&self, node: &Element<'a>, at: &Element<'a>) -> Checked<()> {
        let places = !matches!(self, Self::Weights(..));
        if places && node.get("matrix")?.is_some() {
            let message = format!(
                "{} has a matrix: only translation, rotation and scale can be animated",
                node.pointer()
            );
            return Err(at.fault(message));
        }
        if !places && node.get("mesh")?.is_none() {
            return Err(at.fault(format!("{} has no mesh whose weights could change", node.pointer())));
        }
        Ok(())
    }

    /// What the numbers of its keys are.
    pub(super) fn meaning(&self) -> Meaning {
        match self {
            Self::Rotation(_) => Meaning::Rotation,
            Self::Translation(_) | Self::Scale(_) => Meaning::Numbers(3),
            Self::Weights(_, None) => Meaning::Weights,
            Self::Weights(_, Some(_)) | Self::Truth(_) => Meaning::Numbers(1),
            Self::Numbers(names) => Meaning::Numbers(match names.as_slice() {
                // Of a texture transform, not of a normal map.
                [.., holder, last] if holder == "KHR_texture_transform" && last == "scale" => 2,
                [.., last] => NUMBERS.iter().find(|(name, _)| name == last).map_or(1, |(_, lanes)| *lanes),
                [] => 1,
            }),
        }
    }
}
