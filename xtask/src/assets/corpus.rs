//! The folder of test files: which models it holds, and whom to credit, which the tables of its README.md say.
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::Context;

/// The folder with its credits.
pub(super) struct Corpus {
    /// Where it is.
    pub(super) folder: PathBuf,
    credits: Vec<(String, String)>,
}

/// A file to try.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Model {
    /// Its path below the folder, with slashes.
    pub(super) file: String,
    /// Licence, authors and source; `None` if the tables do not name the file.
    pub(super) credit: Option<String>,
}

impl Corpus {
    /// Reads the tables.
    pub(super) fn open(folder: &Path) -> anyhow::Result<Self> {
        let readme = folder.join("README.md");
        let text = fs::read_to_string(&readme)
            .with_context(|| format!("{}: its tables name the licences", readme.display()))?;
        Ok(Self { folder: folder.to_path_buf(), credits: credits(&text) })
    }

    /// Files below the folder `format` that end in one of `suffixes`, in order.
    pub(super) fn models(&self, format: &str, suffixes: &[&str]) -> anyhow::Result<Vec<Model>> {
        let mut files = Vec::new();
        collect(&self.folder.join(format), format, &mut files)?;
        files.retain(|file| suffixes.iter().any(|suffix| file.to_lowercase().ends_with(suffix)));
        if format == "pbrt" {
            // The others are parts that these include.
            let is_whole = |file: &String| {
                fs::read_to_string(self.folder.join(file)).is_ok_and(|text| text.contains("WorldBegin"))
            };
            files.retain(is_whole);
        }
        files.sort();
        Ok(files.into_iter().map(|file| Model { credit: self.credit(&file), file }).collect())
    }

    /// What the row says whose path is the file's or that of the nearest folder around it.
    fn credit(&self, file: &str) -> Option<String> {
        let around = |path: &str| file == path || file.strip_prefix(path).is_some_and(|r| r.starts_with('/'));
        let rows = self.credits.iter().filter(|(path, _)| around(path));
        rows.max_by_key(|(path, _)| path.len()).map(|(_, credit)| credit.clone())
    }
}

/// Paths with licence and source, from the tables of a Markdown text.
fn credits(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut columns: Option<(usize, usize)> = None;
    for line in text.lines() {
        let Some(row) = line.trim().strip_prefix('|').and_then(|row| row.strip_suffix('|')) else {
            columns = None;
            continue;
        };
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let Some((licence, source)) = columns else {
            let column = |name: &str| cells.iter().position(|cell| *cell == name);
            columns = column("licence").zip(column("source"));
            continue;
        };
        let cell = |index: usize| cells.get(index).copied().filter(|cell| !cell.is_empty());
        if let (Some(path), Some(licence)) = (cell(0), cell(licence)) {
            let source = cell(source).map(|source| format!("; {source}")).unwrap_or_default();
            found.push((path.trim_end_matches('/').to_owned(), format!("{licence}{source}")));
        }
    }
    found
}

fn collect(folder: &Path, below: &str, files: &mut Vec<String>) -> anyhow::Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))? {
        let entry = entry?;
        let path = format!("{below}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            collect(&entry.path(), &path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const README: &str = "\
text\n\n| file | triangles | licence | source | size |\n|---|---|---|---|---|\n\
| gltf/A.glb | 3 | CC0 | here | 1 kB |\n\n| file | exercises | licence | source | size |\n|---|---|---|---|---|\n\
| obj/spot/ | a cow | CC-BY (c) Keenan | there | 1 MB |\n| obj/none.obj | x |  | | |\n\n| other | table |\n|---|---|\n| a | b |\n";

    #[test]
    fn credits_are_found_by_file_and_by_folder() {
        let corpus = Corpus { folder: PathBuf::new(), credits: credits(README) };
        assert_eq!(corpus.credit("gltf/A.glb").as_deref(), Some("CC0; here"));
        assert_eq!(corpus.credit("obj/spot/a b.obj").as_deref(), Some("CC-BY (c) Keenan; there"));
        for unknown in ["gltf/A.glb.bin", "obj/spotted.obj", "obj/none.obj", "a"] {
            assert_eq!(corpus.credit(unknown), None, "{unknown}");
        }
    }
}
