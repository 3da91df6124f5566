//! Watches the scene's files and opens the scene again when one of them changes.
//!
//! Looked at a few times a second rather than asked of the system: that works alike on every system, on network drives, and
//! with editors that replace files.
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{Receiver, RecvTimeoutError},
    },
    time::{Duration, SystemTime},
};

use durer::{Imported, Options, Studio, import::Play, scene::Severity};

use crate::{
    settings::{Look, Settings},
    stage::{Opened, Stage},
};

/// Between two looks.
const BETWEEN_LOOKS: Duration = Duration::from_millis(250);

/// How the scene is opened.
pub(crate) struct Opener {
    /// As the user named it.
    pub(crate) scene: String,
    pub(crate) options: Options,
    /// How its pictures are shown at first.
    pub(crate) look: Look,
    /// Complaints in words.
    pub(crate) describe: Describe,
}

/// Complaints of at least this severity, in words.
pub type Describe = Box<dyn Fn(&Imported, Severity) -> String + Send + Sync>;

/// What is seen of a file; `None` if it is not there.
type Stamp = Option<(SystemTime, u64)>;

impl Opener {
    /// Compiles an imported scene.
    ///
    /// # Errors
    /// The scene with its complaints.
    pub(crate) fn open(&self, imported: Imported, revision: u64) -> Result<Opened, Box<Imported>> {
        self.compiled(imported, &self.options, revision)
    }

    /// The scene as its animations have it at another moment, read anew.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub(crate) fn posed(&self, time: f32, revision: u64) -> Result<Opened, String> {
        let play = if self.options.play == Play::Rest { Play::First } else { self.options.play.clone() };
        let options = Options { time, play, ..self.options.clone() };
        let imported = durer::open_for(&self.scene, &options);
        let posed = self.compiled(imported, &options, revision);
        posed.map_err(|imported| (self.describe)(&imported, Severity::Error))
    }

    fn compiled(
        &self,
        imported: Imported,
        options: &Options,
        revision: u64,
    ) -> Result<Opened, Box<Imported>> {
        let (studio, prepared) = Studio::open(imported, options)?;
        let warnings = (self.describe)(&studio.imported, Severity::Warning);
        let warnings = if warnings.is_empty() { Vec::new() } else { vec![warnings] };
        let original = Arc::new(Settings::new(&studio, self.look));
        Ok(Opened { studio, prepared: Arc::new(prepared), original, revision, warnings })
    }

    /// The files that the scene was read from.
    fn files(&self, imported: &Imported) -> BTreeSet<PathBuf> {
        let mut files: BTreeSet<PathBuf> = imported.assets.files_read().into_iter().collect();
        if durer::builtin::find(&self.scene).is_none() {
            files.insert(PathBuf::from(&self.scene));
            files.extend(imported.sources.names().map(PathBuf::from).filter(|name| name.is_file()));
        }
        files.extend(self.options.environment.clone());
        files
    }

    /// Looks until `stop` is closed.
    pub(crate) fn watch(&self, stage: &Stage, stop: &Receiver<()>) {
        let rest = || stop.recv_timeout(BETWEEN_LOOKS) == Err(RecvTimeoutError::Timeout);
        let mut revision = stage.opened().revision;
        let mut known = stamps(&self.files(&stage.opened().studio.imported));
        while rest() {
            let mut seen = again(&known);
            if seen == known {
                continue;
            }
            // A file that is being written changes again.
            while rest() {
                let now = again(&seen);
                if now == std::mem::replace(&mut seen, now.clone()) {
                    break;
                }
            }
            known = seen;
            match self.open(durer::open_for(&self.scene, &self.options), revision + 1) {
                Ok(opened) => {
                    revision += 1;
                    let files = stamps(&self.files(&opened.studio.imported));
                    // What changed while it was read is looked at once more.
                    known = files
                        .into_iter()
                        .map(|(file, now)| (file.clone(), known.get(&file).copied().unwrap_or(now)))
                        .collect();
                    stage.reopened(opened);
                }
                Err(imported) => {
                    // What it was read from so far, beside what it was read from before: what is missing may come.
                    for (file, now) in stamps(&self.files(&imported)) {
                        known.entry(file).or_insert(now);
                    }
                    stage.in_trouble((self.describe)(&imported, Severity::Error));
                }
            }
        }
    }
}

fn stamps(files: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Stamp> {
    files.iter().map(|file| (file.clone(), stamp(file))).collect()
}

fn again(files: &BTreeMap<PathBuf, Stamp>) -> BTreeMap<PathBuf, Stamp> {
    files.keys().map(|file| (file.clone(), stamp(file))).collect()
}

fn stamp(file: &Path) -> Stamp {
    let data = fs::metadata(file).ok()?;
    Some((data.modified().ok()?, data.len()))
}
