//! Options that say which scene is looked at, from where, and when.
use std::path::PathBuf;

use clap::Args;
use durer::{
    Options,
    compile::{Aperture, Focus, LensOptions},
    import::Play,
    scene::Missing,
};

use crate::value::{Exposure, definition, film_point, finite, not_negative, positive, shutter};

/// Which scene, from which camera, when.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Scene")]
pub(crate) struct SceneOptions {
    /// A scene file (glTF, pbrt, Mitsuba, OBJ, PLY or STL), or the name of a built-in scene (see `durer scenes`).
    #[arg(default_value = "whitted", help_heading = None)]
    pub(crate) scene: String,
    /// Camera, by name or index [default: the first, or one that frames everything].
    #[arg(long, value_name = "NAME_OR_INDEX", allow_negative_numbers = true)]
    pub(super) camera: Option<String>,
    /// A picture that surrounds the scene and lights it instead of its own sky: EXR, HDR, PFM, PNG, JPEG, BMP
    /// or TGA, twice as wide as high or, as pbrt-v4 has it, square. Its top is +y, its middle +x.
    #[arg(long, value_name = "FILE")]
    pub(super) env: Option<PathBuf>,
    /// The set of materials to wear, by name or index, of a glTF file that has several (`durer info` lists them) [default:
    /// the file's own].
    #[arg(long, value_name = "NAME_OR_INDEX", allow_negative_numbers = true)]
    pub(super) variant: Option<String>,
    /// A value for a name that a scene of Mitsuba leaves open, as in -Dspp=64; again for each name.
    #[arg(long = "define", short = 'D', value_name = "NAME=VALUE", value_parser = definition)]
    pub(super) define: Vec<(String, String)>,
    /// The folder that the scene may read files from: its own, or one above it [default: its own].
    #[arg(long, value_name = "FOLDER")]
    pub(super) root: Option<PathBuf>,
    /// Which animation of a glTF file to play, by name or index, or all (`durer info` lists them) [default: the first
    /// with --time-at or --shutter, else none: the scene at rest].
    #[arg(long, value_name = "NAME_OR_INDEX", allow_negative_numbers = true)]
    pub(super) animation: Option<String>,
    /// The moment of the picture [default: 0].
    #[arg(long, value_name = "SECONDS", value_parser = finite, allow_negative_numbers = true)]
    pub(super) time_at: Option<f32>,
    /// Shutter opening and closing, in seconds after --time-at, or how long it is open; with an f behind, as in 0.5f or
    /// -0.25,0.25f, in frames of --fps [default: the scene's, else an instant].
    #[arg(long, value_name = "OPEN,CLOSE", value_parser = shutter, allow_hyphen_values = true)]
    pub(super) shutter: Option<Exposure>,
    /// Frames in a second [default: 24].
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub(super) fps: Option<f32>,
    /// Radius of the lens in metres; 0 has everything in focus [default: the camera's].
    #[arg(long, value_name = "RADIUS_M", value_parser = not_negative, conflicts_with = "fnumber")]
    pub(super) aperture: Option<f32>,
    /// Width of the lens as focal length by diameter [default: the camera's].
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub(super) fnumber: Option<f32>,
    /// Depth of the plane in focus, in metres [default: the camera's].
    #[arg(long, value_name = "DISTANCE_M", value_parser = positive, conflicts_with = "focus_pixel")]
    pub(super) focus: Option<f32>,
    /// Focus on what is seen there, in pixels from the upper left corner.
    #[arg(long, value_name = "X,Y", value_parser = film_point)]
    pub(super) focus_pixel: Option<[f32; 2]>,
    /// A missing or damaged texture or mesh is an error, except of OBJ and PLY files, where it is a warning. With this it
    /// is a warning everywhere, and a visible placeholder is drawn in place of a texture.
    #[arg(long)]
    pub(super) lenient: bool,
}

impl SceneOptions {
    /// The wishes in the library's terms.
    pub(crate) fn wishes(&self) -> Options {
        Options {
            camera: self.camera.clone(),
            environment: self.env.clone(),
            play: self.play(),
            variant: self.variant.clone(),
            definitions: self.define.clone(),
            root: self.root.clone(),
            time: self.time_at.unwrap_or(0.0),
            shutter: self.shutter.map(|shutter| shutter.seconds(self.fps())),
            lens: self.lens(),
            missing: if self.lenient { Missing::Warn } else { Missing::Refuse },
            ..Options::default()
        }
    }

    /// Frames in a second.
    pub(crate) fn fps(&self) -> f32 {
        const USUAL: f32 = 24.0;
        self.fps.unwrap_or(USUAL)
    }
    /// The moment of the picture, or of the first of several.
    pub(crate) fn start(&self) -> f32 {
        self.time_at.unwrap_or(0.0)
    }
    /// The same scene at another moment, of the first animation unless another is named.
    pub(crate) fn at(&self, time: f32) -> Self {
        Self { time_at: Some(time), ..self.clone() }
    }

    /// Who names a moment means one of the animation.
    fn play(&self) -> Play {
        match &self.animation {
            Some(name) => Play::Named(name.clone()),
            None if self.time_at.is_some() || self.shutter.is_some() => Play::First,
            None => Play::Rest,
        }
    }

    /// Option names with their values, as they were given.
    pub(super) fn words(&self) -> Vec<(&'static str, Option<String>)> {
        let Self {
            scene: _,
            camera,
            env,
            variant,
            define,
            root,
            animation,
            time_at,
            shutter,
            fps: _,
            aperture,
            fnumber,
            focus,
            focus_pixel,
            lenient: _,
        } = self;
        let definitions = define.iter().map(|(name, value)| ("define", Some(format!("{name}={value}"))));
        let others = [
            ("camera", camera.clone()),
            ("root", root.as_ref().map(|f| f.display().to_string())),
            ("env", env.as_ref().map(|f| f.display().to_string())),
            ("variant", variant.clone()),
            ("animation", animation.clone()),
            ("time-at", time_at.map(|v| v.to_string())),
            ("shutter", shutter.map(|s| s.seconds(self.fps())).map(|s| format!("{},{}", s.min, s.max))),
            ("aperture", aperture.map(|v| v.to_string())),
            ("fnumber", fnumber.map(|v| v.to_string())),
            ("focus", focus.map(|v| v.to_string())),
            ("focus-pixel", focus_pixel.map(|[x, y]| format!("{x},{y}"))),
        ];
        others.into_iter().chain(definitions).collect()
    }

    fn lens(&self) -> LensOptions {
        let radius = self.aperture.map(Aperture::Radius);
        let distance = self.focus.map(Focus::Distance);
        LensOptions {
            aperture: radius.or(self.fnumber.map(Aperture::FNumber)),
            focus: distance.or(self.focus_pixel.map(Focus::Pixel)),
        }
    }
}
