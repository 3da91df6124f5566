//! The pbrt-v4 scene language, written: whatever its reader made of a file comes back from what is written here.
//!
//! Numbers are the shortest decimals that read back as they were. Cameras are written by the inverse of their placement,
//! as the language has it, or by the placement itself where the inverse of the inverse differs in the last bit. Nodes that shapes share are
//! written once, as objects with instances. Files that lie within the original go into a folder beside the text, as they
//! are; paths of others stay relative to the folder of the original, or go the same way.
mod film;
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

use super::{Beside, Files, beside::Gathered};
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
    /// What changes all of these; 0 is left out.
    pub seed: u64,
    /// The part that is wanted: first and last of x, then of y, in pixels.
    pub crop: Option<[u32; 4]>,
}

/// What is written, and how.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// The picture.
    pub film: Film,
    /// The index of the camera that comes first.
    pub camera: usize,
    /// Which files go along.
    pub files: Files,
    /// The folder beside the text where these lie.
    pub folder: &'a str,
    /// Comments at the top.
    pub remarks: &'a [String],
}

/// A scene in the language, and what lies beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Files in [`Plan::folder`].
    pub beside: Vec<Beside>,
}

/// Most complaints that are listed.
const MOST_COMPLAINTS: usize = 20;

/// A file in the making, and what cannot be in it.
struct Writer<'a> {
    desc: &'a SceneDesc,
    gathered: Gathered<'a>,
    text: String,
    times: Times,
    refused: BTreeSet<String>,
    /// The name of each material.
    materials: Vec<String>,
    /// What was written of each mesh.
    meshes: BTreeMap<usize, Result<Node, String>>,
}

/// A scene as the plan says.
///
/// # Errors
/// What of the scene the language has no words for, each in a sentence.
pub fn write(desc: &SceneDesc, assets: &FileAssets, plan: Plan<'_>) -> Result<Written, Vec<String>> {
    let mut writer = Writer {
        desc,
        gathered: Gathered::new(assets, plan.files, plan.folder),
        text: String::new(),
        times: Times::of(desc),
        refused: BTreeSet::new(),
        materials: names(&desc.materials),
        meshes: BTreeMap::new(),
    };
    for line in plan.remarks.iter().flat_map(|remark| remark.lines()) {
        writer.line(&format!("# {line}"));
    }
    writer.media();
    writer.options(plan.film, plan.camera);
    writer.line("\nWorldBegin");
    writer.textures();
    writer.materials();
    writer.lights();
    writer.shapes();
    if writer.refused.is_empty() {
        Ok(Written { text: writer.text, beside: writer.gathered.list })
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
        for complaint in params(node, &mut self.gathered, &mut self.text) {
            self.refuse(format!("{owner}: {complaint}"));
        }
        self.text.push('\n');
    }

    fn options(&mut self, film: Film, camera: usize) {
        let Film { width, height, samples, sampler, seed, crop } = film;
        let options = self.desc.options;
        for (name, is_set) in [
            ("disablepixeljitter", options.disable_pixel_jitter),
            ("disablewavelengthjitter", options.disable_wavelength_jitter),
            ("disabletexturefiltering", options.disable_texture_filtering),
            ("forcediffuse", options.force_diffuse),
        ] {
            if is_set {
                self.line(&format!("Option \"bool {name}\" true"));
            }
        }
        if let Some(scale) = options.displacement_edge_scale {
            self.line(&format!("Option \"float displacementedgescale\" {scale}"));
        }
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
        // Seeds of files have 32 bits.
        let seed = match seed as u32 as i32 {
            0 => String::new(),
            seed => format!(" \"integer seed\" [ {seed} ]"),
        };
        self.line(&film::line(&self.desc.film, [width, height], crop));
        self.line(&match sampler {
            SamplerKind::Regular | SamplerKind::Stratified => {
                let jitter = sampler == SamplerKind::Stratified;
                format!(
                    "Sampler \"stratified\" \"integer xsamples\" [ {samples} ] \"integer ysamples\" [ 1 ] \
                     \"bool jitter\" [ {jitter} ]{seed}"
                )
            }
            kind => format!("Sampler {} \"integer pixelsamples\" [ {samples} ]{seed}", quoted(kind.word())),
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
        self.times.frame(&camera.world_from_camera).write_inverse(&mut self.text);
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
            self.times.frame(&light.world_from_light).write(&mut self.text);
            self.node("LightSource", &light.node, (&light.name, &owner));
            self.line("AttributeEnd");
        }
    }

    /// Shapes in their order: those that stand alone, then from the first that is placed several times on all as
    /// instances, which the language unfolds after the others.
    fn shapes(&mut self) {
        let desc = self.desc;
        let mut uses: BTreeMap<Object, u32> = BTreeMap::new();
        desc.shapes.iter().for_each(|shape| *uses.entry(Object::of(shape)).or_default() += 1);
        let mut kinds: HashMap<Source, u32> = HashMap::new();
        uses.keys().for_each(|object| *kinds.entry(object.0.0).or_default() += 1);
        self.put_meshes_aside(&kinds);
        let is_shared = |shape: &ShapeDesc| uses.get(&Object::of(shape)).is_some_and(|&uses| uses > 1);
        let first = desc.shapes.iter().position(is_shared).unwrap_or(desc.shapes.len());
        let (alone, instances) = desc.shapes.split_at(first);
        for shape in alone {
            self.line("\nAttributeBegin");
            self.times.frame(&shape.world_from_object).write(&mut self.text);
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
            self.times.frame(&shape.world_from_object).write(&mut self.text);
            self.line(&format!("ObjectInstance \"object {object}\"\nAttributeEnd"));
        }
    }

    /// Writes meshes into files where that is better, and makes shapes of the others.
    fn put_meshes_aside(&mut self, kinds: &HashMap<Source, u32>) {
        for (number, mesh) in self.desc.meshes.iter().enumerate() {
            let Some(&objects) = kinds.get(&Source::Mesh(number as u32)) else { continue };
            let file = mesh::file(mesh, objects > 1, (&mut self.gathered, number));
            self.meshes.insert(number, file.map_or_else(|| mesh::node(mesh), Ok));
        }
    }

    fn shape(&mut self, shape: &ShapeDesc) {
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
            ShapeSource::Mesh(id) => match self.meshes.get(&id.index()).cloned() {
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
