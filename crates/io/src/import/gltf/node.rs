//! The node hierarchy: transforms composed in f64, shapes, cameras and lights placed in the world.
use durer_core::{
    glam::{DAffine3, DMat3, DQuat, DVec3},
    math::Motion,
};
use durer_scene::{SceneDesc, ShapeDesc, ShapeSource};

use super::{
    accessor::Accessor,
    buffer::Buffers,
    camera,
    document::Document,
    element::{Checked, Element},
    material,
    mesh::Meshes,
};

/// The index of a node.
pub(super) struct NodeRef<'a> {
    /// Which node.
    pub(super) index: usize,
    /// Who asked for it: what complaints point at.
    pub(super) at: Element<'a>,
}

impl<'a> NodeRef<'a> {
    /// From an element of a list of children.
    pub(super) fn parse(at: Element<'a>) -> Checked<Self> {
        Ok(Self { index: at.index()?, at })
    }
}

/// A node still to be visited.
struct Visit<'a> {
    node: NodeRef<'a>,
    world: DAffine3,
    depth: usize,
}

/// Places what the nodes of one scene carry.
pub(super) struct Walk<'w, 'b, 'a> {
    /// The document.
    pub(super) document: &'b Document<'a>,
    /// Its buffers.
    pub(super) buffers: &'b Buffers<'a>,
    /// Its meshes.
    pub(super) meshes: Meshes<'b, 'a>,
    /// Where shapes, cameras and lights go.
    pub(super) desc: &'w mut SceneDesc,
}

impl<'a> Walk<'_, '_, 'a> {
    /// Visits every node below the scene's roots, in document order.
    pub(super) fn run(&mut self, roots: Vec<NodeRef<'a>>) -> Checked<()> {
        let mut seen = vec![false; self.document.root.list("nodes")?.len()];
        let visit = |world, depth| move |node| Visit { node, world, depth };
        let mut stack: Vec<Visit<'a>> = roots.into_iter().rev().map(visit(DAffine3::IDENTITY, 1)).collect();
        while let Some(Visit { node: NodeRef { index, at }, world: above, depth }) = stack.pop() {
            let Some(node) = self.document.root.list_item("nodes", index)? else {
                return Err(
                    at.fault(format!("refers to /nodes/{index}, but there are only {} nodes", seen.len()))
                );
            };
            if depth > self.document.limits.depth {
                let message = format!("nodes are nested deeper than {}", self.document.limits.depth);
                return Err(at.fault(message));
            }
            match seen.get_mut(index) {
                Some(seen) if !*seen => *seen = true,
                // Two ways to one node are a cycle, or lead to trees that grow exponentially.
                _ => {
                    let message = "this node was reached before: nodes must form a tree, without cycles";
                    return Err(at.fault(message));
                }
            }
            if let Some(extension) = node.extension("KHR_node_visibility")?
                && extension.get("visible")?.is_some()
                && !extension.flag("visible")?
            {
                continue;
            }
            let Some(local) = self.document.keep(local(self.document, &node)) else {
                continue;
            };
            let world = above * local;
            if !world.is_finite() {
                return Err(node.fault("the transforms above this node multiply to infinity"));
            }
            self.document.keep(self.place(&node, &world));
            let children =
                node.list("children")?.into_iter().map(NodeRef::parse).collect::<Checked<Vec<_>>>()?;
            stack.extend(children.into_iter().rev().map(visit(world, depth + 1)));
        }
        Ok(())
    }

    fn place(&mut self, node: &Element<'a>, world: &DAffine3) -> Checked<()> {
        if let Some(camera) = self.document.member(node, "camera", "cameras")? {
            let name = if node.name().is_empty() { camera.name() } else { node.name() };
            self.desc.cameras.push(camera::camera(&camera, name, world)?);
        }
        if let Some(reference) = node.extension("KHR_lights_punctual")? {
            let light = self.light(&reference.required("light")?)?;
            let name = if node.name().is_empty() { light.name() } else { node.name() };
            self.desc.lights.push(camera::light(&light, name, world)?);
        }
        let Some(mesh) = self.document.member(node, "mesh", "meshes")? else {
            return Ok(());
        };
        if node.get("skin")?.is_some() {
            self.document.warn(node, "skins are not applied yet: the mesh is drawn in its bind pose");
        }
        match node.extension("EXT_mesh_gpu_instancing")? {
            None => self.shapes(node, &mesh, world),
            Some(extension) => {
                for instance in self.instances(&extension)? {
                    self.shapes(node, &mesh, &(*world * instance))?;
                }
                Ok(())
            }
        }
    }

