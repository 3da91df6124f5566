//! Material files: finding those that `mtllib` names, and which material `usemtl` means.
//!
//! The line may name one file with spaces or several. Paths are relative to the OBJ file; of one that leads nowhere, or
//! out of the folder (such as an absolute path of the machine the file was made on), the last name is tried beside the
//! OBJ file, then the OBJ file's own name with the suffix `.mtl`. What is not found leaves the shapes grey.
use std::{
    collections::{HashMap, HashSet},
    ops::Range,
    sync::Arc,
};

use durer_core::Id;
use durer_scene::{AssetError, Assets, MaterialRef, NamedNode};

use super::{
    material,
    model::Model,
    mtl::{self, Material},
    piece::Event,
    texture::Textures,
};
use crate::import::{
    Imported,
    text::{Complaint, Part, tell},
};

/// Most names of material files that are looked for, those of all lines together.
const MOST_NAMES: usize = 64;

/// Materials by name.
#[derive(Debug, Default)]
pub(super) struct Library {
    materials: HashMap<String, MaterialRef>,
}

impl Library {
    /// The material called `name`.
    pub(super) fn get(&self, name: &str) -> Option<MaterialRef> {
        self.materials.get(name).copied()
    }
}

/// A file that was found.
struct Found {
    path: String,
    bytes: Arc<[u8]>,
}

/// Loads the materials that faces use.
pub(super) fn load(
    text: Part<'_>,
    model: &Model,
    complaints: &mut Vec<Complaint>,
    imported: &mut Imported,
) -> Library {
    let (files, used) = wanted(text, model);
    let mut said = HashSet::new();
    let mut left = MOST_NAMES;
    let (mut all, mut seen): (Vec<(Material, String)>, HashSet<String>) = (Vec::new(), HashSet::new());
    let mut libraries: Vec<Found> = Vec::new();
    for (line, at) in &files {
        if left == 0 {
            break;
        }
        left = left.saturating_sub(1);
        for found in find((line, at), &mut left, imported, complaints) {
            if !said.insert(found.path.clone()) {
                continue;
            }
            let (materials, problems) = mtl::parse(&found.bytes);
            tell(problems, &found.path, &found.bytes, imported);
            let folder = found.path.replace('\\', "/");
            let folder = folder.rsplit_once('/').map_or("", |(folder, _)| folder);
            let library = libraries.len();
            let fresh = materials.into_iter().filter(|m| seen.insert(m.name.clone()));
            all.extend(fresh.map(|m| (Material { library, ..m }, folder.to_owned())));
            libraries.push(found);
        }
    }
    if left == 0 {
        let message =
            format!("so many material files are named that only the first {MOST_NAMES} are looked for");
        complaints.push(Complaint::whole(message).warning());
    }
    let names: HashSet<&str> = used.iter().map(|(name, _)| name.as_str()).collect();
    all.retain(|(m, _)| names.contains(m.name.as_str()));
    let mut library = Library::default();
    let mut textures = Textures::load(&all, imported);
    let mut invisible = Vec::new();
    for (made, folder) in &all {
        if made.is_invisible() && invisible.len() < 8 {
            let shown = Part::whole(made.name.as_bytes()).shown();
            let message = format!("material {shown} is fully transparent (d 0): nothing of it will be seen");
            invisible.push(Complaint::whole(message).warning());
        }
        let node = material::node(made, folder, &mut textures);
        let materials = &mut imported.desc.materials;
        library.materials.insert(made.name.clone(), Id::new(materials.len() as u32));
        materials.push(NamedNode { name: made.name.clone(), node });
    }
    imported.desc.textures = std::mem::take(&mut textures.list);
    complaints.append(&mut invisible);
    let none_found = libraries.is_empty() && !files.is_empty();
    let problems = textures.complaints(&all);
    for (number, library) in libraries.iter().enumerate() {
        let own = problems.iter().filter(|(of, _)| *of == number).map(|(_, problem)| problem.clone());
        tell(own.collect(), &library.path, &library.bytes, imported);
    }
    complaints.extend(unknown(&files, used, &library, none_found));
    library
}

