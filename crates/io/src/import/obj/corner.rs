//! Corners of faces: `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from -1.
use crate::import::text::{Part, integer};

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
        let from_zero = if written < 0 { before as i64 + written } else { written - 1 };
        match u32::try_from(from_zero).ok().filter(|&i| (i as usize) < all) {
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

    fn at(word: &str) -> (Result<[u32; 3], Wrong>, usize) {
        let mut lost = [0; 2];
        let found = resolve(Part::whole(word.as_bytes()), [5, 4, 3], [10, 8, 6], &mut lost);
        (found, lost.iter().sum())
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
