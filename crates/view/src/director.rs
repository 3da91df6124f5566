//! The thread of a session: takes what it is asked for, changes the scene, renders in turns with the others, and sends what
//! there is to see.
use std::{
    collections::VecDeque,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{Sender, channel},
    },
    time::{Duration, Instant},
};

use durer::{Job, Prepared, Wanted, compile::Kept, scene::Diagnostics};
use serde_json::json;

use crate::{
    answer::{Answerer, Question},
    camera::CameraTold,
    form::{Complaint, Effort, FormId},
    layer::Layer,
    pick,
    save::{self, File, SaveFormat},
    session::{Copied, Out, Outbox, Request, Session},
    settings::Settings,
    stage::{Opened, Stage},
    take::{Pace, Take},
};

/// How long a session renders if another one waits, and if none does.
const SHORT_TURN: Duration = Duration::from_millis(15);
const LONG_TURN: Duration = Duration::from_millis(60);
/// Pictures that are getting better are sent no more often than this.
const BETWEEN_FRAMES: Duration = Duration::from_millis(100);
/// Neither is what is said of them.
const BETWEEN_STATUS: Duration = Duration::from_millis(250);
/// Materials, and as many lights, whose forms are sent unasked.
const MOST_FORMS: usize = 200;

/// See above.
pub(crate) struct Director {
    pub(super) stage: Arc<Stage>,
    pub(super) session: Arc<Session>,
    pub(super) opened: Arc<Opened>,
    /// As the scene was opened.
    pub(super) original: Settings,
    pub(super) settings: Settings,
    /// The last settings that could be prepared.
    good: (Settings, Layer),
    kept: Kept,
    /// What the integrator sees.
    pub(super) prepared: Arc<Prepared>,
    /// What the layer shows, if it is not that.
    shown: Option<Arc<Prepared>>,
    pub(super) layer: Layer,
    /// Of the last camera message.
    pub(super) seq: u64,
    take: Take,
    pace: Pace,
    cancel: Arc<AtomicBool>,
    pub(super) outbox: Option<Outbox>,
    answerer: Answerer,
    /// Questions that are being answered.
    questions: usize,
    paused: bool,
    /// What the requests since the last picture make necessary.
    pub(super) effort: Effort,
    /// Which form was changed last.
    pub(super) changed: Vec<FormId>,
    frames: Frames,
    told: Option<(Instant, String)>,
}

/// What was sent of the picture.
#[derive(Debug, Default)]
struct Frames {
    count: u64,
    /// Sent and not drawn yet.
    outstanding: Option<u64>,
    /// [`Take::news`] of what was sent; `None` if nothing of this picture was.
    news: Option<u64>,
    sent: Option<Instant>,
    /// What the last one took.
    cost: Duration,
}

impl Director {
    pub(crate) fn new(stage: Arc<Stage>, session: Arc<Session>, like: Option<Arc<Session>>) -> Self {
        let opened = stage.opened();
        let original = Settings::new(&opened.studio, stage.look);
        let prepared = Arc::clone(&opened.prepared);
        let take = Take::new(&prepared.job(), Pace::default());
        let mut new = Self {
            settings: original.clone(),
            good: (original.clone(), Layer::Beauty),
            original,
            kept: opened.studio.kept.clone(),
            prepared,
            shown: None,
            layer: Layer::Beauty,
            seq: 0,
            take,
            pace: Pace::default(),
            cancel: Arc::default(),
            outbox: None,
            answerer: Answerer::start(&session),
            questions: 0,
            paused: false,
            effort: Effort::None,
            changed: Vec::new(),
            frames: Frames::default(),
            told: None,
            stage,
            session,
            opened,
        };
        if let Some(copied) =
            like.and_then(|like| copied(&like)).filter(|c| c.revision == new.opened.revision)
        {
            (new.settings, new.layer, new.seq) = (copied.settings, copied.layer, copied.seq);
            new.effort = Effort::Again;
        }
        new
    }

    /// Until the session is over.
    pub(crate) fn run(mut self) {
        while let Some((requests, cancel)) = self.session.requests(self.wait()) {
            if std::mem::replace(&mut self.cancel, cancel).load(Ordering::Relaxed) {
                // Whatever was asked for and whether or not it is done: the film is of no use.
                self.effort = self.effort.max(Effort::Retake);
            }
            self.take_up(requests);
            self.prepare();
            self.render();
            self.send_frame();
            self.tell();
        }
        if let Some(outbox) = &self.outbox {
            outbox.send(Out::Close(1001, "durer stops"));
        }
    }

