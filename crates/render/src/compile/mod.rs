//! From a [`SceneDesc`] to a frozen [`Scene`]: every kind is looked up, every parameter checked, every reference
//! resolved, the camera and lights a file lacks are made up, and the kernel is built. After this rendering cannot fail.
//!
//! Placements are composed in f64 and the world is moved so that the camera sits at the origin (the camera-world space
//! of pbrt); coordinates are rounded to f32 once. Scenes far from the origin stay watertight.

mod automatic;
mod camera;
mod displace;
mod geometry;
mod kept;
mod lights;
mod moved;
mod nodes;
mod report;
mod sides;
mod strands;

use std::{
    collections::BTreeMap,
    sync::Arc,
    time::{Duration, Instant},
};

use durer_accel::BuildOptions;
use durer_core::{glam::DAffine3, math::Interval};
use durer_model::{
    Volume,
    light::{Extent, Light},
    material::Material,
    texture::{Filters, Texture},
};
use durer_scene::{Assets, CameraDesc, Diagnostics, Missing, Node, SceneDesc};

use crate::{Media, MediumStack, Scene, View, light_sampler::LightChooser, media};

pub use camera::{Aperture, Focus, LensOptions};
use geometry::Earlier;
use kept::Ground;
pub use kept::Kept;
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
    compiled(desc, (assets, options), Before::Gone, diagnostics).map(|(scene, _)| scene)
}

/// What was compiled before, and whether what is compiled now shall be kept for later.
#[derive(Clone, Copy)]
enum Before<'k> {
    /// Nothing is kept.
    Gone,
    /// This is the first time.
    Nothing,
    /// This is kept, and shapes, meshes and textures are as they were.
    Kept(&'k Kept),
    /// This is kept of another moment.
    Moment(&'k Kept),
}

impl<'k> Before<'k> {
    fn kept(self) -> Option<&'k Kept> {
        match self {
            Self::Kept(kept) | Self::Moment(kept) => Some(kept),
            Self::Gone | Self::Nothing => None,
        }
    }
}

fn compiled(
    desc: &SceneDesc,
    (assets, options): (&dyn Assets, &CompileOptions),
    before: Before<'_>,
    diagnostics: &mut Diagnostics,
) -> Option<(Scene, Option<Kept>)> {
    let names = durer_scene::TextureNames::of(&desc.textures);
    let mut nodes = nodes::Builder { desc, assets, missing: options.missing, names: &names, diagnostics };
    let kept = before.kept();
    let is_described_so = |kept: &&Kept| match before {
        Before::Moment(_) => {
            kept.origin == desc.origin.unwrap_or(kept.origin) && *kept.described == *desc.textures
        }
        _ => true,
    };
    let known = kept.filter(is_described_so);
    let new_textures = |nodes: &mut nodes::Builder<'_>| known.is_none().then(|| nodes.textures());
    let inside = nodes.insides();
    let ((new_textures, mut materials), of_textures) =
        timed(|| (new_textures(&mut nodes), nodes.materials()));
    let (ground, of_shapes) = timed(|| match before {
        Before::Kept(kept) => kept.ground.clone(),
        _ => Arc::new(Ground::new(&mut nodes)),
    });
    let camera = camera::chosen(desc, options, nodes.diagnostics).unwrap_or_else(|| {
        automatic::camera(desc.extent.unwrap_or(ground.bounds), options, nodes.diagnostics)
    });
    let first_place =
        |camera: &CameraDesc| camera.world_from_camera.keys().first().map(|(_, m)| m.translation);
    let origin = kept.map(|kept| kept.origin).or(desc.origin).or_else(|| first_place(&camera));
    let moves = ground.moves || desc.lights.iter().any(|l| !l.world_from_light.is_still());
    let view = camera::view(&mut nodes, &options.lens.given_to(camera.clone()), options, (moves, origin));
    let shutter = view.as_ref().map_or(Interval::point(options.time), |view| view.shutter.interval());
    let world_from_camera = camera.world_from_camera.at(shutter.min.into());
    let origin = origin.unwrap_or(world_from_camera.translation);
    let render_from_world = DAffine3::from_translation(-origin);
    let volumes = nodes.volumes(&render_from_world);
    let all_lights = automatic::lights(desc, &volumes, &world_from_camera, nodes.diagnostics);
    let textures = match (known, new_textures) {
        (Some(kept), _) => Arc::clone(&kept.textures),
        (None, built) => placed(built.unwrap_or_default(), desc, &render_from_world),
    };
    let default_material = materials.len() as u32;
    materials.push(nodes::default_material(nodes.diagnostics)?);
    let materials: Arc<[Box<dyn Material>]> = materials.into();
    let surfaces = lights::Surfaces { textures: &textures, materials: &materials };
    let lights = nodes.lights(&all_lights, (&ground.built, &surfaces), &render_from_world, shutter);
    let placing = geometry::Placing {
        desc,
        render_from_world,
        lights: &lights.of_shapes,
        default_material,
        materials: &materials,
        accel: options.accel,
    };
    let (counts, extent) = (ground.counts, ground.extent(origin));
    // Where nothing is kept, meshes are let go one by one while copies of them are placed.
    let shared = (!matches!(before, Before::Gone)).then(|| Arc::clone(&ground));
    let earlier = match before {
        Before::Gone | Before::Nothing => Earlier::None,
        Before::Kept(kept) => Earlier::Same(&kept.placed),
        Before::Moment(kept) => Earlier::Moment(&kept.placed),
    };
    let (placed, of_placing) = timed(|| placing.place(ground, earlier, diagnostics));
    let (view, placed) = (view?, placed?);
    let mut report = Report::new(counts, &placed, of_textures, of_shapes + of_placing);
    report.texture_bytes = textures.iter().map(|texture| texture.bytes()).sum();
    let measured = materials.iter().filter_map(|material| material.measurement());
    let measured: BTreeMap<_, _> = measured.map(|of| (Arc::as_ptr(of), of.bytes())).collect();
    report.measured_bytes = measured.values().sum();
    if diagnostics.has_errors() {
        return None;
    }
    let sides = media::Media::new((0..).zip(&desc.shapes).map(|(index, shape)| {
        let material = placed.objects[index].material;
        (
            (material, shape.media),
            sides::medium(shape, (material, &*materials[material as usize]), inside.get(material as usize)),
        )
    }));
    let made = Made {
        textures,
        materials,
        volumes,
        media: sides,
        lights,
        placed: placed.clone(),
        view,
        report,
        extent,
    };
    let mut scene = made.scene(desc);
    let pixel_scale = camera::pixel_scale(desc, options);
    camera::focus(&mut scene, pixel_scale, camera.node.at.clone(), diagnostics)?;
    scene.start = media::start(&scene, sides::around(&camera));
    let textures = Arc::clone(&scene.textures);
    let kept = shared.map(|ground| {
        let described = known.map_or_else(|| desc.textures.as_slice().into(), |k| Arc::clone(&k.described));
        Kept { camera, lights: all_lights, moves, origin, ground, placed, textures, described }
    });
    Some((scene, kept))
}

