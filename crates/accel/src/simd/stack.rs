//! A stack on the stack that is not zeroed first.
use std::mem::MaybeUninit;

/// Most entries. A tree is at most 64 levels deep and a node puts aside at most 15 children.
const CAPACITY: usize = 64 * 15 + 1;

/// Memory for a [`Stack`]. PERF: zeroing its 8 KiB takes longer than a short ray (bench kernel).
pub(crate) struct Slots([MaybeUninit<u64>; CAPACITY]);

impl Slots {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; CAPACITY])
    }
}

/// Things put aside by a walk. PERF: apart from its memory, so that the count stays in a register (bench kernel).
pub(crate) struct Stack<'s> {
    slots: &'s mut Slots,
    held: usize,
}

impl<'s> Stack<'s> {
    #[inline(always)]
    pub(crate) fn new(slots: &'s mut Slots) -> Self {
        Self { slots, held: 0 }
    }

    /// # Panics
    /// If the tree is deeper than the builder makes them.
    #[inline(always)]
    pub(crate) fn push(&mut self, entry: u64) {
        self.slots.0[self.held].write(entry);
        self.held += 1;
    }

    #[inline(always)]
    pub(crate) fn pop(&mut self) -> Option<u64> {
        self.held = self.held.checked_sub(1)?;
        // SAFETY: `held` only grows in `push`, which has then written every slot below it within bounds.
        Some(unsafe { self.slots.0.get_unchecked(self.held).assume_init() })
    }

    /// Puts an entry among the last `count`, which are sorted, largest first.
    ///
    /// # Panics
    /// If the tree is deeper than the builder makes them.
    #[inline(always)]
    pub(crate) fn insert(&mut self, entry: u64, count: usize) {
        debug_assert!(count <= self.held);
        let first = self.held - count.min(self.held);
        let mut at = self.held;
        self.push(entry);
        // SAFETY: all slots below `held` are written, and `first < at < held`.
        unsafe {
            while at > first && self.slots.0.get_unchecked(at - 1).assume_init() < entry {
                *self.slots.0.get_unchecked_mut(at) = *self.slots.0.get_unchecked(at - 1);
                at -= 1;
            }
            self.slots.0.get_unchecked_mut(at).write(entry);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_in_comes_out_sorted_where_asked() {
        let mut slots = Slots::new();
        let mut stack = Stack::new(&mut slots);
        assert_eq!(stack.pop(), None);
        stack.push(1);
        for (count, entry) in [5, 9, 2, 7].into_iter().enumerate() {
            stack.insert(entry, count);
        }
        let popped: Vec<_> = std::iter::from_fn(|| stack.pop()).collect();
        assert_eq!(popped, [2, 5, 7, 9, 1]);
    }

    #[test]
    #[should_panic(expected = "index out of bounds")]
    fn too_deep_a_tree_is_no_silent_overflow() {
        let mut slots = Slots::new();
        let mut stack = Stack::new(&mut slots);
        (0..=CAPACITY as u64).for_each(|entry| stack.push(entry));
    }
}
