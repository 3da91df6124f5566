//! The compiled scene: frozen, without lifetimes, ready to be asked for hits by any number of threads.
use std::sync::Arc;

use durer_accel::{Accel, Hit, PrimitiveHit, UserGeometry};
use durer_core::{
    Id,
    math::{Interval, Point2, Point3, Ray, Transform, Vector3},
    sampling::Sampler,
    spectrum::{Basis, Spectrum},
};
use durer_model::{
    Surface,
    camera::Camera,
    light::Light,
    material::Material,
    shape::{Shape, ShapeHit, mesh_surface},
    texture::Texture,
};
use durer_scene::Mesh;

use crate::{SampleCx, probe::Probe};

/// A thing with a name and a material: what a hit belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Object {
    /// As the file calls it, else kind and number.
    pub name: String,
    /// Its material.
    pub material: u32,
    /// Turns the normals.
    pub reverse_orientation: bool,
}

/// What the instances of the kernel stand for.
#[derive(Clone, Debug)]
pub(crate) enum Target {
    /// All still meshes that are used once, in render space; see [`Scene::merged`].
    Merged,
    /// All still shapes; the primitive is the index in [`Scene::shapes`].
    Shapes,
    /// One moving shape: an index in [`Scene::movers`].
    Mover(u32),
    /// A mesh that is used several times, or moves.
    Mesh(Id<Object>, Arc<Mesh>),
}

/// A mesh of the merged tree, in render space.
#[derive(Debug)]
pub(crate) struct MergedMesh {
    pub(crate) first_triangle: u32,
    pub(crate) object: Id<Object>,
    pub(crate) mesh: Mesh,
}

/// A shape that is no mesh.
#[derive(Debug)]
pub(crate) struct PlacedShape {
    pub(crate) shape: Arc<dyn Shape>,
    pub(crate) object: Id<Object>,
    /// Identity for moving shapes: the kernel places them.
    pub(crate) render_from_object: Transform,
    pub(crate) object_from_render: Transform,
}

/// The camera in its place, and the picture it takes.
#[derive(Debug)]
pub struct View {
    /// The camera.
    pub camera: Box<dyn Camera>,
    /// Its placement.
    pub render_from_camera: Transform,
    /// Render space is the world moved by this vector, so that the camera is at its origin (f64: the move is exact).
    pub world_from_render: durer_core::glam::DVec3,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// When the shutter is open, in seconds.
    pub shutter: Interval,
}

impl View {
    /// The ray through a point of the picture, in pixels from the upper left corner, in render space and of unit length.
    pub fn ray(&self, film: Point2, time: f32, sampler: &Sampler) -> Ray {
        let film = Point2::new(film.x / self.width as f32, film.y / self.height as f32);
        let ray = self.render_from_camera.ray(&self.camera.ray(film, time, sampler));
        // PERF: a placement without scale keeps the length (bench render).
        if (ray.d.length_squared() - 1.0).abs() <= 4.0 * f32::EPSILON {
            ray
        } else {
            Ray { d: ray.d.normalize(), ..ray }
        }
    }
    /// Cosine between unit direction `d` and the camera's axis: depth along the axis per ray length.
    pub fn cos_to_axis(&self, d: Vector3) -> f32 {
        self.render_from_camera.vector(Vector3::new(0.0, 0.0, 1.0)).normalize().dot(d)
    }
    /// A point of render space in world space.
    pub fn to_world(&self, p: Point3) -> [f64; 3] {
        (p.to_f64() + self.world_from_render).to_array()
    }
}

/// A compiled scene.
#[derive(Debug)]
pub struct Scene {
    /// What compiling found and took.
    pub report: crate::compile::Report,
    /// What hits belong to.
    pub objects: Vec<Object>,
    /// Materials, as [`Object::material`] numbers them.
    pub materials: Vec<Box<dyn Material>>,
    /// Textures, in the order of the description.
    pub textures: Vec<Box<dyn Texture>>,
    /// Lights.
    pub lights: Vec<Box<dyn Light>>,
    /// The lights that rays are cast to. PERF: asked for at every hit (bench render).
    pub(crate) lamps: Vec<u32>,
    /// The lights around the scene.
    pub(crate) surroundings: Vec<u32>,
    /// Names of the lights.
    pub light_names: Vec<String>,
    /// The camera.
    pub view: View,
    /// The ray-intersection kernel.
    pub accel: Accel,
    pub(crate) targets: Vec<Target>,
    pub(crate) merged: Vec<MergedMesh>,
    pub(crate) shapes: Vec<PlacedShape>,
    pub(crate) movers: Vec<PlacedShape>,
    /// True if some material has holes, so that hits must be asked about them.
    pub(crate) has_holes: bool,
    /// True if some material is not seen from behind.
    pub(crate) has_backs: bool,
}

impl UserGeometry for Scene {
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        let placed = match self.targets[instance as usize] {
            Target::Mover(index) => &self.movers[index as usize],
            _ => &self.shapes[prim as usize],
        };
        let m = &placed.object_from_render;
        let local = Ray { o: m.point(ray.o), d: m.vector(ray.d), t_min: ray.t_min, t_max, time: ray.time };
        let hit = placed.shape.intersect(&local)?;
        Some(PrimitiveHit { t: hit.t, u: hit.u, v: hit.v })
    }
}

/// A scene some of whose surfaces are cut out by textures, or not seen from behind.
struct Holed<'a> {
    cx: &'a SampleCx<'a>,
    /// The ray in render space.
    ray: &'a Ray,
    /// Whether surfaces hide their backs.
    culls: bool,
}

