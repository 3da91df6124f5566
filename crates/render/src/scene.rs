//! The compiled scene: frozen, without lifetimes, ready to be asked for hits by any number of threads.
use std::sync::{Arc, OnceLock};

use durer_accel::{
    Accel, Hit, PrimitiveHit, UserGeometry,
    curve::{CurveHit, Curves},
};
use durer_core::{
    Id,
    math::{Normal3, Point2, Point3, Ray, Transform, Vector3},
    spectrum::{Basis, Spectrum},
};
use durer_model::{
    Fill, Hull, Medium, Surface, Volume,
    light::{Extent, Light},
    material::Material,
    shape::{Shape, ShapeHit, mesh_surface},
    texture::{Filters, Footprint, Texture},
};
use durer_scene::Mesh;

use crate::{
    Media, MediumStack, SampleCx, View, emitters::Emitters, light_sampler::LightChooser, probe::Probe,
};

/// A thing with a name and a material: what a hit belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Object {
    /// As the file calls it, else kind and number.
    pub name: String,
    /// Its material.
    pub material: u32,
    /// Turns the normals.
    pub reverse_orientation: bool,
    /// Index of the light that it is, if it shines.
    pub light: Option<u32>,
}

/// What the instances of the kernel stand for.
#[derive(Clone, Debug)]
pub(crate) enum Target {
    /// A still mesh that is used once, in render space.
    Baked(Id<Object>, Arc<Mesh>),
    /// All still shapes; the primitive is the index in [`Scene::shapes`].
    Shapes,
    /// One moving shape: an index in [`Scene::movers`].
    Mover(u32),
    /// A mesh that is used several times, or moves, in its own space.
    Mesh(Id<Object>, Arc<Mesh>),
    /// Segments of curves, with the object of each and which part of it that is.
    Strands(Owners, Arc<Curves>),
}

/// The object of each segment, and which part of it that is.
pub(crate) type Owners = Arc<[(Id<Object>, u32)]>;

impl Target {
    /// Whether it is no mesh.
    fn is_shape(&self) -> bool {
        matches!(self, Self::Shapes | Self::Mover(_) | Self::Strands(..))
    }
}

/// A shape that is no mesh.
#[derive(Debug)]
pub(crate) struct PlacedShape {
    pub(crate) shape: Arc<dyn Shape>,
    pub(crate) object: Id<Object>,
    /// Which part of the object it is.
    pub(crate) part: u32,
    /// Identity for moving shapes: the kernel places them.
    pub(crate) render_from_object: Transform,
    pub(crate) object_from_render: Transform,
}

/// A compiled scene.
#[derive(Debug)]
pub struct Scene {
    /// What compiling found and took.
    pub report: crate::compile::Report,
    /// What hits belong to.
    pub objects: Arc<[Object]>,
    /// Materials, as [`Object::material`] numbers them.
    pub materials: Arc<[Box<dyn Material>]>,
    /// Names of the materials; empty where the description gives none.
    pub material_names: Arc<[String]>,
    /// Textures, in the order of the description.
    pub textures: Arc<[Box<dyn Texture>]>,
    /// What the one that wants footprints most wants of them.
    pub(crate) filters: Filters,
    /// Names of the textures.
    pub texture_names: Arc<[String]>,
    /// Lights.
    pub lights: Arc<[Box<dyn Light>]>,
    /// The lights that rays are cast to. PERF: asked for at every hit (bench render).
    pub(crate) lamps: Arc<[u32]>,
    /// The lights around the scene.
    pub(crate) surroundings: Arc<[u32]>,
    /// The lights that rays see which left: those around the scene, and for paths disks like the sun.
    pub(crate) far: Arc<[u32]>,
    /// By which one of the lights is chosen that rays can be cast to.
    pub(crate) chooser: Arc<LightChooser>,
    /// Those that send particles, once some are sent.
    pub(crate) emitters: OnceLock<Emitters>,
    /// A ball around everything finite.
    pub extent: Extent,
    /// Names of the lights.
    pub light_names: Arc<[String]>,
    /// The camera.
    pub view: View,
    /// The ray-intersection kernel.
    pub accel: Arc<Accel>,
    pub(crate) targets: Arc<[Target]>,
    pub(crate) shapes: Arc<[PlacedShape]>,
    pub(crate) movers: Arc<[PlacedShape]>,
    /// What fills transparent bodies.
    pub media: Arc<Media>,
    /// What floats in bodies or in the air, in the order of the description.
    pub volumes: Arc<[Volume]>,
    /// Names of the volumes.
    pub volume_names: Arc<[String]>,
    /// Whether light goes straight on through anything. PERF: asked by every shadow ray of a path.
    pub(crate) is_passed: bool,
    /// The bodies that the camera is in.
    pub start: MediumStack,
    /// See [`Scene::brightest`]; by how gloss is seen.
    pub(crate) brightest: [OnceLock<Result<f32, String>>; 2],
}

