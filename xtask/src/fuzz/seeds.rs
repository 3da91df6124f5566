//! What a target begins with: small files of its format from the test files and from the project itself, and the words in
//! them.
use std::{
    collections::BTreeMap,
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};

use anyhow::Context;

use super::target::Target;
use crate::root;

/// Most words of a dictionary: the most frequent ones.
const MOST_WORDS: usize = 500;
/// Lengths of words that are worth it.
const LENGTHS: std::ops::RangeInclusive<usize> = 3..=48;

/// Gathers what `target` begins with into `corpus`, and writes its `words`; says how many files there are.
pub(super) fn gather(
    target: &Target,
    assets: Option<&Path>,
    corpus: &Path,
    words: &Path,
) -> anyhow::Result<usize> {
    fs::create_dir_all(corpus).with_context(|| format!("{} cannot be made", corpus.display()))?;
    let (root, mut files) = (root()?, Vec::new());
    for folder in
        ["crates", "benches", "tests"].map(|f| root.join(f)).iter().map(PathBuf::as_path).chain(assets)
    {
        below(folder, &mut files);
    }
    files.retain(|file| is_of(target, file));
    below(&root.join("fuzz/seeds").join(target.name), &mut files);
    let mut counts = BTreeMap::new();
    for (number, file) in files.iter().enumerate() {
        let bytes = match target.name {
            "obj" => with_materials(file)?,
            _ => fs::read(file)?,
        };
        if target.is_wordy {
            count_words(&bytes, &mut counts);
        }
        fs::write(corpus.join(format!("seed-{number}")), bytes)?;
    }
    // An empty one is an error to libFuzzer.
    if target.is_wordy {
        fs::write(words, dictionary(counts))?;
    }
    Ok(files.len())
}

/// All files in a folder and those below, in the order of their names.
fn below(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    entries.sort();
    for entry in entries {
        match entry.is_dir() {
            true => below(&entry, files),
            false => files.push(entry),
        }
    }
}

fn is_of(target: &Target, file: &Path) -> bool {
    let suffix = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let short = || file.metadata().is_ok_and(|about| about.len() <= target.longest);
    target.suffixes.contains(&suffix.as_str()) && short()
}

/// A model, a zero byte, and the library that it names, as the target wants it.
fn with_materials(file: &Path) -> anyhow::Result<Vec<u8>> {
    let bytes = fs::read(file)?;
    let Ok(text) = std::str::from_utf8(&bytes) else { return Ok(bytes) };
    let name = text.lines().find_map(|line| line.strip_prefix("mtllib ")).map(str::trim);
    let library = name.and_then(|name| fs::read(file.with_file_name(name)).ok());
    let (Some(name), Some(library)) = (name, library) else { return Ok(bytes) };
    Ok([text.replacen(name, "fuzzed.mtl", 1).as_bytes(), b"\0", &library].concat())
}

/// Counts words, and strings with what is around them.
fn count_words(bytes: &[u8], counts: &mut BTreeMap<String, usize>) {
    let is_inner = |c: u8| c.is_ascii_alphanumeric() || b"_-:.".contains(&c);
    let words = bytes.split(|&c| !is_inner(c)).filter(|w| w.first().is_some_and(u8::is_ascii_alphabetic));
    let is_plain = |s: &&[u8]| s.iter().all(|&c| is_inner(c) || c == b' ');
    let strings = bytes.split(|&c| c == b'"').filter(|s| s.contains(&b' ')).filter(is_plain);
    for word in words.chain(strings).filter(|w| LENGTHS.contains(&w.len())) {
        *counts.entry(String::from_utf8_lossy(word).into_owned()).or_default() += 1;
    }
}

/// As libFuzzer reads them.
fn dictionary(counts: BTreeMap<String, usize>) -> String {
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts.into_iter().take(MOST_WORDS).fold(String::new(), |mut all, (word, _)| {
        let _ = writeln!(all, "\"{word}\"");
        all
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_the_files_most_frequent_first() {
        let mut counts = BTreeMap::new();
        count_words(b"Shape \"trianglemesh\" \"point3 P\" [1 2e5 3] Shape\n# \xff x", &mut counts);
        let words = dictionary(counts);
        assert_eq!(words.lines().next(), Some("\"Shape\""));
        assert!(words.contains("\"point3 P\"") && words.contains("\"trianglemesh\""));
        assert!(!words.contains("2e5") && !words.contains("\"P\"") && !words.contains('#'));
    }

    #[test]
    fn materials_follow_their_model() {
        let folder = std::env::temp_dir().join(format!("durer-seeds-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join("m.obj"), "mtllib m.mtl\nv 0 0 0\n").expect("a file");
        fs::write(folder.join("m.mtl"), "newmtl a\n").expect("a file");
        let joined = with_materials(&folder.join("m.obj")).expect("files");
        fs::remove_dir_all(&folder).expect("the folder");
        assert_eq!(joined, b"mtllib fuzzed.mtl\nv 0 0 0\n\0newmtl a\n");
    }
}
