//! The live page of durer: a small web server on this machine that renders a scene while you watch, walk through it, change it
//! and ask for the rays of a pixel. `docs/view.md` describes what goes over the wire.
//!
//! One scene and one crew of threads; every page has a session of its own, with its camera and settings, whose thread (the
//! director) changes the scene, renders in turns with the others, and sends pictures as fast as the page takes them. HTTP
//! and WebSockets are served by one more thread, which never waits for a picture.
#![forbid(unsafe_code)]

mod answer;
mod camera;
mod change;
mod develop;
mod director;
mod form;
mod guard;
mod hear;
mod layer;
mod message;
mod pack;
mod page;
mod pick;
mod reopen;
mod save;
mod server;
mod session;
mod settings;
mod socket;
mod stage;
mod take;
mod told;
mod turns;
mod watch;

use std::{
    io,
    net::{SocketAddr, TcpListener},
    sync::{Arc, mpsc},
    thread,
};

use durer::{Imported, Options};
use tokio::sync::watch as signal;

pub use page::PageSource;
pub use settings::Look;
pub use watch::Describe;

use guard::Guard;
use server::Server;
use stage::Stage;
use watch::Opener;

/// What is shown, and where.
pub struct Config {
    /// The scene as the user named it: a file or a built-in one.
    pub scene: String,
    /// What is asked of it.
    pub options: Options,
    /// How its pictures are shown at first.
    pub look: Look,
    /// Where to listen; port 0 takes any that is free.
    pub at: SocketAddr,
    /// The page.
    pub page: PageSource,
    /// Complaints about a scene in words.
    pub describe: Describe,
}

/// A running server. It stops when this is dropped.
pub struct Live {
    guard: Guard,
    stop: signal::Sender<bool>,
    stage: Arc<Stage>,
    thread: Option<thread::JoinHandle<()>>,
    /// Closed, it ends the watch over files.
    watch: Option<mpsc::Sender<()>>,
}

/// Why there is no server.
#[derive(Debug)]
pub enum StartError {
    /// The scene has errors; it comes with its complaints.
    Scene(Box<Imported>),
    /// The system refused.
    System(io::Error),
}

impl From<io::Error> for StartError {
    fn from(error: io::Error) -> Self {
        Self::System(error)
    }
}

impl Live {
    /// Compiles an imported scene and shows it.
    ///
    /// # Errors
    /// If the scene has errors, or the system lets nobody listen there.
    pub fn start(imported: Imported, config: Config) -> Result<Self, StartError> {
        let listener = TcpListener::bind(config.at)?;
        listener.set_nonblocking(true)?;
        let guard = Guard::new(listener.local_addr()?).map_err(io::Error::other)?;
        let Config { scene, options, look, page, describe, .. } = config;
        let opener = Arc::new(Opener { scene, options, look, describe });
        let opened = opener.open(imported, 1).map_err(StartError::Scene)?;
        let stage = Arc::new(Stage::new(Arc::clone(&opener), opened));
        let (stop, stopped) = signal::channel(false);
        let server = Server {
            guard: guard.clone(),
            stage: Arc::clone(&stage),
            page,
            stop: stopped,
            developing: tokio::sync::Semaphore::new(1),
        };
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let serve = move || {
            runtime.block_on(async move {
                if let Ok(listener) = tokio::net::TcpListener::from_std(listener) {
                    Arc::new(server).run(listener).await;
                }
                // Sockets say goodbye.
                tokio::time::sleep(std::time::Duration::from_millis(100)).await;
            });
        };
        let thread = Some(thread::Builder::new().name("durer server".to_owned()).spawn(serve)?);
        let (watch, watched) = mpsc::channel();
        let watched_stage = Arc::clone(&stage);
        thread::Builder::new()
            .name("durer watch".to_owned())
            .spawn(move || opener.watch(&watched_stage, &watched))?;
        Ok(Self { guard, stop, stage, thread, watch: Some(watch) })
    }

    /// The address of the page, secret included.
    pub fn url(&self) -> String {
        format!("http://{}/?token={}", self.guard.at, self.guard.token)
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.guard.at
    }

    /// Shows the caller the scene as it was opened, with its complaints.
    pub fn scene<R>(&self, look: impl FnOnce(&Imported) -> R) -> R {
        look(&self.stage.opened().studio.imported)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        drop(self.watch.take());
        let _ = self.stop.send(true);
        self.stage.close();
        if let Some(thread) = self.thread.take() {
            // It has nothing to say.
            let _ = thread.join();
        }
    }
}
