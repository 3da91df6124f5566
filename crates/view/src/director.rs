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

use durer::{Job, Prepared, compile::Kept};
use serde_json::json;

use crate::{
    answer::{Answerer, Question},
    change::Undo,
    form::{Complaint, Effort, FormId},
    layer::Layer,
    save::{self, File, SaveFormat},
    session::{Copied, Out, Outbox, Request, Session},
    settings::Settings,
    stage::{Opened, Stage},
    take::{Pace, Take},
    told::Told,
};

/// How long a session renders if another one waits, and if none does.
const SHORT_TURN: Duration = Duration::from_millis(15);
const LONG_TURN: Duration = Duration::from_millis(60);
/// Pictures that are getting better are sent no more often than this.
const BETWEEN_FRAMES: Duration = Duration::from_millis(100);

/// See above.
pub(crate) struct Director {
    pub(super) stage: Arc<Stage>,
    pub(super) session: Arc<Session>,
    pub(super) opened: Arc<Opened>,
    /// As the scene was opened.
    pub(super) original: Arc<Settings>,
    pub(super) settings: Settings,
    /// What changed since the scene was prepared.
    pub(super) undo: Vec<Undo>,
    pub(super) kept: Kept,
    /// What the integrator sees.
    pub(super) prepared: Arc<Prepared>,
    /// What the layer shows, if it is not that.
    pub(super) shown: Option<Arc<Prepared>>,
    pub(super) layer: Layer,
    /// Of the last camera message.
    pub(super) seq: u64,
    pub(super) take: Take,
    pub(super) pace: Pace,
    cancel: Arc<AtomicBool>,
    pub(super) outbox: Option<Outbox>,
    answerer: Answerer,
    /// Questions that are being answered.
    questions: usize,
    pub(super) paused: bool,
    /// What the requests since the last picture make necessary.
    pub(super) effort: Effort,
    /// Which form was changed last.
    pub(super) changed: Vec<FormId>,
    pub(super) frames: Frames,
    pub(super) told: Option<Told>,
}

/// What was sent of the picture.
#[derive(Debug, Default)]
pub(super) struct Frames {
    count: u64,
    /// Sent and not drawn yet.
    outstanding: Option<u64>,
    /// [`Take::news`] of what was sent; `None` if nothing of this picture was.
    pub(super) news: Option<u64>,
    sent: Option<Instant>,
    /// What the last one took.
    cost: Duration,
}

impl Director {
    pub(crate) fn new(stage: Arc<Stage>, session: Arc<Session>, like: Option<Arc<Session>>) -> Self {
        let opened = stage.opened();
        let original = Arc::clone(&opened.original);
        let prepared = Arc::clone(&opened.prepared);
        let take = Take::new(&prepared.job(), Pace::default());
        let mut new = Self {
            settings: (*original).clone(),
            undo: Vec::new(),
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
            let own = std::mem::replace(&mut new.settings, copied.settings);
            new.undo = vec![Undo::All(Box::new(own)), Undo::Layer(Layer::Beauty)];
            (new.layer, new.seq) = (copied.layer, copied.seq);
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
                Request::Look(answer) => {
                    let look = self.settings.look;
                    let _ = answer.send((look.exposure, look.tonemap(&self.prepared.integrator_name)));
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

    pub(super) fn wants_samples(&self) -> bool {
        self.outbox.is_some() && !self.paused && self.questions == 0 && !self.take.is_done(&self.job())
    }

    pub(super) fn pause(&mut self, paused: bool) {
        self.paused = paused;
        self.told = None;
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
        let hello = self.hello(resumed);
        self.send(&hello);
        self.told = None;
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

    /// Has a question answered, by another thread; until then rendering rests.
    pub(super) fn question(&mut self, question: Question) {
        if let Some(outbox) = &self.outbox
            && self.answerer.ask(question, outbox.clone())
        {
            self.questions += 1;
        }
    }

    fn save(&self, format: SaveFormat) -> Result<File, String> {
        save::file(
            format,
            &self.stage.opener.scene,
            (&self.settings, &self.opened),
            (&self.job_prepared(), &self.take),
        )
    }

    fn job_prepared(&self) -> Arc<Prepared> {
        Arc::clone(self.shown.as_ref().unwrap_or(&self.prepared))
    }
}

/// What another session shows; `None` if it does not answer.
fn copied(like: &Session) -> Option<Copied> {
    let (sender, answer): (Sender<Copied>, _) = channel();
    like.ask(Request::Copy(sender));
    answer.recv_timeout(Duration::from_secs(5)).ok()
}
