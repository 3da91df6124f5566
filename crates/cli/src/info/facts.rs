//! The facts about a scene. Field names are the keys of the JSON form, a contract; `docs/json.md` lists them.
use std::path::Path;

use durer::{
    FORMATS, Prepared, builtin,
    scene::{AnimationDesc, Diagnostics, NamedNode, Node, SceneDesc, Severity, ShapeDesc},
};
use serde::Serialize;

use super::{
    camera::{self, CameraFacts},
    memory::Memory,
    texture::{self, TextureFacts},
};
use crate::{load::Loaded, options::SceneOptions, report::Complaint};

#[derive(Serialize)]
pub(super) struct Info<'a> {
    pub(super) version: u32,
    pub(super) scene: &'a str,
    pub(super) format: Option<&'static str>,
    pub(super) counts: Counts,
    pub(super) bounds: Option<WorldBounds>,
    pub(super) cameras: Vec<CameraFacts<'a>>,
    /// Where the camera used stands and looks.
    #[serde(skip)]
    pub(super) view: Option<([f64; 3], [f64; 3])>,
    pub(super) lights: Vec<Named<'a>>,
    pub(super) materials: Vec<Named<'a>>,
    pub(super) textures: Vec<TextureFacts<'a>>,
    pub(super) animations: Vec<AnimationFacts<'a>>,
    pub(super) variants: &'a [String],
    pub(super) film: Film<'a>,
    /// What the scene asks for.
    pub(super) integrator: Option<&'a str>,
    pub(super) render: Option<Render<'a>>,
    /// The vector instructions that rays walk the hierarchy with.
    pub(super) isa: Option<&'static str>,
    pub(super) memory: Option<Memory>,
    pub(super) seconds: Phases,
    pub(super) doctor: &'a [String],
    pub(super) complaints: Complaints,
    pub(super) diagnostics: Vec<Complaint<'a>>,
}

#[derive(Serialize)]
pub(super) struct Counts {
    pub(super) shapes: usize,
    pub(super) moving_shapes: usize,
    pub(super) meshes: usize,
    /// With those read from files of their own, a shared one once.
    pub(super) meshes_different: Option<u64>,
    pub(super) materials: usize,
    pub(super) textures: usize,
    pub(super) lights: usize,
    pub(super) cameras: usize,
    /// Of all meshes, a shared mesh once.
    pub(super) vertices: Option<u64>,
    /// The same.
    pub(super) triangles_described: Option<u64>,
    /// A shared mesh as often as it is placed.
    pub(super) triangles_placed: Option<u64>,
    /// Placed shapes that are no meshes.
    pub(super) other_shapes: Option<u64>,
    /// In the kernel, a shared mesh once.
    pub(super) triangles: Option<u64>,
    /// In the kernel: each placed mesh, the still shapes that are none as one, each moving one.
    pub(super) instances: Option<u64>,
    pub(super) nodes: Option<u64>,
}

#[derive(Serialize)]
pub(super) struct WorldBounds {
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
}

#[derive(Serialize)]
pub(super) struct Named<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
}

/// Its place in the list is the index that `--animation` takes.
#[derive(Serialize)]
pub(super) struct AnimationFacts<'a> {
    pub(super) name: &'a str,
    /// First and last key, in seconds.
    pub(super) start: f32,
    pub(super) end: f32,
}

impl<'a> AnimationFacts<'a> {
    fn of(animation: &'a AnimationDesc) -> Self {
        Self { name: &animation.name, start: animation.start, end: animation.end }
    }
}

#[derive(Serialize)]
pub(super) struct Film<'a> {
    pub(super) width: Option<u32>,
    pub(super) height: Option<u32>,
    pub(super) spp: Option<u32>,
    pub(super) filename: Option<&'a str>,
}

/// What `durer render` makes of the scene if no option says otherwise.
#[derive(Serialize)]
pub(super) struct Render<'a> {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) spp: u32,
    pub(super) integrator: &'a str,
}

/// Wall time.
#[derive(Serialize)]
pub(super) struct Phases {
    /// Reading and parsing.
    pub(super) load: f64,
    /// All of compilation, which holds the next three.
    pub(super) build: f64,
    pub(super) textures: Option<f64>,
    pub(super) geometry: Option<f64>,
    pub(super) acceleration: Option<f64>,
    /// `load` and `build`.
    pub(super) total: f64,
}

/// How many of `diagnostics` are how bad.
#[derive(Serialize)]
pub(super) struct Complaints {
    pub(super) errors: usize,
    pub(super) warnings: usize,
    pub(super) notes: usize,
}

