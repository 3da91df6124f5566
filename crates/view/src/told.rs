//! What the page is told: everything at first, then what changes.
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use durer::{
    Prepared,
    compile::Kept,
    math::Point3,
    scene::{CameraDesc, ShapeDesc, TextureValue},
};
use serde_json::{Value, json};

use crate::{
    camera::CameraTold,
    director::Director,
    form::{Complaint, FormId},
    layer::Layer,
    pick, save,
    session::Out,
    settings::Settings,
};

/// What is said of a picture in the making is said no more often than this.
const BETWEEN_STATUS: Duration = Duration::from_millis(250);
/// Materials, and as many lights, whose forms are sent unasked.
const MOST_FORMS: usize = 200;

/// What was said last of how it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Told {
    when: Instant,
    state: &'static str,
}

impl Director {
    /// The first message.
    pub(crate) fn hello(&self, resumed: bool) -> Value {
        json!({
            "type": "hello",
            "version": 1,
            "durer": env!("CARGO_PKG_VERSION"),
            "session": self.session.id,
            "resumed": resumed,
            "scene": self.scene_told(),
            "camera": self.camera_told(),
            "layer": self.layer.word(),
            "layers": Layer::words(),
            "forms": self.all_forms(),
            "status": self.status(),
        })
    }

    /// Whether the camera stands where the scene has it.
    pub(crate) fn is_exact(&self, original: &Settings) -> bool {
        let there = original.desc.cameras.get(self.settings.camera);
        there.is_some_and(|camera| camera.world_from_camera == self.settings.camera().world_from_camera)
    }

    pub(crate) fn send(&self, message: &Value) {
        self.send_text(message.to_string());
    }

    pub(crate) fn send_text(&self, text: String) {
        if let Some(outbox) = &self.outbox {
            outbox.send(Out::Text(text));
        }
    }

    /// Says that something was not done.
    pub(crate) fn complain(&self, complaint: &Complaint, id: Option<u64>) {
        self.send(&json!({
            "type": "error", "about": complaint.about, "param": complaint.param, "message": complaint.message,
            "hint": complaint.hint, "id": id,
        }));
    }

    /// Forms as they are now.
    pub(crate) fn send_forms(&self, ids: &[FormId]) {
        let forms: Vec<_> = ids.iter().filter_map(|id| id.form(&self.settings, &self.original)).collect();
        self.send(&json!({ "type": "forms", "forms": forms }));
    }

    /// All forms, of many materials and lights the first.
    pub(crate) fn all_forms(&self) -> Value {
        let near = |id: &FormId| match id {
            FormId::Material(n) | FormId::Light(n) => *n < MOST_FORMS,
            _ => true,
        };
        let ids = FormId::all(&self.settings.desc).into_iter().filter(near).take(3 * MOST_FORMS);
        ids.filter_map(|id| id.form(&self.settings, &self.original)).map(|form| json!(form)).collect()
    }

    pub(crate) fn camera_told(&self) -> CameraTold {
        let bounds = self.kept.bounds();
        let around = if bounds.is_empty() { 1.0 } else { f64::from(bounds.diagonal().length()) };
        let (camera, frame) = (self.settings.camera(), &self.settings.frame);
        CameraTold::new(camera, frame, &self.prepared, (around, self.is_exact(&self.original)))
    }

    /// Where the camera is.
    pub(crate) fn tell_camera(&self) {
        let mut told = json!(self.camera_told());
        told["type"] = "camera".into();
        told["seq"] = self.seq.into();
        self.send(&told);
    }

