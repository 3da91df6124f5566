//! Shapes into the kernel: still meshes used once are moved to where they stand, the rest become instances.
use std::{
    collections::{HashMap, hash_map::Entry},
    sync::{Arc, OnceLock},
    time::{Duration, Instant},
};

use durer_accel::{Accel, AccelBuilder, BuildError, BuildOptions, GeometryId, Placement, Visibility};
use durer_core::{
    Id,
    glam::DAffine3,
    math::{Bounds3, Motion, Point3, Transform, Vector3},
};
use durer_model::{
    material::Material,
    shape::{Geometry, Shape, Strands},
};
use durer_scene::{Diagnostics, Location, Mesh, SceneDesc, ShapeDesc, ShapeSource};
use rayon::prelude::*;

use super::{kept::Ground, report::mesh_bytes, strands};
use crate::{
    Object,
    scene::{PlacedShape, Target},
};

impl Object {
    /// What the `index`-th shape of a description is called.
    pub(super) fn name(shape: &ShapeDesc, index: usize) -> String {
        let kind = match &shape.source {
            ShapeSource::Node(node) => node.kind.as_str(),
            ShapeSource::Mesh(_) => "mesh",
        };
        if shape.name.is_empty() { format!("{kind} {index}") } else { shape.name.clone() }
    }
}

/// What becomes of the shapes of a description.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) accel: Arc<Accel>,
    pub(super) objects: Arc<[Object]>,
    pub(super) targets: Arc<[Target]>,
    pub(super) shapes: Arc<[PlacedShape]>,
    pub(super) movers: Arc<[PlacedShape]>,
    /// How each of the objects is seen.
    pub(super) seen: Arc<[Visibility]>,
    /// What the kernel holds of meshes, in the order of their instances.
    pub(super) held: Arc<[Held]>,
    /// Heap memory of the copies of meshes that were moved to where they stand.
    pub(super) placed_mesh_bytes: u64,
    /// What a ray costs in the trees as they were built; looked at when it is asked for first.
    pub(super) cost: OnceLock<f64>,
    /// What the trees took.
    pub(super) building: Duration,
}

/// How shapes are placed.
pub(super) struct Placing<'a> {
    pub(super) desc: &'a SceneDesc,
    pub(super) render_from_world: DAffine3,
    pub(super) default_material: u32,
    pub(super) materials: &'a [Box<dyn Material>],
    /// The light of each shape.
    pub(super) lights: &'a [Option<u32>],
    pub(super) accel: BuildOptions,
}

/// What was placed earlier.
#[derive(Clone, Copy)]
pub(super) enum Earlier<'k> {
    /// Nothing that could be used.
    None,
    /// The same shapes.
    Same(&'k Placed),
    /// The scene at another moment.
    Moment(&'k Placed),
}

/// A mesh in the kernel.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub(super) object: Id<Object>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) motion: Motion,
    pub(super) geometry: GeometryId,
    pub(super) instance: u32,
    /// Moved to where it stands.
    pub(super) is_baked: bool,
}

/// A mesh on its way into the kernel.
pub(super) struct PendingMesh {
    pub(super) object: Id<Object>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) motion: Motion,
    /// Several shapes use the mesh.
    shared: bool,
    /// It is elsewhere at other moments.
    apart: bool,
}

impl PendingMesh {
    /// Whether it is moved to where it stands.
    pub(super) fn is_baked(&self) -> bool {
        !self.shared && !self.apart && self.mesh.is_still() && self.motion.is_still()
    }
}

/// What the shapes of a description become on their way into the kernel.
#[derive(Default)]
pub(super) struct Pending {
    pub(super) meshes: Vec<PendingMesh>,
    pub(super) shapes: Vec<PlacedShape>,
    pub(super) movers: Vec<(PlacedShape, Motion)>,
    pub(super) strands: Vec<(Id<Object>, Arc<Strands>, Motion)>,
}

impl Pending {
    /// Adds a shape: which part of which object.
    fn shape(&mut self, shape: Arc<dyn Shape>, (object, part): (Id<Object>, u32), motion: &Motion) {
        let place = |m: Transform| PlacedShape {
            shape,
            object,
            part,
            render_from_object: m,
            object_from_render: m.inverse(),
        };
        if motion.is_still() {
            self.shapes.push(place(Transform::from_f64(&motion.at(0.0))));
        } else {
            self.movers.push((place(Transform::IDENTITY), motion.clone()));
        }
    }
}

