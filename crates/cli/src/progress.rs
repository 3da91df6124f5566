//! The progress bar: percent, time left, rates. Drawn on a terminal only.
use std::{
    fmt::Write,
    io::{IsTerminal, stderr},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use durer::Progress;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

const TEMPLATE: &str = "{percent:>3}% {wide_bar} {eta} left, {rates}";

/// A bar on stderr, or nothing.
pub(crate) struct Bar {
    bar: ProgressBar,
    rays: Arc<AtomicU64>,
}

impl Bar {
    /// A bar for so many samples; invisible if `quiet` or if stderr is no terminal.
    pub(crate) fn new(samples: u64, quiet: bool) -> Self {
        let rays = Arc::new(AtomicU64::new(0));
        if quiet || !stderr().is_terminal() {
            return Self { bar: ProgressBar::hidden(), rays };
        }
        let bar = ProgressBar::new(samples);
        let counted = Arc::clone(&rays);
        let rates = move |state: &ProgressState, text: &mut dyn Write| {
            let seconds = state.elapsed().as_secs_f64().max(1e-3);
            let per_second = |n: u64| n as f64 / seconds / 1e6;
            let (samples, rays) = (per_second(state.pos()), per_second(counted.load(Ordering::Relaxed)));
            let _ = write!(text, "{samples:.2} Msamples/s, {rays:.2} Mrays/s");
        };
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            bar.set_style(style.with_key("rates", rates));
        }
        // One sample of a large picture may take longer than a reader's patience.
        bar.enable_steady_tick(Duration::from_millis(250));
        Self { bar, rays }
    }

    /// So many samples there are by now and in what follows.
    pub(crate) fn expect(&self, following: u64) {
        self.bar.set_length(self.bar.position().saturating_add(following));
    }
    /// Makes room on the terminal while something else is said.
    pub(crate) fn pause<T>(&self, work: impl FnOnce() -> T) -> T {
        self.bar.suspend(work)
    }

    /// Wipes the bar.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bar {
    fn advance(&self, samples: u64, rays: u64) {
        self.rays.fetch_add(rays, Ordering::Relaxed);
        self.bar.inc(samples);
    }
}
