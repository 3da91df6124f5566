//! A viewer's session: what it is asked for, by whom, and the thread that answers. It outlives its socket, so that a viewer
//! that slept finds everything as it was.
use std::{
    collections::VecDeque,
    sync::{
        Arc, Condvar, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::Sender,
    },
    thread,
    time::{Duration, Instant},
};

use durer::film::ToneMap;
use tokio::sync::{mpsc, oneshot};

use crate::{
    director::Director,
    layer::Layer,
    message::Message,
    save::{File, SaveFormat},
    settings::Settings,
    stage::{Stage, lock},
};

/// What goes to the page.
#[derive(Debug)]
pub(crate) enum Out {
    Text(String),
    Frame(Vec<u8>),
    /// The end, for this reason.
    Close(u16, &'static str),
}

/// The way to a page.
#[derive(Clone, Debug)]
pub(crate) struct Outbox {
    sender: mpsc::Sender<Out>,
    /// Sockets are numbered.
    pub(crate) number: u64,
}

impl Outbox {
    /// Messages that wait for a slow page; more are dropped.
    const ROOM: usize = 256;

    pub(crate) fn new(number: u64) -> (Self, mpsc::Receiver<Out>) {
        let (sender, receiver) = mpsc::channel(Self::ROOM);
        (Self { sender, number }, receiver)
    }

    /// Sends, or drops if there is no room: whoever reads nothing misses something.
    pub(crate) fn send(&self, out: Out) {
        let _ = self.sender.try_send(out);
    }
}

/// What a session is asked for.
pub(crate) enum Request {
    /// By the page.
    Said(Message),
    /// By the page, but nobody can read it.
    Unreadable(String),
    /// There is a new socket; the session was there before.
    Connect(Outbox, bool),
    /// A socket is gone.
    Disconnect(u64),
    /// The scene was opened again, or could not be.
    Scene,
    /// A question about a pixel was answered.
    Answered,
    /// A file.
    Save(SaveFormat, oneshot::Sender<Result<File, String>>),
    /// How its light becomes colours.
    Look(oneshot::Sender<(f32, ToneMap)>),
    /// What it shows, for another session.
    Copy(Sender<Copied>),
}

/// What another session begins with.
pub(crate) struct Copied {
    pub(crate) settings: Settings,
    pub(crate) layer: Layer,
    pub(crate) seq: u64,
    pub(crate) revision: u64,
}

/// What waits for the session's thread.
struct Inbox {
    requests: VecDeque<Request>,
    /// Ends the picture that is being rendered.
    cancel: Arc<AtomicBool>,
    /// The session is over.
    ended: bool,
    /// Since when nobody looks.
    waiting: Option<Instant>,
}

/// However the thread ends, nobody waits for it.
struct Over(Arc<Session>);

impl Drop for Over {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// See above.
pub(crate) struct Session {
    /// Nobody can guess it.
    pub(crate) id: String,
    inbox: Mutex<Inbox>,
    filled: Condvar,
}

impl Session {
    /// Requests that wait: a page that sends more is not ours.
    const ROOM: usize = 4096;

    /// Starts the thread; `None` if there is none to be had.
    pub(crate) fn start(stage: &Arc<Stage>, id: String, like: Option<Arc<Self>>) -> Option<Arc<Self>> {
        let inbox = Inbox {
            requests: VecDeque::new(),
            cancel: Arc::default(),
            ended: false,
            waiting: Some(Instant::now()),
        };
        let session = Arc::new(Self { id, inbox: Mutex::new(inbox), filled: Condvar::new() });
        let (own, stage) = (Arc::clone(&session), Arc::clone(stage));
        let run = move || {
            let over = Over(Arc::clone(&own));
            Director::new(stage, own, like).run();
            drop(over);
        };
        thread::Builder::new().name("durer session".to_owned()).spawn(run).ok()?;
        Some(session)
    }

    /// Asks for something.
    pub(crate) fn ask(&self, request: Request) {
        let mut inbox = lock(&self.inbox);
        if inbox.ended {
            return;
        }
        match &request {
            Request::Connect(..) => inbox.waiting = None,
            Request::Said(message) if message.ends_picture() => inbox.cancel.store(true, Ordering::Relaxed),
            _ => {}
        }
        if inbox.requests.len() < Self::ROOM {
            inbox.requests.push_back(request);
        }
        drop(inbox);
        self.filled.notify_all();
    }

    /// The scene was opened again, or could not be.
    pub(crate) fn scene_changed(&self) {
        self.ask(Request::Scene);
    }

    /// Ends the thread.
    pub(crate) fn end(&self) {
        let mut inbox = lock(&self.inbox);
        inbox.ended = true;
        inbox.requests.clear();
        inbox.cancel.store(true, Ordering::Relaxed);
        drop(inbox);
        self.filled.notify_all();
    }

    /// Since when nobody looks; `None` if somebody does.
    pub(crate) fn waiting_since(&self) -> Option<Instant> {
        lock(&self.inbox).waiting
    }

    /// Nobody looks any more.
    pub(crate) fn begin_waiting(&self) {
        lock(&self.inbox).waiting = Some(Instant::now());
    }

    /// Whether its thread has ended or will.
    pub(crate) fn is_over(&self) -> bool {
        lock(&self.inbox).ended
    }

    /// Whether somebody asked for something.
    pub(crate) fn is_asked(&self) -> bool {
        let inbox = lock(&self.inbox);
        inbox.ended || !inbox.requests.is_empty()
    }

    /// All requests, with a new flag that tells when the picture to come is of no use; waits for one so long, or for ever.
    /// `None` when the session is over.
    pub(crate) fn requests(&self, wait: Option<Duration>) -> Option<(VecDeque<Request>, Arc<AtomicBool>)> {
        let mut inbox = lock(&self.inbox);
        let until = wait.map(|wait| Instant::now() + wait);
        while inbox.requests.is_empty() && !inbox.ended {
            let left = until.map(|until| until.saturating_duration_since(Instant::now()));
            inbox = match left {
                Some(Duration::ZERO) => break,
                Some(left) => self.filled.wait_timeout(inbox, left).unwrap_or_else(PoisonError::into_inner).0,
                None => self.filled.wait(inbox).unwrap_or_else(PoisonError::into_inner),
            };
        }
        if inbox.ended {
            return None;
        }
        if inbox.cancel.load(Ordering::Relaxed) {
            inbox.cancel = Arc::default();
        }
        Some((std::mem::take(&mut inbox.requests), Arc::clone(&inbox.cancel)))
    }
}
