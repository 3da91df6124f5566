//! From a [`SceneDesc`] to a frozen [`Scene`]: every kind is looked up, every parameter checked, every reference
//! resolved, the camera and lights a file lacks are made up, and the kernel is built. After this rendering cannot fail.
//!
//! Placements are composed in f64 and the world is moved so that the camera sits at the origin (the camera-world space
//! of pbrt); coordinates are rounded to f32 once. Scenes far from the origin stay watertight.

mod automatic;
mod camera;
mod geometry;
mod lights;
mod nodes;
mod report;

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use durer_accel::BuildOptions;
use durer_core::{glam::DAffine3, math::Interval};
use durer_model::{
    light::Light,
    material::Material,
    shape::Geometry,
    texture::{Filters, Texture},
};
use durer_scene::{Assets, Diagnostics, Missing, Node, SceneDesc};

use crate::{Media, MediumStack, Scene, integrator::NOT_YET, light_sampler::LightChooser, media};

pub use camera::{Aperture, Focus, LensOptions};
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
    /// What replaces the camera's own lens.
    pub lens: LensOptions,
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
            lens: LensOptions::default(),
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
    let ((mut textures, mut materials), of_textures) = timed(|| (nodes.textures(), nodes.materials()));
    let (shapes, of_shapes) = timed(|| nodes.shapes());
    let counts = GeometryCounts::of(desc, &shapes);
    let bounds = geometry::world_bounds(desc, &shapes);
    let radius = if bounds.is_empty() { 1.0 } else { 0.5 * bounds.diagonal().length() };
    let camera = camera::chosen(desc, options, nodes.diagnostics)
        .unwrap_or_else(|| automatic::camera(bounds, options, nodes.diagnostics));
    let camera = options.lens.given_to(camera);
    let bends = |g: &Geometry| matches!(g, Geometry::Mesh(mesh) if !mesh.is_still());
    let moves = desc.shapes.iter().any(|s| !s.world_from_object.is_still())
        || desc.meshes.iter().any(|mesh| !mesh.is_still())
        || desc.lights.iter().any(|l| !l.world_from_light.is_still())
        || shapes.iter().flatten().any(bends);
    let view = camera::view(&mut nodes, &camera, options, moves);
    let shutter = view.as_ref().map_or(Interval::point(options.time), |view| view.shutter.interval());
    let world_from_camera = camera.world_from_camera.at(shutter.min.into());
    let origin = world_from_camera.translation;
    let lights = automatic::lights(desc, &world_from_camera, nodes.diagnostics);
    let render_from_world = DAffine3::from_translation(-origin);
    // If one of them could not be built, this scene is never looked at.
    for (texture, described) in textures.iter_mut().zip(&desc.textures) {
        texture.place(&(render_from_world * described.world_from_texture));
    }
    let default_material = materials.len() as u32;
    materials.push(nodes::default_material(nodes.diagnostics)?);
    let materials: Arc<[Box<dyn Material>]> = materials.into();
    let textures: Arc<[Box<dyn Texture>]> = textures.into();
    let surfaces = lights::Surfaces { textures: &textures, materials: &materials };
    let lights = nodes.lights(&lights, (&shapes, &surfaces), &render_from_world, shutter);
    let placing = geometry::Placing {
        desc,
        render_from_world,
        lights: &lights.of_shapes,
        default_material,
        materials: &materials,
        accel: options.accel,
    };
    let (placed, of_placing) = timed(|| placing.place(shapes, diagnostics));
    let (view, placed) = (view?, placed?);
    let mut report = Report::new(counts, &placed, of_textures, of_shapes + of_placing);
    report.texture_bytes = textures.iter().map(|texture| texture.bytes()).sum();
    if diagnostics.has_errors() {
        return None;
    }
    let lights::Lights { lights, names: light_names, .. } = lights;
    let those =
        |is: fn(&dyn Light) -> bool| (0..).zip(&lights).filter(|(_, l)| is(&***l)).map(|(i, _)| i).collect();
    let mut scene = Scene {
        brightest: Default::default(),
        report,
        objects: placed.objects,
        filters: textures.iter().map(|texture| texture.filters()).max().unwrap_or(Filters::Never),
        textures,
        texture_names: desc.textures.iter().map(|t| t.name.clone()).collect(),
        material_names: desc.materials.iter().map(|m| m.name.clone()).chain([String::new()]).collect(),
        lamps: those(|light| !light.surrounds()),
        surroundings: those(|light| light.surrounds()),
        far: those(|light| light.surrounds() || light.is_disk()),
        chooser: LightChooser::new(&lights, radius),
        lights,
        light_names,
        view,
        accel: placed.accel,
        targets: placed.targets,
        shapes: placed.shapes,
        movers: placed.movers,
        media: Media::new(&materials),
        is_passed: materials
            .iter()
            .any(|m| m.is_passed() || m.medium().is_some_and(|m| m.priority.is_some())),
        start: MediumStack::default(),
        materials,
    };
    camera::focus(&mut scene, camera::pixel_scale(desc, options), camera.node.at, diagnostics)?;
    scene.start = media::start(&scene);
    Some(scene)
}

/// What `work` makes, and how long it takes.
fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let made = work();
    (made, start.elapsed())
}

/// The integrator of a description that asks for none.
pub fn default_integrator() -> Node {
    Node::new("path", durer_scene::Params::new())
}

/// What is used for an integrator of pbrt that we do not have: paths of as many bounces, which see most of the same light.
pub fn stand_in_integrator(node: &Node) -> Option<Node> {
    let mut params = durer_scene::Params::new();
    if let Some(depth) = node.params.get("maxdepth") {
        params.push(depth.clone());
    }
    NOT_YET.contains(&node.kind.as_str()).then(|| Node::new("path", params))
}
