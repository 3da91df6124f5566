//! The scene around the rays, coarse enough to send along: triangles within a budget, whole spheres, endless planes.
mod form;
mod light;
mod quantise;
mod simplify;

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::{
    Object, Piece, Prepared, Scene, View,
    glam::{DAffine3, DVec3},
    math::{Normal3, Point2, Point3, Vector3},
    model::{ShadeCx, Surface},
    spectrum::Basis,
};

use super::number::{Metres, Number, Place, Rgb, rgb};

pub use light::GhostLight;
pub use quantise::{GhostMesh, Triangles};

/// Triangles in all, before copies.
const TRIANGLES: usize = 24_000;
/// Things in all; of more the smallest are left out.
const THINGS: usize = 1500;
/// Placements in all; of more some are left out evenly.
const COPIES: usize = 2500;

/// A scene for the eye.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostScene {
    /// As it was named on the command line.
    pub name: String,
    /// Lower and upper corner of everything finite, in world space.
    pub bounds: [[Metres; 3]; 2],
    /// Who looks.
    pub camera: GhostCamera,
    /// What there is to see.
    pub objects: Vec<GhostObject>,
    /// What gives light.
    pub lights: Vec<GhostLight>,
}

/// A camera, when its shutter opens. Directions have unit length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostCamera {
    /// Where it is.
    pub eye: Place,
    /// Along the rows of the picture.
    pub right: [Number; 3],
    /// Against its columns.
    pub up: [Number; 3],
    /// Into the picture.
    pub look: [Number; 3],
    /// Angle between the left and the right edge, in degrees; 0 if rays are parallel.
    pub fov_x: Number,
    /// Angle between the upper and the lower edge, in degrees.
    pub fov_y: Number,
    /// `perspective` or `orthographic`.
    pub kind: String,
    /// Left, right, upper and lower edge of the picture: tangents right of and above the axis, or of parallel rays metres.
    pub window: [Number; 4],
}

/// Things of the same form and material.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostObject {
    /// The object's name; the first one's if there are several.
    pub name: String,
    /// The names of all copies, if there are several.
    pub names: Vec<String>,
    /// The material: its name, or kind and number.
    pub material: String,
    /// Its colour, more or less: linear RGB.
    pub color: Rgb,
    /// It is a light.
    pub emits: bool,
    /// Its triangles; null for a sphere.
    pub mesh: Option<GhostMesh>,
    /// Where they are: rows of the 3 x 4 matrix world-from-mesh. Empty: where the mesh itself says.
    pub copies: Vec<[Number; 12]>,
    /// It is a whole sphere.
    pub sphere: Option<GhostSphere>,
    /// It goes on without end; the mesh is a part of it.
    pub plane: bool,
}

/// A whole sphere.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostSphere {
    /// Its centre.
    pub center: Place,
    /// Its radius in metres.
    pub radius: Number,
}

/// Triangles on their way into the page, in a space of their own.
#[derive(Clone, Debug, Default, PartialEq)]
struct Soup {
    positions: Vec<DVec3>,
    indices: Vec<[u32; 3]>,
}

/// A thing before it is made smaller.
struct Thing<'a> {
    objects: Vec<&'a Object>,
    form: Ghostly,
    copies: Vec<DAffine3>,
    plane: bool,
}

/// What is drawn of a thing.
enum Ghostly {
    Sphere(GhostSphere),
    Soup(Soup),
}

impl GhostScene {
    /// The scene as it is when the shutter opens.
    pub fn new(name: &str, prepared: &Prepared) -> Self {
        let scene = &prepared.scene;
        let time = scene.view.shutter.interval().min;
        let pieces = scene.pieces(time);
        let bounds = form::bounds(&pieces, time);
        let mut things = gather(scene, &pieces, time, &bounds);
        limit(&mut things);
        let world = scene.view.world_from_render;
        let objects = things.into_iter().map(|thing| object(prepared, thing, world)).collect();
        let corner = |p: Point3| (p.to_f64() + world).to_array().map(Metres);
        let empty = bounds.is_empty();
        Self {
            name: name.to_owned(),
            bounds: [bounds.min, bounds.max]
                .map(|p| if empty { <[Metres; 3]>::default() } else { corner(p) }),
            camera: camera(&scene.view),
            objects,
            lights: light::lights(scene, &bounds),
        }
    }
}

