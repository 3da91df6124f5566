//! What the readers of text formats (OBJ, MTL, ASCII PLY and STL) share: lines and words with their places, numbers, and
//! complaints that point into the text.

mod complaint;
mod lines;
mod number;

pub(crate) use complaint::{Complaint, Tally, grouped, tell};
pub(crate) use lines::{PIECE, Part, Words, is_continued};
pub(crate) use number::{ends, float, integer, leading_float, leading_integer, short_integer};

/// The text with LF for CR if lines end in CR alone, as on old Macintosh computers; places stay the same.
pub(crate) fn with_line_feeds(mut text: Vec<u8>) -> Vec<u8> {
    if memchr::memchr(b'\n', &text).is_none() {
        text.iter_mut().filter(|b| **b == b'\r').for_each(|b| *b = b'\n');
    }
    text
}
