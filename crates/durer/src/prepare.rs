//! A description and wishes to something that renders.
use std::collections::BTreeMap;

use durer_accel::BuildOptions;
use durer_core::{
    math::Vector3,
    spectrum::{Basis, Carried},
};
use durer_io::import::Imported;
use durer_model::filter::Filter;
use durer_render::{
    Object, Scene,
    compile::{self, CompileOptions},
    drive::{Antialias, Jitter, Job, Passes, Settings},
    film::Tile,
    integrator::{Integrator, Output},
};
use durer_scene::{Diagnostics, Location, Missing, Node, SceneDesc};

use crate::{
    Options, environment, layers, particles, settings,
    transport::{integrator_node, registered_word, rules},
};

/// Pixels of a picture whose size nobody asked for.
const DEFAULT_SIZE: (u32, u32) = (1280, 720);
/// Fewest samples per pixel that a filter with negative lobes copes with.
const LEAST_WITH_LOBES: u32 = 16;
/// Most pixels along an edge: pictures beyond are typing errors.
const LARGEST_EDGE: u32 = 1 << 16;
/// Most pixels of a picture: its sums take 4 GiB.
const MOST_PIXELS: u64 = 1 << 28;

/// A compiled scene with light transport and settings.
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// Light transport.
    pub integrator: Box<dyn Integrator>,
    /// The integrator's registered word.
    pub integrator_name: String,
    /// What the integrator was told: its parameters with their values.
    pub rules: BTreeMap<String, serde_json::Value>,
    /// Name of each of [`Scene::materials`], or its registered word and number.
    pub material_names: Vec<String>,
    /// Samples, seed, threads.
    pub settings: Settings,
}

impl Prepared {
    /// The part of the picture that is rendered.
    pub fn window(&self) -> Tile {
        self.settings.window(self.scene.view.width, self.scene.view.height)
    }
    /// What the material of this number is called.
    pub fn material_name(&self, material: u32) -> String {
        self.material_names.get(material as usize).cloned().unwrap_or_else(|| "default".to_owned())
    }
    /// The largest radiance that any ray of the scene can bring, over all channels, in the mean over random choices. Looked
    /// for when it is asked for first.
    ///
    /// # Errors
    /// Why there is no bound, as a clause.
    pub fn brightest(&self) -> Result<f32, &str> {
        if self.settings.carried == Carried::Wavelengths {
            return Err("bounds are known of red, green and blue, and rays carry wavelengths");
        }
        match self.integrator.facts().bounded {
            Some(gloss) => self.scene.brightest(gloss),
            None => Err("paths also follow the light between matte surfaces"),
        }
    }
    /// What the driver takes.
    pub fn job(&self) -> Job<'_> {
        let (scene, integrator) = (&self.scene, &*self.integrator);
        Job { scene, integrator, settings: self.settings, passes: Passes::default() }
    }
}

/// Compiles a scene; `None` if [`Imported::diagnostics`] holds an error, be it of import or of compilation.
pub fn prepare(imported: &mut Imported, options: &Options) -> Option<Prepared> {
    let Imported { desc, assets, diagnostics, .. } = imported;
    if diagnostics.has_errors() {
        return None;
    }
    let desc = &*environment::within(desc, options, assets, diagnostics)?;
    let integrator = integrator_node(desc, options, diagnostics);
    prepared(desc, &integrator, options, diagnostics, |options, diagnostics| {
        compile::compile(desc, &*assets, options, diagnostics)
    })
}

/// Prepares what `compile` makes of a description that has the surroundings which the options ask for; `None` on errors.
pub(crate) fn prepared(
    desc: &SceneDesc,
    integrator_node: &Node,
    options: &Options,
    diagnostics: &mut Diagnostics,
    compile: impl FnOnce(&CompileOptions, &mut Diagnostics) -> Option<Scene>,
) -> Option<Prepared> {
    let integrator = compile::integrator(integrator_node, diagnostics);
    let asked = picture_size(desc, options, diagnostics);
    let size = asked.unwrap_or(DEFAULT_SIZE);
    let (width, height) = size;
    let compile_options = CompileOptions {
        accel: BuildOptions { engine: options.engine, preset: options.preset, ..BuildOptions::default() },
        missing: options.missing,
        camera: options.camera.clone(),
        time: options.time,
        shutter: options.shutter,
        lens: options.lens,
        ..CompileOptions::new(width, height)
    };
    let scene = compile(&compile_options, diagnostics);
    let (mut scene, integrator) = (scene?, integrator?);
    asked?;
    if integrator.facts().looks {
        check_content(desc, &scene, options.nothing, diagnostics)?;
    }
    let eye =
        integrator.eye_samples(settings::samples(desc, options, integrator.facts().output, diagnostics));
    filter(desc, &mut scene, integrator.facts().output, eye.total, diagnostics);
    let of_film = if desc.film.spectral { Carried::Wavelengths } else { Carried::Rgb };
    let carried = options.carried.unwrap_or(of_film);
    scene.view.layers = layers::kept(desc, options, (&*integrator, carried, size), diagnostics)?;
    check_antialias(options, &scene, (&*integrator, carried), diagnostics);
    particles::check(&scene, &*integrator, diagnostics)?;
    check_walks(&scene, &*integrator, integrator_node, diagnostics);
    let settings = settings::settings(desc, options, &scene.view, (eye, carried));
    check_jitter(desc, &settings, diagnostics);
    Some(Prepared {
        scene,
        integrator,
        integrator_name: registered_word(&integrator_node.kind),
        rules: rules(integrator_node),
        material_names: material_names(desc),
        settings,
    })
}

