//! Corners of faces: `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from -1.
use crate::import::text::{Part, ends, integer, short_integer};

/// What a corner says of an attribute it does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Why an index is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrong {
    /// Not of the form above.
    Form,
    /// There is no such element.
    Range(i64),
}

/// The corner that `text` begins with and the bytes it takes, if it is sound: nearly all are. For the others there is
/// [`resolve`]. PERF: `cargo xtask bench load`.
#[inline]
pub(super) fn leading(text: &[u8], so_far: [usize; 3], total: [usize; 3]) -> Option<([u32; 3], usize)> {
    let mut indices = [NONE; 3];
    let mut rest = text;
    for (place, (index, (before, all))) in indices.iter_mut().zip(so_far.into_iter().zip(total)).enumerate() {
        match rest {
            [b'/', ..] if place > 0 => {}
            _ => {
                let (written, behind) = short_integer(rest)?;
                *index = from_zero(written, before).filter(|&i| (i as usize) < all)?;
                rest = behind;
            }
        }
        match rest {
            [b'/', behind @ ..] => rest = behind,
            _ => return ends(rest).then_some((indices, text.len() - rest.len())),
        }
    }
    None
}

/// An index as written, counted from 0.
#[inline]
fn from_zero(written: i64, before: usize) -> Option<u32> {
    u32::try_from(if written < 0 { before as i64 + written } else { written - 1 }).ok()
}

/// Position, texture coordinates and normal as indices from 0. `so_far` counts what stands before, `total` what is in
/// the whole file; texture coordinates and normals that are not there are counted in `lost`.
#[inline]
pub(super) fn resolve(
    word: Part<'_>,
    so_far: [usize; 3],
    total: [usize; 3],
    lost: &mut [usize; 2],
) -> Result<[u32; 3], Wrong> {
    let mut fields = word.bytes.split(|&b| b == b'/');
    let mut indices = [NONE; 3];
    for (place, index) in indices.iter_mut().enumerate() {
        let Some(field) = fields.next() else {
            break;
        };
        if field.is_empty() && place > 0 {
            continue;
        }
        let written = integer(field).or_else(|| huge(field)).ok_or(Wrong::Form)?;
        let (before, all) = (so_far.get(place).copied().unwrap_or(0), total.get(place).copied().unwrap_or(0));
        match from_zero(written, before).filter(|&i| (i as usize) < all) {
            Some(found) => *index = found,
            None if place == 0 => return Err(Wrong::Range(written)),
            None => {
                if let Some(lost) = lost.get_mut(place - 1) {
                    *lost += 1;
                }
            }
        }
    }
    if fields.next().is_some() { Err(Wrong::Form) } else { Ok(indices) }
}

/// A whole number of more than 18 digits, as one that no file has as many vertices for.
fn huge(field: &[u8]) -> Option<i64> {
    let digits = field.strip_prefix(b"-").unwrap_or(field);
    let is_whole = digits.len() > 18 && digits.iter().all(u8::is_ascii_digit);
    let most = 999_999_999_999_999_999;
    is_whole.then_some(if digits.len() < field.len() { -most } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways, which must agree.
    fn at(word: &str) -> (Result<[u32; 3], Wrong>, usize) {
        let mut lost = [0; 2];
        let (so_far, total) = ([5, 4, 3], [10, 8, 6]);
        let found = resolve(Part::whole(word.as_bytes()), so_far, total, &mut lost);
        for behind in ["", " 1", "\r"] {
            if let Some((corner, len)) = leading(format!("{word}{behind}").as_bytes(), so_far, total) {
                assert_eq!((found, lost, len), (Ok(corner), [0; 2], word.len()), "{word}");
            }
        }
        (found, lost.iter().sum())
    }

    #[test]
    fn sound_corners_are_read_at_once() {
        let read = |text: &str| leading(text.as_bytes(), [5, 4, 3], [10, 8, 6]);
        assert_eq!(read("10/8/-1 7"), Some(([9, 7, 2], 7)));
        assert_eq!(read("2//6\n"), Some(([1, NONE, 5], 4)));
        assert_eq!(read("3"), Some(([2, NONE, NONE], 1)));
        for text in ["", "0", "11", "1/9", "1/2/3/4", "1/1a", "-", "1\\", "99999999999999999999"] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn all_four_forms_count_from_one_or_backwards() {
        assert_eq!(at("1"), (Ok([0, NONE, NONE]), 0));
        assert_eq!(at("10/8"), (Ok([9, 7, NONE]), 0));
        assert_eq!(at("2//6"), (Ok([1, NONE, 5]), 0));
        assert_eq!(at("-1/-1/-1"), (Ok([4, 3, 2]), 0));
        assert_eq!(at("1//"), (Ok([0, NONE, NONE]), 0));
        assert_eq!(at("1/0/7"), (Ok([0, NONE, NONE]), 2));
        assert_eq!(at("0"), (Err(Wrong::Range(0)), 0));
        assert_eq!(at("11"), (Err(Wrong::Range(11)), 0));
        assert_eq!(at("99999999999999999999999").0, Err(Wrong::Range(999_999_999_999_999_999)));
        assert_eq!(at("-9223372036854775808").0, Err(Wrong::Range(-999_999_999_999_999_999)));
        assert_eq!(at("-6"), (Err(Wrong::Range(-6)), 0));
        for word in ["", "/1", "1/2/3/4", "a", "1.5"] {
            assert_eq!(at(word).0, Err(Wrong::Form), "{word}");
        }
    }
}
