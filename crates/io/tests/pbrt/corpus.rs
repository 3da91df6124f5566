//! Files of others, and the example of our documentation.
use std::path::Path;

use durer_io::import::{Imported, open};
use durer_scene::Limits;

use super::read::{complaints, read, shared, sound};

fn pbrt_files(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|e| e.path()) {
        if path.is_dir() {
            pbrt_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "pbrt") {
            found.push(path);
        }
    }
    found.sort();
}

#[test]
fn the_shared_scenes_are_read() {
    let Some(folder) = shared("pbrt") else { return };
    let mut files = Vec::new();
    pbrt_files(&folder, &mut files);
    assert!(files.len() > 10, "{files:?}");
    for file in files {
        let imported = open(&file, Limits::default());
        let errors: Vec<_> = complaints(&imported).into_iter().filter(|c| c.contains(" error: ")).collect();
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        if text.contains("WorldBegin") {
            assert_eq!(errors, Vec::<String>::new(), "{}", file.display());
            assert!(!imported.desc.shapes.is_empty(), "{}", file.display());
            assert_eq!(imported.desc.cameras.len(), 1, "{}", file.display());
        } else {
            // A file to be included: it has no WorldBegin and may use materials of the file that includes it.
            assert!(errors[0].contains("WorldBegin"), "{}: {errors:?}", file.display());
            assert!(
                errors[1..].iter().all(|e| e.contains("unknown material")),
                "{}: {errors:?}",
                file.display()
            );
        }
    }
}

/// The errors of a malformed file; `None` where the file is missing.
fn errors_of(name: &str) -> Option<Vec<String>> {
    errors_in(name, &open(&shared(&format!("malformed/pbrt/{name}"))?, Limits::default()))
}

/// All of them, where a file of an older version would show a few.
fn all_errors_of(name: &str) -> Option<Vec<String>> {
    let text = std::fs::read_to_string(shared(&format!("malformed/pbrt/{name}"))?).expect("a text");
    errors_in(name, &read(&text))
}

fn errors_in(name: &str, imported: &Imported) -> Option<Vec<String>> {
    let found = complaints(imported);
    for complaint in &found {
        eprintln!("{name}:{complaint}");
    }
    Some(found.into_iter().filter(|c| c.contains(" error: ")).collect())
}

#[test]
fn files_of_older_versions_are_called_so_first() {
    for name in ["pbrt-v2-syntax_killeroo-simple.pbrt", "pbrt-v3-syntax_uber.pbrt"] {
        let Some(errors) = errors_of(name) else { return };
        assert!(errors[0].contains("this looks like a pbrt-v2 or pbrt-v3 file"), "{errors:?}");
        assert!((3..=7).contains(&errors.len()), "{errors:?}");
    }
}

#[test]
fn older_versions_are_told_apart() {
    if let Some(errors) = all_errors_of("pbrt-v2-syntax_killeroo-simple.pbrt") {
        assert_eq!(
            errors[0],
            "5:6 error: unknown film \"image\" | \"image\" | this is pbrt-v3's word; pbrt-v4 writes \"rgb\""
        );
        assert!(
            errors
                .iter()
                .any(|e| e.contains("unknown directive \"SurfaceIntegrator\"") && e.contains("pbrt-v2"))
        );
        assert!(
            errors
                .iter()
                .any(|e| e.contains("unknown sampler \"lowdiscrepancy\"") && e.contains("\"paddedsobol\""))
        );
        assert!(errors.iter().any(|e| e.contains("unknown parameter type \"color\"")));
    }
    if let Some(errors) = all_errors_of("pbrt-v3-syntax_uber.pbrt") {
        assert!(errors[0].contains("unknown film \"image\""), "{errors:?}");
        assert!(
            errors
                .iter()
                .any(|e| e.contains("unknown parameter type \"color\" | color | pbrt-v4 writes \"rgb\""))
        );
        for (word, now) in [
            ("parameter \"mapname\"", "filename"),
            ("material \"uber\"", "dielectric"),
            ("parameter \"Kt\"", "trans"),
        ] {
            let told = |e: &String| e.contains(&format!("unknown {word}")) && e.contains(now);
            assert!(errors.iter().any(told), "{word}: {errors:?}");
        }
    }
}

#[test]
fn kinds_are_left_to_the_model() {
    if let Some(errors) = errors_of("unknown-shape_bilinearPatch.pbrt") {
        assert_eq!(errors, Vec::<String>::new());
    }
}

#[test]
fn the_example_of_the_documentation_is_sound() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pbrt-language.md");
    let page = std::fs::read_to_string(page).expect("the page is in the repository");
    let examples: Vec<&str> = page.split("```pbrt\n").skip(1).filter_map(|p| p.split("```").next()).collect();
    let scene = examples.iter().find(|e| e.contains("WorldBegin")).expect("a whole scene");
    let desc = sound(scene);
    assert!(
        desc.shapes.len() > 3
            && desc.lights.len() > 1
            && desc.cameras.len() == 1
            && !desc.textures.is_empty()
    );
    assert!(desc.shapes.iter().any(|s| s.name == "glass ball"));
    for part in examples.iter().filter(|e| !e.contains("WorldBegin")) {
        sound(&format!("WorldBegin {part}"));
    }
}
