//! Changes of what the viewer wants of the scene.
use std::sync::Arc;

use durer::{
    Options, Prepared, Wanted,
    integrator::Surveyed,
    math::Motion,
    scene::{Diagnostics, Node},
};

use crate::{
    director::Director,
    form::{Complaint, Effort, FormId},
    layer::Layer,
    settings::{Look, Settings},
    take::Take,
};

/// How a change is taken back that cannot be prepared.
pub(crate) enum Undo {
    /// The node of a form.
    Node(FormId, Node),
    /// Film, time and lens, and the look.
    Options(Box<Options>, Look),
    /// The camera that was chosen, and where it was.
    Camera(usize, Motion),
    Layer(Layer),
    /// Everything.
    All(Box<Settings>),
}

impl Director {
    /// Remembers what a form holds before it is changed.
    pub(crate) fn remember(&mut self, id: FormId) {
        let settings = &self.settings;
        if let Some(node) = id.node(settings) {
            self.undo.push(Undo::Node(id, node));
        }
        self.undo.push(Undo::Options(Box::new(settings.options.clone()), settings.look));
    }

    /// Remembers where the camera is.
    pub(crate) fn remember_camera(&mut self) {
        let place = self.settings.camera().world_from_camera.clone();
        self.undo.push(Undo::Camera(self.settings.camera, place));
    }

    pub(crate) fn take_back(&mut self) {
        for undo in std::mem::take(&mut self.undo).into_iter().rev() {
            match undo {
                Undo::Node(id, node) => id.put(&mut self.settings, node),
                Undo::Options(options, look) => {
                    (self.settings.options, self.settings.look) = (*options, look)
                }
                Undo::Camera(camera, place) => {
                    self.settings.choose_camera(camera);
                    self.settings.desc.cameras[camera].world_from_camera = place;
                }
                Undo::Layer(layer) => self.layer = layer,
                Undo::All(settings) => self.settings = *settings,
            }
        }
    }

    /// Does what requests made necessary. If the scene as it is wanted cannot be, it stays as it was.
    pub(crate) fn prepare(&mut self) {
        let effort = std::mem::take(&mut self.effort);
        if effort == Effort::Again && self.is_elsewhen() {
            return self.pose();
        }
        let changed = std::mem::take(&mut self.changed);
        match effort {
            Effort::None => return,
            Effort::Develop => self.frames.news = None,
            Effort::Retake | Effort::Again => {
                if effort == Effort::Again {
                    self.say_status("compiling");
                }
                let mut said = Diagnostics::default();
                if self.prepared_again(effort, &mut said).is_some() {
                    self.undo.clear();
                } else {
                    self.take_back();
                    let about = changed.last().map_or_else(|| "camera".to_owned(), FormId::to_string);
                    if let Some(complaint) = Complaint::errors(about, &said) {
                        self.complain(&complaint, None);
                    }
                }
                self.take = Take::new(&self.job(), self.pace);
                self.frames.news = None;
            }
        }
        if !changed.is_empty() {
            self.send_forms(&changed);
        }
        if changed.iter().any(|id| matches!(id, FormId::Camera | FormId::Film)) {
            self.tell_camera();
        }
        self.told = None;
    }

    fn prepared_again(&mut self, effort: Effort, said: &mut Diagnostics) -> Option<()> {
        let Settings { desc, options, .. } = &self.settings;
        let integrator = &self.settings.integrator();
        let (studio, wanted) = (&self.opened.studio, Wanted { desc, integrator, options });
        let (prepared, kept) = match effort {
            Effort::Again => {
                let (prepared, kept) = studio.again(wanted, &self.kept, said)?;
                (prepared, Some(kept))
            }
            _ => (studio.retake(wanted, (&self.kept, &self.prepared.scene), said)?, None),
        };
        let kept = kept.unwrap_or_else(|| self.kept.clone());
        let shown = match (self.layer, self.layer.integrator()) {
            (Layer::Survey(survey), _) => {
                let again = studio.retake(wanted, (&kept, &prepared.scene), said)?;
                let integrator = Surveyed { integrator: again.integrator, survey };
                Some(Arc::new(Prepared { integrator: Box::new(integrator), ..again }))
            }
            (_, None) => None,
            (_, Some(integrator)) => {
                // One sample is enough for what is not averaged.
                let options = Options { samples: None, ..options.clone() };
                let wanted = Wanted { integrator: &integrator, options: &options, ..wanted };
                Some(Arc::new(studio.retake(wanted, (&kept, &prepared.scene), said)?))
            }
        };
        (self.prepared, self.kept, self.shown) = (Arc::new(prepared), kept, shown);
        Some(())
    }

    /// Light transport that a question compares with.
    pub(crate) fn twin(&self, integrator: &Node) -> Result<Prepared, Complaint> {
        let Settings { desc, options, .. } = &self.settings;
        let mut said = Diagnostics::default();
        let wanted = Wanted { desc, integrator, options };
        let twin = self.opened.studio.retake(wanted, (&self.kept, &self.prepared.scene), &mut said);
        twin.ok_or_else(|| Complaint::errors("trace", &said).unwrap_or_default())
    }
}