/// World bounds of everything finite, at the first key of moving things; empty if there is nothing finite. A mesh that is
/// placed again counts by the corners of its box, so that thousands of instances cost no more than their number.
pub(super) fn world_bounds(desc: &SceneDesc, shapes: &[Option<Geometry>]) -> Bounds3 {
    let mut bounds = Bounds3::EMPTY;
    let mut boxes: HashMap<*const Mesh, Option<Bounds3>> = HashMap::new();
    let mut around =
        |mesh: &Arc<Mesh>, place: &dyn Fn(&Point3) -> Point3| match boxes.entry(Arc::as_ptr(mesh)) {
            Entry::Vacant(new) => {
                new.insert(None);
                Bounds3::around(mesh.positions.iter().map(place))
            }
            Entry::Occupied(mut again) => {
                let own = || Bounds3::around(mesh.positions.iter().copied());
                let corners = again.get_mut().get_or_insert_with(own).corners();
                Bounds3::around(corners.iter().map(place))
            }
        };
    for (shape, geometry) in desc.shapes.iter().zip(shapes) {
        let m = shape.world_from_object.at(0.0);
        let place = |p: &Point3| Point3::from_f64(m.transform_point3(p.to_f64()));
        let local = match (geometry, &shape.source) {
            (Some(Geometry::Mesh(mesh)), _) => around(mesh, &place),
            (Some(Geometry::Shapes(parts)), _) => {
                let finite = parts.iter().map(|part| part.bounds()).filter(Bounds3::is_finite);
                finite
                    .fold(Bounds3::EMPTY, |all, b| all.union(Bounds3::around(b.corners().iter().map(place))))
            }
            (Some(Geometry::Strands(strands)), _) => {
                Bounds3::around(strands.bounds().corners().iter().map(place))
            }
            (None, ShapeSource::Mesh(id)) => match desc.meshes.get(id.index()) {
                Some(mesh) => around(mesh, &place),
                None => Bounds3::EMPTY,
            },
            (None, ShapeSource::Node(_)) => Bounds3::EMPTY,
        };
        bounds = bounds.union(local);
    }
    bounds
}

