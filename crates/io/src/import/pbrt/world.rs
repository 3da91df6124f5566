//! What the directives leave behind: materials and objects by name, shapes, and the instances that are unfolded at
//! the end.
//!
//! Names of materials and objects may be used before they are defined, as in pbrt-v4: a slot is made at first mention
//! and checked when everything is read.
use std::{
    collections::{HashMap, HashSet},
    sync::Arc,
};

use durer_core::Id;
use durer_scene::{
    Data, Diagnostics, MaterialRef, MediumDesc, MediumInterface, MediumRef, NamedNode, Node, Param,
    SceneDesc, ShapeDesc, ShapeSource, Span, TextureDesc, TextureValue,
};

use super::{
    input::Word,
    placement::{Placement, is_invertible},
};

/// Most memory, in units of about four bytes, that copies of shapes and parameters may take.
const MOST_COPIED: u64 = 1 << 28;

/// Most shapes that instances may place: they take about 300 bytes each.
const MOST_PLACED: usize = 1 << 22;

/// A name that may be used before it is defined.
#[derive(Debug)]
struct Slot {
    index: usize,
    defined: bool,
    used: Option<Span>,
}

/// A shape before instancing.
#[derive(Clone, Debug)]
pub(super) struct PlacedShape {
    pub(super) name: String,
    pub(super) node: Arc<Node>,
    pub(super) placement: Placement,
    pub(super) material: Option<MaterialRef>,
    pub(super) reverse: bool,
    pub(super) area_light: Option<Arc<Node>>,
    pub(super) media: Option<MediumInterface>,
}

impl PlacedShape {
    fn within(self, parent: &Placement, times: (f64, f64)) -> Result<ShapeDesc, &'static str> {
        let motion = parent.compose(&self.placement).motion(times);
        if motion.keys().iter().any(|(_, m)| !is_invertible(m)) {
            return Err("a shape of this instance gets a singular transformation");
        }
        Ok(ShapeDesc {
            name: self.name,
            source: ShapeSource::Node(self.node),
            world_from_object: motion,
            material: self.material,
            reverse_orientation: self.reverse,
            area_light: self.area_light,
            media: self.media,
        })
    }
}

#[derive(Debug)]
struct Instance {
    object: usize,
    placement: Placement,
    at: Span,
}

/// The scene being built.
#[derive(Debug)]
pub(super) struct World<'a> {
    /// Where finished things go.
    pub(super) desc: &'a mut SceneDesc,
    /// Seconds of the two matrices of a [`Placement`].
    pub(super) times: (f64, f64),
    materials: HashMap<String, Slot>,
    media: HashMap<String, Slot>,
    /// By the material below and the parameter.
    pub(super) masks: HashMap<(Option<MaterialRef>, String), MaterialRef>,
    objects: HashMap<String, Slot>,
    textures: [HashSet<String>; 2],
    /// Shapes of each object.
    shapes: Vec<Vec<PlacedShape>>,
    /// The object between `ObjectBegin` and `ObjectEnd`.
    open_object: Option<usize>,
    instances: Vec<Instance>,
    copied: u64,
}

impl<'a> World<'a> {
    pub(super) fn new(desc: &'a mut SceneDesc) -> Self {
        Self {
            desc,
            times: (0.0, 1.0),
            materials: HashMap::new(),
            media: HashMap::new(),
            masks: HashMap::new(),
            objects: HashMap::new(),
            textures: Default::default(),
            shapes: Vec::new(),
            open_object: None,
            instances: Vec::new(),
            copied: 0,
        }
    }

    /// A material without name.
    pub(super) fn material(&mut self, node: Node) -> MaterialRef {
        self.desc.materials.push(NamedNode { name: String::new(), node });
        Id::new(self.desc.materials.len() as u32 - 1)
    }

    /// Defines a named material; `None` stands for one that could not be read.
    pub(super) fn define_material(&mut self, name: &Word, node: Option<Node>, diagnostics: &mut Diagnostics) {
        let slot = self.material_slot(&name.text);
        if std::mem::replace(&mut slot.defined, true) {
            diagnostics.error(name.at, format!("the material \"{}\" is defined twice", name.text));
            return;
        }
        let index = slot.index;
        if let (Some(named), Some(node)) = (self.desc.materials.get_mut(index), node) {
            named.node = node;
        }
    }

