//! Memory for a tree: 32-byte rows, on 2 MiB pages where the system gives them.
use crate::layout::Link;
use std::{
    alloc::{self, Layout},
    fmt,
    ptr::NonNull,
};

/// Bytes of a row; records begin at multiples of it.
pub(crate) const ROW: usize = 32;
/// A page as big as most systems have besides small ones.
const BIG_PAGE: usize = 2 << 20;
/// Alignment of small trees: a cache line.
const LINE: usize = 64;

/// What may lie in [`Pages`].
///
/// # Safety
/// The type holds only `f32` and `u32`, has no padding, an alignment of at most [`ROW`] and a size that is a multiple of it.
pub(crate) unsafe trait Record: Copy {}

/// Rows of plain numbers, zero at first.
pub(crate) struct Pages {
    /// What was allocated: a little more than the rows, which begin at `start`.
    memory: NonNull<u8>,
    start: NonNull<u8>,
    rows: usize,
}

// SAFETY: the memory is owned, plain, and changes only through `&mut`.
unsafe impl Send for Pages {}
// SAFETY: as above.
unsafe impl Sync for Pages {}

impl Pages {
    /// `rows` rows of zeros.
    pub(crate) fn zeroed(rows: usize) -> Self {
        if rows == 0 {
            return Self { memory: NonNull::dangling(), start: NonNull::dangling(), rows };
        }
        let (layout, align) = Self::layout(rows);
        // PERF: asked for with the alignment that any memory has, so that fresh memory, which the system has cleared, is not
        // cleared again: each page is first touched by the thread that writes to it (bench kernel, build).
        // SAFETY: the size of the layout is not 0.
        let memory = unsafe { alloc::alloc_zeroed(layout) };
        let Some(memory) = NonNull::new(memory) else { alloc::handle_alloc_error(layout) };
        let gap = memory.addr().get().next_multiple_of(align) - memory.addr().get();
        // SAFETY: the gap is less than `align`, which the layout has besides the rows.
        let start = unsafe { memory.add(gap) };
        ask_for_big_pages(start, rows * ROW);
        Self { memory, start, rows }
    }

    /// What to allocate for some rows, and what to align them to within.
    fn layout(rows: usize) -> (Layout, usize) {
        let size = rows.checked_mul(ROW).expect("a tree fits into memory");
        let align = if size >= BIG_PAGE { BIG_PAGE } else { LINE };
        let size = size.checked_add(align).expect("a tree fits into memory");
        (Layout::from_size_align(size, align_of::<u64>()).expect("a tree fits into memory"), align)
    }

    pub(crate) fn bytes(&self) -> usize {
        self.rows * ROW
    }

    /// The record that begins at `row`.
    ///
    /// # Panics
    /// If it does not lie within the rows.
    #[inline(always)]
    pub(crate) fn get<R: Record>(&self, row: u32) -> &R {
        self.check::<R>(row);
        // SAFETY: in bounds by the check, aligned to a row, and any bits make an `R`: see `Record`.
        unsafe { &*self.start.as_ptr().add(row as usize * ROW).cast::<R>() }
    }

    /// The same, to change.
    ///
    /// # Panics
    /// If it does not lie within the rows.
    pub(crate) fn get_mut<R: Record>(&mut self, row: u32) -> &mut R {
        self.check::<R>(row);
        // SAFETY: as in `get`; `&mut self` makes the borrow the only one.
        unsafe { &mut *self.start.as_ptr().add(row as usize * ROW).cast::<R>() }
    }

    /// All records from `row` on, to change; they fill the rest of the rows.
    ///
    /// # Panics
    /// If `row` lies beyond the end.
    pub(crate) fn slice_mut<R: Record>(&mut self, row: u32) -> &mut [R] {
        const { assert!(align_of::<R>() <= ROW && size_of::<R>().is_multiple_of(ROW)) };
        let rows = self.rows.checked_sub(row as usize).expect("a row of the tree");
        let count = rows / (size_of::<R>() / ROW);
        if count == 0 {
            // Without rows there is no memory, and its address is aligned to nothing.
            return &mut [];
        }
        // SAFETY: `count` records from `row` on lie within the rows; aligned and plain as in `get`.
        unsafe {
            let first = self.start.as_ptr().add(row as usize * ROW).cast::<R>();
            std::slice::from_raw_parts_mut(first, count)
        }
    }

