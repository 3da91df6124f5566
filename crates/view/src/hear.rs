//! What the page says, and what it makes the session do.
use std::sync::Arc;

use durer::glam::DVec3;

use crate::{
    answer::{Question, Traced},
    change::Undo,
    director::Director,
    form::{self, Complaint, Effort, FormId},
    layer::Layer,
    message::{CameraMessage, Message, TraceMessage},
    settings::{Settings, camera_called},
    told::outside,
};

impl Director {
    /// Takes up a message.
    pub(crate) fn hear(&mut self, message: Message) {
        match message {
            Message::Ack { frame } => self.drawn(frame),
            Message::Camera(camera) => self.hear_camera(&camera),
            Message::Set { form, param, value } => {
                self.edit(&form, |id, settings, original| {
                    form::set(id, (settings, original), (&param, &value))
                });
            }
            Message::Kind { form, kind } => {
                self.edit(&form, |id, settings, _| form::kind(id, settings, &kind));
            }
            Message::Reset { form: Some(form) } => self.edit(&form, form::reset),
            Message::Reset { form: None } => {
                let seq = self.seq;
                let old = std::mem::replace(&mut self.settings, (*self.original).clone());
                self.undo.push(Undo::All(Box::new(old)));
                self.changed = FormId::all(&self.settings.desc);
                (self.effort, self.seq) = (Effort::Again, seq);
            }
            Message::Layer { layer } => match Layer::from_word(&layer) {
                Some(layer) => {
                    self.undo.push(Undo::Layer(self.layer));
                    self.layer = layer;
                    self.effort = self.effort.max(Effort::Retake);
                }
                None => {
                    let complaint = form::unknown("layer", "layer", &layer, Layer::words().into_iter());
                    self.complain(&complaint, None);
                }
            },
            Message::Pause { paused } => self.pause(paused),
            Message::Forms { ids } => {
                let ids: Vec<FormId> = ids.iter().filter_map(|id| id.parse().ok()).take(1000).collect();
                self.prepare();
                self.send_forms(&ids);
            }
            Message::Pick(pick) => {
                self.prepare();
                self.pick(pick.id, [pick.x, pick.y]);
            }
            Message::Trace(trace) => {
                self.prepare();
                let id = trace.id;
                match self.traced(trace) {
                    Ok(traced) => self.question(Question::Trace(Box::new(traced))),
                    Err(complaint) => self.complain(&complaint, Some(id)),
                }
            }
            Message::Ghost { id } => {
                self.prepare();
                let prepared = Arc::clone(&self.prepared);
                let (name, revision) = (self.stage.opener.scene.clone(), self.opened.revision);
                self.question(Question::Ghost { id, name, revision, seq: self.seq, prepared });
            }
        }
    }

    fn hear_camera(&mut self, camera: &CameraMessage) {
        let vector = |v: Option<[f64; 3]>| v.map(DVec3::from_array);
        let complain = |this: &Self, message: &str| {
            this.complain(&Complaint::of("camera", None, message), None);
        };
        match (vector(camera.eye), vector(camera.forward), vector(camera.up)) {
            (Some(eye), Some(forward), Some(up)) => {
                let Some(pose) = self.settings.frame.pose(eye, forward, up) else {
                    return complain(
                        self,
                        "these directions say nothing: of no length, or parallel, or no numbers",
                    );
                };
                self.remember_camera();
                let placed = self.settings.frame.placed(&pose);
                let index = self.settings.camera;
                self.settings.desc.cameras[index].world_from_camera = placed;
                self.seq = camera.seq;
                self.effort = self.effort.max(Effort::Retake);
            }
            (None, None, None) => {
                let index = match &camera.name {
                    None => Some(self.original.camera),
                    Some(name) => camera_called(&self.original.desc, name),
                };
                let Some(index) = index else {
                    let known = self.original.desc.cameras.iter().map(|c| c.name.as_str());
                    let name = camera.name.as_deref().unwrap_or_default();
                    let complaint = form::unknown("camera", "camera", name, known);
                    return self.complain(&complaint, None);
                };
                let there = self.original.desc.cameras[index].world_from_camera.clone();
                self.remember_camera();
                self.settings.choose_camera(index);
                self.remember_camera();
                self.settings.desc.cameras[index].world_from_camera = there;
                self.seq = camera.seq;
                self.effort = self.effort.max(Effort::Retake);
                self.changed.push(FormId::Camera);
            }
            _ => complain(self, "a pose needs eye, forward and up"),
        }
    }

    fn edit(
        &mut self,
        form: &str,
        edit: impl FnOnce(FormId, &mut Settings, &Settings) -> Result<Effort, Complaint>,
    ) {
        let Ok(id) = form.parse::<FormId>() else {
            return self.complain(&Complaint::of(form, None, "there is no such form"), None);
        };
        self.remember(id);
        match edit(id, &mut self.settings, &self.original) {
            Ok(effort) => {
                self.effort = self.effort.max(effort);
                if !self.changed.contains(&id) {
                    self.changed.push(id);
                }
            }
            Err(complaint) => {
                self.complain(&complaint, None);
                self.send_forms(&[id]);
            }
        }
    }

    /// A question about a pixel, with all that its answer needs.
    fn traced(&self, trace: TraceMessage) -> Result<Traced, Complaint> {
        let (prepared, pixel) = (Arc::clone(&self.prepared), [trace.x, trace.y]);
        let view = &prepared.scene.view;
        if trace.x >= view.width || trace.y >= view.height {
            return Err(Complaint::of("trace", None, outside(&prepared, pixel)));
        }
        let twin = match &trace.diff {
            None => None,
            Some(diff) => {
                let node = form::with(&self.settings, diff.kind.as_deref(), &diff.params)?;
                let words = diff.params.iter().map(|(name, value)| format!("{name} {value}"));
                let words = diff.kind.iter().cloned().chain(words).collect::<Vec<_>>().join(", ");
                Some((self.twin(&node)?, words))
            }
        };
        let (name, revision, seq) = (self.stage.opener.scene.clone(), self.opened.revision, self.seq);
        Ok(Traced { trace, name, revision, seq, prepared, twin })
    }
}