/// Complains about a scene without geometry; `None` if that shall be an error and no sky of its own can be seen either.
fn check_content(
    desc: &SceneDesc,
    scene: &Scene,
    nothing: Missing,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let built = scene.accel.stats();
    if built.triangles + built.user_primitives + built.curve_segments > 0 {
        return Some(());
    }
    // Without lights of its own a scene is lit by ours, which shows nothing of the file.
    if !desc.lights.is_empty() && has_visible_sky(scene) {
        diagnostics.warning(Location::None, "the scene has no shapes: only its sky can be seen");
        return Some(());
    }
    let found = match desc.shapes.len() {
        0 => "the scene has no shapes".to_owned(),
        1 => "the scene's only shape has no triangle".to_owned(),
        n => format!("none of the scene's {n} shapes has a triangle"),
    };
    let message = format!("nothing to draw: {found}, and no sky of its own");
    let hint = "surfaces are drawn; points, lines and objects that the scene does not use are not";
    match nothing {
        Missing::Refuse => diagnostics.error(Location::None, message).hint(hint),
        Missing::Warn => diagnostics.warning(Location::None, message).hint(hint),
    };
    (nothing == Missing::Warn).then_some(())
}

/// Whether light comes from somewhere behind everything, in one of many directions.
fn has_visible_sky(scene: &Scene) -> bool {
    const DIRECTIONS: u32 = 256;
    (0..DIRECTIONS).any(|i| {
        // A spiral from pole to pole.
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(DIRECTIONS);
        let (radius, angle) = ((1.0 - z * z).sqrt(), f64::from(i) * 2.399_963);
        let d = Vector3::new((radius * angle.cos()) as f32, (radius * angle.sin()) as f32, z as f32);
        Basis::Rgb.to_rgb(scene.escaped(Basis::Rgb, d)).iter().any(|&v| v > 0.0)
    })
}

/// Says what adaptive antialiasing does not do.
fn check_antialias(
    options: &Options,
    scene: &Scene,
    (integrator, carried): (&dyn Integrator, Carried),
    diagnostics: &mut Diagnostics,
) {
    if options.antialias == Antialias::Supersample {
        return;
    }
    if carried == Carried::Wavelengths {
        let message = "adaptive antialiasing compares single samples, and four wavelengths are no colour: pixels are \
                       supersampled";
        diagnostics.warning(Location::None, message);
        return;
    }
    if let Output::Data(_) = integrator.facts().output {
        let message = "data pictures are not antialiased adaptively: their pixels are supersampled";
        diagnostics.warning(Location::None, message);
        return;
    }
    if integrator.facts().gathering.is_some() {
        let message = "adaptive antialiasing looks at each place once, and photons of one pass say little: pixels are \
                       supersampled";
        diagnostics.warning(Location::None, message);
        return;
    }
    if scene.view.layers.is_some() {
        let message = "what the film keeps beside colours is of samples of pixels: they are supersampled";
        diagnostics.warning(Location::None, message);
        return;
    }
    if options.samples.is_some() {
        let message =
            "adaptive antialiasing takes as many samples as it needs: a number per pixel changes nothing";
        diagnostics.warning(Location::None, message).hint("--aa-depth and --aa-threshold say how many");
    }
    if is_blurred(scene) {
        let message = "adaptive antialiasing looks at each place from one point of the lens, at one moment: \
                       supersampling suits blurred pictures better";
        diagnostics.note(Location::None, message);
    }
}

