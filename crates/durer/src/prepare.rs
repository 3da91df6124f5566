//! A description and wishes to something that renders.
use std::collections::BTreeMap;

use durer_accel::BuildOptions;
use durer_core::{math::Vector3, sampling::SamplerKind, spectrum::Basis};
use durer_io::import::Imported;
use durer_model::filter::Filter;
use durer_render::{
    Scene,
    compile::{self, CompileOptions},
    drive::{Antialias, Job, Nesting, Settings},
    film::Tile,
    integrator::{INTEGRATORS, Integrator, Output, PATHS, Show},
};
use durer_scene::{
    Data, Diagnostics, Location, Missing, Node, Param, ParamDefault, ParamSpec, SceneDesc, ValueType,
};

use crate::{Distribution, Options, environment};

/// Pixels of a picture whose size nobody asked for.
const DEFAULT_SIZE: (u32, u32) = (1280, 720);
/// Samples per pixel if nobody asked for a number.
const DEFAULT_SAMPLES: u32 = 64;
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
        match self.integrator.bounded() {
            Some(gloss) => self.scene.brightest(gloss),
            None => Err("paths also follow the light between matte surfaces"),
        }
    }
    /// What the driver takes.
    pub fn job(&self) -> Job<'_> {
        Job { scene: &self.scene, integrator: &*self.integrator, settings: self.settings }
    }
}

