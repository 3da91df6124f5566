//! The project's texts.
use std::{fs, path::Path};

/// A text file.
pub(crate) struct Source {
    /// Path below the project's folder, with slashes.
    pub(crate) path: String,
    /// Content.
    pub(crate) text: String,
}

impl Source {
    pub(crate) fn new(path: &str, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }

    pub(crate) fn is_rust(&self) -> bool {
        self.path.ends_with(".rs")
    }

    /// What the HTML page is written in.
    pub(crate) fn is_script(&self) -> bool {
        self.path.ends_with(".ts") || self.path.ends_with(".tsx")
    }

    /// The lines with their numbers, without what follows `//`. A `//` within a string ends the line too: what stands
    /// behind it on the same line is not looked at.
    pub(crate) fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self.text.lines().enumerate();
        lines.map(|(i, line)| (i + 1, line.split_once("//").map_or(line, |(code, _)| code)))
    }

    /// Complaints about lines of code for which `bad` gives a reason.
    pub(crate) fn complain(&self, bad: impl Fn(&str) -> Option<String>) -> Vec<String> {
        let found = self.code().filter_map(|(number, code)| Some((number, bad(code)?)));
        found.map(|(number, reason)| format!("{}:{number}: {reason}", self.path)).collect()
    }
}

/// The project's folder.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the project")
}

/// All text files of the project that are not built.
pub(crate) fn all() -> Vec<Source> {
    let mut found = Vec::new();
    collect(root(), "", &mut found);
    assert!(found.len() > 100, "the project is not where it is looked for");
    found
}

fn collect(folder: &Path, below: &str, found: &mut Vec<Source>) {
    let mut entries: Vec<_> = fs::read_dir(folder).expect("a readable folder").flatten().collect();
    entries.sort_by_key(|entry| entry.file_name());
    for entry in entries {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{below}{name}");
        let kind = entry.file_type().expect("a kind of file");
        // `.git` is a file where a second checkout shares the first one's history.
        if [".git", "dist", "node_modules", "target"].contains(&name.as_str()) {
            continue;
        }
        if kind.is_dir() {
            collect(&entry.path(), &format!("{path}/"), found);
        } else if kind.is_file() {
            // What is no UTF-8 is no text.
            found.extend(fs::read_to_string(entry.path()).ok().map(|text| Source { path, text }));
        }
    }
}