    /// The material called `name`.
    pub(super) fn use_material(&mut self, name: &Word) -> MaterialRef {
        let slot = self.material_slot(&name.text);
        slot.used.get_or_insert(name.at);
        Id::new(slot.index as u32)
    }

    fn material_slot(&mut self, name: &str) -> &mut Slot {
        let materials = &mut self.desc.materials;
        self.materials.entry(name.to_owned()).or_insert_with(|| {
            materials.push(NamedNode { name: name.to_owned(), node: Node::default() });
            Slot { index: materials.len() - 1, defined: false, used: None }
        })
    }

    /// Defines a medium, whose own space is where `placement` was when the shutter opened; `None` stands for one that could
    /// not be read.
    pub(super) fn define_medium(
        &mut self,
        name: &Word,
        (node, placement): (Option<Node>, &Placement),
        diagnostics: &mut Diagnostics,
    ) {
        let slot = self.medium_slot(&name.text);
        if std::mem::replace(&mut slot.defined, true) {
            diagnostics.error(name.at, format!("the medium \"{}\" is defined twice", name.text));
            return;
        }
        let (index, world_from_medium) = (slot.index, placement.at(self.times.0, self.times));
        if let (Some(medium), Some(node)) = (self.desc.media.get_mut(index), node) {
            *medium = MediumDesc { name: name.text.clone(), node, world_from_medium };
        }
    }

    /// The medium called `name`; an empty name is nothing.
    pub(super) fn use_medium(&mut self, name: &Word) -> Option<MediumRef> {
        if name.text.is_empty() {
            return None;
        }
        let slot = self.medium_slot(&name.text);
        slot.used.get_or_insert(name.at);
        Some(Id::new(slot.index as u32))
    }

    fn medium_slot(&mut self, name: &str) -> &mut Slot {
        let media = &mut self.desc.media;
        self.media.entry(name.to_owned()).or_insert_with(|| {
            media.push(MediumDesc { name: name.to_owned(), ..MediumDesc::default() });
            Slot { index: media.len() - 1, defined: false, used: None }
        })
    }

    /// Adds a texture, whose own space is where `placement` was when the shutter opened.
    pub(super) fn texture(
        &mut self,
        name: &Word,
        value: TextureValue,
        (node, placement): (Option<Node>, &Placement),
        diagnostics: &mut Diagnostics,
    ) {
        let [floats, colors] = &mut self.textures;
        let (names, what) = match value {
            TextureValue::Float => (floats, "float"),
            TextureValue::Color => (colors, "spectrum"),
        };
        if !names.insert(name.text.clone()) {
            diagnostics.error(name.at, format!("the {what} texture \"{}\" is defined twice", name.text));
        } else if let Some(node) = node {
            let world_from_texture = placement.at(self.times.0, self.times);
            self.desc.textures.push(TextureDesc { name: name.text.clone(), value, node, world_from_texture });
        }
    }

    /// True between `ObjectBegin` and `ObjectEnd`.
    pub(super) fn in_object(&self) -> bool {
        self.open_object.is_some()
    }

    /// Shapes go to the object `name` from here on.
    pub(super) fn begin_object(&mut self, name: &Word, diagnostics: &mut Diagnostics) {
        let slot = self.object_slot(&name.text);
        let index = slot.index;
        if std::mem::replace(&mut slot.defined, true) {
            diagnostics.error(name.at, format!("the object \"{}\" is defined twice", name.text));
        }
        self.open_object = Some(index);
    }

    /// Shapes go to the scene from here on.
    pub(super) fn end_object(&mut self) {
        self.open_object = None;
    }

    fn object_slot(&mut self, name: &str) -> &mut Slot {
        let shapes = &mut self.shapes;
        self.objects.entry(name.to_owned()).or_insert_with(|| {
            shapes.push(Vec::new());
            Slot { index: shapes.len() - 1, defined: false, used: None }
        })
    }

