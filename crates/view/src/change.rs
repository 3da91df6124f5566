//! Changes: of the scene on disk, and of what the viewer wants of it.
use std::sync::Arc;

use durer::{
    Options, Prepared, Wanted,
    math::Motion,
    scene::{Diagnostics, Node},
};
use serde_json::json;

use crate::{
    director::Director,
    form::{Complaint, Effort, FormId},
    layer::Layer,
    settings::{Look, Settings},
    stage::Opened,
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

    fn take_back(&mut self) {
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

    /// The scene is another, or could not be opened.
    pub(crate) fn change_scene(&mut self) {
        let opened = self.stage.opened();
        if opened.revision != self.opened.revision {
            self.reopen(opened);
        }
        self.told = None;
    }

    /// Goes on with the scene as it is now on disk: with this viewer's film, look and camera, without his changes of what is
    /// in the scene.
    fn reopen(&mut self, opened: Arc<Opened>) {
        let old = std::mem::replace(&mut self.original, Arc::clone(&opened.original));
        let mut settings = (*self.original).clone();
        settings.look = self.settings.look;
        let (new, mine, was) = (&mut settings.options, &self.settings.options, &old.options);
        let kept = |now, mine: Option<u32>, was| if mine == was { now } else { mine };
        new.width = kept(new.width, mine.width, was.width);
        new.height = kept(new.height, mine.height, was.height);
        new.samples = kept(new.samples, mine.samples, was.samples);
        if mine.time != was.time {
            new.time = mine.time;
        }
        if self.settings.integrator() != old.integrator() {
            settings.desc.integrator = Some(self.settings.integrator());
        }
        if self.settings.camera < settings.desc.cameras.len() {
            settings.choose_camera(self.settings.camera);
            if !self.is_exact(&old) {
                let moved = self.settings.camera().world_from_camera.clone();
                settings.desc.cameras[settings.camera].world_from_camera = moved;
            }
        }
        self.kept = opened.studio.kept.clone();
        self.prepared = Arc::clone(&opened.prepared);
        self.shown = None;
        self.undo = vec![Undo::All(Box::new((*self.original).clone()))];
        self.opened = opened;
        self.settings = settings;
        self.effort = Effort::Again;
        self.prepare();
        let scene = json!({
            "type": "scene", "scene": self.scene_told(), "camera": self.camera_told(), "forms": self.all_forms(),
        });
        self.send(&scene);
    }

    /// Does what requests made necessary. If the scene as it is wanted cannot be, it stays as it was.
    pub(crate) fn prepare(&mut self) {
        let effort = std::mem::take(&mut self.effort);
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
        let shown = match self.layer.integrator() {
            None => None,
            Some(integrator) => {
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