    /// The first `count` records, of one sort, and the rest, of another, to change.
    ///
    /// # Panics
    /// If there are not as many rows.
    pub(crate) fn split_mut<A: Record, B: Record>(&mut self, count: usize) -> (&mut [A], &mut [B]) {
        const { assert!(align_of::<A>() <= ROW && size_of::<A>().is_multiple_of(ROW)) };
        const { assert!(align_of::<B>() <= ROW && size_of::<B>().is_multiple_of(ROW)) };
        let first = count * (size_of::<A>() / ROW);
        let rest = self.rows.checked_sub(first).expect("rows of the tree") / (size_of::<B>() / ROW);
        if self.rows == 0 {
            return (&mut [], &mut []);
        }
        // SAFETY: both slices lie within the rows, one behind the other; aligned and plain as in `get`.
        unsafe {
            let second = self.start.as_ptr().add(first * ROW);
            let records = std::slice::from_raw_parts_mut(self.start.as_ptr().cast::<A>(), count);
            (records, std::slice::from_raw_parts_mut(second.cast::<B>(), rest))
        }
    }

    #[inline(always)]
    fn check<R: Record>(&self, row: u32) {
        const { assert!(align_of::<R>() <= ROW && size_of::<R>().is_multiple_of(ROW)) };
        assert!(row as usize + size_of::<R>() / ROW <= self.rows, "a record outside the tree");
    }

    /// Where a node or packet lies, for prefetching only; nonsense for other links.
    #[inline(always)]
    pub(crate) fn address(&self, link: Link) -> *const u8 {
        self.start.as_ptr().wrapping_add((link.0 & (Link::LIMIT - 1)) as usize * ROW)
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        if self.rows > 0 {
            // SAFETY: allocated by `zeroed` with the same layout.
            unsafe { alloc::dealloc(self.memory.as_ptr(), Self::layout(self.rows).0) };
        }
    }
}

impl Clone for Pages {
    fn clone(&self) -> Self {
        let copy = Self::zeroed(self.rows);
        // SAFETY: both hold `bytes()` bytes and are different allocations.
        unsafe { self.start.copy_to_nonoverlapping(copy.start, self.bytes()) };
        copy
    }
}

impl fmt::Debug for Pages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pages").field("bytes", &self.bytes()).finish_non_exhaustive()
    }
}

/// An empty vector with room for `count` values, on big pages if that are many.
pub(crate) fn roomy<T>(count: usize) -> Vec<T> {
    let room = Vec::with_capacity(count);
    if size_of::<T>() * count >= 2 * BIG_PAGE {
        let begin = NonNull::from(room.as_slice()).cast::<u8>();
        let gap = begin.addr().get().next_multiple_of(BIG_PAGE) - begin.addr().get();
        // SAFETY: the gap is less than a big page, and the room is larger.
        ask_for_big_pages(unsafe { begin.add(gap) }, size_of::<T>() * room.capacity() - gap);
    }
    room
}

/// Linux: fewer entries of the translation buffer. A refusal costs speed only, so it is not looked at.
#[cfg(target_os = "linux")]
fn ask_for_big_pages(start: NonNull<u8>, bytes: usize) {
    if bytes >= BIG_PAGE {
        // SAFETY: the range was just allocated and begins at a page; the advice changes no contents.
        unsafe { libc::madvise(start.as_ptr().cast(), bytes, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn ask_for_big_pages(_: NonNull<u8>, _: usize) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    #[repr(C)]
    struct Numbers([u32; 8]);
    // SAFETY: 32 bytes of u32.
    unsafe impl Record for Numbers {}

    #[test]
    fn records_keep_what_is_written_and_clones_are_apart() {
        for rows in [1, 3, BIG_PAGE / ROW + 5] {
            let mut pages = Pages::zeroed(rows);
            let last = rows as u32 - 1;
            assert_eq!(*pages.get::<Numbers>(last), Numbers([0; 8]));
            pages.get_mut::<Numbers>(last).0[7] = 5;
            let mut copy = pages.clone();
            copy.get_mut::<Numbers>(last).0[7] = 6;
            assert_eq!((pages.get::<Numbers>(last).0[7], copy.get::<Numbers>(last).0[7]), (5, 6));
        }
        let mut none = Pages::zeroed(0).clone();
        assert_eq!((none.bytes(), none.slice_mut::<Numbers>(0).len()), (0, 0));
    }

    #[test]
    fn two_sorts_of_records_lie_one_behind_the_other() {
        let mut pages = Pages::zeroed(7);
        let (first, second) = pages.split_mut::<Numbers, Numbers>(3);
        assert_eq!((first.len(), second.len()), (3, 4));
        (first[2].0[0], second[0].0[0]) = (1, 2);
        assert_eq!([2, 3].map(|row| pages.get::<Numbers>(row).0[0]), [1, 2]);
    }

    #[test]
    fn big_pages_change_nothing_but_speed() {
        for count in [0, 3, 3 * BIG_PAGE / 4] {
            let mut room = roomy::<u32>(count);
            assert!(room.is_empty() && room.capacity() >= count);
            room.extend(0..count as u32);
            assert!(room.iter().copied().eq(0..count as u32));
        }
    }

    #[test]
    #[should_panic(expected = "a record outside the tree")]
    fn nothing_is_read_beyond_the_end() {
        Pages::zeroed(2).get::<Numbers>(2);
    }
}
