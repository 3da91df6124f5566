//! "Did you mean ...?"

/// Bytes of a word that may be one that people type: comparing longer ones takes long and finds nothing.
const LONGEST: usize = 64;

/// The valid word nearest to `word`, if one is near enough to be a slip of the finger. Of short words nearly all are near
/// each other: up to three letters only one may differ, and words of less than three have no neighbours.
pub fn nearest_word<'a>(word: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    let near_enough = |distance: usize, v: &str| {
        let least = v.chars().count().min(word.chars().count());
        match least {
            0..3 => word.eq_ignore_ascii_case(v),
            3 => distance <= 1,
            _ => distance <= 1 + least / 3,
        }
    };
    valid
        .into_iter()
        .filter(|v| v.len() <= 2 * LONGEST)
        .map(|v| (strsim::damerau_levenshtein(&lower, &v.to_lowercase()), v))
        .filter(|(distance, v)| near_enough(*distance, v))
        .min_by_key(|(distance, _)| *distance)
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
        assert_eq!(nearest_word("foo", ["fo", "f", "vn"]), None);
        assert_eq!(nearest_word("bas", ["bar", "o"]), Some("bar"));
        assert_eq!(nearest_word("kd", ["Kd", "Ks"]), Some("Kd"));
    }

    #[test]
    fn words_that_nobody_types_are_not_compared() {
        let long = "a".repeat(LONGEST);
        assert_eq!(nearest_word(&long[1..], [long.as_str()]), Some(long.as_str()));
        assert_eq!(nearest_word(&format!("{long}b"), [long.as_str()]), None);
    }
}
