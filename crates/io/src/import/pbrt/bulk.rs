//! Long lists of numbers, which most of a large file is: read without a token for each, in pieces by several threads.
//!
//! What is no number between blanks ends this; it is left to the reader of tokens, which knows what to say of it.
//! PERF: `cargo xtask bench load`.
use rayon::prelude::*;

use super::{lexer::scan_word, number};
use crate::import::text::{PIECE, leading_float, leading_integer};

/// What lists hold.
pub(super) trait Listed: Copy + Send {
    /// The number that `text` begins with and the bytes it takes.
    fn leading(text: &[u8]) -> Option<(Self, usize)>;
}

impl Listed for f32 {
    #[inline]
    fn leading(text: &[u8]) -> Option<(Self, usize)> {
        leading_float(text).or_else(|| rare(text, number::float32))
    }
}

impl Listed for i32 {
    #[inline]
    fn leading(text: &[u8]) -> Option<(Self, usize)> {
        let short = leading_integer(text).and_then(|(value, len)| Some((Self::try_from(value).ok()?, len)));
        short.or_else(|| rare(text, number::int32))
    }
}

/// A number that is long, or that a bracket follows.
#[cold]
fn rare<T, E>(text: &[u8], read: fn(&str) -> Result<T, E>) -> Option<(T, usize)> {
    let len = scan_word(text, 0);
    let word = std::str::from_utf8(text.get(..len)?).ok()?;
    read(word).ok().map(|value| (value, len))
}

/// Appends the numbers that `text` begins with; returns how many bytes they and the blanks around them take.
pub(super) fn numbers<T: Listed>(text: &[u8], values: &mut Vec<T>) -> usize {
    let end = memchr::memchr3(b']', b'#', b'"', text).unwrap_or(text.len());
    let whole = text.get(..end).unwrap_or_default();
    let pieces = pieces(whole);
    if let [only] = pieces.as_slice() {
        return read(only, values);
    }
    let apart = |piece: &[u8]| {
        let mut own = Vec::with_capacity(piece.len() / 8);
        let len = read(piece, &mut own);
        (own, len, len == piece.len())
    };
    let read: Vec<(Vec<T>, usize, bool)> = pieces.into_par_iter().map(apart).collect();
    values.reserve(read.iter().map(|(own, ..)| own.len()).sum());
    let mut taken = 0;
    for (own, len, is_whole) in read {
        values.extend_from_slice(&own);
        taken += len;
        if !is_whole {
            break;
        }
    }
    taken
}

/// Cut at blanks into pieces of about [`PIECE`] bytes.
fn pieces(mut text: &[u8]) -> Vec<&[u8]> {
    let mut pieces = Vec::with_capacity(text.len() / PIECE + 1);
    while let Some(behind) = text.get(PIECE..).filter(|behind| behind.len() > PIECE / 2) {
        let blank = behind.iter().position(|b| is_blank(*b)).unwrap_or(behind.len());
        let (piece, rest) = text.split_at_checked(PIECE + blank).unwrap_or((text, &[]));
        pieces.push(piece);
        text = rest;
    }
    pieces.push(text);
    pieces
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\t' | b'\r')
}

/// Appends the numbers that a piece begins with; returns where what is none begins.
fn read<T: Listed>(text: &[u8], values: &mut Vec<T>) -> usize {
    let mut rest = text;
    loop {
        while let [b' ' | b'\n' | b'\t' | b'\r', behind @ ..] = rest {
            rest = behind;
        }
        let Some((value, len)) = T::leading(rest) else { break };
        values.push(value);
        rest = rest.get(len..).unwrap_or_default();
    }
    text.len() - rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_up_to_what_is_none() {
        for (text, expected, taken) in [
            ("1 -2.5\n3e1 ]", &[1.0, -2.5, 30.0][..], 11),
            ("1 2] 3", &[1.0, 2.0], 3),
            ("1 2# 3\n4", &[1.0, 2.0], 3),
            ("0.100000000000000000000001 1 x 2", &[0.1, 1.0], 29),
            ("1 inf", &[1.0], 2),
            ("1e39", &[], 0),
            ("", &[], 0),
        ] {
            let mut values: Vec<f32> = Vec::new();
            assert_eq!(
                (numbers(text.as_bytes(), &mut values), values.as_slice()),
                (taken, expected),
                "{text}"
            );
        }
        let mut values: Vec<i32> = vec![7];
        assert_eq!(numbers(b"1 -2 +3 2147483648 4", &mut values), 8);
        assert_eq!(values, [7, 1, -2, 3]);
    }

    #[test]
    fn long_lists_are_cut_between_numbers() {
        let count = PIECE / 2;
        let mut text: String = (0..count).map(|i| format!("{i} ")).collect();
        let mut values: Vec<i32> = Vec::new();
        assert!(pieces(text.as_bytes()).len() > 2);
        assert_eq!(numbers(text.as_bytes(), &mut values), text.len());
        assert!(values.len() == count && values.iter().zip(0..).all(|(a, b)| *a == b));
        // What is wrong in the first piece ends it there, whatever the others hold.
        text.replace_range(1000..1003, " x ");
        values.clear();
        assert_eq!(numbers(text.as_bytes(), &mut values), 1001);
        assert!(values.len() < 300);
    }
}
