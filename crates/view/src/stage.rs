//! What all viewers share: the opened scene, the threads, the list of sessions.
use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    time::Duration,
};

use durer::{Prepared, Studio};

use crate::{
    guard::secret, session::Session, settings::Settings, socket::Numbers, turns::Turns, watch::Opener,
};

/// Sessions at once: each keeps a film.
const MOST_SESSIONS: usize = 16;
/// How long a session waits for its viewer to come back.
const PATIENCE: Duration = Duration::from_secs(3600);

/// A scene, opened.
pub(crate) struct Opened {
    pub(crate) studio: Studio,
    /// As it was opened.
    pub(crate) prepared: Arc<Prepared>,
    /// What every viewer sees at first.
    pub(crate) original: Arc<Settings>,
    /// Counts how often it was opened.
    pub(crate) revision: u64,
    /// Warnings, in words.
    pub(crate) warnings: Vec<String>,
}

/// See above.
pub(crate) struct Stage {
    pub(crate) opener: Arc<Opener>,
    pub(crate) turns: Turns,
    /// Open sockets.
    viewers: AtomicUsize,
    pub(crate) numbers: Numbers,
    opened: Mutex<Arc<Opened>>,
    /// Why the scene could not be opened again.
    trouble: Mutex<Option<String>>,
    sessions: Mutex<Vec<Arc<Session>>>,
}

/// What is behind the lock is whole, whoever died holding it.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Stage {
    pub(crate) fn new(opener: Arc<Opener>, opened: Opened) -> Self {
        Self {
            opener,
            turns: Turns::default(),
            viewers: AtomicUsize::new(0),
            numbers: Numbers::new(),
            opened: Mutex::new(Arc::new(opened)),
            trouble: Mutex::new(None),
            sessions: Mutex::default(),
        }
    }

    /// The scene as it was opened last.
    pub(crate) fn opened(&self) -> Arc<Opened> {
        Arc::clone(&lock(&self.opened))
    }

    /// Why that is not the scene on disk, if so.
    pub(crate) fn trouble(&self) -> Option<String> {
        lock(&self.trouble).clone()
    }

    /// The scene was opened again.
    pub(crate) fn reopened(&self, opened: Opened) {
        *lock(&self.opened) = Arc::new(opened);
        *lock(&self.trouble) = None;
        lock(&self.sessions).iter().for_each(|session| session.scene_changed());
    }

    /// It could not be: everybody keeps what there is.
    pub(crate) fn in_trouble(&self, why: String) {
        *lock(&self.trouble) = Some(why);
        lock(&self.sessions).iter().for_each(|session| session.scene_changed());
    }

    /// A session by its id.
    pub(crate) fn session(&self, id: &str) -> Option<Arc<Session>> {
        let sessions = lock(&self.sessions);
        sessions.iter().find(|session| session.id == id && !session.is_over()).cloned()
    }

    /// A new session, like another one if there is one; `None` if there is no room for it.
    pub(crate) fn new_session(self: &Arc<Self>, like: Option<Arc<Session>>) -> Option<Arc<Session>> {
        let mut sessions = lock(&self.sessions);
        sessions.retain(|session| {
            let patient = session.waiting_since().is_none_or(|since| since.elapsed() < PATIENCE);
            let stays = patient && !session.is_over();
            if !stays {
                session.end();
            }
            stays
        });
        if sessions.len() >= MOST_SESSIONS {
            let waiting = (0..).zip(sessions.iter()).filter_map(|(i, s)| Some((s.waiting_since()?, i)));
            let (_, oldest): (_, usize) = waiting.min()?;
            sessions.remove(oldest).end();
        }
        let session = Session::start(self, secret().ok()?, like)?;
        sessions.push(Arc::clone(&session));
        Some(session)
    }

    /// Ends all sessions.
    pub(crate) fn close(&self) {
        lock(&self.sessions).drain(..).for_each(|session| session.end());
    }

    /// A socket was opened.
    pub(crate) fn viewer_came(&self) {
        self.viewers.fetch_add(1, Ordering::Relaxed);
        lock(&self.sessions).iter().for_each(|session| session.scene_changed());
    }

    /// A socket was closed.
    pub(crate) fn viewer_left(&self) {
        self.viewers.fetch_sub(1, Ordering::Relaxed);
        lock(&self.sessions).iter().for_each(|session| session.scene_changed());
    }

    /// Open sockets.
    pub(crate) fn viewer_count(&self) -> usize {
        self.viewers.load(Ordering::Relaxed)
    }
}