/// The scene's own part of a ray's way: shapes that are no meshes, and what is not there for the ray.
struct Asked<'a> {
    cx: &'a SampleCx<'a>,
    /// The ray in render space.
    ray: &'a Ray,
    /// Whether shapes hide their backs; the kernel hides those of triangles.
    culls: bool,
    /// Whether what is no surface is met where media begin and end.
    bounds: bool,
}

impl UserGeometry for Asked<'_> {
    const FILTERS: bool = true;

    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        self.cx.scene.intersect_shape(instance, prim, ray, t_max)
    }

    /// False in holes, and on the backs of shapes that hide them.
    fn accepts(&self, hit: &Hit) -> bool {
        let Self { cx, ray, culls, bounds } = *self;
        let object = cx.scene.resolve(hit).0;
        let material = cx.scene.material(object);
        if bounds && material.is_nothing() {
            return cx.scene.media.of_object(object).is_some();
        }
        let may_hide = culls && material.is_one_sided() && cx.scene.targets[hit.instance as usize].is_shape();
        if !may_hide && !material.has_holes() {
            return true;
        }
        let surface = cx.scene.surface(ray, hit).1;
        let is_hidden = may_hide && !surface.is_outside(-ray.d);
        let is_hole = || material.has_holes() && material.is_hole(&cx.shade(), &surface.texture_at());
        !(is_hidden || is_hole())
    }
}

impl Scene {
    /// The nearest hit that is there for rays that see: neither a hole nor the back of something one-sided.
    pub fn closest<P: Probe>(&self, cx: &SampleCx<'_>, ray: &Ray, probe: &mut P, id: P::Id) -> Option<Hit> {
        let asked = Asked { cx, ray, culls: true, bounds: false };
        self.accel.query(ray).user(&asked).cull_backs(true).probe(probe, id).closest()
    }