/// Pieces to things: parts of an object and copies of a mesh together.
fn gather<'a>(
    scene: &'a Scene,
    pieces: &[Piece<'_>],
    time: f32,
    bounds: &crate::math::Bounds3,
) -> Vec<Thing<'a>> {
    let mut things: Vec<Thing<'a>> = Vec::new();
    let mut of_mesh: HashMap<(*const crate::scene::Mesh, u32), usize> = HashMap::new();
    let mut of_object: HashMap<usize, usize> = HashMap::new();
    let world = scene.view.world_from_render;
    for piece in pieces {
        let object = scene.object(piece.object);
        let m = DAffine3::from_translation(world) * piece.render_from_object.to_f64();
        if let Some(mesh) = form::mesh(piece) {
            let known = things.len();
            let index = *of_mesh.entry((std::ptr::from_ref(mesh), object.material)).or_insert(known);
            if index == known {
                let form = Ghostly::Soup(form::soup(mesh, time));
                things.push(Thing { objects: Vec::new(), form, copies: Vec::new(), plane: false });
            }
            things[index].objects.push(object);
            things[index].copies.push(m);
            continue;
        }
        if let Some(sphere) = form::sphere(piece, &m) {
            let form = Ghostly::Sphere(sphere);
            things.push(Thing { objects: vec![object], form, copies: Vec::new(), plane: false });
            continue;
        }
        let Some((soup, plane)) = form::tessellated(piece, bounds) else { continue };
        let known = things.len();
        let index = *of_object.entry(piece.object.index()).or_insert(known);
        if index == known {
            let form = Ghostly::Soup(Soup::default());
            things.push(Thing { objects: vec![object], form, copies: vec![DAffine3::IDENTITY], plane });
        }
        if let Ghostly::Soup(all) = &mut things[index].form {
            all.add(&soup, &m);
        }
    }
    things
}

impl Soup {
    fn add(&mut self, other: &Self, m: &DAffine3) {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions.iter().map(|p| m.transform_point3(*p)));
        self.indices.extend(other.indices.iter().map(|t| t.map(|i| i + first)));
    }
}

/// Makes everything fit: fewer things, fewer triangles, fewer copies.
fn limit(things: &mut Vec<Thing<'_>>) {
    let count = |thing: &Thing<'_>| match &thing.form {
        Ghostly::Sphere(_) => 0,
        Ghostly::Soup(soup) => soup.indices.len(),
    };
    if things.len() > THINGS {
        // The largest, in their order.
        let mut sizes: Vec<(f64, usize)> =
            things.iter().enumerate().map(|(i, t)| (form::size(&t.form, &t.copies), i)).collect();
        sizes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let kept: std::collections::HashSet<usize> = sizes.iter().take(THINGS).map(|s| s.1).collect();
        let mut index = 0;
        things.retain(|_| {
            index += 1;
            kept.contains(&(index - 1))
        });
    }
    let counts: Vec<usize> = things.iter().map(count).collect();
    let quota = simplify::quota(&counts, TRIANGLES);
    for thing in things.iter_mut() {
        if let Ghostly::Soup(soup) = &mut thing.form
            && soup.indices.len() > quota
        {
            *soup = simplify::clustered(soup, quota);
        }
    }
    let copies: usize = things.iter().map(|t| t.copies.len()).sum();
    if copies > COPIES {
        let step = copies.div_ceil(COPIES);
        for thing in things.iter_mut() {
            let mut index = 0;
            thing.objects = thing.objects.iter().copied().step_by(step).collect();
            thing.copies.retain(|_| {
                index += 1;
                (index - 1) % step == 0
            });
        }
    }
}