    pub(crate) fn scene_told(&self) -> Value {
        let (desc, scene) = (&self.original.desc, &self.prepared.scene);
        let bounds = self.kept.bounds();
        let corner = |p: Point3| p.to_array();
        let name = |(i, c): (usize, &CameraDesc)| match c.name.as_str() {
            "" => i.to_string(),
            name => name.to_owned(),
        };
        let textures = desc.textures.iter().take(1000);
        let value = |value| match value {
            TextureValue::Float => "float",
            TextureValue::Color => "color",
        };
        let textures: Vec<_> = textures.map(|t| json!({ "name": t.name, "value": value(t.value) })).collect();
        let played = desc.animations.iter().map(|a| (f64::from(a.start), f64::from(a.end)));
        let played = played.reduce(|all, own| (all.0.min(own.0), all.1.max(own.1)));
        let time = played.or(Kept::times(desc)).map_or([0.0; 2], |(first, last)| [first, last]);
        json!({
            "name": self.stage.opener.scene,
            "revision": self.opened.revision,
            "triangles": scene.report.geometry.triangles_placed,
            "objects": scene.objects.len(),
            "bounds": (!bounds.is_empty()).then(|| [corner(bounds.min), corner(bounds.max)]),
            "handedness": self.settings.frame.handedness(),
            "up": save::up(&self.original),
            "cameras": desc.cameras.iter().enumerate().map(name).collect::<Vec<_>>(),
            "textures": textures,
            "time": time,
            "warnings": self.opened.warnings,
        })
    }

    pub(crate) fn state(&self) -> &'static str {
        if self.stage.trouble().is_some() {
            "error"
        } else if self.take.is_done(&self.job()) {
            "done"
        } else {
            "rendering"
        }
    }

    pub(crate) fn status(&self) -> Value {
        self.status_of(self.state())
    }

    pub(crate) fn status_of(&self, state: &str) -> Value {
        json!({
            "type": "status",
            "state": state,
            "message": self.stage.trouble(),
            "samples": self.take.samples(),
            "of": self.job().settings.samples,
            "rays_per_s": self.take.rays_per_second(),
            "seconds": self.take.busy().as_secs_f64(),
            "viewers": self.stage.viewer_count(),
            "paused": self.paused,
        })
    }

    pub(crate) fn say_status(&self, state: &str) {
        self.send(&self.status_of(state));
    }

    /// Says how it goes, if that changed, and not all the time.
    pub(crate) fn tell(&mut self) {
        let state = self.state();
        let said = self.told.filter(|told| told.state == state);
        let recent = said.is_some_and(|told| told.when.elapsed() < BETWEEN_STATUS);
        let nothing_new = said.is_some() && !self.wants_samples();
        if recent || nothing_new || self.outbox.is_none() {
            return;
        }
        self.say_status(state);
        self.told = Some(Told { when: Instant::now(), state });
    }

    /// The form of the light that a shape sends out: that of the first shape that shares it.
    fn light_form(&self, shape: usize) -> Option<FormId> {
        let shapes = &self.settings.desc.shapes;
        let light = shapes.get(shape)?.area_light.as_ref()?;
        let shares = |s: &ShapeDesc| s.area_light.as_ref().is_some_and(|other| Arc::ptr_eq(other, light));
        shapes.iter().position(shares).map(FormId::AreaLight)
    }

    /// What is seen in a pixel.
    pub(crate) fn pick(&self, id: u64, pixel: [u32; 2]) {
        let seen = pick::seen(&self.prepared, pixel);
        match seen {
            Some(mut told) => {
                told["id"] = id.into();
                let light = told["light"].as_u64().and_then(|shape| self.light_form(shape as usize));
                told["light"] = json!(light.map(|form| form.to_string()));
                told["rgb"] = json!(self.take.mean(pixel));
                told["samples"] = self.take.samples().into();
                told["revision"] = self.opened.revision.into();
                self.send(&told);
            }
            None => {
                let complaint = Complaint::of("pick", None, outside(&self.prepared, pixel));
                self.complain(&complaint, Some(id));
            }
        }
    }
}

/// The complaint about a pixel that is none of the picture's.
pub(crate) fn outside(prepared: &Prepared, [x, y]: [u32; 2]) -> String {
    let view = &prepared.scene.view;
    format!("pixel {x},{y} lies outside the picture of {} x {} pixels", view.width, view.height)
}