    fn take_up(&mut self, requests: VecDeque<Request>) {
        for request in requests {
            match request {
                Request::Said(message) => self.hear(message),
                Request::Unreadable(why) => {
                    self.complain(&Complaint::of("protocol", None, why), None);
                }
                Request::Connect(outbox, resumed) => self.connect(outbox, resumed),
                Request::Disconnect(number) => {
                    if self.outbox.as_ref().is_some_and(|outbox| outbox.number == number) {
                        self.outbox = None;
                        self.session.begin_waiting();
                    }
                }
                Request::Scene => self.change_scene(),
                Request::Answered => self.questions = self.questions.saturating_sub(1),
                Request::Save(format, answer) => {
                    self.prepare();
                    // Whoever asked may be gone.
                    let _ = answer.send(self.save(format));
                }
                Request::Copy(answer) => {
                    let _ = answer.send(Copied {
                        settings: self.settings.clone(),
                        layer: self.layer,
                        seq: self.seq,
                        revision: self.opened.revision,
                    });
                }
            }
        }
    }

    /// How long there is nothing to do but to wait for requests; `None` for ever.
    fn wait(&self) -> Option<Duration> {
        if self.effort != Effort::None || self.wants_samples() {
            return Some(Duration::ZERO);
        }
        self.has_frame().then(|| {
            self.frames.sent.map_or(Duration::ZERO, |sent| self.between().saturating_sub(sent.elapsed()))
        })
    }

