//! Work to threads: whoever is free takes the next item, a tile or a pixel.
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Calls `work` once for every item, on up to `threads` threads, in no order that may matter; stops handing out once
/// `cancel` is set. Every thread has one `S` of its own.
pub(super) fn share_out<T: Copy + Sync, S: Default>(
    items: &[T],
    threads: usize,
    cancel: &AtomicBool,
    work: impl Fn(T, &mut S) + Sync,
) {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut own = S::default();
        while let Some(&item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            if cancel.load(Ordering::Relaxed) {
                return;
            }
            work(item, &mut own);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.clamp(1, items.len().max(1)) {
            scope.spawn(worker);
        }
        worker();
    });
}