/// The textures where they stand. If one of them could not be built, this scene is never looked at.
fn placed(
    mut textures: Vec<Box<dyn Texture>>,
    desc: &SceneDesc,
    render_from_world: &DAffine3,
) -> Arc<[Box<dyn Texture>]> {
    for (texture, described) in textures.iter_mut().zip(&desc.textures) {
        texture.place(&(*render_from_world * described.world_from_texture));
    }
    textures.into()
}

/// The parts of a scene, compiled.
struct Made {
    textures: Arc<[Box<dyn Texture>]>,
    materials: Arc<[Box<dyn Material>]>,
    volumes: Vec<Volume>,
    media: Media,
    lights: lights::Lights,
    placed: geometry::Placed,
    view: View,
    report: Report,
    /// A ball around everything finite, in render space.
    extent: Extent,
}

impl Made {
    /// The scene, neither focused nor told which bodies the camera is in.
    fn scene(self, desc: &SceneDesc) -> Scene {
        let Self { textures, materials, volumes, media, lights, placed, view, report, extent } = self;
        let lights::Lights { lights, names: light_names, .. } = lights;
        let those = |is: fn(&dyn Light) -> bool| {
            (0..).zip(&lights).filter(|(_, l)| is(&***l)).map(|(i, _)| i).collect()
        };
        Scene {
            brightest: Default::default(),
            emitters: Default::default(),
            extent,
            report,
            objects: placed.objects,
            filters: match desc.options.disable_texture_filtering {
                true => Filters::Never,
                false => textures.iter().map(|texture| texture.filters()).max().unwrap_or(Filters::Never),
            },
            textures,
            texture_names: desc.textures.iter().map(|t| t.name.clone()).collect(),
            material_names: desc.materials.iter().map(|m| m.name.clone()).chain([String::new()]).collect(),
            lamps: those(|light| !light.surrounds()),
            surroundings: those(|light| light.surrounds()),
            far: those(|light| light.surrounds() || light.is_disk()),
            chooser: Arc::new(LightChooser::new(&lights, extent.radius)),
            lights: lights.into(),
            light_names: light_names.into(),
            view,
            accel: placed.accel,
            targets: placed.targets,
            shapes: placed.shapes,
            movers: placed.movers,
            media: Arc::new(media),
            volumes: volumes.into(),
            volume_names: desc.media.iter().map(|medium| medium.name.clone()).collect(),
            is_passed: materials
                .iter()
                .any(|m| m.is_passed() || m.medium().is_some_and(|m| m.priority.is_some())),
            start: MediumStack::default(),
            materials,
        }
    }
}

/// What `work` makes, and how long it takes.
fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let made = work();
    (made, start.elapsed())
}

/// The integrator of a description that asks for none: paths, which heed media if there are any.
pub fn default_integrator(desc: &SceneDesc) -> Node {
    let kind = if desc.media.is_empty() { "path" } else { "volpath" };
    Node::new(kind, durer_scene::Params::new())
}
