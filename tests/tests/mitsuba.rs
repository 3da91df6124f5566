//! Scenes of Mitsuba, from file to picture.
use std::path::{Path, PathBuf};

use durer::{Imported, Options, prepare, scene::Severity};
use durer_tests::{render, shared};

/// All files below a folder that are scenes: parts of others have no camera of their own and are not.
fn scenes(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten().map(|e| e.path());
    let mut found: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { scenes(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "xml"))
        .filter(|path| !path.components().any(|c| c.as_os_str() == "fragments" || c.as_os_str() == "include"))
        .collect();
    found.sort();
    found
}

fn small(root: Option<PathBuf>) -> Options {
    Options { width: Some(8), height: Some(8), samples: Some(2), root, ..Options::default() }
}

fn said(imported: &Imported, severity: Severity) -> Vec<String> {
    imported.diagnostics.iter().filter(|d| d.severity == severity).map(|d| d.message.clone()).collect()
}

#[test]
fn every_shared_scene_of_mitsuba_is_read_and_shows_something() {
    let Some(folder) = shared("every_shared_scene_of_mitsuba_is_read_and_shows_something") else { return };
    let folder = folder.join("assets/mitsuba");
    let all = scenes(&folder);
    assert!(all.len() >= 35, "{}", all.len());
    for file in all {
        let options = small(Some(folder.clone()));
        let mut imported = durer::open_for(&file.to_string_lossy(), &options);
        let prepared = prepare(&mut imported, &options);
        assert_eq!(said(&imported, Severity::Error), Vec::<String>::new(), "{}", file.display());
        let picture = render(&prepared.expect("no error was told")).film;
        let light: f32 = picture.pixels().iter().map(|p| p.mean().iter().sum::<f32>()).sum();
        assert!(light.is_finite() && light > 0.0, "{}: {light}", file.display());
    }
}

#[test]
fn files_above_the_scene_are_read_only_if_the_user_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("scenes/one");
    std::fs::create_dir_all(&inner).expect("folders");
    std::fs::write(folder.path().join("part.xml"), "<scene version='3.0.0'><shape type='sphere'/></scene>")
        .expect("written");
    let file = inner.join("scene.xml");
    std::fs::write(&file, "<scene version='3.0.0'><include filename='../../part.xml'/></scene>")
        .expect("written");
    let open = |root: Option<PathBuf>| durer::open_for(&file.to_string_lossy(), &small(root));
    let refused = open(None);
    assert!(said(&refused, Severity::Error)[0].contains("part.xml"), "{:?}", refused.diagnostics);
    let hint = refused.diagnostics.iter().find_map(|d| d.hint.clone()).unwrap_or_default();
    assert!(hint.contains("--root"), "{hint}");
    assert!(open(Some(folder.path().join("scenes"))).diagnostics.has_errors(), "one folder is not enough");
    let read = open(Some(folder.path().to_owned()));
    assert!(!read.diagnostics.has_errors(), "{:?}", read.diagnostics);
    assert_eq!(read.desc.shapes.len(), 1);
    let elsewhere = open(Some(std::env::temp_dir().join("nowhere")));
    assert!(elsewhere.diagnostics.has_errors(), "a root must hold the scene");
}

#[test]
fn values_of_the_command_line_go_before_those_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.xml");
    let text = "<scene version='3.0.0'><default name='res' value='32'/><sensor type='perspective'>\
                <film type='hdrfilm'><integer name='width' value='$res'/></film></sensor>\
                <shape type='sphere'/></scene>";
    std::fs::write(&file, text).expect("written");
    let open = |definitions: &[(&str, &str)]| {
        let definitions = definitions.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        durer::open_for(&file.to_string_lossy(), &Options { definitions, ..Options::default() })
    };
    assert_eq!(open(&[]).desc.film.width, Some(32));
    assert_eq!(open(&[("res", "16")]).desc.film.width, Some(16));
    let unknown = open(&[("rse", "16")]);
    assert!(said(&unknown, Severity::Error)[0].contains("\"rse\""));
}