impl UserGeometry for Holed<'_> {
    const FILTERS: bool = true;

    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        self.cx.scene.intersect(instance, prim, ray, t_max)
    }
    fn accepts(&self, hit: &Hit) -> bool {
        let Self { cx, ray, culls } = *self;
        let (object, prim) = cx.scene.resolve(hit);
        let material = cx.scene.material(object);
        let is_hidden = culls && material.is_one_sided() && cx.scene.is_back(ray, hit, object, prim);
        let is_hole = || {
            material.has_holes() && material.is_hole(&cx.shade(), &cx.scene.surface(ray, hit).1.texture_at())
        };
        !is_hidden && !is_hole()
    }
}

impl Scene {
    /// The nearest hit that is no hole.
    pub fn closest<P: Probe>(&self, cx: &SampleCx<'_>, ray: &Ray, probe: &mut P, id: P::Id) -> Option<Hit> {
        match self.has_holes || self.has_backs {
            true => self.accel.query(ray).user(&Holed { cx, ray, culls: true }).probe(probe, id).closest(),
            false => self.accel.query(ray).user(self).probe(probe, id).closest(),
        }
    }

    /// True if anything that is no hole lies on the ray.
    pub fn occluded<P: Probe>(&self, cx: &SampleCx<'_>, ray: &Ray, probe: &mut P, id: P::Id) -> bool {
        match self.has_holes {
            true => self.accel.query(ray).user(&Holed { cx, ray, culls: false }).probe(probe, id).any(),
            false => self.accel.query(ray).user(self).probe(probe, id).any(),
        }
    }

    /// The nearest object that casts a shadow on the ray; unwatched.
    pub fn blocker(&self, cx: &SampleCx<'_>, ray: &Ray) -> Option<Id<Object>> {
        let holed = Holed { cx, ray, culls: false };
        self.accel.query(ray).user(&holed).closest().map(|hit| self.resolve(&hit).0)
    }

    /// True if the ray met something from behind. The winding of triangles decides, as it does for rasterisers,
    /// whatever the vertex normals say.
    fn is_back(&self, ray: &Ray, hit: &Hit, object: Id<Object>, prim: u32) -> bool {
        let (mesh, d) = match &self.targets[hit.instance as usize] {
            Target::Merged => (&self.merged_at(hit.prim).mesh, ray.d),
            Target::Mesh(_, mesh) => {
                let to_render = self.accel.instance_transform(hit.instance, ray.time);
                (&**mesh, to_render.inverse().vector(ray.d))
            }
            Target::Shapes | Target::Mover(_) => return !self.surface(ray, hit).1.is_outside(-ray.d),
        };
        let [a, b, c] = mesh.corners(mesh.indices[prim as usize].map(|i| i as usize), ray.time);
        let front = (b - a).cross(c - a).dot(d) <= 0.0;
        front == self.object(object).reverse_orientation
    }

    /// The object of a hit, and the hit triangle's number within its mesh.
    pub fn resolve(&self, hit: &Hit) -> (Id<Object>, u32) {
        match &self.targets[hit.instance as usize] {
            Target::Merged => {
                let merged = self.merged_at(hit.prim);
                (merged.object, hit.prim - merged.first_triangle)
            }
            Target::Shapes => (self.shapes[hit.prim as usize].object, 0),
            Target::Mover(index) => (self.movers[*index as usize].object, 0),
            Target::Mesh(object, _) => (*object, hit.prim),
        }
    }

    fn merged_at(&self, prim: u32) -> &MergedMesh {
        &self.merged[self.merged.partition_point(|m| m.first_triangle <= prim) - 1]
    }

    /// The place of a hit that this ray found, in render space.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> (Id<Object>, Surface) {
        let shape_surface = |placed: &PlacedShape, ray: &Ray, to_render: &Transform| {
            let local = placed.object_from_render.ray(ray);
            let local_hit = ShapeHit { t: hit.t, u: hit.u, v: hit.v };
            let reverse = self.object(placed.object).reverse_orientation;
            (placed.object, placed.shape.surface(&local, &local_hit).placed(to_render, reverse))
        };
        match &self.targets[hit.instance as usize] {
            Target::Merged => {
                let merged = self.merged_at(hit.prim);
                let surface =
                    mesh_surface(&merged.mesh, hit.prim - merged.first_triangle, [hit.u, hit.v], ray.time);
                let reverse = self.object(merged.object).reverse_orientation;
                (merged.object, if reverse { surface.reversed() } else { surface })
            }
            Target::Mesh(object, mesh) => {
                let to_render = self.accel.instance_transform(hit.instance, ray.time);
                let surface = mesh_surface(mesh, hit.prim, [hit.u, hit.v], ray.time);
                (*object, surface.placed(&to_render, self.object(*object).reverse_orientation))
            }
            Target::Shapes => {
                let placed = &self.shapes[hit.prim as usize];
                shape_surface(placed, ray, &placed.render_from_object)
            }
            Target::Mover(index) => {
                let to_render = self.accel.instance_transform(hit.instance, ray.time);
                shape_surface(&self.movers[*index as usize], &to_render.inverse().ray(ray), &to_render)
            }
        }
    }

    /// An object.
    pub fn object(&self, id: Id<Object>) -> &Object {
        &self.objects[id.index()]
    }
    /// The material of an object.
    pub fn material(&self, object: Id<Object>) -> &dyn Material {
        &*self.materials[self.object(object).material as usize]
    }
    /// The lights that surround the scene: those with an ambient term, or seen by rays that left.
    pub fn surroundings(&self) -> impl Iterator<Item = &dyn Light> {
        self.surroundings.iter().map(|&i| &*self.lights[i as usize])
    }
    /// Radiance along a ray that left the scene.
    pub fn escaped(&self, basis: Basis, d: Vector3) -> Spectrum {
        self.surroundings().fold(Spectrum::BLACK, |sum, light| sum + light.escaped(basis, d))
    }
}
