//! A stack on the stack that is not zeroed first.
use std::mem::MaybeUninit;

/// Most entries. A tree is at most 64 levels deep and a node puts aside at most 15 children.
const CAPACITY: usize = 64 * 15 + 1;

/// Things put aside by a walk. PERF: zeroing its 8 KiB takes longer than a short ray (bench kernel).
pub(crate) struct Stack {
    slots: [MaybeUninit<u64>; CAPACITY],
    held: usize,
}

impl Stack {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { slots: [const { MaybeUninit::uninit() }; CAPACITY], held: 0 }
    }

    /// # Panics
    /// If the tree is deeper than the builder makes them.
    #[inline(always)]
    pub(crate) fn push(&mut self, entry: u64) {
        self.slots[self.held].write(entry);
        self.held += 1;
    }

    #[inline(always)]
    pub(crate) fn pop(&mut self) -> Option<u64> {
        self.held = self.held.checked_sub(1)?;
        // SAFETY: `held` only grows in `push`, which has then written every slot below it within bounds.
        Some(unsafe { self.slots.get_unchecked(self.held).assume_init() })
    }

    /// Moves the last entry to its place among the last `count`, which are otherwise sorted, largest first.
    #[inline(always)]
    pub(crate) fn settle(&mut self, count: usize) {
        debug_assert!(count <= self.held && count > 0);
        let first = self.held - count;
        let mut at = self.held - 1;
        // SAFETY: all slots below `held` are written, and `first <= at < held`.
        unsafe {
            let entry = self.slots.get_unchecked(at).assume_init();
            while at > first && self.slots.get_unchecked(at - 1).assume_init() < entry {
                *self.slots.get_unchecked_mut(at) = *self.slots.get_unchecked(at - 1);
                at -= 1;
            }
            self.slots.get_unchecked_mut(at).write(entry);
        }
    }
}