    /// The same, or the nearest place where a medium begins or ends.
    pub(crate) fn closest_boundary<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: &Ray,
        probe: &mut P,
        id: P::Id,
    ) -> Option<Hit> {
        let asked = Asked { cx, ray, culls: true, bounds: true };
        self.accel.query(ray).user(&asked).cull_backs(true).probe(probe, id).closest()
    }

    /// True if anything that is no hole lies on the ray.
    pub fn occluded<P: Probe>(&self, cx: &SampleCx<'_>, ray: &Ray, probe: &mut P, id: P::Id) -> bool {
        self.accel.query(ray).user(&Asked { cx, ray, culls: false, bounds: false }).probe(probe, id).any()
    }

    /// The nearest hit that is no hole, backs of one-sided things included: what a ray to a light meets. With `bounds` also
    /// where media begin and end.
    pub(crate) fn closest_in_the_way<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        ray: &Ray,
        bounds: bool,
        (probe, id): (&mut P, P::Id),
    ) -> Option<Hit> {
        self.accel.query(ray).user(&Asked { cx, ray, culls: false, bounds }).probe(probe, id).closest()
    }

    /// Meets a ray with a shape that is no mesh, for the kernel.
    pub(crate) fn intersect_shape(
        &self,
        instance: u32,
        prim: u32,
        ray: &Ray,
        t_max: f32,
    ) -> Option<PrimitiveHit> {
        let placed = match self.targets[instance as usize] {
            Target::Mover(index) => &self.movers[index as usize],
            _ => &self.shapes[prim as usize],
        };
        let m = &placed.object_from_render;
        let local = Ray { o: m.point(ray.o), d: m.vector(ray.d), t_min: ray.t_min, t_max, time: ray.time };
        let hit = placed.shape.intersect(&local)?;
        Some(PrimitiveHit { t: hit.t, u: hit.u, v: hit.v })
    }

    /// The nearest object that casts a shadow on the ray; unwatched.
    pub fn blocker(&self, cx: &SampleCx<'_>, ray: &Ray) -> Option<Id<Object>> {
        let asked = Asked { cx, ray, culls: false, bounds: false };
        self.accel.query(ray).user(&asked).closest().map(|hit| self.resolve(&hit).0)
    }

    /// The object of a hit, and which of its triangles or parts was hit.
    #[inline]
    pub fn resolve(&self, hit: &Hit) -> (Id<Object>, u32) {
        match &self.targets[hit.instance as usize] {
            Target::Baked(object, _) | Target::Mesh(object, _) => (*object, hit.prim),
            Target::Shapes => {
                let shape = &self.shapes[hit.prim as usize];
                (shape.object, shape.part)
            }
            Target::Mover(index) => {
                let shape = &self.movers[*index as usize];
                (shape.object, shape.part)
            }
            Target::Strands(owners, _) => owners[hit.prim as usize],
        }
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
            Target::Baked(object, mesh) => {
                let surface = mesh_surface(mesh, hit.prim, [hit.u, hit.v], ray.time);
                let reverse = self.object(*object).reverse_orientation;
                (*object, if reverse { surface.reversed() } else { surface })
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
            Target::Strands(owners, curves) => {
                let object = owners[hit.prim as usize].0;
                (object, self.strand_surface(curves, object, ray, hit))
            }
        }
    }

    /// The place of a hit on a curve, in render space.
    fn strand_surface(&self, curves: &Curves, object: Id<Object>, ray: &Ray, hit: &Hit) -> Surface {
        let to_render = self.accel.instance_transform(hit.instance, ray.time);
        let found = CurveHit { t: hit.t, u: hit.u, v: hit.v, n_g: hit.n_g };
        let place = curves.surface(hit.prim, &to_render.inverse().ray(ray), &found);
        let n = Normal3::from(hit.n_g);
        let uv = Point2::new(hit.u, 0.5 * (hit.v + 1.0));
        let own = Surface {
            p: place.p,
            p_error: place.p_error,
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu: place.dpdu,
            // By uv, which crosses the strand once.
            dpdv: place.dpdv * 2.0,
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        };
        own.placed(&to_render, self.object(object).reverse_orientation)
    }

    /// Whether an instance of the kernel consists of triangles.
    pub(crate) fn is_mesh(&self, instance: u32) -> bool {
        !self.targets[instance as usize].is_shape()
    }

    /// Corners of the triangle that was hit at `time` seconds, in render space; `None` if it is none.
    pub fn triangle(&self, hit: &Hit, time: f32) -> Option<[Point3; 3]> {
        let corners = |mesh: &Mesh| mesh.corners(mesh.indices[hit.prim as usize].map(|i| i as usize), time);
        match &self.targets[hit.instance as usize] {
            Target::Baked(_, mesh) => Some(corners(mesh)),
            Target::Mesh(_, mesh) => {
                let to_render = self.accel.instance_transform(hit.instance, time);
                Some(corners(mesh).map(|p| to_render.point(p)))
            }
            Target::Shapes | Target::Mover(_) | Target::Strands(..) => None,
        }
    }

    /// The same scene with another camera, which is neither focused nor told what bodies it is in.
    pub(crate) fn seen_by(&self, view: View) -> Self {
        Self {
            view,
            start: MediumStack::default(),
            brightest: Default::default(),
            emitters: OnceLock::new(),
            extent: self.extent,
            report: self.report,
            objects: Arc::clone(&self.objects),
            materials: Arc::clone(&self.materials),
            material_names: Arc::clone(&self.material_names),
            textures: Arc::clone(&self.textures),
            filters: self.filters,
            texture_names: Arc::clone(&self.texture_names),
            lights: Arc::clone(&self.lights),
            lamps: Arc::clone(&self.lamps),
            surroundings: Arc::clone(&self.surroundings),
            far: Arc::clone(&self.far),
            chooser: Arc::clone(&self.chooser),
            light_names: Arc::clone(&self.light_names),
            accel: Arc::clone(&self.accel),
            targets: Arc::clone(&self.targets),
            shapes: Arc::clone(&self.shapes),
            movers: Arc::clone(&self.movers),
            media: Arc::clone(&self.media),
            volumes: Arc::clone(&self.volumes),
            volume_names: Arc::clone(&self.volume_names),
            is_passed: self.is_passed,
        }
    }

    /// The volume that fills a place, if one does.
    pub fn volume_of(&self, fill: Fill) -> Option<&Volume> {
        match fill {
            Fill::Volume(number) => self.volumes.get(number as usize),
            Fill::Nothing | Fill::Below(_) => None,
        }
    }
    /// What floats somewhere, by name.
    pub fn fill_name(&self, fill: Fill) -> &str {
        let name = match fill {
            Fill::Nothing => None,
            Fill::Volume(number) => self.volume_names.get(number as usize),
            Fill::Below(material) => self.material_names.get(material as usize),
        };
        name.map_or("", String::as_str)
    }
    /// Whether an object is a transparent body.
    pub(crate) fn is_body(&self, object: Id<Object>) -> bool {
        self.medium_of(object).is_some_and(|id| self.media.get(id).hull == Hull::Body)
    }
    /// The first object that has this medium behind its surface.
    pub fn filled_with(&self, medium: Id<Medium>) -> Option<&Object> {
        (0..)
            .zip(self.objects.iter())
            .find(|(i, _)| self.media.of_object(Id::new(*i)) == Some(medium))
            .map(|(_, o)| o)
    }
    /// An object.
    pub fn object(&self, id: Id<Object>) -> &Object {
        &self.objects[id.index()]
    }
    /// The material of an object.
    pub fn material(&self, object: Id<Object>) -> &dyn Material {
        &*self.materials[self.object(object).material as usize]
    }
    /// Whether some shape has no end.
    pub fn is_endless(&self) -> bool {
        self.shapes.iter().chain(self.movers.iter()).any(|placed| !placed.shape.bounds().is_finite())
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
