//! Ctrl-C: the first ends the render and keeps the picture so far, the second ends everything at once.
use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use crate::exit::{Exit, tell};

/// A promise to notice Ctrl-C.
pub(crate) struct Interrupt {
    cancel: Arc<AtomicBool>,
    rendering: Arc<AtomicBool>,
}

impl Interrupt {
    /// Starts to listen. Before [`Interrupt::rendering`] there is nothing to keep: Ctrl-C ends the program. After it the user
    /// is told `what` becomes of what there is.
    ///
    /// Shells let background jobs of scripts ignore the signal; someone who sends it all the same means it.
    pub(crate) fn listen(what: &'static str) -> anyhow::Result<Self> {
        let this = Self { cancel: Arc::default(), rendering: Arc::default() };
        let (cancel, rendering) = (Arc::clone(&this.cancel), Arc::clone(&this.rendering));
        ctrlc::set_handler(move || {
            let second = cancel.swap(true, Ordering::Relaxed);
            if second || !rendering.load(Ordering::Relaxed) {
                std::process::exit(Exit::Interrupted as i32);
            }
            tell(&format!("\ninterrupted: {what} (Ctrl-C again to leave at once)"));
        })?;
        Ok(this)
    }

    /// From now on there is something to keep. The flag to watch.
    pub(crate) fn rendering(&self) -> &AtomicBool {
        self.rendering.store(true, Ordering::Relaxed);
        &self.cancel
    }
}
