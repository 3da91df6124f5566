//! The pbrt-v4 scene language, written: whatever its reader made of a file comes back from what is written here.
//!
//! Numbers are the shortest decimals that read back as they were. Cameras are written by the inverse of their placement,
//! as the language has it, so that they may come back off in the last bit of a double. Nodes that shapes share are
//! written once, as objects with instances. Paths stay relative to the folder of the original: the file belongs there.
mod media;
mod mesh;
mod place;
mod value;

use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    fmt::Write,
    sync::Arc,
};

use durer_core::{Id, sampling::SamplerKind};
use durer_scene::{CameraDesc, NamedNode, Node, SceneDesc, ShapeDesc, ShapeSource, TextureValue};

use crate::FileAssets;
use place::{Frame, Times};
use value::{params, quoted};

/// The picture that the file asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples per pixel.
    pub samples: u32,
    /// How they become random numbers.
    pub sampler: SamplerKind,
}

/// Most complaints that are listed.
const MOST_COMPLAINTS: usize = 20;

/// A file in the making, and what cannot be in it.
struct Writer<'a> {
    desc: &'a SceneDesc,
    assets: &'a FileAssets,
    text: String,
    times: Times,
    refused: BTreeSet<String>,
    /// The name of each material.
    materials: Vec<String>,
}

/// The text of a scene; its first camera is the one called `camera` by its index. `remarks` become comments.
///
/// # Errors
/// What of the scene the language has no words for, each in a sentence.
pub fn text(
    desc: &SceneDesc,
    assets: &FileAssets,
    (film, camera): (Film, usize),
    remarks: &[String],
) -> Result<String, Vec<String>> {
    let mut writer = Writer {
        desc,
        assets,
        text: String::new(),
        times: Times::of(desc),
        refused: BTreeSet::new(),
        materials: names(&desc.materials),
    };
    for line in remarks.iter().flat_map(|remark| remark.lines()) {
        writer.line(&format!("# {line}"));
    }
    writer.media();
    writer.options(film, camera);
    writer.line("\nWorldBegin");
    writer.textures();
    writer.materials();
    writer.lights();
    writer.shapes();
    if writer.refused.is_empty() {
        Ok(writer.text)
    } else {
        Err(writer.refused.into_iter().take(MOST_COMPLAINTS).collect())
    }
}