impl<'a> Info<'a> {
    /// `doctor` is what was found odd in the finished scene; the diagnostics hold it too.
    pub(super) fn new(asked: &'a SceneOptions, loaded: &'a Loaded, doctor: &'a [String]) -> Self {
        let scene = &asked.scene;
        let wishes = asked.wishes();
        let Loaded { imported, prepared, .. } = loaded;
        let desc = &imported.desc;
        let prepared = prepared.as_ref();
        let textures = texture::of(desc, prepared.map(|_| &imported.assets));
        Self {
            version: 1,
            scene,
            format: format(scene),
            counts: Counts::new(desc, prepared),
            bounds: prepared.and_then(world_bounds),
            cameras: camera::of(desc, wishes.camera.as_deref(), wishes.time),
            view: prepared.map(camera::view),
            lights: lights(desc),
            materials: desc.materials.iter().map(|NamedNode { name, node }| named(name, node)).collect(),
            isa: prepared.map(|p| p.scene.accel.isa().name()),
            memory: prepared.map(|p| Memory::new(p, texture::image_bytes(desc, &imported.assets))),
            textures,
            animations: desc.animations.iter().map(AnimationFacts::of).collect(),
            variants: &desc.variants,
            film: Film {
                width: desc.film.width,
                height: desc.film.height,
                spp: desc.film.samples,
                filename: desc.film.filename.as_deref(),
            },
            integrator: desc.integrator.as_ref().map(|n| n.kind.as_str()),
            render: prepared.map(Render::new),
            seconds: Phases::new(loaded),
            doctor,
            complaints: Complaints::new(&imported.diagnostics),
            diagnostics: Complaint::all(imported),
        }
    }
}

impl<'a> Render<'a> {
    fn new(prepared: &'a Prepared) -> Self {
        let view = &prepared.scene.view;
        let spp = prepared.settings.samples;
        Self { width: view.width, height: view.height, spp, integrator: &prepared.integrator_name }
    }
}

/// Lights that are described by themselves, then shapes that shine.
fn lights(desc: &SceneDesc) -> Vec<Named<'_>> {
    let shining = desc.shapes.iter().filter_map(|s| Some(named(&s.name, s.area_light.as_ref()?)));
    desc.lights.iter().map(|l| named(&l.name, &l.node)).chain(shining).collect()
}

fn named<'a>(name: &'a str, node: &'a Node) -> Named<'a> {
    Named { name, kind: &node.kind }
}

/// The format of a file: by its last suffix, and by the one before it where that names a compression.
fn format(scene: &str) -> Option<&'static str> {
    if builtin::find(scene).is_some() {
        return Some("built-in");
    }
    let lower = scene.to_lowercase();
    let suffix = Path::new(lower.strip_suffix(".gz").unwrap_or(&lower)).extension()?.to_str()?.to_owned();
    FORMATS.iter().find(|f| f.suffixes.contains(&suffix.as_str())).map(|f| f.name)
}

impl Counts {
    fn new(desc: &SceneDesc, prepared: Option<&Prepared>) -> Self {
        let built = prepared.map(|p| p.scene.accel.stats());
        let geometry = prepared.map(|p| p.scene.report.geometry);
        let moves = |shape: &&ShapeDesc| !shape.world_from_object.is_still();
        Self {
            shapes: desc.shapes.len(),
            moving_shapes: desc.shapes.iter().filter(moves).count(),
            meshes: desc.meshes.len(),
            meshes_different: geometry.map(|g| g.meshes),
            materials: desc.materials.len(),
            textures: desc.textures.len(),
            lights: lights(desc).len(),
            cameras: desc.cameras.len(),
            vertices: geometry.map(|g| g.vertices),
            triangles_described: geometry.map(|g| g.triangles),
            triangles_placed: geometry.map(|g| g.triangles_placed),
            other_shapes: geometry.map(|g| g.other_shapes),
            triangles: built.map(|b| b.triangles),
            instances: built.map(|b| b.instances),
            nodes: built.map(|b| b.nodes),
        }
    }
}

/// The box around everything finite; `None` if there is nothing.
fn world_bounds(prepared: &Prepared) -> Option<WorldBounds> {
    let bounds = prepared.scene.accel.bounds();
    let view = &prepared.scene.view;
    (!bounds.is_empty())
        .then(|| WorldBounds { min: view.to_world(bounds.min), max: view.to_world(bounds.max) })
}

impl Phases {
    fn new(loaded: &Loaded) -> Self {
        let times = loaded.prepared.as_ref().map(|p| p.scene.report.times);
        Self {
            load: loaded.load.as_secs_f64(),
            build: loaded.build.as_secs_f64(),
            textures: times.map(|t| t.textures.as_secs_f64()),
            geometry: times.map(|t| t.geometry.as_secs_f64()),
            acceleration: times.map(|t| t.acceleration.as_secs_f64()),
            total: (loaded.load + loaded.build).as_secs_f64(),
        }
    }
}

impl Complaints {
    fn new(diagnostics: &Diagnostics) -> Self {
        let count = |severity| diagnostics.iter().filter(|d| d.severity == severity).count();
        Self {
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
            notes: count(Severity::Note),
        }
    }
}
