//! What the nodes of one scene carry, placed in the world: shapes, cameras and lights.
use std::{collections::HashMap, sync::Arc};

use durer_core::{
    Id,
    glam::DAffine3,
    math::{Motion, Point3},
};
use durer_scene::{MaterialRef, Mesh, SceneDesc, ShapeDesc, ShapeSource, VertexKey};

use super::{
    animation::target::Bearer,
    buffer::Buffers,
    camera,
    document::{Document, only},
    element::{Checked, Element},
    instance, luminaire,
    material::Looks,
    mesh::{Asked, Known, Meshes, Pose},
    node::Hierarchy,
    primitive::has_no_area,
    skin::Skin,
    stance::{Stance, Story},
};

/// A shape whose mesh is not made yet.
struct Pending<'a> {
    mesh: Asked,
    name: String,
    world: Motion,
    material: Option<MaterialRef>,
    /// The node, if its scale is zero in some direction, be it for a moment.
    flat: Option<Box<Element<'a>>>,
    /// The animation moves or bends it, be it at this moment or not.
    apart: bool,
}

/// Most shapes of one file: nodes times primitives, of which a short file can make any number.
const MOST_SHAPES: usize = 1 << 21;

/// Which mesh in which pose: the mesh's index, the bits of the weights by moment, the skin.
type PoseKey = (usize, Vec<Vec<u32>>, Option<usize>);

/// A primitive's mesh and material; `None` if there is nothing to draw.
type Part = Option<(Asked, Option<MaterialRef>)>;

/// Places what the nodes of one scene carry.
pub(super) struct Walk<'w, 'a> {
    document: &'w Document<'a>,
    buffers: &'w Buffers,
    nodes: &'w Hierarchy<'a>,
    looks: &'w Looks,
    story: Story<'w>,
    meshes: Meshes<'a>,
    skins: HashMap<usize, Skin>,
    parts: HashMap<PoseKey, Arc<[Part]>>,
    pending: Vec<Pending<'a>>,
}

