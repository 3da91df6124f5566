//! Tiles to threads: whoever is free takes the next one.
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::film::Tile;

/// Calls `work` once for every tile, on up to `threads` threads, in no order that may matter; stops handing out once
/// `cancel` is set. Every thread has one `S` of its own.
pub(super) fn share_out<S: Default>(
    tiles: &[Tile],
    threads: usize,
    cancel: &AtomicBool,
    work: impl Fn(Tile, &mut S) + Sync,
) {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut own = S::default();
        while let Some(&tile) = tiles.get(next.fetch_add(1, Ordering::Relaxed)) {
            if cancel.load(Ordering::Relaxed) {
                return;
            }
            work(tile, &mut own);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.clamp(1, tiles.len().max(1)) {
            scope.spawn(worker);
        }
        worker();
    });
}
