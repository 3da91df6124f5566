//! What the readers of text formats (OBJ, MTL, ASCII PLY and STL) share: lines and words with their places, numbers, and
//! complaints that point into the text.

mod complaint;
mod lines;
mod number;

pub(crate) use complaint::{Complaint, Tally, grouped, tell};
pub(crate) use lines::{Part, Words, is_continued};
pub(crate) use number::{float, integer, leading_float, leading_integer};