impl<'w, 'a> Walk<'w, 'a> {
    /// Nothing visited yet.
    pub(super) fn new(
        (document, buffers): (&'w Document<'a>, &'w Buffers),
        (nodes, story): (&'w Hierarchy<'a>, Story<'w>),
        looks: &'w Looks,
    ) -> Self {
        let (meshes, skins, parts) = (Meshes::default(), HashMap::new(), HashMap::new());
        Self { document, buffers, nodes, looks, story, meshes, skins, parts, pending: Vec::new() }
    }

    /// Visits the nodes `roots` and all below them in document order, then makes their meshes that are not `known`.
    pub(super) fn run(mut self, roots: &[usize], known: &mut Known, desc: &mut SceneDesc) -> Checked<()> {
        let mut seen = vec![false; self.document.root.list("nodes")?.len()];
        let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
        self.check_count()?;
        while let Some(index) = stack.pop() {
            // A scene may name a node and its child.
            let new = seen.get_mut(index).is_some_and(|seen| !std::mem::replace(seen, true));
            let Some(node) = self.nodes.node(index).filter(|_| new) else { continue };
            if is_hidden(node)? {
                continue;
            }
            self.document.keep(self.place(node, index, desc));
            if self.document.is_exhausted() {
                return Ok(());
            }
            stack.extend(self.nodes.children_of(index).iter().rev());
        }
        self.finish(known, desc);
        Ok(())
    }

    fn place(&mut self, node: &Element<'a>, index: usize, desc: &mut SceneDesc) -> Checked<()> {
        let world = self.motion(index, &DAffine3::IDENTITY);
        if let Some(camera) = self.document.member(node, "camera", "cameras")? {
            let name = if node.name().is_empty() { camera.name() } else { node.name() };
            if desc.cameras.is_empty() {
                desc.film = camera::film(&camera)?;
            }
            desc.cameras.push(camera::camera(&camera, name, &world)?);
        }
        if let Some(reference) = node.extension("KHR_lights_punctual")? {
            let light = self.light(&reference.required("light")?)?;
            let name = if node.name().is_empty() { light.name() } else { node.name() };
            desc.lights.push(camera::light(&light, name, &world)?);
        }
        if let Some(carrier) = node.extension(luminaire::NAME)? {
            desc.lights.push(luminaire::light(&carrier, (node.name(), &world), &self.looks.luminaires)?);
        }
        let Some(mesh) = self.document.member(node, "mesh", "meshes")? else {
            return Ok(());
        };
        let pose = self.pose((node, index), &mesh)?;
        let worlds = match node.extension("EXT_mesh_gpu_instancing")? {
            None => vec![world],
            Some(extension) => {
                let all = instance::placements(self.document, self.buffers, &extension)?;
                all.iter().map(|local| self.motion(index, local)).collect()
            }
        };
        self.shapes((node, index), &mesh, &pose, &worlds)
    }

    /// How something moves that a node carries in this place.
    fn motion(&self, node: usize, local: &DAffine3) -> Motion {
        let key = |stance: &Stance| (f64::from(stance.time), stance.world(node) * *local);
        let still = || self.story.stances.first().map_or(*local, |stance| key(stance).1);
        match Motion::keyed(self.story.stances.iter().map(key).collect()) {
            Ok(motion) if !motion.is_still() => motion,
            _ => Motion::still(still()),
        }
    }

    fn light(&self, reference: &Element<'a>) -> Checked<Element<'a>> {
        let index = reference.index()?;
        let extension = self.document.root.extension("KHR_lights_punctual")?;
        if let Some(extension) = &extension
            && let Some(light) = extension.list_item("lights", index)?
        {
            return Ok(light);
        }
        let count = extension.map_or(Ok(0), |e| e.list("lights").map(|list| list.len()))?;
        let message = format!("refers to /extensions/KHR_lights_punctual/lights/{index}, but ");
        Err(reference.fault(message + &only(count, "lights")))
    }

    /// Weights of the morph targets, the node's before the mesh's, and the skin.
    fn pose(&mut self, (node, index): (&Element<'a>, usize), mesh: &Element<'a>) -> Checked<Pose> {
        let own = match node.get("weights")? {
            Some(own) => own.items()?.map(|w| w.number()).collect::<Checked<Vec<f64>>>()?,
            None => mesh.list("weights")?.iter().map(Element::number).collect::<Checked<_>>()?,
        };
        let bearer = match node.get("weights")? {
            Some(_) => Bearer::Node(index),
            None => Bearer::Mesh(node.required("mesh")?.index()?),
        };
        let at = |stance: &Stance| match stance.weights(Bearer::Node(index)).or(stance.weights(bearer)) {
            Some(animated) => animated.to_vec(),
            None => own.iter().map(|w| *w as f32).collect(),
        };
        let mut weights: Vec<Vec<f32>> = self.story.stances.iter().map(at).collect();
        if weights.iter().zip(weights.iter().skip(1)).all(|(a, b)| a == b) {
            weights.truncate(1);
        }
        let skin = match node.get("skin")? {
            None => None,
            Some(reference) => {
                let index = reference.index()?;
                if !self.skins.contains_key(&index) {
                    let element = self.document.item("skins", &reference)?;
                    let places = (self.nodes, &self.story);
                    let skin = Skin::read(self.document, self.buffers, places, &element)?;
                    self.skins.insert(index, skin);
                }
                Some(index)
            }
        };
        Ok(Pose { weights, skin })
    }

    /// Complains about nodes that make too many shapes together, before the first is made.
    fn check_count(&self) -> Checked<()> {
        let meshes = self.document.root.list("meshes")?;
        let sizes: Vec<usize> =
            meshes.iter().map(|m| m.list("primitives").map(|p| p.len())).collect::<Checked<_>>()?;
        let mut shapes = 0_usize;
        for node in self.document.root.list("nodes")? {
            if let Some(mesh) = node.get("mesh")? {
                shapes = shapes.saturating_add(sizes.get(mesh.index()?).copied().unwrap_or(0));
            }
        }
        self.document.at_most(&self.document.root, shapes, MOST_SHAPES, "shapes (nodes times primitives)")
    }

    /// What the primitives of a mesh are in a pose; asked for once, as many nodes may show it.
    fn parts(&mut self, mesh: &Element<'a>, key: PoseKey, pose: &Pose) -> Checked<Arc<[Part]>> {
        if let Some(known) = self.parts.get(&key) {
            return Ok(Arc::clone(known));
        }
        let mut parts = Vec::new();
        for primitive in mesh.required("primitives")?.items()? {
            let look = self.looks.of(self.document, &primitive);
            let asked = look.and_then(|look| {
                let asked = self.meshes.ask(self.document, &primitive, look.sets, pose)?;
                Ok(asked.map(|mesh| (mesh, look.material)))
            });
            parts.push(self.document.keep(asked).flatten());
        }
        let parts: Arc<[Part]> = parts.into();
        self.parts.insert(key, Arc::clone(&parts));
        Ok(parts)
    }

    /// One shape per primitive and placement.
    fn shapes(
        &mut self,
        (node, index): (&Element<'a>, usize),
        mesh: &Element<'a>,
        pose: &Pose,
        worlds: &[Motion],
    ) -> Checked<()> {
        let name = if node.name().is_empty() { mesh.name() } else { node.name() };
        let bits = |weights: &Vec<f32>| weights.iter().map(|w| w.to_bits()).collect();
        let weights = pose.weights.iter().map(bits).collect();
        let parts = self.parts(mesh, (node.required("mesh")?.index()?, weights, pose.skin), pose)?;
        let bearers = [Bearer::Node(index), Bearer::Mesh(node.required("mesh")?.index()?)];
        let morphs = bearers.into_iter().any(|bearer| self.story.morphs(bearer));
        let count = parts.len().saturating_mul(worlds.len());
        let all = count.saturating_add(self.pending.len());
        self.document.at_most(node, all, MOST_SHAPES, "shapes (places times primitives)")?;
        // A mesh that many nodes show may have a name as long as the file.
        self.document.spend(node, count, name.len().saturating_sub(64))?;
        for (place, world) in worlds.iter().enumerate() {
            for (number, part) in (1..).zip(&*parts) {
                let Some((mesh, material)) = *part else { continue };
                if mesh.skin.is_some() && place > 0 {
                    // A skin alone says where its vertices are: all instances would be in one place.
                    self.document.warn(node, "instances of a mesh with a skin are drawn once");
                    continue;
                }
                let is_flat = mesh.skin.is_none() && is_flat(world);
                let flat = is_flat.then(|| Box::new(node.clone()));
                let several = parts.len() > 1 && !name.is_empty();
                let name = if several { format!("{name}#{number}") } else { name.to_owned() };
                let moves = match mesh.skin.and_then(|skin| self.skins.get(&skin)) {
                    Some(skin) => skin.moves,
                    None => self.story.moves(index),
                };
                let (world, apart) = (world.clone(), moves || morphs);
                self.pending.push(Pending { mesh, name, world, material, flat, apart });
            }
        }
        Ok(())
    }

    /// Makes the meshes and the shapes that have one.
    fn finish(self, known: &mut Known, desc: &mut SceneDesc) {
        let times: Vec<f32> = self.story.stances.iter().map(|stance| stance.time).collect();
        let made = self.meshes.build((self.document, self.buffers), (&self.skins, &times), known);
        let mut ids = Vec::with_capacity(made.len());
        for mesh in made {
            ids.push(mesh.map(|mesh| {
                desc.meshes.push(mesh);
                Id::new(desc.meshes.len() as u32 - 1)
            }));
        }
        for Pending { mesh, name, mut world, material, flat, apart } in self.pending {
            let Some(mut id) = ids.get(mesh.number).copied().flatten() else { continue };
            if let Some(node) = flat {
                let Some(Some(flat)) =
                    self.document.keep(flattened(self.document, &node, (id, &world), desc))
                else {
                    continue;
                };
                (id, world) = flat;
            }
            let skin = mesh.skin.and_then(|skin| self.skins.get(&skin));
            let anchored = |skin: &Skin| Motion::still(DAffine3::from_translation(skin.anchor));
            let world = skin.map_or(world, anchored);
            if apart {
                desc.apart.insert(desc.shapes.len());
            }
            desc.shapes.push(ShapeDesc {
                name,
                source: ShapeSource::Mesh(id),
                world_from_object: world,
                material,
                reverse_orientation: false,
                area_light: None,
                media: None,
            });
        }
    }
}

/// Whether no ray could be brought into the space of a moving thing at some moment: it is flat, or turns inside out.
fn is_flat(motion: &Motion) -> bool {
    let mut sides = motion.keys().iter().map(|(_, m)| m.matrix3.determinant());
    let first = sides.next().unwrap_or(0.0);
    first == 0.0 || sides.any(|side| side * first <= 0.0)
}

/// A mesh as a node shows it that is scaled to zero in some direction, moved to where it is but for the node's first
/// translation. Normals are those of the triangles. `None`, after a warning, if nothing is left.
fn flattened<'a>(
    document: &Document<'a>,
    node: &Element<'a>,
    (id, world): (Id<Mesh>, &Motion),
    desc: &mut SceneDesc,
) -> Checked<Option<(Id<Mesh>, Motion)>> {
    let (Some(mesh), Some((_, first))) = (desc.meshes.get(id.index()), world.keys().first()) else {
        return Ok(None);
    };
    let moments = mesh.keys().max(world.keys().len());
    document.spend(node, mesh.positions.len().saturating_mul(moments), 48)?;
    document.spend(node, mesh.indices.len(), 12)?;
    let anchor = first.translation;
    let placed = |(moment, m): (usize, &DAffine3)| -> Vec<Point3> {
        let place = |p: &Point3| m.matrix3 * Point3::to_f64(*p) + (m.translation - anchor);
        mesh.key(moment).1.iter().map(|p| Point3::from(place(p).as_vec3().to_array())).collect()
    };
    let mut flat = Mesh {
        positions: placed((0, first)),
        normals: Vec::new(),
        tangents: Vec::new(),
        later: Vec::new(),
        ..Mesh::clone(mesh)
    };
    for moment in 1..moments {
        let key = world.keys().get(moment);
        let time = key.map_or_else(|| mesh.key(moment).0, |(time, _)| *time as f32);
        let positions = placed((moment, key.map_or(first, |(_, m)| m)));
        flat.later.push(VertexKey { time, positions, normals: Vec::new() });
    }
    if let Some((time, _)) = world.keys().first().filter(|_| world.keys().len() > 1) {
        flat.time = *time as f32;
    }
    if has_no_area(&flat) {
        document.warn(node, "a node is scaled to zero and nothing of it is left; it is not drawn");
        return Ok(None);
    }
    desc.meshes.push(Arc::new(flat));
    let place = Motion::still(DAffine3::from_translation(anchor));
    Ok(Some((Id::new(desc.meshes.len() as u32 - 1), place)))
}

/// KHR_node_visibility: hides a node and all below it.
fn is_hidden(node: &Element<'_>) -> Checked<bool> {
    let Some(extension) = node.extension("KHR_node_visibility")? else {
        return Ok(false);
    };
    Ok(extension.get("visible")?.is_some() && !extension.flag("visible")?)
}
