//! What the nodes of one scene carry, placed in the world: shapes, cameras and lights.
use std::collections::HashMap;

use durer_core::{Id, glam::DAffine3, math::Motion};
use durer_scene::{MaterialRef, SceneDesc, ShapeDesc, ShapeSource};

use super::{
    buffer::Buffers,
    camera,
    document::{Document, only},
    element::{Checked, Element},
    instance,
    material::Looks,
    mesh::{Asked, Meshes, Pose},
    node::Hierarchy,
    skin::Skin,
};

/// A shape whose mesh is not made yet.
struct Pending {
    mesh: Asked,
    name: String,
    world: DAffine3,
    material: Option<MaterialRef>,
}

/// Places what the nodes of one scene carry.
pub(super) struct Walk<'w, 'a> {
    document: &'w Document<'a>,
    buffers: &'w Buffers<'a>,
    nodes: &'w Hierarchy<'a>,
    looks: &'w Looks,
    meshes: Meshes<'a>,
    skins: HashMap<usize, Skin>,
    pending: Vec<Pending>,
}

impl<'w, 'a> Walk<'w, 'a> {
    /// Nothing visited yet.
    pub(super) fn new(
        document: &'w Document<'a>,
        buffers: &'w Buffers<'a>,
        nodes: &'w Hierarchy<'a>,
        looks: &'w Looks,
    ) -> Self {
        let (meshes, skins, pending) = (Meshes::default(), HashMap::new(), Vec::new());
        Self { document, buffers, nodes, looks, meshes, skins, pending }
    }

    /// Visits the nodes `roots` and all below them in document order, then makes their meshes.
    pub(super) fn run(mut self, roots: &[usize], desc: &mut SceneDesc) -> Checked<()> {
        let mut seen = vec![false; self.document.root.list("nodes")?.len()];
        let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
        while let Some(index) = stack.pop() {
            // A scene may name a node and its child.
            let new = seen.get_mut(index).is_some_and(|seen| !std::mem::replace(seen, true));
            let Some(node) = self.nodes.node(index).filter(|_| new) else { continue };
            if is_hidden(node)? {
                continue;
            }
            self.document.keep(self.place(node, index, desc));
            stack.extend(self.nodes.children_of(index).iter().rev());
        }
        self.finish(desc);
        Ok(())
    }

    fn place(&mut self, node: &Element<'a>, index: usize, desc: &mut SceneDesc) -> Checked<()> {
        let world = self.nodes.world(index);
        if let Some(camera) = self.document.member(node, "camera", "cameras")? {
            let name = if node.name().is_empty() { camera.name() } else { node.name() };
            desc.cameras.push(camera::camera(&camera, name, &world)?);
        }
        if let Some(reference) = node.extension("KHR_lights_punctual")? {
            let light = self.light(&reference.required("light")?)?;
            let name = if node.name().is_empty() { light.name() } else { node.name() };
            desc.lights.push(camera::light(&light, name, &world)?);
        }
        let Some(mesh) = self.document.member(node, "mesh", "meshes")? else {
            return Ok(());
        };
        let pose = self.pose(node, &mesh)?;
        let worlds = match node.extension("EXT_mesh_gpu_instancing")? {
            None => vec![world],
            Some(extension) => {
                let all = instance::placements(self.document, self.buffers, &extension)?;
                all.into_iter().map(|local| world * local).collect()
            }
        };
        self.shapes(node, &mesh, &pose, &worlds)
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
    fn pose(&mut self, node: &Element<'a>, mesh: &Element<'a>) -> Checked<Pose> {
        let weights = match node.get("weights")? {
            Some(own) => own.items()?.map(|w| w.number()).collect::<Checked<Vec<f64>>>()?,
            None => mesh.list("weights")?.iter().map(Element::number).collect::<Checked<_>>()?,
        };
        let skin = match node.get("skin")? {
            None => None,
            Some(reference) => {
                let index = reference.index()?;
                if !self.skins.contains_key(&index) {
                    let element = self.document.item("skins", &reference)?;
                    let skin = Skin::read(self.document, self.buffers, self.nodes, &element)?;
                    self.skins.insert(index, skin);
                }
                Some(index)
            }
        };
        Ok(Pose { weights: weights.into_iter().map(|w| w as f32).collect(), skin })
    }

    /// One shape per primitive and placement.
    fn shapes(
        &mut self,
        node: &Element<'a>,
        mesh: &Element<'a>,
        pose: &Pose,
        worlds: &[DAffine3],
    ) -> Checked<()> {
        let name = if node.name().is_empty() { mesh.name() } else { node.name() };
        let primitives: Vec<Element<'a>> = mesh.required("primitives")?.items()?.collect();
        let asked: Vec<_> = primitives
            .iter()
            .map(|primitive| {
                let look = self.looks.of(self.document, primitive)?;
                let asked = self.meshes.ask(self.document, primitive, look.sets, pose)?;
                Ok(asked.map(|mesh| (mesh, look.material)))
            })
            .map(|asked| self.document.keep(asked).flatten())
            .collect();
        for (place, world) in worlds.iter().enumerate() {
            for (number, (primitive, asked)) in (1..).zip(primitives.iter().zip(&asked)) {
                let Some((mesh, material)) = *asked else { continue };
                if mesh.skin.is_some() && place > 0 {
                    // A skin alone says where its vertices are: all instances would be in one place.
                    self.document.warn(node, "instances of a mesh with a skin are drawn once");
                    continue;
                }
                if mesh.skin.is_none() && world.matrix3.determinant() == 0.0 {
                    self.document.warn(node, "a node is scaled to zero in some direction; it is not drawn");
                    continue;
                }
                let size = size_of::<Pending>() + size_of::<ShapeDesc>() + name.len();
                self.document.spend(primitive, 1, size)?;
                let several = primitives.len() > 1 && !name.is_empty();
                let name = if several { format!("{name}#{number}") } else { name.to_owned() };
                self.pending.push(Pending { mesh, name, world: *world, material });
            }
        }
        Ok(())
    }

    /// Makes the meshes and the shapes that have one.
    fn finish(self, desc: &mut SceneDesc) {
        let made = self.meshes.build(self.document, self.buffers, &self.skins);
        let mut ids = Vec::with_capacity(made.len());
        for mesh in made {
            ids.push(mesh.map(|mesh| {
                desc.meshes.push(mesh);
                Id::new(desc.meshes.len() as u32 - 1)
            }));
        }
        for Pending { mesh, name, world, material } in self.pending {
            let Some(id) = ids.get(mesh.number).copied().flatten() else { continue };
            let skin = mesh.skin.and_then(|skin| self.skins.get(&skin));
            let world = skin.map_or(world, |skin| DAffine3::from_translation(skin.anchor));
            desc.shapes.push(ShapeDesc {
                name,
                source: ShapeSource::Mesh(id),
                world_from_object: Motion::still(world),
                material,
                reverse_orientation: false,
            });
        }
    }
}

/// KHR_node_visibility: hides a node and all below it.
fn is_hidden(node: &Element<'_>) -> Checked<bool> {
    let Some(extension) = node.extension("KHR_node_visibility")? else {
        return Ok(false);
    };
    Ok(extension.get("visible")?.is_some() && !extension.flag("visible")?)
}
