//! The pbrt scenes of others, from file to what can be rendered.
use std::path::{Path, PathBuf};

use durer::{Options, prepare, scene::Severity};
use durer_tests::shared;

fn pbrt_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten().map(|e| e.path());
    let mut found: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { pbrt_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "pbrt"))
        .collect();
    found.sort();
    found
}

#[test]
fn every_shared_pbrt_scene_is_compiled() {
    let Some(folder) = shared("every_shared_pbrt_scene_is_compiled") else { return };
    let mut compiled = 0;
    for file in pbrt_files(&folder.join("assets/pbrt")) {
        // The others are parts, to be included.
        if !std::fs::read_to_string(&file).is_ok_and(|text| text.contains("WorldBegin")) {
            continue;
        }
        let mut imported = durer::open(&file.to_string_lossy());
        let prepared =
            prepare(&mut imported, &Options {
            width: Some(16),
            height: Some(16),
            engine: Engine::BruteForce,
            ..Options::default()
        });
        let errors = imported.diagnostics.iter().filter(|d| d.severity == Severity::Error);
        let errors: Vec<_> = errors.map(|d| d.message.as_str()).collect();
        // Image lights are the only thing a scene may wait for.
        let waits = |e: &&str| e.contains("image environment maps are not supported yet");
        assert!(errors.iter().all(waits), "{}: {errors:?}", file.display());
        assert_eq!(prepared.is_some(), errors.is_empty());
        compiled += usize::from(prepared.is_some());
        // What is left out is said, but no shape of these scenes is.
        assert!(
            !imported.diagnostics.iter().any(|d| d.message.contains("is left out")),
            "{}",
            file.display()
        );
    }
    assert!(compiled > 10, "{compiled}");
}
