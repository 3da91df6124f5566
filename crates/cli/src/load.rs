//! From the name of a scene to something that renders, with a clock beside it.
use std::{
    path::Path,
    time::{Duration, Instant},
};

use durer::{
    FORMATS, Imported, Options, Prepared, builtin,
    import::Play,
    scene::{Limits, Location, SceneDesc, nearest_word},
};

use crate::exit::Exit;

/// How many files of a folder are looked through for one that was meant.
const MOST_FILES: usize = 10_000;
/// How many of them are named.
const MOST_NAMED: usize = 5;

/// A scene, and how long it took to get it.
pub(crate) struct Loaded {
    pub(crate) imported: Imported,
    /// `None` if the diagnostics hold an error.
    pub(crate) prepared: Option<Prepared>,
    /// What to tell the shell of that error.
    pub(crate) failure: Exit,
    /// Reading and parsing.
    pub(crate) load: Duration,
    /// Compiling, with the hierarchy of boxes.
    pub(crate) build: Duration,
}

pub(crate) fn load(scene: &str, wishes: &Options) -> Loaded {
    let start = Instant::now();
    let mut imported = import(scene, wishes);
    let load = start.elapsed();
    let failure = failure(&imported, wishes);
    let start = Instant::now();
    let prepared = durer::prepare(&mut imported, wishes);
    Loaded { imported, prepared, failure, load, build: start.elapsed() }
}

/// Reads a scene as it is wanted; complains about one that is not there with what may have been meant.
pub(crate) fn import(scene: &str, wishes: &Options) -> Imported {
    absent(scene).unwrap_or_else(|| durer::open_for(scene, wishes))
}

/// What to tell the shell if a scene that was read cannot be prepared.
pub(crate) fn failure(imported: &Imported, wishes: &Options) -> Exit {
    let desc = &imported.desc;
    let sound = !imported.diagnostics.has_errors();
    // The file is as it should be: the option is not.
    let wrong_camera = sound && wishes.camera.as_deref().is_some_and(|c| !has_camera(desc, c));
    let wrong_animation = match &wishes.play {
        Play::Named(name) => !has_animation(desc, name),
        Play::Rest | Play::First => false,
    };
    let is_read =
        sound || !(desc.shapes.is_empty() && desc.animations.is_empty() && desc.variants.is_empty());
    let wrong_variant = wishes.variant.as_deref().is_some_and(|v| !is_one_of(&desc.variants, v));
    if wrong_camera || (is_read && (wrong_animation || wrong_variant)) { Exit::Usage } else { Exit::Failed }
}

/// Whether a camera has this name or index.
fn has_camera(desc: &SceneDesc, wanted: &str) -> bool {
    is_one_of(&desc.cameras.iter().map(|camera| &camera.name).collect::<Vec<_>>(), wanted)
}

/// Whether an animation has this name or index, or all are wanted.
fn has_animation(desc: &SceneDesc, wanted: &str) -> bool {
    let names: Vec<&String> = desc.animations.iter().map(|animation| &animation.name).collect();
    is_one_of(&names, wanted) || (wanted == "all" && !names.is_empty())
}

/// Whether something is a name of the list, or an index into it.
fn is_one_of(names: &[impl AsRef<str>], wanted: &str) -> bool {
    let is_index = wanted.parse().is_ok_and(|index: usize| index < names.len());
    is_index || names.iter().any(|name| name.as_ref() == wanted)
}

/// The complaint about a scene that is a folder or does not exist, with what may have been meant.
fn absent(scene: &str) -> Option<Imported> {
    let path = Path::new(scene);
    if builtin::find(scene).is_some() {
        return None;
    }
    let (message, hint) = if path.is_dir() {
        (format!("{scene} is a folder; name a scene file in it"), listed(path, &scene_files(path)))
    } else if matches!(path.try_exists(), Ok(false)) {
        let folder = path.parent().filter(|f| *f != Path::new("")).unwrap_or(Path::new("."));
        let names = scene_files(folder);
        match (meant(path, &names), path.extension()) {
            (Some(near), _) => {
                let near = path.with_file_name(near);
                (format!("{scene}: there is no such file"), Some(format!("did you mean {}?", near.display())))
            }
            // The library knows what to say of words and of other formats.
            (None, None) => return None,
            (None, Some(_)) if !is_scene_file(scene) => return None,
            (None, Some(_)) if !folder.is_dir() => {
                (format!("{scene}: there is no such file"), Some("there is no such folder either".to_owned()))
            }
            (None, Some(_)) => (format!("{scene}: there is no such file"), listed(folder, &names)),
        }
    } else {
        return None;
    };
    let mut imported = Imported::new("".into(), Limits::default());
    let error = imported.diagnostics.error(Location::None, message);
    if let Some(hint) = hint {
        error.hint(hint);
    }
    Some(imported)
}

/// Whether the suffix says that durer reads it.
pub(crate) fn is_scene_file(name: &str) -> bool {
    let lower = name.to_lowercase();
    let suffix = Path::new(lower.strip_suffix(".gz").unwrap_or(&lower)).extension();
    suffix.is_some_and(|suffix| FORMATS.iter().flat_map(|f| f.suffixes).any(|s| suffix == *s))
}

/// Names of the scene files in a folder, sorted; none where it cannot be read.
fn scene_files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_FILES);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| is_scene_file(name)).collect();
    names.sort();
    names
}

/// The file that a name without one may mean: the same but for the suffix, else one of similar letters. A word without
/// suffix that is nearer to a built-in scene means that.
fn meant<'a>(path: &Path, names: &'a [String]) -> Option<&'a str> {
    let wanted = path.file_name()?.to_str()?;
    let stem = |name: &str| name.split('.').next().unwrap_or_default().to_lowercase();
    let twin = names.iter().find(|name| stem(name) == stem(wanted)).map(String::as_str);
    if twin.is_some() || path.extension().is_some() {
        return twin.or_else(|| nearest_word(wanted, names.iter().map(String::as_str)));
    }
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let words = builtin::SCENES.iter().map(|s| s.name).chain(stems.iter().map(String::as_str));
    let near = nearest_word(wanted, words)?;
    names.iter().find(|name| stem(name) == near).map(String::as_str)
}

/// The scene files of a folder as a hint; `None` if there are none.
fn listed(folder: &Path, names: &[String]) -> Option<String> {
    let first = names.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    let more = names.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    let place = if folder == Path::new(".") { "here".to_owned() } else { format!("in {}", folder.display()) };
    (!names.is_empty()).then(|| format!("scene files {place}: {first}{more}"))
}