/// Compiles a scene; `None` if [`Imported::diagnostics`] holds an error, be it of import or of compilation.
pub fn prepare(imported: &mut Imported, options: &Options) -> Option<Prepared> {
    let Imported { desc, assets, diagnostics, .. } = imported;
    if diagnostics.has_errors() {
        return None;
    }
    let lit;
    let desc = match &options.environment {
        Some(file) => {
            lit = environment::surround(desc, file, assets, diagnostics)?;
            &lit
        }
        None => &*desc,
    };
    let integrator_node = integrator_node(desc, options, diagnostics);
    let integrator = compile::integrator(&integrator_node, diagnostics);
    let size = picture_size(desc, options, diagnostics);
    let (width, height) = size.unwrap_or(DEFAULT_SIZE);
    let compile_options = CompileOptions {
        accel: BuildOptions { engine: options.engine, preset: options.preset, ..BuildOptions::default() },
        missing: options.missing,
        camera: options.camera.clone(),
        time: options.time,
        shutter: options.shutter,
        lens: options.lens,
        ..CompileOptions::new(width, height)
    };
    let scene = compile::compile(desc, &*assets, &compile_options, diagnostics);
    let (mut scene, integrator) = (scene?, integrator?);
    size?;
    check_content(desc, &scene, options.nothing, diagnostics)?;
    let eye = integrator.eye_samples(samples(desc, options, integrator.output(), diagnostics));
    filter(desc, &mut scene, integrator.output(), eye.total, diagnostics);
    check_antialias(options, &scene, &*integrator, diagnostics);
    let settings = Settings {
        samples: eye.total,
        sampler: options.sampler.unwrap_or_else(|| sampler(desc)),
        nesting: Nesting { time: eye.time, lens: eye.lens },
        seed: options.seed,
        threads: options.threads.unwrap_or_else(all_cores),
        crop: options.crop,
        antialias: options.antialias,
    };
    let integrator_name = registered_word(&integrator_node.kind);
    let rules = rules(&integrator_node);
    Some(Prepared {
        scene,
        integrator,
        integrator_name,
        rules,
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
    if built.triangles + built.user_primitives > 0 {
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
    integrator: &dyn Integrator,
    diagnostics: &mut Diagnostics,
) {
    if options.antialias == Antialias::Supersample {
        return;
    }
    if let Output::Data(_) = integrator.output() {
        let message = "data pictures are not antialiased adaptively: their pixels are supersampled";
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

/// Whether the camera has a lens or sees things for a while.
fn is_blurred(scene: &Scene) -> bool {
    !scene.view.shutter.sees_one_moment() || scene.view.camera.lens().is_open()
}

/// The word of the integrator that answers to `kind`, or stands in for it.
fn registered_word(kind: &str) -> String {
    let entry = INTEGRATORS.iter().find(|e| e.answers_to(kind));
    entry.map_or_else(|| compile::default_integrator().kind, |e| e.schema.name.to_owned())
}

/// The integrator's parameters with their values, without those that have none.
fn rules(node: &Node) -> BTreeMap<String, serde_json::Value> {
    let takes = INTEGRATORS.iter().find(|e| e.answers_to(&node.kind)).map_or(&[][..], |e| e.schema.params);
    let rule = |spec: &ParamSpec| {
        let written = node.params.get(spec.name).map(|param| &param.data);
        let value = match (written, spec.default) {
            (Some(Data::Ints(v)), _) if v.len() == 1 => v[0].into(),
            (Some(Data::Floats(v)), _) if v.len() == 1 => short(v[0]),
            (Some(Data::Bools(v)), _) if v.len() == 1 => v[0].into(),
            (Some(Data::Strings(v)), _) if v.len() == 1 => v[0].clone().into(),
            (_, ParamDefault::Int(v)) => v.into(),
            (_, ParamDefault::Float(v)) => short(v),
            (_, ParamDefault::Bool(v)) => v.into(),
            (_, ParamDefault::Text(v)) => v.into(),
            _ => return None,
        };
        Some((rule_name(spec.name), value))
    };
    takes.iter().filter_map(rule).collect()
}

/// A number with no more digits than it has bits.
fn short(v: f32) -> serde_json::Value {
    v.to_string().parse().map_or(serde_json::Value::Null, |v: f64| v.into())
}

/// Keys are read by programs: words apart.
fn rule_name(parameter: &str) -> String {
    let words = [
        ("max", "depth"),
        ("min", "contribution"),
        ("shadow", "rays"),
        ("gloss", "rays"),
        ("time", "samples"),
    ];
    let more = [("lens", "samples"), ("aa", "samples"), ("attenuation", "distance")];
    let apart = words.into_iter().chain(more).find(|(a, b)| parameter.strip_prefix(a) == Some(b));
    apart.map_or_else(|| parameter.to_owned(), |(a, b)| format!("{a}_{b}"))
}

/// Name of every material, or its kind and number.
fn material_names(desc: &SceneDesc) -> Vec<String> {
    let name = |(index, material): (usize, &durer_scene::NamedNode)| match material.name.as_str() {
        "" => format!("{} {index}", material.node.kind),
        name => name.to_owned(),
    };
    desc.materials.iter().enumerate().map(name).collect()
}

/// The integrator the options ask for, else the scene's, else the default; with the options' limits put in.
fn integrator_node(desc: &SceneDesc, options: &Options, diagnostics: &mut Diagnostics) -> Node {
    let of_scene = desc.integrator.clone();
    let mut node = match (&options.integrator, of_scene) {
        (Some(kind), Some(node)) if node.kind == *kind => node,
        (Some(kind), _) => Node::new(kind, durer_scene::Params::new()),
        (None, Some(node)) => node,
        (None, None) => compile::default_integrator(),
    };
    if let Some(other) = compile::stand_in_integrator(&node) {
        // Not of those that we have: the default one stands in, and the wishes are for it.
        let message =
            format!("integrator \"{}\" is not supported yet; \"{}\" is used", node.kind, other.kind);
        diagnostics.warning(node.at.clone(), message);
        node = other;
    }
    if let Some(depth) = desc.usual_depth.filter(|_| PATHS.contains(&registered_word(&node.kind).as_str())) {
        usual(&mut node, "maxdepth", ValueType::Integer, Data::Ints(vec![depth.min(i32::MAX as u32) as i32]));
    }
    let takes = INTEGRATORS.iter().find(|e| e.answers_to(&node.kind)).map_or(&[][..], |e| e.schema.params);
    for (wish, name, ty, data) in wishes(options) {
        if takes.iter().any(|p| p.name == name) {
            node.params.set(Param { name: name.to_owned(), ty, data, at: Location::None });
        } else {
            let takers = INTEGRATORS.iter().filter(|e| e.schema.params.iter().any(|p| p.name == name));
            let takers: Vec<_> = takers.map(|e| e.schema.name).collect();
            let quoted: Vec<_> = takers.iter().map(|name| format!("\"{name}\"")).collect();
            let message =
                format!("{wish} concerns the integrator {} only, not \"{}\"", quoted.join(" or "), node.kind);
            let hint = format!("add --integrator {}", takers.join(" or "));
            diagnostics.warning(Location::None, message).hint(hint);
        }
    }
    node
}

/// Gives `node` a parameter that it does not have.
fn usual(node: &mut Node, name: &str, ty: ValueType, data: Data) {
    if node.params.get(name).is_none() {
        node.params.push(Param { name: name.to_owned(), ty, data, at: Location::None });
    }
}

/// What the options ask of an integrator: a name for people, the parameter and its value.
fn wishes(options: &Options) -> Vec<(&'static str, &'static str, ValueType, Data)> {
    let Distribution { shadow_rays, lights, gloss_rays, time_samples, lens_samples, aa_samples, sampling } =
        options.distribution;
    let text = |word: &str| (ValueType::String, Data::Strings(vec![word.to_owned()]));
    let int = |n: u32| (ValueType::Integer, Data::Ints(vec![n.min(i32::MAX as u32) as i32]));
    let float = |v: f32| (ValueType::Float, Data::Floats(vec![v]));
    let all = [
        ("what is shown of a hit", "show", options.show.map(|show| text(show.word()))),
        ("the depth limit", "maxdepth", options.max_depth.map(int)),
        ("the contribution limit", "mincontribution", options.min_contribution.map(float)),
        ("what transparent things do to shadows", "shadows", options.shadows.map(|s| text(s.word()))),
        ("the number of shadow rays", "shadowrays", shadow_rays.map(int)),
        ("the choice of lights", "lights", lights.map(|l| text(l.word()))),
        ("the number of gloss rays", "glossrays", gloss_rays.map(int)),
        ("the number of moments", "timesamples", time_samples.map(int)),
        ("the number of lens points", "lenssamples", lens_samples.map(int)),
        ("the number of pixel points", "aasamples", aa_samples.map(int)),
        ("the way samples are combined", "sampling", sampling.map(|s| text(s.word()))),
    ];
    all.into_iter().filter_map(|(wish, name, value)| value.map(|(ty, data)| (wish, name, ty, data))).collect()
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

/// Averages of object numbers mean nothing, and a mean depth little: data pictures take one sample unless told.
fn samples(desc: &SceneDesc, options: &Options, output: Output, diagnostics: &mut Diagnostics) -> u32 {
    let asked = options.samples.map(|n| n.max(1));
    match output {
        Output::Data(Show::Id) => {
            if asked.is_some_and(|n| n > 1) {
                diagnostics
                    .warning(Location::None, "object ids cannot be averaged: one sample per pixel is taken");
            }
            1
        }
        Output::Data(_) => asked.unwrap_or(1),
        Output::Radiance => asked.or(desc.film.samples).unwrap_or(DEFAULT_SAMPLES).max(1),
    }
}

fn sampler(desc: &SceneDesc) -> SamplerKind {
    match desc.sampler.as_ref().map(|n| n.kind.as_str()) {
        Some("stratified") if !is_jittered(desc) => SamplerKind::Regular,
        // pbrt's other sampler whose noise is fine-grained.
        Some("pmj02bn") => SamplerKind::ZSobol,
        word => word.and_then(SamplerKind::from_word).unwrap_or_default(),
    }
}

/// What a stratified sampler says of it; it does unless told otherwise.
fn is_jittered(desc: &SceneDesc) -> bool {
    let jitter = desc.sampler.as_ref().and_then(|node| node.params.get("jitter"));
    jitter.is_none_or(|param| param.data != Data::Bools(vec![false]))
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

fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}