/// Names of materials that faces use, where they are not found.
fn unknown(
    files: &[(String, Range<usize>)],
    used: Vec<(String, Range<usize>)>,
    library: &Library,
    none_found: bool,
) -> Vec<Complaint> {
    let missing = used.into_iter().filter(|(name, _)| library.get(name).is_none());
    // A file that is not there was complained about: what it would hold is not to be told again.
    if library.materials.is_empty() && none_found {
        return Vec::new();
    }
    if files.is_empty() {
        let first = missing.take(1);
        let message = "the file uses materials, but names no file that holds them (mtllib); drawn in grey";
        return first.map(|(_, at)| Complaint::error(at, message).warning()).collect();
    }
    let warning = |(name, at): (String, Range<usize>)| {
        let warning =
            Complaint::error(at, format!("there is no material \"{name}\"; drawn in grey")).warning();
        match durer_scene::nearest_word(&name, library.materials.keys().map(String::as_str)) {
            Some(near) => warning.hint(format!("did you mean \"{near}\"?")),
            None => warning,
        }
    };
    missing.take(8).map(warning).collect()
}

/// The `mtllib` lines, and the materials used with their first places.
#[expect(clippy::type_complexity, reason = "two lists of names with places")]
fn wanted(text: Part<'_>, model: &Model) -> (Vec<(String, Range<usize>)>, Vec<(String, Range<usize>)>) {
    let (mut files, mut used) = (Vec::new(), Vec::new());
    let mut seen = HashSet::new();
    for (_, event) in model.pieces.iter().flat_map(|p| &p.events) {
        let (Event::Library(range) | Event::Material(range)) = event else {
            continue;
        };
        let bytes = text.bytes.get(range.start - text.at..range.end - text.at).unwrap_or_default();
        let name = Part { bytes, at: range.start }.text();
        let is_file = matches!(event, Event::Library(_));
        if name.is_empty() || !seen.insert((is_file, name.clone())) {
            continue;
        }
        if is_file { files.push((name, range.clone())) } else { used.push((name, range.clone())) }
    }
    (files, used)
}

/// The files that the rest of a `mtllib` line names; `left` more names may be looked for.
fn find(
    (line, at): (&str, &Range<usize>),
    left: &mut usize,
    imported: &Imported,
    complaints: &mut Vec<Complaint>,
) -> Vec<Found> {
    let assets = &imported.assets;
    if let Ok(bytes) = assets.bytes(line) {
        return vec![Found { path: line.to_owned(), bytes }];
    }
    let mut found = Vec::new();
    for name in names(line) {
        if *left == 0 {
            break;
        }
        *left -= 1;
        let own = format!("{}.mtl", imported.desc.name);
        let other = assets.in_other_case(&name).or_else(|| assets.in_other_case(last_name(&name)));
        let other = other.as_deref().unwrap_or(&own);
        let tried = [name.as_str(), last_name(&name), other, &own];
        let mut why: Option<AssetError> = None;
        for path in tried {
            match assets.bytes(path) {
                Ok(bytes) => {
                    if path != name {
                        let message = format!("{name} is not there; {path} is read instead");
                        complaints.push(Complaint::error(at.clone(), message).warning());
                    }
                    found.push(Found { path: path.to_owned(), bytes });
                    why = None;
                    break;
                }
                Err(error) => {
                    why.get_or_insert(error);
                }
            }
        }
        if let Some(error) = why {
            let message = format!("{error}; its materials are drawn in grey");
            complaints.push(Complaint::error(at.clone(), message).warning());
        }
    }
    found
}

/// Several names in one line: each ends in `.mtl`, so that they may hold spaces; else they end at spaces.
fn names(line: &str) -> Vec<String> {
    let (mut names, mut open) = (Vec::new(), String::new());
    for word in line.split_whitespace() {
        if !open.is_empty() {
            open.push(' ');
        }
        open += word.trim_matches('"');
        if word.trim_matches('"').to_lowercase().ends_with(".mtl") {
            names.push(std::mem::take(&mut open));
        }
    }
    if names.is_empty() {
        return line.split_whitespace().map(str::to_owned).collect();
    }
    names.extend((!open.is_empty()).then_some(open));
    names
}

/// What stands behind the last slash.
pub(super) fn last_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn several_names_may_hold_spaces() {
        assert_eq!(names("a.mtl b c.MTL d/e.mtl"), ["a.mtl", "b c.MTL", "d/e.mtl"]);
        assert_eq!(names("\"a b.mtl\""), ["a b.mtl"]);
        assert_eq!(names("stuff other"), ["stuff", "other"]);
        assert_eq!(names("  "), [""; 0]);
    }
}