/// Names that tell materials apart: their own, or with a number.
fn names(materials: &[NamedNode]) -> Vec<String> {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    let mut name = |(index, material): (usize, &NamedNode)| {
        let own = if material.name.is_empty() { format!("material {index}") } else { material.name.clone() };
        let mut free = own.clone();
        let mut number = index;
        while !taken.insert(free.clone()) {
            free = format!("{own} ({number})");
            number += 1;
        }
        free
    };
    materials.iter().enumerate().map(&mut name).collect()
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn refuse(&mut self, what: impl Into<String>) {
        if self.refused.len() <= MOST_COMPLAINTS {
            self.refused.insert(what.into());
        }
    }

    /// A directive with a kind and its parameters; `owner` is what complaints call it.
    fn node(&mut self, directive: &str, node: &Node, (name, owner): (&str, &str)) {
        let mut line = format!("{directive} {}", quoted(&node.kind));
        if !name.is_empty() {
            let _ = write!(line, " \"string name\" [ {} ]", quoted(name));
        }
        self.text.push_str(&line);
        self.params(node, owner);
    }

    fn params(&mut self, node: &Node, owner: &str) {
        for complaint in params(node, self.assets, &mut self.text) {
            self.refuse(format!("{owner}: {complaint}"));
        }
        self.text.push('\n');
    }

    fn options(&mut self, film: Film, camera: usize) {
        let Film { width, height, samples, sampler } = film;
        if let Some((start, end)) = self.times.seconds() {
            self.line(&format!("TransformTimes {start} {end}"));
        }
        let cameras = &self.desc.cameras;
        let others = cameras.iter().enumerate().filter(|(index, _)| *index != camera).map(|(_, c)| c);
        let mut seen = BTreeSet::new();
        for desc in cameras.get(camera).into_iter().chain(others) {
            // Of two with the same name the language knows the last only.
            if seen.insert(desc.name.clone()) {
                self.camera(desc);
            }
        }
        let file = self.desc.film.filename.as_ref();
        let file = file.map(|f| format!(" \"string filename\" [ {} ]", quoted(f))).unwrap_or_default();
        self.line(&format!(
            "Film \"rgb\" \"integer xresolution\" [ {width} ] \"integer yresolution\" [ {height} ]{file}"
        ));
        self.line(&match sampler {
            SamplerKind::Regular | SamplerKind::Stratified => {
                let jitter = sampler == SamplerKind::Stratified;
                format!(
                    "Sampler \"stratified\" \"integer xsamples\" [ {samples} ] \"integer ysamples\" [ 1 ] \
                     \"bool jitter\" [ {jitter} ]"
                )
            }
            kind => format!("Sampler {} \"integer pixelsamples\" [ {samples} ]", quoted(kind.word())),
        });
        if let Some(filter) = &self.desc.filter {
            self.node("PixelFilter", filter, ("", "the filter"));
        }
        if let Some(integrator) = &self.desc.integrator {
            self.node("Integrator", integrator, ("", "the integrator"));
        }
    }

    fn camera(&mut self, camera: &CameraDesc) {
        let owner = format!("camera \"{}\"", camera.name);
        if camera.media.is_some() {
            self.sides(camera.media);
        }
        self.times.frame(&camera.world_from_camera, |m| m.inverse()).write(&mut self.text);
        self.node("Camera", &camera.node, (&camera.name, &owner));
        self.line("Identity");
    }

    fn textures(&mut self) {
        let desc = self.desc;
        for texture in &desc.textures {
            let owner = format!("texture \"{}\"", texture.name);
            self.line("\nTransformBegin");
            Frame::Still(texture.world_from_texture).write(&mut self.text);
            let value = match texture.value {
                TextureValue::Float => "float",
                TextureValue::Color => "spectrum",
            };
            let directive = format!("Texture {} \"{value}\"", quoted(&texture.name));
            self.node(&directive, &texture.node, ("", &owner));
            self.line("TransformEnd");
        }
    }

    fn materials(&mut self) {
        let desc = self.desc;
        for (index, material) in desc.materials.iter().enumerate() {
            let name = self.materials.get(index).cloned().unwrap_or_default();
            let owner = format!("material \"{name}\"");
            let kind = quoted(&material.node.kind);
            self.text.push_str(&format!("\nMakeNamedMaterial {} \"string type\" [ {kind} ]", quoted(&name)));
            self.params(&material.node, &owner);
        }
    }

    fn lights(&mut self) {
        let desc = self.desc;
        for light in &desc.lights {
            let owner = format!("light \"{}\"", light.name);
            self.line("\nAttributeBegin");
            self.times.frame(&light.world_from_light, |m| *m).write(&mut self.text);
            self.node("LightSource", &light.node, (&light.name, &owner));
            self.line("AttributeEnd");
        }
    }

    /// Shapes in their order: those that stand alone, then from the first that shares what it is built from on all as
    /// instances, which the language unfolds after the others.
    fn shapes(&mut self) {
        let desc = self.desc;
        let mut uses: HashMap<Source, u32> = HashMap::new();
        desc.shapes.iter().for_each(|shape| *uses.entry(Source::of(shape)).or_default() += 1);
        let is_shared = |shape: &ShapeDesc| uses.get(&Source::of(shape)).is_some_and(|&uses| uses > 1);
        let first = desc.shapes.iter().position(is_shared).unwrap_or(desc.shapes.len());
        let (alone, instances) = desc.shapes.split_at(first);
        for shape in alone {
            self.line("\nAttributeBegin");
            self.times.frame(&shape.world_from_object, |m| *m).write(&mut self.text);
            self.shape(shape);
            self.line("AttributeEnd");
        }
        let mut objects: BTreeMap<Object, usize> = BTreeMap::new();
        for shape in instances {
            let number = objects.len();
            let key = Object::of(shape);
            let object = match objects.get(&key) {
                Some(&known) => known,
                None => {
                    self.line(&format!("\nAttributeBegin\nObjectBegin \"object {number}\""));
                    self.shape(shape);
                    self.line("ObjectEnd\nAttributeEnd");
                    objects.insert(key, number);
                    number
                }
            };
            self.line("\nAttributeBegin");
            self.times.frame(&shape.world_from_object, |m| *m).write(&mut self.text);
            self.line(&format!("ObjectInstance \"object {object}\"\nAttributeEnd"));
        }
    }

    fn shape(&mut self, shape: &ShapeDesc) {
        let desc = self.desc;
        let owner = owner(shape);
        self.sides(shape.media);
        if shape.reverse_orientation {
            self.line("ReverseOrientation");
        }
        if let Some(light) = &shape.area_light {
            self.node("AreaLightSource", light, ("", &owner));
        }
        if let Some(name) = shape.material.and_then(|m| self.materials.get(m.index()).cloned()) {
            self.line(&format!("NamedMaterial {}", quoted(&name)));
        }
        match &shape.source {
            ShapeSource::Node(node) => self.node("Shape", node, (&shape.name, &owner)),
            ShapeSource::Mesh(id) => match desc.meshes.get(id.index()).map(|mesh| mesh::node(mesh)) {
                Some(Ok(node)) => self.node("Shape", &node, (&shape.name, &owner)),
                Some(Err(why)) => self.refuse(format!("{owner}: {why}")),
                None => {}
            },
        }
    }
}

fn owner(shape: &ShapeDesc) -> String {
    let kind = match &shape.source {
        ShapeSource::Node(node) => node.kind.as_str(),
        ShapeSource::Mesh(_) => "mesh",
    };
    if shape.name.is_empty() {
        format!("a shape of kind \"{kind}\"")
    } else {
        format!("shape \"{}\"", shape.name)
    }
}

/// What a shape is built from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Source {
    Node(*const Node),
    Mesh(u32),
}

impl Source {
    fn of(shape: &ShapeDesc) -> Self {
        match &shape.source {
            ShapeSource::Node(node) => Self::Node(Arc::as_ptr(node)),
            ShapeSource::Mesh(id) => Self::Mesh(id.index() as u32),
        }
    }
}

/// What instances of an object have in common.
type Shared = (Source, Option<u32>, bool, Option<*const Node>, String, Sides);

/// The media inside and outside.
type Sides = Option<[Option<usize>; 2]>;

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Object(Shared);

impl Object {
    fn of(shape: &ShapeDesc) -> Self {
        let material = shape.material.map(|m: Id<NamedNode>| m.index() as u32);
        let light = shape.area_light.as_ref().map(Arc::as_ptr);
        let sides = shape.media.map(|m| [m.inside, m.outside].map(|medium| medium.map(Id::index)));
        Self((Source::of(shape), material, shape.reverse_orientation, light, shape.name.clone(), sides))
    }
}