    /// Places the object `name`.
    pub(super) fn instance(&mut self, name: &Word, placement: Placement) {
        let slot = self.object_slot(&name.text);
        slot.used.get_or_insert(name.at);
        let object = slot.index;
        self.instances.push(Instance { object, placement, at: name.at });
    }

    /// Adds a shape to the scene or the open object.
    ///
    /// # Errors
    /// What is wrong with its placement.
    pub(super) fn shape(&mut self, shape: PlacedShape) -> Result<(), &'static str> {
        if let Some(shapes) = self.open_object.and_then(|index| self.shapes.get_mut(index)) {
            shapes.push(shape);
            return Ok(());
        }
        let placed = shape.within(&Placement::identity(), self.times)?;
        charge_keys(&mut self.copied, &placed)?;
        self.desc.shapes.push(placed);
        Ok(())
    }

    /// Counts a copy of `params`; false if all copies together are too large.
    pub(super) fn may_copy<'p>(&mut self, params: impl IntoIterator<Item = &'p Param>) -> bool {
        self.copied = self.copied.saturating_add(params.into_iter().map(weight).sum());
        self.copied <= MOST_COPIED
    }

    /// Unfolds instances and complains about names that were never defined.
    pub(super) fn finish(mut self, diagnostics: &mut Diagnostics) {
        undefined("material", &self.materials, diagnostics);
        undefined("medium", &self.media, diagnostics);
        undefined("object", &self.objects, diagnostics);
        let unused = self.objects.values().filter(|s| s.used.is_none()).count();
        if unused > 0 {
            let message = format!("{unused} object definition(s) are never placed by ObjectInstance");
            diagnostics.note(durer_scene::Location::None, message);
        }
        let mut placed = 0;
        for instance in &self.instances {
            placed += self.shapes.get(instance.object).map_or(0, Vec::len);
            if placed > MOST_PLACED {
                let message = format!("the instances up to this one place more than {MOST_PLACED} shapes");
                diagnostics.error(instance.at, message);
                return;
            }
            for shape in self.shapes.get(instance.object).into_iter().flatten() {
                let placed = shape.clone().within(&instance.placement, self.times);
                match placed.and_then(|shape| charge_keys(&mut self.copied, &shape).map(|()| shape)) {
                    Ok(shape) => self.desc.shapes.push(shape),
                    Err(message) => {
                        diagnostics.error(instance.at, message);
                        if diagnostics.is_full() {
                            return;
                        }
                        break;
                    }
                }
            }
        }
    }
}

/// Counts the keys of a moving shape among the copies.
fn charge_keys(copied: &mut u64, shape: &ShapeDesc) -> Result<(), &'static str> {
    // A key is a time and twelve numbers in f64; the one of a still shape is counted with the shapes.
    let keys = shape.world_from_object.keys().len() as u64 - 1;
    *copied = copied.saturating_add(keys * 26);
    if keys == 0 || *copied <= MOST_COPIED {
        Ok(())
    } else {
        Err("the keys of moving shapes take more than 1 GiB in all")
    }
}

/// Memory of a parameter in units of about four bytes.
fn weight(param: &Param) -> u64 {
    let values: usize = match &param.data {
        Data::Strings(strings) => strings.iter().map(|s| 8 + s.len() / 4).sum(),
        data => data.len(),
    };
    32 + values as u64
}

fn undefined(what: &str, slots: &HashMap<String, Slot>, diagnostics: &mut Diagnostics) {
    let mut missing: Vec<_> =
        slots.iter().filter(|(_, s)| !s.defined).filter_map(|(name, s)| Some((s.used?, name))).collect();
    // A hash map has no order of its own; complaints come in the order of the text.
    missing.sort_by_key(|(at, _)| (at.source.0, at.start));
    let mut known: Vec<&str> =
        slots.iter().filter(|(_, s)| s.defined).map(|(name, _)| name.as_str()).collect();
    known.sort_unstable();
    let spare = Diagnostics::MOST_ERRORS.saturating_sub(diagnostics.error_count());
    for (at, name) in missing.into_iter().take(spare) {
        diagnostics.unknown(at, what, name, known.iter().copied());
    }
}
