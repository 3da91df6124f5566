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
            return Self { start: NonNull::dangling(), rows };
        }
        let layout = Self::layout(rows);
        // SAFETY: the size of the layout is not 0.
        let start = unsafe { alloc::alloc(layout) };
        let Some(start) = NonNull::new(start) else { alloc::handle_alloc_error(layout) };
        ask_for_big_pages(start, layout.size());
        // SAFETY: `start` was just allocated with this size.
        unsafe { start.as_ptr().write_bytes(0, layout.size()) };
        Self { start, rows }
    }

    fn layout(rows: usize) -> Layout {
        let size = rows.checked_mul(ROW).expect("a tree fits into memory");
        let align = if size >= BIG_PAGE { BIG_PAGE } else { LINE };
        Layout::from_size_align(size, align).expect("a tree fits into memory")
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
            unsafe { alloc::dealloc(self.start.as_ptr(), Self::layout(self.rows)) };
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
    #[should_panic(expected = "a record outside the tree")]
    fn nothing_is_read_beyond_the_end() {
        Pages::zeroed(2).get::<Numbers>(2);
    }
}