impl Placing<'_> {
    /// Places all shapes and builds the kernel; `None` if there was something to complain about. If all objects are seen
    /// as they were `earlier`, that is used.
    pub(super) fn place(
        &self,
        ground: Arc<Ground>,
        earlier: Earlier<'_>,
        diagnostics: &mut Diagnostics,
    ) -> Option<Placed> {
        let objects: Arc<[Object]> =
            self.desc.shapes.iter().enumerate().map(|(index, shape)| self.object(shape, index)).collect();
        let seen: Arc<[Visibility]> = objects.iter().map(|object| self.seen(object)).collect();
        if let Earlier::Same(kept) = earlier
            && kept.seen == seen
        {
            return Some(Placed { objects, building: Duration::ZERO, ..kept.clone() });
        }
        let geometry = Arc::try_unwrap(ground).map_or_else(|shared| shared.built.clone(), |own| own.built);
        let mut uses: HashMap<*const Mesh, u32> = HashMap::new();
        let geometry: Vec<_> =
            self.desc.shapes.iter().zip(geometry).map(|(s, g)| self.geometry(s, g)).collect();
        for geometry in &geometry {
            if let Some(Geometry::Mesh(mesh)) = geometry {
                *uses.entry(Arc::as_ptr(mesh)).or_default() += 1;
            }
        }
        let mut pending = Pending::default();
        for (index, (shape, geometry)) in self.desc.shapes.iter().zip(geometry).enumerate() {
            let object = Id::new(index as u32);
            let motion = shape.world_from_object.within(&self.render_from_world);
            if motion.keys().iter().any(|(_, m)| !Transform::from_f64(m).is_invertible()) {
                diagnostics.error(at(shape), "the shape's transform cannot be inverted: it flattens space");
                continue;
            }
            match geometry {
                Some(Geometry::Mesh(mesh)) => {
                    let shared = uses.get(&Arc::as_ptr(&mesh)).is_some_and(|&n| n > 1);
                    let apart = self.desc.apart.contains(&index);
                    pending.meshes.push(PendingMesh { object, mesh, motion, shared, apart });
                }
                Some(Geometry::Shapes(parts)) => {
                    let parts = (0..).zip(parts);
                    parts.for_each(|(part, shape)| pending.shape(shape, (object, part), &motion));
                }
                Some(Geometry::Strands(strands)) => pending.strands.push((object, strands, motion)),
                None => {}
            }
        }
        if let Earlier::Moment(kept) = earlier
            && kept.seen == seen
            && let Some(moved) = kept.moved(&pending)
        {
            return Some(Placed { objects, ..moved });
        }
        match self.build(pending, (objects, seen)) {
            Ok(placed) => Some(placed),
            Err(error) => {
                diagnostics.error(Location::None, error);
                None
            }
        }
    }

    /// What a shape is made of: built from its node, or a mesh of the description.
    fn geometry(&self, shape: &ShapeDesc, built: Option<Geometry>) -> Option<Geometry> {
        match shape.source {
            ShapeSource::Mesh(id) => self.desc.meshes.get(id.index()).cloned().map(Geometry::Mesh),
            ShapeSource::Node(_) => built,
        }
    }

    fn object(&self, shape: &ShapeDesc, index: usize) -> Object {
        Object {
            name: Object::name(shape, index),
            material: shape.material.map_or(self.default_material, |m| m.index() as u32),
            reverse_orientation: shape.reverse_orientation,
            light: self.lights.get(index).copied().flatten(),
        }
    }

    /// Hands everything to the kernel; an error says which object it is about.
    fn build(
        &self,
        pending: Pending,
        (objects, all_seen): (Arc<[Object]>, Arc<[Visibility]>),
    ) -> Result<Placed, String> {
        let Pending { meshes, shapes, movers, strands } = pending;
        let (single, several): (Vec<_>, Vec<_>) = meshes.into_iter().partition(PendingMesh::is_baked);
        let baked = bake(single);
        let placed_mesh_bytes = baked.iter().map(|(_, mesh)| mesh_bytes(mesh)).sum();
        let seen = |object: Id<Object>| all_seen[object.index()];
        let about = |object: Id<Object>| {
            let name = &objects[object.index()].name;
            move |error: BuildError| format!("{name}: {error}")
        };
        let whole = |error: BuildError| error.to_string();

        let start = Instant::now();
        let mut kernel = AccelBuilder::new(self.accel);
        let mut targets = Vec::new();
        let mut held = Vec::new();
        for (PendingMesh { object, mesh: source, motion, .. }, mesh) in &baked {
            let geometry = kernel.borrowed_triangles(&mesh.positions, &mesh.indices);
            let geometry = geometry.map_err(about(*object))?;
            let instance = kernel.instance_seen(geometry, Placement::Identity, seen(*object));
            let (object, mesh) = (*object, Arc::clone(mesh));
            let (source, motion) = (Arc::clone(source), motion.clone());
            let instance = instance.map_err(about(object))?;
            held.push(Held { object, mesh: source, motion, geometry, instance, is_baked: true });
            targets.push(Target::Baked(object, mesh));
        }
        if !shapes.is_empty() {
            let bounds = shapes.iter().map(|s| s.render_from_object.bounds(&s.shape.bounds()));
            let geometry = kernel.user(bounds.collect()).map_err(whole)?;
            let is_filtered = shapes.iter().any(|s| shape_seen(seen(s.object)).is_filtered);
            let seen = Visibility { is_filtered, ..Visibility::default() };
            kernel.instance_seen(geometry, Placement::Identity, seen).map_err(whole)?;
            targets.push(Target::Shapes);
        }
        for (index, (mover, motion)) in movers.iter().enumerate() {
            let geometry = kernel.user(vec![mover.shape.bounds()]).map_err(about(mover.object))?;
            let seen = shape_seen(seen(mover.object));
            let placement = Placement::from_motion(motion);
            kernel.instance_seen(geometry, placement, seen).map_err(about(mover.object))?;
            targets.push(Target::Mover(index as u32));
        }
        let mut known: HashMap<*const Mesh, GeometryId> = HashMap::new();
        for PendingMesh { object, mesh, motion, apart, .. } in &several {
            let geometry = match known.entry(Arc::as_ptr(mesh)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    let keys = (0..mesh.keys()).map(|key| mesh.key(key));
                    *new.insert(kernel.keyed_triangles(&mesh.indices, keys).map_err(about(*object))?)
                }
            };
            if *apart {
                kernel.keep_apart(geometry).map_err(about(*object))?;
            }
            let placement = Placement::from_motion(motion);
            let instance =
                kernel.instance_seen(geometry, placement, seen(*object)).map_err(about(*object))?;
            let (object, mesh, motion) = (*object, Arc::clone(mesh), motion.clone());
            targets.push(Target::Mesh(object, Arc::clone(&mesh)));
            held.push(Held { object, mesh, motion, geometry, instance, is_baked: false });
        }
        for strand in strands::gathered(strands) {
            let name = |error: BuildError| format!("{}: {error}", objects[strand.objects[0].index()].name);
            let is_filtered = strand.objects.iter().any(|object| shape_seen(seen(*object)).is_filtered);
            let visible = Visibility { is_filtered, ..Visibility::default() };
            let geometry = kernel.curves((*strand.curves).clone()).map_err(name)?;
            kernel.instance_seen(geometry, strand.placement, visible).map_err(name)?;
            targets.push(Target::Strands(strand.owners, strand.curves));
        }
        let accel = Arc::new(kernel.build().map_err(whole)?);
        let building = start.elapsed();
        let (targets, shapes, held) = (targets.into(), shapes.into(), held.into());
        let (movers, seen) = (movers.into_iter().map(|(mover, _)| mover).collect(), all_seen);
        let cost = OnceLock::new();
        Ok(Placed { accel, objects, targets, shapes, movers, seen, held, cost, placed_mesh_bytes, building })
    }

    /// How the triangles of an object are seen.
    fn seen(&self, object: &Object) -> Visibility {
        // A material that could not be built was complained about.
        let material = self.materials.get(object.material as usize);
        Visibility {
            hides_backs: material.is_some_and(|m| m.is_one_sided()),
            is_reversed: object.reverse_orientation,
            is_filtered: material.is_some_and(|m| m.has_holes() || may_touch(&**m)),
            ..Visibility::default()
        }
    }
}

