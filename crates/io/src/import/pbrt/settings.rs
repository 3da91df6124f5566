//! The directives before `WorldBegin`: camera, picture and transport.
use durer_scene::{CameraDesc, Node};

use super::{
    color_space::{COLOR_SPACES, ColorSpace},
    film,
    input::Reported,
    integrator,
    lexer::Token,
    params::stored,
    parser::Parser,
};

/// Keeps the search for names cheap.
const MOST_CAMERAS: usize = 1024;

impl Parser<'_> {
    /// `Camera`
    pub(super) fn camera(&mut self, head: Token) -> Result<(), Reported> {
        // Known even if the parameters are wrong, so that CoordSysTransform "camera" makes no second error.
        let world_from_camera = self.state.ctm.inverse();
        self.coordinate_systems.insert("camera".to_owned(), world_from_camera.clone());
        let (kind, mut params) = self.kind_and_params(head, "a kind of camera")?;
        let name = self.name(&mut params);
        let node = Node { kind: kind.text, params: stored(params), at: kind.at.into() };
        let world_from_camera = world_from_camera.motion(self.world.times);
        let camera = CameraDesc { name, node, world_from_camera, media: self.state.media };
        let cameras = &mut self.world.desc.cameras;
        let full = cameras.len() >= MOST_CAMERAS;
        match cameras.iter_mut().find(|c| c.name == camera.name) {
            Some(old) => {
                *old = camera;
                let message = "this Camera replaces the earlier one; several need a \"string name\" each";
                self.warn_once("Camera", kind.at, message);
            }
            None if full => {
                self.input.error(kind.at, format!("more than {MOST_CAMERAS} cameras"));
            }
            None => cameras.push(camera),
        }
        Ok(())
    }

    /// Warns if an option directive is given again.
    fn only(&mut self, key: &'static str, again: bool, head: Token) {
        if again {
            let at = self.input.lexer.span(head);
            self.warn_once(key, at, format!("this {key} replaces the earlier one"));
        }
    }

    /// `Film`
    pub(super) fn film(&mut self, head: Token) -> Result<(), Reported> {
        let node = self.node(head, "a kind of film")?;
        self.only("Film", self.world.desc.film.width.is_some(), head);
        film::film(&node, &mut self.world.desc.film, self.input.diagnostics);
        Ok(())
    }

    /// `Sampler`
    pub(super) fn sampler(&mut self, head: Token) -> Result<(), Reported> {
        let node = self.node(head, "a kind of sampler")?;
        self.only("Sampler", self.world.desc.sampler.is_some(), head);
        film::sampler(&node, &mut self.world.desc.film, self.input.diagnostics);
        self.world.desc.sampler = Some(node);
        Ok(())
    }

    /// `PixelFilter`
    pub(super) fn pixel_filter(&mut self, head: Token) -> Result<(), Reported> {
        let node = self.node(head, "a kind of filter")?;
        self.only("PixelFilter", self.world.desc.filter.is_some(), head);
        self.world.desc.filter = Some(node);
        Ok(())
    }

    /// `Integrator`
    pub(super) fn integrator(&mut self, head: Token) -> Result<(), Reported> {
        let node = self.node(head, "a kind of integrator")?;
        self.only("Integrator", self.world.desc.integrator.is_some(), head);
        self.world.desc.integrator = Some(integrator::mapped(node, self.input.diagnostics));
        Ok(())
    }

    /// `Accelerator`: pictures do not depend on it.
    pub(super) fn accelerator(&mut self, head: Token) -> Result<(), Reported> {
        let (kind, _) = self.kind_and_params(head, "a kind of accelerator")?;
        if self.first_time("Accelerator") {
            self.input.diagnostics.note(kind.at, "durer chooses its acceleration structure itself");
        }
        Ok(())
    }

    /// `ColorSpace`
    pub(super) fn color_space(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a colour space")?;
        match ColorSpace::of(&name.text) {
            Some(space) => self.state.color_space = space,
            None => {
                let known = COLOR_SPACES.map(|space| space.name);
                self.input.diagnostics.unknown(name.at, "colour space", &name.text, known);
            }
        }
        Ok(())
    }
}
