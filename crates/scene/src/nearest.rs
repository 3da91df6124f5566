//! "Did you mean ...?"

/// Bytes of a word that may be one that people type: comparing longer ones takes long and finds nothing.
const LONGEST: usize = 64;

/// The valid word nearest to `word`, if one is near enough to be a slip of the finger.
pub fn nearest_word<'a>(word: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    valid
        .into_iter()
        .filter(|v| v.len() <= 2 * LONGEST)
        .map(|v| (strsim::damerau_levenshtein(&lower, &v.to_lowercase()), v))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, v)| *distance <= 1 + v.len().min(word.len()) / 3)
        .map(|(_, v)| v)
}

#[cfg(test)]
#[allow(clippy::indexing_slicing, reason = "a test that fails may panic")]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let valid = ["radius", "zmin", "reflectance"];
        assert_eq!(nearest_word("raduis", valid), Some("radius"));
        assert_eq!(nearest_word("Reflectence", valid), Some("reflectance"));
        assert_eq!(nearest_word("banana", valid), None);
    }

    #[test]
    fn words_that_nobody_types_are_not_compared() {
        let long = "a".repeat(LONGEST);
        assert_eq!(nearest_word(&long[1..], [long.as_str()]), Some(long.as_str()));
        assert_eq!(nearest_word(&format!("{long}b"), [long.as_str()]), None);
    }
}
