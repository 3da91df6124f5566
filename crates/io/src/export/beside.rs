//! Files that a scene needs, gathered in a folder beside the one that is written.
//!
//! No path of the original becomes a path here: names are made of its last part, of letters, digits and a few marks, and
//! no two are the same on systems that do not tell letter cases apart. What is gathered was read for the scene, so it lies
//! in its folder or within its file.
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
    sync::Arc,
};

use durer_scene::Assets;

use crate::{FileAssets, image};

/// Which files go with the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Files {
    /// Those that lie within the scene file. Paths of others stay relative to its folder: the text belongs there.
    Embedded,
    /// All: text and files can be moved anywhere.
    All,
}

/// What is in a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// These bytes.
    Bytes(Arc<[u8]>),
    /// What is in this file of the scene's folder.
    Copy(PathBuf),
}

/// A file that lies beside the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// Relative to the text, with `/` between its two names.
    pub path: String,
    /// What is in it.
    pub content: Content,
}

/// Files being gathered.
pub(super) struct Gathered<'a> {
    assets: &'a FileAssets,
    files: Files,
    folder: &'a str,
    /// Paths in the folder, by what the scene calls the files.
    known: BTreeMap<String, String>,
    /// Names in lower case.
    taken: BTreeSet<String>,
    pub(super) list: Vec<Beside>,
}

impl<'a> Gathered<'a> {
    /// None yet; `folder` is where they will lie.
    pub(super) fn new(assets: &'a FileAssets, files: Files, folder: &'a str) -> Self {
        let (known, taken, list) = (BTreeMap::new(), BTreeSet::new(), Vec::new());
        Self { assets, files, folder, known, taken, list }
    }

    /// What the file that the scene calls `name` is called now; `None` if it is none, or stays where it is.
    ///
    /// # Errors
    /// If it cannot be had.
    pub(super) fn path_of(&mut self, name: &str) -> Result<Option<String>, String> {
        if let Some(path) = self.known.get(name) {
            return Ok(Some(path.clone()));
        }
        let (called, content) = if self.assets.is_embedded(name) {
            let bytes = self.assets.bytes(name).map_err(|e| e.to_string())?;
            // Names like `image:3`; only the bytes tell what it is.
            let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
            let suffix = image::suffix_of(&bytes).map_or_else(|| suffix_of(name), str::to_owned);
            (format!("{stem}{suffix}"), Content::Bytes(bytes))
        } else {
            let Some(file) = self.assets.read_as(name).filter(|_| self.files == Files::All) else {
                return Ok(None);
            };
            (name.to_owned(), Content::Copy(file))
        };
        let path = self.add(&called, content);
        self.known.insert(name.to_owned(), path.clone());
        Ok(Some(path))
    }

    /// Adds a file that is called like the last part of `called`, as far as that is free; returns its path.
    pub(super) fn add(&mut self, called: &str, content: Content) -> String {
        let name = safe(called);
        let (stem, suffix) = name.rsplit_once('.').unwrap_or((&name, ""));
        let dot = if suffix.is_empty() { "" } else { "." };
        let mut free = name.clone();
        let mut number = 2;
        while !self.taken.insert(free.to_lowercase()) {
            free = format!("{stem}-{number}{dot}{suffix}");
            number += 1;
        }
        let path = format!("{}/{free}", self.folder);
        self.list.push(Beside { path: path.clone(), content });
        path
    }
}

/// `.suffix` of a name, or nothing.
fn suffix_of(name: &str) -> String {
    name.rsplit_once('.').map(|(_, suffix)| format!(".{suffix}")).unwrap_or_default()
}

/// Most characters of a name.
const LONGEST: usize = 100;

/// The last part of a path as a name that every system takes.
fn safe(path: &str) -> String {
    let last = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let all: Vec<char> = last.chars().map(plain).collect();
    // What tells formats apart stands at the end.
    let name: String = all.iter().skip(all.len().saturating_sub(LONGEST)).collect();
    // Hidden files, options of commands, `..`, Windows' devices with and without a suffix.
    let name = name.trim_start_matches(['.', '-']).trim_end_matches('.');
    const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
    let stem = name.split('.').next().unwrap_or_default().to_lowercase();
    let is_port = |kind: &str| stem.strip_prefix(kind).is_some_and(|n| n.len() == 1);
    if stem.is_empty() || DEVICES.contains(&stem.as_str()) || is_port("com") || is_port("lpt") {
        return format!("file-{name}");
    }
    name.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Limits;

    #[test]
    fn names_are_safe_on_every_system() {
        for (path, name) in [
            ("image:3.png", "image-3.png"),
            ("textures/Böden/wood 1.JPG", "wood-1.JPG"),
            ("a\\b\\..\\c.exr", "c.exr"),
            ("../../etc/passwd", "passwd"),
            ("..", "file-"),
            ("", "file-"),
            (".htaccess", "htaccess"),
            ("-rf.png", "rf.png"),
            ("con.png", "file-con.png"),
            ("x/COM1", "file-COM1"),
            ("--env light/sky.exr", "sky.exr"),
            ("ends.", "ends"),
        ] {
            assert_eq!(safe(path), name, "{path}");
        }
        assert_eq!(safe(&format!("{}.png", "x".repeat(300))).len(), LONGEST);
    }

    #[test]
    fn no_two_files_have_the_same_name() {
        let mut assets = FileAssets::new("".into(), Limits::default());
        assets.insert("a/wood.png", *b"\x89PNG\r\n\x1a\n1");
        assets.insert("b/WOOD.png", *b"\x89PNG\r\n\x1a\n2");
        assets.insert("c/wood.jpg", *b"\x89PNG\r\n\x1a\n3");
        let mut gathered = Gathered::new(&assets, Files::Embedded, "room-files");
        let paths: Vec<_> = ["a/wood.png", "b/WOOD.png", "c/wood.jpg", "a/wood.png", "d.png"]
            .map(|n| gathered.path_of(n))
            .into();
        let path = |name: &str| Ok(Some(format!("room-files/{name}")));
        let expected = [path("wood.png"), path("WOOD-2.png"), path("wood-3.png"), path("wood.png"), Ok(None)];
        assert_eq!(paths, expected);
        assert_eq!(gathered.list.len(), 3);
    }
}