    fn light(&self, reference: &Element<'a>) -> Checked<Element<'a>> {
        let lights = match self.document.root.extension("KHR_lights_punctual")? {
            Some(extension) => extension.list_item("lights", reference.index()?)?,
            None => None,
        };
        lights.ok_or_else(|| {
            reference.fault("there is no such light in /extensions/KHR_lights_punctual/lights")
        })
    }

    /// One shape per primitive.
    fn shapes(&mut self, node: &Element<'a>, mesh: &Element<'a>, world: &DAffine3) -> Checked<()> {
        if world.matrix3.determinant() == 0.0 {
            self.document.warn(node, "a node is scaled to zero in some direction; it is not drawn");
            return Ok(());
        }
        let name = if node.name().is_empty() { mesh.name() } else { node.name() };
        let primitives: Vec<Element<'a>> = mesh.required("primitives")?.items()?.collect();
        for (index, primitive) in primitives.iter().enumerate() {
            let made = self
                .meshes
                .mesh(primitive)
                .and_then(|id| Ok(id.zip(Some(material::reference(self.document, primitive)?))));
            let Some(Some((id, material))) = self.document.keep(made) else {
                continue;
            };
            self.document.spend(primitive, 1, size_of::<ShapeDesc>() + size_of::<(f64, DAffine3)>())?;
            let numbered = || {
                if name.is_empty() { String::new() } else { format!("{name}#{}", index + 1) }
            };
            self.desc.shapes.push(ShapeDesc {
                name: if primitives.len() > 1 { numbered() } else { name.to_owned() },
                source: ShapeSource::Mesh(id),
                world_from_object: Motion::still(*world),
                material,
                reverse_orientation: false,
            });
        }
        Ok(())
    }

    /// Placements of EXT_mesh_gpu_instancing, relative to the node.
    fn instances(&self, extension: &Element<'a>) -> Checked<Vec<DAffine3>> {
        let attributes = extension.required("attributes")?;
        let open = |key| match attributes.get(key)? {
            Some(reference) => Accessor::open(self.document, self.buffers, &reference).map(Some),
            None => Ok(None),
        };
        let accessors = [open("TRANSLATION")?, open("ROTATION")?, open("SCALE")?];
        let counts: Vec<usize> = accessors.iter().flatten().map(|a| a.count).collect();
        let count = counts.first().copied().unwrap_or(0);
        if counts.iter().any(|c| *c != count) {
            return Err(attributes.fault("attributes of instances have different lengths"));
        }
        let [translation, rotation, scale] = accessors;
        self.document.spend(extension, count, size_of::<DAffine3>())?;
        let triple = |a: Option<Accessor<'_, 'a>>, default: f32| {
            a.map_or(Ok(vec![[default; 3]; count]), |a| a.floats::<3>(self.document, None))
        };
        let (moves, scales) = (triple(translation, 0.0)?, triple(scale, 1.0)?);
        let turns =
            rotation.map_or(Ok(vec![[0.0, 0.0, 0.0, 1.0]; count]), |a| a.floats::<4>(self.document, None))?;
        let placed = moves.iter().zip(&turns).zip(&scales).map(|((t, r), s)| {
            trs(t.map(f64::from), r.map(f64::from), s.map(f64::from)).filter(DAffine3::is_finite)
        });
        placed.collect::<Option<_>>().ok_or_else(|| attributes.fault("an instance has no valid placement"))
    }
}

fn trs(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> Option<DAffine3> {
    let [x, y, z, w] = rotation;
    let length = (x * x + y * y + z * z + w * w).sqrt();
    let q = DQuat::from_xyzw(x / length, y / length, z / length, w / length);
    let made = DAffine3::from_scale_rotation_translation(DVec3::from(scale), q, DVec3::from(translation));
    (length > 0.0 && length.is_finite()).then_some(made)
}

/// A node's own transform.
fn local(document: &Document<'_>, node: &Element<'_>) -> Checked<DAffine3> {
    if let Some(element) = node.get("matrix")? {
        let m: [f64; 16] = element.numbers()?;
        let [a, b, c, p, d, e, f, q, g, h, i, r, x, y, z, w] = m;
        if [p, q, r, w] != [0.0, 0.0, 0.0, 1.0] {
            document.warn(&element, "the last row of this matrix is not 0 0 0 1; it is ignored");
        }
        let matrix3 = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i));
        return Ok(DAffine3 { matrix3, translation: DVec3::new(x, y, z) });
    }
    let translation = node.numbers_or("translation", [0.0; 3])?;
    let rotation = node.numbers_or("rotation", [0.0, 0.0, 0.0, 1.0])?;
    let scale = node.numbers_or("scale", [1.0; 3])?;
    trs(translation, rotation, scale).ok_or_else(|| node.fault_at("rotation", "a quaternion of length 0"))
}
