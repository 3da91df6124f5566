//! A scene as binary glTF 2.0, as it is when the shutter opens: meshes with their placements, `principled` materials and what
//! comes near them, pictures, cameras, lights without extent. What glTF has no words for is named in warnings.
//!
//! glTF is right-handed and its cameras look along -z. A world whose camera is left-handed (pbrt's) is mirrored at x = 0, so
//! that what was on the right of the picture stays there.
pub(crate) mod bin;
mod camera;
mod light;
mod material;
mod principled;
mod shape;
mod texture;

use std::collections::BTreeSet;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::Motion,
};
use durer_scene::{SceneDesc, TextureValue};
use serde_json::{Value, json};

use crate::ToWrite;
use bin::Bin;

/// A file, and what of the scene is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Glb {
    /// The file.
    pub bytes: Vec<u8>,
    /// What is left out or approximated, each in a sentence.
    pub warnings: Vec<String>,
}

/// Most warnings that are listed.
const MOST_WARNINGS: usize = 40;

/// A scene on its way into a file.
struct Writer<'a> {
    whole: &'a ToWrite<'a>,
    desc: &'a SceneDesc,
    bin: Bin,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
    cameras: Vec<Value>,
    lights: Vec<Value>,
    /// Nodes of the world, mirrored or not.
    nodes: Vec<Value>,
    extensions: BTreeSet<String>,
    warnings: Vec<String>,
    /// From the world of the scene to that of the file.
    mirror: DAffine3,
    memo: Memo,
}

/// What was written already.
#[derive(Default)]
struct Memo {
    shapes: shape::Known,
    materials: material::Known,
    textures: texture::Known,
}

impl ToWrite<'_> {
    /// As binary glTF.
    ///
    /// # Errors
    /// Why there is no file.
    pub fn glb(&self) -> Result<Glb, String> {
        let desc = self.said().ok_or("there is no camera")?;
        let left_handed = desc
            .cameras
            .get(self.camera)
            .is_some_and(|c| c.world_from_camera.at(0.0).matrix3.determinant() > 0.0);
        let mirror = DVec3::new(if left_handed { -1.0 } else { 1.0 }, 1.0, 1.0);
        let mut writer = Writer {
            whole: self,
            desc: &desc,
            bin: Bin::default(),
            meshes: Vec::new(),
            materials: Vec::new(),
            images: Vec::new(),
            samplers: Vec::new(),
            textures: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            nodes: Vec::new(),
            extensions: BTreeSet::new(),
            warnings: Vec::new(),
            mirror: DAffine3::from_scale(mirror),
            memo: Memo::default(),
        };
        writer.shapes();
        writer.cameras();
        writer.lights();
        writer.finish()
    }
}

impl Writer<'_> {
    /// Says that something is not in the file, once.
    fn warn(&mut self, warning: impl Into<String>) {
        let warning = warning.into();
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// Where something stands in the file; says that motion is not in it.
    fn placed(&mut self, motion: &Motion, name: &str) -> DAffine3 {
        if !motion.is_still() {
            self.warn(format!("\"{name}\" moves: it stands where it is when the shutter opens"));
        }
        self.mirror * motion.at(self.whole.options.time.into())
    }

    /// Adds a node.
    fn node(&mut self, name: &str, place: &DAffine3, mut node: Value) {
        if *place != DAffine3::IDENTITY {
            let [x, y, z] = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis];
            let columns = [x.extend(0.0), y.extend(0.0), z.extend(0.0), place.translation.extend(1.0)];
            let numbers: Vec<f64> = columns.iter().flat_map(|c| c.to_array()).collect();
            node["matrix"] = json!(numbers);
        }
        if !name.is_empty() {
            node["name"] = name.into();
        }
        self.nodes.push(node);
    }

    /// The value of a texture that parameters refer to.
    fn texture_desc(&self, name: &str, value: TextureValue) -> Option<&durer_scene::TextureDesc> {
        self.desc.textures.iter().find(|t| t.name == name && t.value == value)
    }

    fn finish(mut self) -> Result<Glb, String> {
        let roots: Vec<usize> = (0..self.nodes.len()).collect();
        let mut document = json!({
            "asset": { "version": "2.0", "generator": concat!("durer ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": self.desc.name, "nodes": roots }],
        });
        if !self.lights.is_empty() {
            self.extensions.insert(light::PUNCTUAL.to_owned());
            document["extensions"] = json!({ light::PUNCTUAL: { "lights": self.lights } });
        }
        let lists = [
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("images", self.images),
            ("samplers", self.samplers),
            ("textures", self.textures),
            ("cameras", self.cameras),
            ("bufferViews", self.bin.views),
            ("accessors", self.bin.accessors),
        ];
        for (name, list) in lists {
            // glTF has no empty lists.
            if !list.is_empty() {
                document[name] = list.into();
            }
        }
        if !self.extensions.is_empty() {
            document["extensionsUsed"] = json!(self.extensions);
        }
        if !self.bin.bytes.is_empty() {
            document["buffers"] = json!([{ "byteLength": self.bin.bytes.len() }]);
        }
        let bytes = bin::container(&document, &self.bin.bytes);
        let mut warnings = self.warnings;
        let more = warnings.len().saturating_sub(MOST_WARNINGS);
        warnings.truncate(MOST_WARNINGS);
        if more > 0 {
            warnings.push(format!("and {more} more"));
        }
        Ok(Glb { bytes: bytes.ok_or("it would have more than 4 GiB, which glTF has no room for")?, warnings })
    }
}
