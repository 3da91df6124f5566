//! A scene as it was prepared, written down: everything that options and habits decided is said in the file.
use durer_io::{
    FileAssets,
    export::{
        Files,
        pbrt::{Film, Plan, Written, write},
    },
};
use durer_render::{
    drive::Antialias,
    integrator::{INTEGRATORS, PATHS},
};
use durer_scene::{Data, Location, Node, Param, ParamDefault, SceneDesc, ValueType};

use crate::{
    Options, Prepared,
    transport::{registered_word, with_usual_depth},
};

/// What is written.
#[derive(Clone, Copy)]
pub struct ToWrite<'a> {
    /// The scene, with a camera.
    pub desc: &'a SceneDesc,
    /// Its files.
    pub assets: &'a FileAssets,
    /// Film, time and lens.
    pub options: &'a Options,
    /// Which of its cameras comes first.
    pub camera: usize,
    /// The scene prepared, if the options leave sizes open.
    pub prepared: &'a Prepared,
}

impl ToWrite<'_> {
    /// The picture that the file asks for.
    pub fn film(&self) -> Film {
        let (options, view) = (self.options, &self.prepared.scene.view);
        Film {
            width: options.width.unwrap_or(view.width),
            height: options.height.unwrap_or(view.height),
            samples: options.samples.or(self.desc.film.samples).unwrap_or(self.prepared.settings.samples),
            sampler: options.sampler.unwrap_or(self.prepared.settings.sampler),
            seed: options.seed.or(self.desc.film.seed).unwrap_or(0),
            crop: self.prepared.settings.crop.map(|crop| [crop.x0, crop.x1, crop.y0, crop.y1]),
        }
    }

    /// The description with the lens of the options and with the depth that the integrator has if nobody says another.
    /// `None` without the camera.
    pub fn said(&self) -> Option<SceneDesc> {
        let (mut desc, options, film) = (self.desc.clone(), self.options, self.film());
        let asked = [desc.film.width, desc.film.height];
        let taken = desc.cameras.get_mut(self.camera)?;
        let scales = options.lens.focus.is_none();
        *taken = options.lens.given_to(taken.clone());
        if let Some(param) = taken.node.params.get("focuspixel").filter(|_| scales) {
            // It speaks of the picture that the scene asked for.
            let by =
                |now: u32, asked: Option<u32>| asked.map_or(1.0, |asked| now as f32 / asked.max(1) as f32);
            let by = [by(film.width, asked[0]), by(film.height, asked[1])];
            let mut param = param.clone();
            if let Data::Floats(pixel) = &mut param.data {
                pixel.iter_mut().zip(by).for_each(|(at, by)| *at *= by);
            }
            taken.node.params.set(param);
        }
        let integrator = desc.integrator.take();
        desc.integrator = integrator.map(|node| with_depth(&desc, node));
        Some(desc)
    }

    /// In pbrt's language.
    ///
    /// # Errors
    /// What it has no words for, each in a sentence.
    pub fn pbrt(&self, files: Files, folder: &str, remarks: &[String]) -> Result<Written, Vec<String>> {
        let desc = self.said().ok_or_else(|| vec!["there is no camera".to_owned()])?;
        let remarks: Vec<String> = remarks.iter().cloned().chain(self.words()).collect();
        let plan = Plan { film: self.film(), camera: self.camera, files, folder, remarks: &remarks };
        write(&desc, self.assets, plan)
    }

    /// Options that no scene file holds, in a sentence.
    pub fn words(&self) -> Option<String> {
        let options = self.options;
        let mut words = String::new();
        if options.time != 0.0 {
            words += &format!(" --time-at {}", options.time);
        }
        if let Some(shutter) = options.shutter {
            words += &format!(" --shutter {},{}", shutter.min, shutter.max);
        }
        if options.antialias != Antialias::Supersample {
            words += " --antialias adaptive";
        }
        (!words.is_empty()).then(|| format!("What scene files do not say: render it with{words}."))
    }
}

/// The integrator with the depth that it has: where a file is silent, that is another one in another format.
fn with_depth(desc: &SceneDesc, node: Node) -> Node {
    let mut node = with_usual_depth(desc, node);
    let word = registered_word(&node.kind);
    if PATHS.contains(&word.as_str()) && node.params.get("maxdepth").is_none() {
        let entry = INTEGRATORS.iter().find(|e| e.schema.name == word);
        let spec = entry.and_then(|e| e.schema.params.iter().find(|p| p.name == "maxdepth"));
        if let Some(ParamDefault::Int(depth)) = spec.map(|spec| spec.default) {
            let (name, at) = ("maxdepth".to_owned(), Location::None);
            node.params.push(Param { name, ty: ValueType::Integer, data: Data::Ints(vec![depth]), at });
        }
    }
    node
}