    pub(super) fn job(&self) -> Job<'_> {
        self.shown.as_ref().unwrap_or(&self.prepared).job()
    }

    fn wants_samples(&self) -> bool {
        self.outbox.is_some() && !self.paused && self.questions == 0 && !self.take.is_done(&self.job())
    }

    pub(super) fn pause(&mut self, paused: bool) {
        self.paused = paused;
    }

    pub(super) fn drawn(&mut self, frame: u64) {
        if self.frames.outstanding == Some(frame) {
            self.frames.outstanding = None;
        }
    }

    /// A new page: it is told everything.
    fn connect(&mut self, outbox: Outbox, resumed: bool) {
        if let Some(old) = self.outbox.replace(outbox) {
            old.send(Out::Close(1008, "another page took over this session"));
        }
        self.frames = Frames { count: 0, outstanding: None, news: None, sent: None, cost: Duration::ZERO };
        self.paused = false;
        self.prepare();
        let hello = json!({
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
        });
        self.send(&hello);
        self.told = None;
    }

    /// The scene is another, or could not be opened.
    fn change_scene(&mut self) {
        let opened = self.stage.opened();
        if opened.revision != self.opened.revision {
            self.reopen(opened);
        }
        self.told = None;
    }

    /// Goes on with the scene as it is now on disk: with this viewer's film, look and camera, without his changes of what is
    /// in the scene.
    fn reopen(&mut self, opened: Arc<Opened>) {
        let old = std::mem::replace(&mut self.original, Settings::new(&opened.studio, self.stage.look));
        let mut settings = self.original.clone();
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
        self.good = (self.original.clone(), Layer::Beauty);
        self.opened = opened;
        self.settings = settings;
        self.effort = Effort::Again;
        self.prepare();
        let scene = json!({
            "type": "scene", "scene": self.scene_told(), "camera": self.camera_told(), "forms": self.all_forms(),
        });
        self.send(&scene);
    }

    /// Whether the camera stands where the scene has it.
    fn is_exact(&self, original: &Settings) -> bool {
        let there = original.desc.cameras.get(self.settings.camera);
        there.is_some_and(|camera| camera.world_from_camera == self.settings.camera().world_from_camera)
    }

    /// Does what requests made necessary. If the scene as it is wanted cannot be, it stays as it was.
    pub(super) fn prepare(&mut self) {
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
                    self.good = (self.settings.clone(), self.layer);
                } else {
                    (self.settings, self.layer) = self.good.clone();
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
                let options = durer::Options { samples: None, ..options.clone() };
                let wanted = Wanted { integrator: &integrator, options: &options, ..wanted };
                Some(Arc::new(studio.retake(wanted, (&kept, &prepared.scene), said)?))
            }
        };
        (self.prepared, self.kept, self.shown) = (Arc::new(prepared), kept, shown);
        Some(())
    }

    /// A turn of rendering.
    fn render(&mut self) {
        if !self.wants_samples() {
            return;
        }
        let stage = Arc::clone(&self.stage);
        let turn = stage.turns.take();
        if self.session.is_asked() {
            return;
        }
        let start = Instant::now();
        let enough = || {
            let limit = if turn.is_awaited() { SHORT_TURN } else { LONG_TURN };
            start.elapsed() >= limit || self.session.is_asked()
        };
        let job = self.shown.as_ref().unwrap_or(&self.prepared).job();
        self.take.advance(&job, &mut self.pace, &enough, &self.cancel);
    }

    /// Time between pictures: what they cost shall be a small part of all work.
    fn between(&self) -> Duration {
        BETWEEN_FRAMES.max(4 * self.frames.cost)
    }

    fn has_frame(&self) -> bool {
        self.outbox.is_some()
            && self.frames.outstanding.is_none()
            && self.take.news > 0
            && self.frames.news != Some(self.take.news)
    }

    /// Sends the picture, if it is another than the page has, and if the page is ready for it.
    fn send_frame(&mut self) {
        let job = self.job();
        let now = self.take.is_coarse() || self.take.is_done(&job) || self.frames.news.is_none();
        let due = now || self.frames.sent.is_none_or(|sent| sent.elapsed() >= self.between());
        if !self.has_frame() || !due || self.session.is_asked() {
            return;
        }
        let start = Instant::now();
        let name = &self.shown.as_ref().unwrap_or(&self.prepared).integrator_name;
        let Some(shown) = self.take.shown(&job, self.settings.look, name) else { return };
        let number = self.frames.count + 1;
        let view = &job.scene.view;
        let head = json!({
            "frame": number,
            "seq": self.seq,
            "revision": self.opened.revision,
            "layer": self.layer.word(),
            "film": [view.width, view.height],
            "width": shown.width,
            "height": shown.height,
            "samples": self.take.samples(),
            "of": job.settings.samples,
            "done": self.take.is_done(&job),
            "ms": self.take.begun.elapsed().as_secs_f64() * 1e3,
            "rays_per_s": self.take.rays_per_second(),
            "white": shown.white,
            "range": shown.range,
        });
        let head = head.to_string().into_bytes();
        let mut bytes = (head.len() as u32).to_le_bytes().to_vec();
        bytes.extend(head);
        bytes.extend(shown.png);
        if let Some(outbox) = &self.outbox {
            outbox.send(Out::Frame(bytes));
        }
        let (news, cost) = (Some(self.take.news), start.elapsed());
        self.frames =
            Frames { count: number, outstanding: Some(number), news, sent: Some(Instant::now()), cost };
    }

    pub(super) fn send(&self, message: &serde_json::Value) {
        self.send_text(message.to_string());
    }

    pub(super) fn send_text(&self, text: String) {
        if let Some(outbox) = &self.outbox {
            outbox.send(Out::Text(text));
        }
    }

    /// Says that something was not done.
    pub(super) fn complain(&self, complaint: &Complaint, id: Option<u64>) {
        self.send(&json!({
            "type": "error", "about": complaint.about, "param": complaint.param, "message": complaint.message,
            "hint": complaint.hint, "id": id,
        }));
    }

    fn send_forms(&self, ids: &[FormId]) {
        let forms: Vec<_> = ids.iter().filter_map(|id| id.form(&self.settings, &self.original)).collect();
        self.send(&json!({ "type": "forms", "forms": forms }));
    }

    /// Forms that were asked for.
    pub(super) fn tell_forms(&self, ids: &[FormId]) {
        self.send_forms(ids);
    }

    /// All forms, of many materials and lights the first.
    fn all_forms(&self) -> serde_json::Value {
        let near = |id: &FormId| match id {
            FormId::Material(n) | FormId::Light(n) => *n < MOST_FORMS,
            _ => true,
        };
        let ids = FormId::all(&self.settings.desc).into_iter().filter(near).take(3 * MOST_FORMS);
        ids.filter_map(|id| id.form(&self.settings, &self.original)).map(|form| json!(form)).collect()
    }

    pub(super) fn camera_told(&self) -> CameraTold {
        let bounds = self.kept.bounds();
        let around = if bounds.is_empty() { 1.0 } else { f64::from(bounds.diagonal().length()) };
        let (camera, frame) = (self.settings.camera(), &self.settings.frame);
        CameraTold::new(camera, frame, &self.prepared, (around, self.is_exact(&self.original)))
    }

    fn scene_told(&self) -> serde_json::Value {
        let (desc, scene) = (&self.original.desc, &self.prepared.scene);
        let bounds = self.kept.bounds();
        let corner = |p: durer::math::Point3| p.to_array();
        let name = |(i, c): (usize, &durer::scene::CameraDesc)| match c.name.as_str() {
            "" => i.to_string(),
            name => name.to_owned(),
        };
        let textures = desc.textures.iter().take(1000);
        let value = |value| match value {
            durer::scene::TextureValue::Float => "float",
            durer::scene::TextureValue::Color => "color",
        };
        let textures: Vec<_> = textures.map(|t| json!({ "name": t.name, "value": value(t.value) })).collect();
        let time = Kept::times(desc).map_or([0.0; 2], |(first, last)| [first, last]);
        json!({
            "name": self.stage.name,
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

    fn state(&self) -> &'static str {
        if self.stage.trouble().is_some() {
            "error"
        } else if self.take.is_done(&self.job()) {
            "done"
        } else {
            "rendering"
        }
    }

    fn status(&self) -> serde_json::Value {
        self.status_of(self.state())
    }

    fn status_of(&self, state: &str) -> serde_json::Value {
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

    fn say_status(&self, state: &str) {
        self.send(&self.status_of(state));
    }

    /// Says how it goes, if that changed, and not all the time.
    fn tell(&mut self) {
        let state = self.state();
        let recent =
            self.told.as_ref().is_some_and(|(when, what)| what == state && when.elapsed() < BETWEEN_STATUS);
        let finished = self.told.as_ref().is_some_and(|(_, what)| what == state) && !self.wants_samples();
        if recent || finished || self.outbox.is_none() {
            return;
        }
        self.say_status(state);
        self.told = Some((Instant::now(), state.to_owned()));
    }

    /// What is seen in a pixel.
    pub(super) fn pick(&self, id: u64, pixel: [u32; 2]) {
        let seen = pick::seen(&self.prepared, pixel);
        match seen {
            Some(mut told) => {
                told["id"] = id.into();
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

    /// Has a question answered, by another thread; until then rendering rests.
    pub(super) fn question(&mut self, question: Question) {
        if let Some(outbox) = &self.outbox
            && self.answerer.ask(question, outbox.clone())
        {
            self.questions += 1;
        }
    }

    /// Light transport that a question compares with.
    pub(super) fn twin(&self, integrator: &durer::scene::Node) -> Result<Prepared, Complaint> {
        let Settings { desc, options, .. } = &self.settings;
        let mut said = Diagnostics::default();
        let wanted = Wanted { desc, integrator, options };
        let twin = self.opened.studio.retake(wanted, (&self.kept, &self.prepared.scene), &mut said);
        twin.ok_or_else(|| Complaint::errors("trace", &said).unwrap_or_default())
    }

    fn save(&self, format: SaveFormat) -> Result<File, String> {
        save::file(
            format,
            &self.stage.name,
            (&self.settings, &self.opened),
            (&self.job_prepared(), &self.take),
        )
    }

    fn job_prepared(&self) -> Arc<Prepared> {
        Arc::clone(self.shown.as_ref().unwrap_or(&self.prepared))
    }
}

/// The complaint about a pixel that is none of the picture's.
pub(crate) fn outside(prepared: &Prepared, [x, y]: [u32; 2]) -> String {
    let view = &prepared.scene.view;
    format!("pixel {x},{y} lies outside the picture of {} x {} pixels", view.width, view.height)
}

/// What another session shows; `None` if it does not answer.
fn copied(like: &Session) -> Option<Copied> {
    let (sender, answer): (Sender<Copied>, _) = channel();
    like.ask(Request::Copy(sender));
    answer.recv_timeout(Duration::from_secs(5)).ok()
}
