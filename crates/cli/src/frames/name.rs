//! Names of the pictures of a sequence: `out.####.png` or `out.%04d.png`; a number goes before the suffix of a name without
//! a place for it.
use std::path::{Path, PathBuf};

/// Digits where a name says nothing of them.
const DIGITS: usize = 4;

/// The file of a frame.
pub(super) fn numbered(pattern: &Path, frame: u32) -> PathBuf {
    let Some(name) = pattern.file_name().map(|name| name.to_string_lossy().into_owned()) else {
        return pattern.to_owned();
    };
    let (before, digits, after) = place(&name);
    pattern.with_file_name(format!("{before}{frame:0digits$}{after}"))
}

/// What stands before the number, how many digits that has at least, and what stands behind it.
fn place(name: &str) -> (String, usize, &str) {
    if let Some(start) = name.find('#') {
        let after = name[start..].trim_start_matches('#');
        return (name[..start].to_owned(), name.len() - start - after.len(), after);
    }
    if let Some((before, rest)) = name.split_once('%')
        && let Some((digits, after)) = rest.split_once('d')
        && digits.len() <= 2
        && digits.chars().all(|c| c.is_ascii_digit())
        // "50%done" is a word.
        && !(digits.is_empty() && after.starts_with(char::is_alphabetic))
    {
        return (before.to_owned(), digits.parse().unwrap_or(1), after);
    }
    let end = name.rfind('.').unwrap_or(name.len());
    (format!("{}.", &name[..end]), DIGITS, &name[end..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_where_a_name_wants_them() {
        for (pattern, expected) in [
            ("a/out.####.png", "a/out.0007.png"),
            ("out#.png", "out7.png"),
            ("out.%04d.exr", "out.0007.exr"),
            ("out%d.png", "out7.png"),
            ("out%3d_x.png", "out007_x.png"),
            ("out.png", "out.0007.png"),
            ("100%.png", "100%.0007.png"),
            ("50%done.png", "50%done.0007.png"),
        ] {
            assert_eq!(numbered(Path::new(pattern), 7), Path::new(expected), "{pattern}");
        }
        assert_eq!(numbered(Path::new("o.##.png"), 123), Path::new("o.123.png"));
    }
}