fn object(prepared: &Prepared, thing: Thing<'_>, world: DVec3) -> GhostObject {
    let scene = &prepared.scene;
    let Thing { objects, form, copies, plane } = thing;
    let Some(first) = objects.first() else { return GhostObject::default() };
    let (mesh, sphere) = match form {
        Ghostly::Sphere(sphere) => (None, Some(sphere)),
        Ghostly::Soup(soup) => (Some(GhostMesh::new(&soup)), None),
    };
    let moved = |m: &DAffine3| !m.abs_diff_eq(DAffine3::IDENTITY, 0.0);
    let names = objects.iter().map(|o| o.name.clone()).collect();
    GhostObject {
        name: first.name.clone(),
        names: if objects.len() > 1 { names } else { Vec::new() },
        material: prepared.material_name(first.material),
        color: color(scene, first, world),
        emits: first.light.is_some(),
        mesh,
        copies: if copies.iter().any(moved) { copies.iter().map(rows).collect() } else { Vec::new() },
        sphere,
        plane,
    }
}

fn rows(m: &DAffine3) -> [Number; 12] {
    let columns = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation];
    std::array::from_fn(|i| Number(columns[i % 4][i / 4] as f32))
}

/// The mean colour of a material over some places of a surface that faces the eye.
fn color(scene: &Scene, object: &Object, world: DVec3) -> Rgb {
    let material = &*scene.materials[object.material as usize];
    let cx = ShadeCx { basis: Basis::Rgb, textures: &scene.textures, log: None };
    let mut sum = [0.0f32; 3];
    for i in 0..16u8 {
        let uv = Point2::new(f32::from(i % 4) / 4.0 + 0.125, f32::from(i / 4) / 4.0 + 0.125);
        let p = Point3::from_f64(DVec3::new(f64::from(i % 4), f64::from(i / 4), 0.5) - world);
        let n = Normal3::new(0.0, 0.0, 1.0);
        let mut surface = Surface {
            p,
            p_error: Vector3::ZERO,
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu: Vector3::new(1.0, 0.0, 0.0),
            dpdv: Vector3::new(0.0, 1.0, 0.0),
            vertex_color: [1.0; 4],
            footprint: durer_model::texture::Footprint::POINT,
        };
        let albedo = material.bsdf(&cx, &mut surface, Vector3::new(0.0, 0.0, 1.0)).albedo();
        sum.iter_mut().zip(Basis::Rgb.to_rgb(albedo)).for_each(|(s, v)| *s += v / 16.0);
    }
    rgb(sum)
}

fn camera(view: &View) -> GhostCamera {
    let time = view.shutter.interval().min;
    let placed = view.render_from_camera(time);
    let axis =
        |x: f32, y: f32, z: f32| placed.vector(Vector3::new(x, y, z)).normalize().to_array().map(Number);
    let (w, h) = (view.width as f32, view.height as f32);
    let ray = |x: f32, y: f32| view.ray(Point2::new(x, y), crate::model::camera::Lens::CENTRE, time);
    let edges = [[ray(0.0, h / 2.0), ray(w, h / 2.0)], [ray(w / 2.0, 0.0), ray(w / 2.0, h)]];
    let angle = edges.map(|[a, b]| {
        let (cross, dot) = (a.d.to_f64().cross(b.d.to_f64()).length(), a.d.to_f64().dot(b.d.to_f64()));
        Number(libm::atan2(cross, dot).to_degrees() as f32)
    });
    let parallel = angle[0].0 == 0.0 && angle[1].0 == 0.0;
    let back = placed.inverse();
    let edge = |ray: &crate::math::Ray, axis: usize| {
        let (o, d) = (back.point(ray.o).to_array(), back.vector(ray.d).to_array());
        if parallel { o[axis] } else { d[axis] / d[2] }
    };
    let [x, y] = [0, 1].map(|axis| [edge(&edges[axis][0], axis), edge(&edges[axis][1], axis)]);
    GhostCamera {
        eye: (placed.point(Point3::ZERO).to_f64() + view.world_from_render).to_array().map(Metres),
        right: axis(1.0, 0.0, 0.0),
        up: axis(0.0, 1.0, 0.0),
        look: axis(0.0, 0.0, 1.0),
        fov_x: angle[0],
        fov_y: angle[1],
        kind: if parallel { "orthographic" } else { "perspective" }.to_owned(),
        window: [x[0], x[1], y[0], y[1]].map(Number),
    }
}