/// Says what options leave out in vain.
fn check_jitter(desc: &SceneDesc, settings: &Settings, diagnostics: &mut Diagnostics) {
    if settings.wavelengths == Jitter::Middle && settings.carried == Carried::Rgb {
        let message = "\"disablewavelengthjitter\" changes nothing: rays carry red, green and blue";
        diagnostics.note(Location::None, message).hint("--spectral has them carry wavelengths");
    }
    if desc.options.disable_pixel_jitter && settings.antialias != Antialias::Supersample {
        let message = "\"disablepixeljitter\" does not move the places that adaptive antialiasing looks at";
        diagnostics.warning(Location::None, message).hint("leave --antialias out");
    }
}

/// Says what is drawn as a matte body because the integrator does not follow light below its surface.
fn check_walks(scene: &Scene, integrator: &dyn Integrator, node: &Node, diagnostics: &mut Diagnostics) {
    let facts = integrator.facts();
    if facts.walks || facts.output != Output::Radiance {
        return;
    }
    let is_walked = |object: &&Object| scene.materials[object.material as usize].is_walked();
    let mut names: Vec<&str> = Vec::new();
    for object in scene.objects.iter().filter(is_walked) {
        let name = scene.material_names[object.material as usize].as_str();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let Some((first, others)) = names.split_first() else { return };
    let more = if others.is_empty() { String::new() } else { format!(" (and {} more)", others.len()) };
    let message = format!(
        "integrator \"{}\" does not follow light below surfaces: material \"{first}\"{more} is drawn as a matte body \
         under a coat",
        node.kind
    );
    diagnostics.warning(node.at.clone(), message).hint("take \"path\" or \"volpath\"");
}

/// Whether the camera has a lens or sees things for a while.
fn is_blurred(scene: &Scene) -> bool {
    !scene.view.shutter.sees_one_moment() || scene.view.camera.lens().is_open()
}

/// Name of every material, or its kind and number.
fn material_names(desc: &SceneDesc) -> Vec<String> {
    let name = |(index, material): (usize, &durer_scene::NamedNode)| match material.name.as_str() {
        "" => format!("{} {index}", material.node.kind),
        name => name.to_owned(),
    };
    desc.materials.iter().enumerate().map(name).collect()
}

fn picture_size(desc: &SceneDesc, options: &Options, diagnostics: &mut Diagnostics) -> Option<(u32, u32)> {
    let scene = (desc.film.width.unwrap_or(DEFAULT_SIZE.0), desc.film.height.unwrap_or(DEFAULT_SIZE.1));
    let aspect = f64::from(scene.0) / f64::from(scene.1.max(1));
    let (width, height) = match (options.width, options.height) {
        (Some(w), Some(h)) => (w, h),
        (Some(w), None) => (w, (f64::from(w) / aspect).round() as u32),
        (None, Some(h)) => ((f64::from(h) * aspect).round() as u32, h),
        (None, None) => scene,
    };
    let scaled = |v: u32| match options.scale {
        Some(scale) => (f64::from(v) * f64::from(scale)).round() as u32,
        None => v,
    };
    let size = (scaled(width), scaled(height));
    if size.0 == 0 || size.1 == 0 || size.0 > LARGEST_EDGE || size.1 > LARGEST_EDGE {
        let message = format!("a picture of {} x {} pixels cannot be rendered", size.0, size.1);
        diagnostics
            .error(Location::None, message)
            .hint(format!("each edge may have 1 to {LARGEST_EDGE} pixels"));
        return None;
    }
    let pixels = u64::from(size.0) * u64::from(size.1);
    if pixels > MOST_PIXELS {
        let message = format!("a picture of {} x {} has {pixels} pixels", size.0, size.1);
        diagnostics.error(Location::None, message).hint(format!("at most {MOST_PIXELS} fit in memory"));
        return None;
    }
    Some(size)
}

/// Data pictures show their own pixels; and too few samples of either sign may cancel each other.
fn filter(desc: &SceneDesc, scene: &mut Scene, output: Output, samples: u32, diagnostics: &mut Diagnostics) {
    let named = desc.filter.as_ref();
    if let Output::Data(_) = output {
        scene.view.filter = Filter::pixel();
    } else if scene.view.filter.has_negative_lobes() && (2..LEAST_WITH_LOBES).contains(&samples) {
        let message = format!("this filter has negative lobes: {samples} samples may cancel each other");
        let at = named.map_or(Location::None, |node| node.at.clone());
        diagnostics.warning(at, message).hint(format!("take {LEAST_WITH_LOBES} samples or more"));
    }
}
