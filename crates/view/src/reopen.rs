//! The scene on disk is another: what the viewer chose goes on, and so do his changes of what is as it was.
use std::sync::Arc;

use durer::scene::{Node, Param};
use serde_json::json;

use crate::{
    change::Undo,
    director::Director,
    form::{Complaint, Effort, FormId},
    settings::Settings,
    stage::Opened,
    take::Take,
};

impl Director {
    /// The scene is another, or could not be opened.
    pub(crate) fn change_scene(&mut self) {
        let opened = self.stage.opened();
        if opened.revision != self.opened.revision {
            self.reopen(opened);
        }
        self.told = None;
    }

    /// Whether the scene is another at the moment that is wanted: its file is read for it.
    pub(crate) fn is_elsewhen(&self) -> bool {
        let studio = &self.opened.studio;
        !studio.imported.desc.animations.is_empty() && studio.options.time != self.settings.options.time
    }

    /// Goes on with the scene as its animations have it at the moment that is wanted; other viewers keep theirs.
    pub(crate) fn pose(&mut self) {
        self.say_status("compiling");
        let (time, revision) = (self.settings.options.time, self.opened.revision);
        match self.stage.opener.posed(time, revision) {
            Ok(mut posed) => {
                // What a viewer changed is told from what the user asked for.
                let mut original = (*posed.original).clone();
                original.options.time = self.stage.opener.options.time;
                posed.original = Arc::new(original);
                self.reopen(Arc::new(posed));
            }
            Err(why) => {
                self.take_back();
                self.take = Take::new(&self.job(), self.pace);
                self.complain(&Complaint::of("moment", None, why), None);
            }
        }
    }

    /// Goes on with the scene as it is now on disk: with this viewer's film, look and camera, and with his changes of
    /// materials, lights and cameras that the file has as before. He is told which of them are gone.
    fn reopen(&mut self, opened: Arc<Opened>) {
        let old = std::mem::replace(&mut self.original, Arc::clone(&opened.original));
        let mut settings = (*self.original).clone();
        keep_choices(&mut settings, &self.settings, &old);
        if self.settings.camera < settings.desc.cameras.len() {
            settings.choose_camera(self.settings.camera);
            if !self.is_exact(&old) {
                let moved = self.settings.camera().world_from_camera.clone();
                settings.desc.cameras[settings.camera].world_from_camera = moved;
            }
        }
        let gone = keep_changes(&mut settings, &self.settings, &old);
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
        if !gone.is_empty() {
            let message = format!(
                "The scene was changed on disk: your changes of {} are gone, as the file has something else there now",
                gone.join(", ")
            );
            self.complain(&Complaint::of("scene", None, message), None);
        }
    }
}

/// Film, look, time, lens, sampler and integrator, where they are not as they were opened.
fn keep_choices(settings: &mut Settings, mine: &Settings, was: &Settings) {
    settings.look = mine.look;
    if mine.integrator() != was.integrator() {
        settings.desc.integrator = Some(mine.integrator());
    }
    let (new, mine, was) = (&mut settings.options, &mine.options, &was.options);
    let kept = |now, mine: Option<u32>, was| if mine == was { now } else { mine };
    new.width = kept(new.width, mine.width, was.width);
    new.height = kept(new.height, mine.height, was.height);
    new.samples = kept(new.samples, mine.samples, was.samples);
    if mine.sampler != was.sampler {
        new.sampler = mine.sampler;
    }
    if mine.seed != was.seed {
        new.seed = mine.seed;
    }
    if mine.time != was.time {
        new.time = mine.time;
    }
    if mine.lens != was.lens {
        new.lens = mine.lens;
    }
}

/// Changed nodes whose originals are as they were; returns the names of the others.
fn keep_changes(settings: &mut Settings, mine: &Settings, was: &Settings) -> Vec<String> {
    let (mut gone, new) = (Vec::new(), settings.clone());
    let now = FormId::all(&new.desc);
    let changes = FormId::all(&was.desc).into_iter().filter(|id| *id != FormId::Integrator);
    for id in changes {
        let (Some(before), Some(after)) = (id.node(was), id.node(mine)) else { continue };
        if before == after {
            continue;
        }
        let title = id.title(was);
        // Names stay when numbers change.
        let is_it = |other: &&FormId| other.family() == id.family() && other.title(&new) == title;
        let own = now.iter().find(|other| **other == id).filter(is_it);
        let found = own.or_else(|| now.iter().find(is_it)).copied();
        let same = |id: &FormId| id.node(&new).is_some_and(|node| says_the_same(&node, &before));
        match found.filter(same) {
            Some(there) => there.put(settings, after),
            None => gone.push(format!("\"{title}\"")),
        }
    }
    gone
}

/// Whether two nodes are the same, wherever they stand in their files.
fn says_the_same(a: &Node, b: &Node) -> bool {
    let param = |(a, b): (&Param, &Param)| a.name == b.name && a.ty == b.ty && a.data == b.data;
    a.kind == b.kind
        && a.params.iter().count() == b.params.iter().count()
        && a.params.iter().zip(b.params.iter()).all(param)
}
