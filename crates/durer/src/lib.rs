//! **durer**, a ray tracer that lets you look inside.
//!
//! ```no_run
//! use durer::{Options, prepare};
//!
//! let mut imported = durer::open("scene.glb");
//! let prepared = prepare(&mut imported, &Options::default()).expect("the diagnostics say what is wrong");
//! let rendered = prepared.job().render(Default::default(), &(), &Default::default());
//! let rgb = rendered.film.pixels()[0].mean();
//! ```
//!
//! Data flows one way: [`open`] parses and describes, [`prepare`] compiles, [`Job::render`] renders, [`film::develop`]
//! makes a picture, [`image`] writes it. What goes wrong on the way is in [`Imported::diagnostics`].
#![forbid(unsafe_code)]

pub mod builtin;
pub mod cost;
pub mod doctor;
mod environment;
pub mod explain;
mod glb;
mod layers;
mod options;
mod particles;
pub mod picture;
mod prepare;
mod sequence;
mod settings;
mod studio;
mod transport;
pub mod tree;
mod written;

pub use durer_accel as accel;
pub use durer_core::{Id, glam, math, sampling, spectrum};
pub use durer_draw as draw;
pub use durer_io::{
    FileAssets, export, hush_decoders, image,
    import::{self, FORMATS, Imported},
};
pub use durer_model as model;
pub use durer_render::{
    Chosen, Contribution, Form, ImbalanceTotals, LightSampler, Lit, MediumStack, Object, PathRay, Piece,
    SampleCx, Scene, Value, View, compile,
    drive::{self, Gather, Job, Progress, Rendered, Settings},
    film,
    integrator::{self, Output, Shadows, Show},
    probe,
};
pub use durer_scene as scene;

pub use glb::Glb;
pub use options::{Distribution, Options};
pub use prepare::{Prepared, prepare};
pub use sequence::Sequence;
pub use studio::{Studio, Wanted};
pub use transport::with_usual_depth;
pub use written::ToWrite;

use std::path::Path;

use durer_io::import::Play;
use durer_scene::{Limits, Location};

/// Reads a scene: a file, or a built-in scene by name, at rest. A file of that name in the current folder is not mistaken for
/// the built-in scene, as files have a suffix.
pub fn open(scene: &str) -> Imported {
    open_for(scene, &Options::default())
}

/// Reads a scene as `options` want it: at their moment of their animation, in their materials. Elsewhere [`prepare`] shows
/// what options ask for; of a file that holds an animation this must be known when it is read.
pub fn open_for(scene: &str, options: &Options) -> Imported {
    let mut imported = read(scene, options);
    let Imported { desc, diagnostics, .. } = &mut imported;
    if !diagnostics.has_errors() {
        if let (Play::Named(name), true) = (&options.play, desc.animations.is_empty()) {
            diagnostics.error(Location::None, format!("no animation \"{name}\": the scene has none"));
        }
        if let (Some(name), true) = (&options.variant, desc.variants.is_empty()) {
            let message = format!("no variant \"{name}\": the scene has one set of materials");
            diagnostics.error(Location::None, message);
        }
    }
    imported
}

fn read(scene: &str, options: &Options) -> Imported {
    let path = Path::new(scene);
    if let Some(builtin) = builtin::find(scene) {
        builtin.import()
    } else if path.extension().is_none() && !path.exists() {
        let mut imported = Imported::new("".into(), Limits::default());
        let names = builtin::SCENES.iter().map(|s| s.name);
        imported.diagnostics.unknown(Location::None, "file or built-in scene", scene, names);
        imported
    } else {
        import::open(path, options.reading())
    }
}
