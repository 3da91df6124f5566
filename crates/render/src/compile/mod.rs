//! From a [`SceneDesc`] to a frozen [`Scene`]: every kind is looked up, every parameter checked, every reference
//! resolved, the camera and lights a file lacks are made up, and the kernel is built. After this rendering cannot fail.
//!
//! Placements are composed in f64 and the world is moved so that the camera sits at the origin (the camera-world space
//! of pbrt); coordinates are rounded to f32 once. Scenes far from the origin stay watertight.

mod automatic;
mod geometry;
mod nodes;
mod report;

use std::time::{Duration, Instant};

use durer_accel::BuildOptions;
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Interval, Transform},
};
use durer_model::{light::Light, shape::Geometry};
use durer_scene::{Assets, CameraDesc, Data, Diagnostics, Location, Missing, Node, SceneDesc};

use crate::{Media, MediumStack, Scene, View, integrator::Integrator, media};

pub use nodes::integrator;
pub use report::{GeometryCounts, Report, Times};

/// How to compile, beyond what the description says.
#[derive(Clone, Debug, PartialEq)]
pub struct CompileOptions {
    /// How rays find their hits.
    pub accel: BuildOptions,
    /// What becomes of missing images.
    pub missing: Missing,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Camera, by name or index; the first if `None`.
    pub camera: Option<String>,
    /// The moment of the picture, in seconds.
    pub time: f32,
    /// Shutter opening and closing, in seconds after `time`; the camera's if `None`.
    pub shutter: Option<Interval>,
}

impl CompileOptions {
    /// Options for a picture of this size.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            accel: BuildOptions::default(),
            missing: Missing::default(),
            width,
            height,
            camera: None,
            time: 0.0,
            shutter: None,
        }
    }
}

/// Compiles a scene; `None` if `diagnostics` got an error.
pub fn compile(
    desc: &SceneDesc,
    assets: &dyn Assets,
    options: &CompileOptions,
    diagnostics: &mut Diagnostics,
) -> Option<Scene> {
    let names = durer_scene::TextureNames::of(&desc.textures);
    let mut nodes = nodes::Builder { desc, assets, missing: options.missing, names: &names, diagnostics };
    let ((textures, mut materials), of_textures) = timed(|| (nodes.textures(), nodes.materials()));
    let (shapes, of_shapes) = timed(|| nodes.shapes());
    let counts = GeometryCounts::of(desc, &shapes);
    let bounds = geometry::world_bounds(desc, &shapes);
    let camera = chosen_camera(desc, options, nodes.diagnostics)
        .unwrap_or_else(|| automatic::camera(bounds, options, nodes.diagnostics));
    let bends = |g: &Geometry| matches!(g, Geometry::Mesh(mesh) if !mesh.is_still());
    let moves = desc.shapes.iter().any(|s| !s.world_from_object.is_still())
        || desc.meshes.iter().any(|mesh| !mesh.is_still())
        || shapes.iter().flatten().any(bends);
    let shutter = shutter(&camera, moves, options);
    let opening = f64::from(shutter.min);
    if shutter.min != shutter.max && !camera.world_from_camera.is_still() {
        let message =
            "moving cameras are not supported yet: it stands still where it is when the shutter opens";
        nodes.diagnostics.warning(camera.node.at.clone(), message);
    }
    let world_from_camera = camera.world_from_camera.at(opening);
    let origin = world_from_camera.translation;
    let view = view(&mut nodes, &camera, &world_from_camera, options, shutter);
    let lights = automatic::lights(desc, &world_from_camera, nodes.diagnostics);
    let lights = nodes.lights(&lights, -origin, shutter);

    let default_material = materials.len() as u32;
    materials.push(nodes::default_material(nodes.diagnostics)?);
    let placing = geometry::Placing {
        desc,
        render_from_world: DAffine3::from_translation(-origin),
        default_material,
        materials: &materials,
        accel: options.accel,
    };
    let (placed, of_placing) = timed(|| placing.place(shapes, diagnostics));
    let (view, placed) = (view?, placed?);
    let report = Report::new(counts, &placed, of_textures, of_shapes + of_placing);
    if diagnostics.has_errors() {
        return None;
    }
    let (lights, light_names): (Vec<Box<dyn Light>>, _) = lights.into_iter().unzip();
    let those =
        |is: fn(&dyn Light) -> bool| (0..).zip(&lights).filter(|(_, l)| is(&***l)).map(|(i, _)| i).collect();
    let mut scene = Scene {
        report,
        objects: placed.objects,
        textures,
        lamps: those(|light| !light.surrounds()),
        surroundings: those(|light| light.surrounds()),
        lights,
        light_names,
        view,
        accel: placed.accel,
        targets: placed.targets,
        shapes: placed.shapes,
        movers: placed.movers,
        media: Media::new(&materials),
        start: MediumStack::default(),
        materials,
    };
    scene.start = media::start(&scene);
    Some(scene)
}

/// What `work` makes, and how long it takes.
fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let made = work();
    (made, start.elapsed())
}

/// The camera the options name, else the first.
fn chosen_camera(
    desc: &SceneDesc,
    options: &CompileOptions,
    diagnostics: &mut Diagnostics,
) -> Option<CameraDesc> {
    let Some(wanted) = &options.camera else { return desc.cameras.first().cloned() };
    let by_name = desc.cameras.iter().find(|c| &c.name == wanted);
    let found = by_name.or_else(|| desc.cameras.get(wanted.parse::<usize>().ok()?));
    if found.is_none() {
        let names: Vec<String> = (0..desc.cameras.len())
            .map(|i| i.to_string())
            .chain(desc.cameras.iter().map(|c| c.name.clone()).filter(|n| !n.is_empty()))
            .collect();
        diagnostics.unknown(Location::None, "camera", wanted, names.iter().map(String::as_str));
    }
    found.cloned()
}

fn view(
    nodes: &mut nodes::Builder<'_>,
    desc: &CameraDesc,
    world_from_camera: &DAffine3,
    options: &CompileOptions,
    shutter: Interval,
) -> Option<View> {
    let mut camera = nodes.camera(&desc.node)?;
    camera.fit(options.width, options.height);
    let rotation = DAffine3 { translation: DVec3::ZERO, ..*world_from_camera };
    let render_from_camera = Transform::from_f64(&rotation);
    if !render_from_camera.is_invertible() {
        nodes.diagnostics.error(desc.node.at.clone(), "the camera's transform cannot be inverted");
        return None;
    }
    Some(View {
        camera,
        render_from_camera,
        world_from_render: world_from_camera.translation,
        width: options.width,
        height: options.height,
        shutter,
    })
}

/// When the shutter is open: as the options say, else as the camera says; a moment if nothing moves.
fn shutter(camera: &CameraDesc, moves: bool, options: &CompileOptions) -> Interval {
    let of_camera = |name: &str, default: f32| match camera.node.params.get(name).map(|p| &p.data) {
        Some(Data::Floats(v)) => v.first().copied().unwrap_or(default),
        _ => default,
    };
    let asked = options.shutter.unwrap_or_else(|| match moves {
        true => Interval::new(of_camera("shutteropen", 0.0), of_camera("shutterclose", 1.0)),
        false => Interval::point(0.0),
    });
    Interval::new(options.time + asked.min, options.time + asked.max)
}

/// The integrator of a description that asks for none.
pub fn default_integrator() -> Node {
    Node::new("whitted", durer_scene::Params::new())
}

/// A boxed integrator, as [`integrator`] builds it.
pub type BoxedIntegrator = Box<dyn Integrator>;
