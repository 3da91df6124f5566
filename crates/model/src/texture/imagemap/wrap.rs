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
    /// The image is a sphere's octahedral map: beyond an edge lies the same edge, turned round (Clarberg 2008).
    Octahedral,
}

impl Wrap {
    /// The words of scene files.
    pub(super) const WORDS: &[&str] = &["repeat", "clamp", "mirror", "black", "octahedralsphere"];

    /// The mode of one of [`Self::WORDS`]; repeat for any other.
    pub(super) fn of_word(word: &str) -> Self {
        match word {
            "clamp" => Self::Clamp,
            "mirror" => Self::Mirror,
            "black" => Self::Black,
            "octahedralsphere" => Self::Octahedral,
            _ => Self::Repeat,
        }
    }
    /// Column and row inside an image of this size, at least 1 x 1; `None` for black. The octahedral map concerns both axes:
    /// [`Wrap::Octahedral`] comes twice.
    pub(super) fn texel(wrap: [Self; 2], [x, y]: [i64; 2], size: [u32; 2]) -> Option<[u32; 2]> {
        // PERF: remainders of 64 bits take longer than all the rest (bench render).
        if (0..i64::from(size[0])).contains(&x) && (0..i64::from(size[1])).contains(&y) {
            return Some([x as u32, y as u32]);
        }
        let (mut x, mut y) = (x, y);
        if wrap[0] == Self::Octahedral {
            let [w, h] = size.map(i64::from);
            // Everything repeats after two images.
            (x, y) = (x.rem_euclid(2 * w), y.rem_euclid(2 * h));
            if x >= w {
                (x, y) = (2 * w - 1 - x, (h - 1 - y).rem_euclid(2 * h));
            }
            if y >= h {
                (x, y) = (w - 1 - x, 2 * h - 1 - y);
            }
        }
        Some([wrap[0].index(x, size[0])?, wrap[1].index(y, size[1])?])
    }
    /// The index inside; `None` for black. `size` is at least 1.
    fn index(self, i: i64, size: u32) -> Option<u32> {
        let n = i64::from(size);
        let inside = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp | Self::Octahedral => i.clamp(0, n - 1),
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
