//! What lies beyond an image's edge, decided on texel indices.

/// How texel indices outside `[0, size)` are brought inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrap {
    /// The image repeats.
    Repeat,
    /// The outermost texel continues.
    Clamp,
    /// The image repeats, every other time mirrored; edge texels appear twice.
    Mirror,
    /// Nothing: zero.
    Black,
}

impl Wrap {
    /// The words of scene files.
    pub(super) const WORDS: &[&str] = &["repeat", "clamp", "mirror", "black"];

    /// The mode of one of [`Self::WORDS`]; repeat for any other.
    pub(super) fn of_word(word: &str) -> Self {
        match word {
            "clamp" => Self::Clamp,
            "mirror" => Self::Mirror,
            "black" => Self::Black,
            _ => Self::Repeat,
        }
    }
    /// The index inside; `None` for black. `size` is at least 1.
    pub(super) fn index(self, i: i64, size: u32) -> Option<u32> {
        let n = i64::from(size);
        let inside = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let twice = i.rem_euclid(2 * n);
                twice.min(2 * n - 1 - twice)
            }
            Self::Black if (0..n).contains(&i) => i,
            Self::Black => return None,
        };
        Some(inside as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_matches_a_row_written_by_hand() {
        let row = |wrap: Wrap| -> String {
            (-7..7).map(|i| wrap.index(i, 3).map_or('.', |i| ['a', 'b', 'c'][i as usize])).collect()
        };
        assert_eq!(row(Wrap::Repeat), "cabcabcabcabca");
        assert_eq!(row(Wrap::Clamp), "aaaaaaaabccccc");
        assert_eq!(row(Wrap::Mirror), "aabccbaabccbaa");
        assert_eq!(row(Wrap::Black), ".......abc....");
    }
}
