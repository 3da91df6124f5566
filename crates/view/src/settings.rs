//! All that a viewer has chosen: the scene as it is to be seen, and how the picture is shown.
use durer::{
    Options, Studio,
    film::ToneMap,
    scene::{CameraDesc, Node, SceneDesc},
};

use crate::camera::Frame;

/// How light becomes colours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// Stops of brightening.
    pub exposure: f32,
    /// The tone map; `None`: what suits the integrator.
    pub tonemap: Option<ToneMap>,
}

impl Look {
    /// The tone map for light of this integrator.
    pub(crate) fn tonemap(&self, integrator: &str) -> ToneMap {
        self.tonemap.unwrap_or_else(|| durer::picture::Look::usual_tonemap(integrator))
    }
}

/// What a viewer sees.
#[derive(Clone)]
pub(crate) struct Settings {
    /// The scene.
    pub(crate) desc: SceneDesc,
    /// Film, time and lens.
    pub(crate) options: Options,
    pub(crate) look: Look,
    /// Which of the description's cameras.
    pub(crate) camera: usize,
    /// Of that camera, as it was opened.
    pub(crate) frame: Frame,
}

impl Settings {
    /// As the scene was opened.
    pub(crate) fn new(studio: &Studio, look: Look) -> Self {
        let (desc, options) = (studio.imported.desc.clone(), studio.options.clone());
        let camera = match &options.camera {
            None => 0,
            Some(wanted) => camera_called(&desc, wanted).unwrap_or(0),
        };
        let frame = Frame::of(&desc.cameras[camera], options.time);
        let mut new = Self { desc, options, look, camera, frame };
        new.choose_camera(camera);
        new
    }

    /// Another of the description's cameras.
    pub(crate) fn choose_camera(&mut self, camera: usize) {
        self.camera = camera;
        self.options.camera = Some(camera.to_string());
        self.frame = Frame::of(&self.desc.cameras[camera], self.options.time);
        // A camera that is called like the number of another one comes first otherwise.
        let number = camera.to_string();
        if let Some(named) = self.desc.cameras.iter().find(|c| c.name == number) {
            self.options.camera = Some(named.name.clone());
        }
    }

    /// The camera in use.
    pub(crate) fn camera(&self) -> &CameraDesc {
        &self.desc.cameras[self.camera]
    }

    /// The integrator, which a studio always has.
    pub(crate) fn integrator(&self) -> Node {
        self.desc.integrator.clone().unwrap_or_else(|| durer::compile::default_integrator(&self.desc))
    }
}

/// The index of a camera, by name or number.
pub(crate) fn camera_called(desc: &SceneDesc, wanted: &str) -> Option<usize> {
    let by_name = desc.cameras.iter().position(|c| c.name == wanted);
    by_name.or_else(|| wanted.parse().ok().filter(|&index: &usize| index < desc.cameras.len()))
}