/// Whether rays look for what its surfaces touch, see `media::crossing`.
fn may_touch(material: &dyn Material) -> bool {
    material.medium().is_some_and(|medium| medium.priority.is_some())
}

/// The same of a shape that is no mesh: the kernel does not know its front.
fn shape_seen(seen: Visibility) -> Visibility {
    Visibility { is_filtered: seen.is_filtered || seen.hides_backs, hides_backs: false, ..seen }
}

/// Still meshes in render space; those without triangles are left out.
fn bake(meshes: Vec<PendingMesh>) -> Vec<(PendingMesh, Arc<Mesh>)> {
    let bake = |m: PendingMesh| {
        let mesh = Arc::new(baked(&m.mesh, &m.motion.at(0.0)));
        (m, mesh)
    };
    meshes.into_par_iter().filter(|m| !m.mesh.indices.is_empty()).map(bake).collect()
}

fn at(shape: &ShapeDesc) -> Location {
    match &shape.source {
        ShapeSource::Node(node) => node.at.clone(),
        ShapeSource::Mesh(_) => Location::None,
    }
}

/// The mesh in render space, each coordinate rounded once. A mirroring turns the triangles, so that counter-clockwise
/// still means outside.
pub(super) fn baked(mesh: &Mesh, m: &DAffine3) -> Mesh {
    let transform = Transform::from_f64(m);
    let mirrored = transform.swaps_handedness();
    let tangent = |t: &[f32; 4]| {
        let v = transform.vector(Vector3::new(t[0], t[1], t[2]));
        [v.x, v.y, v.z, if mirrored { -t[3] } else { t[3] }]
    };
    let place = |p: &Point3| Point3::from_f64(m.transform_point3(p.to_f64()));
    Mesh {
        positions: mesh.positions.iter().map(place).collect(),
        indices: mesh.indices.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect(),
        normals: mesh.normals.iter().map(|n| transform.normal(*n)).collect(),
        uvs: mesh.uvs.clone(),
        second_uvs: mesh.second_uvs.clone(),
        faces: mesh.faces.clone(),
        tangents: mesh.tangents.iter().map(tangent).collect(),
        colors: mesh.colors.clone(),
        time: mesh.time,
        later: Vec::new(),
    }
}
