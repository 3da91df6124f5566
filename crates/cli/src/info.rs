//! `durer info`: what is in a scene, what it costs, and what is odd about it.

mod doctor;
mod text;

use std::path::Path;

use durer::{
    FORMATS, Prepared, builtin,
    film::{BLOCK, Pixel},
    scene::{NamedNode, Node, SceneDesc, ShapeDesc},
};
use serde::Serialize;

use crate::{
    exit::{Exit, emit, emit_json},
    load::{Loaded, load},
    options::{SceneOptions, TalkOptions},
    report::{self, Complaint},
};

const EXAMPLES: &str = "\
Examples:
  durer info room.glb
  durer info room.glb --json | jq .counts

JSON: an object with version 1; scene, format, counts, bounds, cameras, lights,
materials, film, integrator, memory, seconds, doctor, diagnostics. What could not
be found out because of errors is null. Within a version keys may be added, none
renamed.";

/// Tells what is in a scene: counts, bounds, names, memory, complaints.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneOptions,
    /// As JSON.
    #[arg(long)]
    json: bool,
}

/// The facts. Field names are the keys of the JSON form: a contract.
#[derive(Serialize)]
struct Info<'a> {
    version: u32,
    scene: &'a str,
    format: Option<&'static str>,
    counts: Counts,
    bounds: Option<WorldBounds>,
    cameras: Vec<Named<'a>>,
    lights: Vec<Named<'a>>,
    materials: Vec<Named<'a>>,
    film: Film<'a>,
    /// What the scene asks for.
    integrator: Option<&'a str>,
    memory: Option<Memory>,
    seconds: Phases,
    doctor: Vec<String>,
    diagnostics: Vec<Complaint<'a>>,
}

#[derive(Serialize)]
struct Counts {
    shapes: usize,
    moving_shapes: usize,
    meshes: usize,
    materials: usize,
    textures: usize,
    lights: usize,
    cameras: usize,
    /// In the kernel, a shared mesh once.
    triangles: Option<u64>,
    /// In the kernel: the merged still meshes, the shapes that are none, and each shared or moving mesh.
    instances: Option<u64>,
    nodes: Option<u64>,
}

#[derive(Serialize)]
struct WorldBounds {
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Serialize)]
struct Named<'a> {
    name: &'a str,
    kind: &'a str,
}

#[derive(Serialize)]
struct Film<'a> {
    width: Option<u32>,
    height: Option<u32>,
    spp: Option<u32>,
    filename: Option<&'a str>,
}

/// Bytes, estimated.
#[derive(Serialize)]
struct Memory {
    hierarchy: u64,
    meshes: u64,
    film: u64,
}

#[derive(Serialize)]
struct Phases {
    load: f64,
    build: f64,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let loaded = load(&args.scene.scene, &args.scene.wishes());
    let failed = loaded.prepared.is_none();
    if failed {
        report::print(&loaded.imported, &TalkOptions { quiet: false, verbose: true });
    }
    let info = Info::new(&args.scene.scene, &loaded);
    if args.json {
        emit_json(&info)?;
    } else if !failed {
        emit(&text::table(&info, &loaded.imported))?;
    }
    Ok(if failed { Exit::Failed } else { Exit::Done })
}

impl<'a> Info<'a> {
    fn new(scene: &'a str, loaded: &'a Loaded) -> Self {
        let Loaded { imported, prepared, load, build } = loaded;
        let desc = &imported.desc;
        let prepared = prepared.as_ref();
        Self {
            version: 1,
            scene,
            format: format(scene),
            counts: Counts::new(desc, prepared),
            bounds: prepared.and_then(world_bounds),
            cameras: desc.cameras.iter().map(|c| named(&c.name, &c.node)).collect(),
            lights: desc.lights.iter().map(|l| named(&l.name, &l.node)).collect(),
            materials: desc.materials.iter().map(|NamedNode { name, node }| named(name, node)).collect(),
            film: Film {
                width: desc.film.width,
                height: desc.film.height,
                spp: desc.film.samples,
                filename: desc.film.filename.as_deref(),
            },
            integrator: desc.integrator.as_ref().map(|n| n.kind.as_str()),
            memory: prepared.map(|p| Memory::new(desc, p)),
            seconds: Phases { load: load.as_secs_f64(), build: build.as_secs_f64() },
            doctor: prepared.map(|p| doctor::findings(desc, p)).unwrap_or_default(),
            diagnostics: Complaint::all(imported),
        }
    }
}

fn named<'a>(name: &'a str, node: &'a Node) -> Named<'a> {
    Named { name, kind: &node.kind }
}

fn format(scene: &str) -> Option<&'static str> {
    if builtin::find(scene).is_some() {
        return Some("built-in");
    }
    let suffix = Path::new(scene).extension()?.to_string_lossy().to_lowercase();
    FORMATS.iter().find(|f| f.suffixes.contains(&suffix.as_str())).map(|f| f.name)
}

impl Counts {
    fn new(desc: &SceneDesc, prepared: Option<&Prepared>) -> Self {
        let built = prepared.map(|p| p.scene.accel.stats());
        let moves = |shape: &&ShapeDesc| !shape.world_from_object.is_still();
        Self {
            shapes: desc.shapes.len(),
            moving_shapes: desc.shapes.iter().filter(moves).count(),
            meshes: desc.meshes.len(),
            materials: desc.materials.len(),
            textures: desc.textures.len(),
            lights: desc.lights.len(),
            cameras: desc.cameras.len(),
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

impl Memory {
    fn new(desc: &SceneDesc, prepared: &Prepared) -> Self {
        let view = &prepared.scene.view;
        let pixels = u64::from(view.width) * u64::from(view.height);
        // The block being filled, and a film per digit of the number of blocks.
        let blocks = prepared.settings.samples.div_ceil(BLOCK);
        let films = 1 + u64::from(u32::BITS - blocks.leading_zeros());
        Self {
            hierarchy: prepared.scene.accel.stats().bytes,
            meshes: desc.meshes.iter().map(|m| mesh_bytes(m)).sum(),
            film: pixels * size_of::<Pixel>() as u64 * films,
        }
    }
}

fn mesh_bytes(mesh: &durer::scene::Mesh) -> u64 {
    let total = size_of_val(mesh.positions.as_slice())
        + size_of_val(mesh.indices.as_slice())
        + size_of_val(mesh.normals.as_slice())
        + size_of_val(mesh.uvs.as_slice())
        + size_of_val(mesh.tangents.as_slice())
        + size_of_val(mesh.colors.as_slice());
    total as u64
}
