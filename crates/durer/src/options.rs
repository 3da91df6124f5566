//! What a user may ask for beyond what the scene says.
use std::path::PathBuf;

use durer_accel::{Engine, Preset};
use durer_core::{math::Interval, sampling::SamplerKind, spectrum::Carried};
use durer_io::import::{Moment, Play, Reading};
use durer_render::{
    compile::LensOptions,
    drive::Antialias,
    film::Tile,
    integrator::{Lights, Sampling, Shadows, Show},
};
use durer_scene::{Limits, Missing};

/// Rays per effect of the integrator `distributed`; see [`durer_render::integrator::Distributed`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Distribution {
    /// Rays to each light with extent, per hit.
    pub shadow_rays: Option<u32>,
    /// Which lights get them.
    pub lights: Option<Lights>,
    /// Rays about each blurred direction, per hit.
    pub gloss_rays: Option<u32>,
    /// Moments in the time the shutter is open.
    pub time_samples: Option<u32>,
    /// Points of the lens.
    pub lens_samples: Option<u32>,
    /// Points of the pixel.
    pub aa_samples: Option<u32>,
    /// How they are combined.
    pub sampling: Option<Sampling>,
}

/// Wishes; `None` leaves the choice to the scene, then to the defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Light transport, by its registered word.
    pub integrator: Option<String>,
    /// What `cast` shows.
    pub show: Option<Show>,
    /// Pixels per row. If only one of width and height is given the other follows the scene's aspect ratio.
    pub width: Option<u32>,
    /// Rows.
    pub height: Option<u32>,
    /// Factor on width and height.
    pub scale: Option<f32>,
    /// Samples per pixel.
    pub samples: Option<u32>,
    /// How samples become random numbers.
    pub sampler: Option<SamplerKind>,
    /// Where the samples of a pixel lie.
    pub antialias: Antialias,
    /// Bounces traced at most.
    pub max_depth: Option<u32>,
    /// Stop when a branch's share in the pixel is at or below this.
    pub min_contribution: Option<f32>,
    /// Rays per effect of distributed ray tracing.
    pub distribution: Distribution,
    /// What transparent things do to shadow rays.
    pub shadows: Option<Shadows>,
    /// Whether rays carry colours or wavelengths.
    pub carried: Option<Carried>,
    /// Whether what a film `gbuffer` or `spectral` keeps beside colours is kept: for OpenEXR files.
    pub layers: bool,
    /// Camera, by name or index.
    pub camera: Option<String>,
    /// A picture that surrounds the scene and lights it, instead of the scene's own surroundings or the automatic light.
    /// Its file may lie anywhere. Its top is +y, its middle +x.
    pub environment: Option<PathBuf>,
    /// The part of the picture that is rendered.
    pub crop: Option<Tile>,
    /// The set of materials that the scene wears, by name or index; the file's own if `None`. See [`crate::open_for`].
    pub variant: Option<String>,
    /// Values for names that a scene of Mitsuba leaves open. See [`crate::open_for`].
    pub definitions: Vec<(String, String)>,
    /// The folder that the scene's files may be read from, its own or one above it; its own if `None`. See
    /// [`crate::open_for`].
    pub root: Option<PathBuf>,
    /// Which animation of the file moves the scene. See [`crate::open_for`].
    pub play: Play,
    /// The moment of the picture, in seconds.
    pub time: f32,
    /// Shutter opening and closing, in seconds after `time`.
    pub shutter: Option<Interval>,
    /// Aperture and focus.
    pub lens: LensOptions,
    /// Hierarchy or brute force.
    pub engine: Engine,
    /// How much work goes into the hierarchy. It changes no bit of the picture.
    pub preset: Preset,
    /// Changes every random number; what the scene says, else 0, if `None`.
    pub seed: Option<u64>,
    /// Worker threads; all cores if `None`.
    pub threads: Option<usize>,
    /// What becomes of missing images.
    pub missing: Missing,
    /// What becomes of scenes that show nothing.
    pub nothing: Missing,
}

impl Options {
    /// How a file is read that these options are for.
    pub fn reading(&self) -> Reading {
        Reading {
            limits: Limits::default(),
            play: self.play.clone(),
            moment: self.moment(),
            variant: self.variant.clone(),
            definitions: self.definitions.clone(),
            root: self.root.clone(),
        }
    }
    /// When the scene is looked at, as far as a file must know that holds an animation.
    pub fn moment(&self) -> Moment {
        let Interval { min, max } = self.shutter.unwrap_or(Interval::point(0.0));
        Moment { time: self.time, shutter: Interval::new(self.time + min, self.time + max) }
    }
}
