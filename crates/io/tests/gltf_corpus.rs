//! Every glTF file of the corpus: real ones import with the counts of its README, damaged ones are survived.
mod assets_shared;

use assets_shared::{files, folder};
use durer_io::import::{Imported, open};
use durer_scene::{Assets, Limits, Location, SceneDesc, ShapeSource};
use std::{path::Path, time::Instant};

fn triangles(desc: &SceneDesc) -> usize {
    let count = |source: &ShapeSource| match source {
        ShapeSource::Mesh(id) => desc.meshes[id.index()].indices.len(),
        ShapeSource::Node(_) => 0,
    };
    desc.shapes.iter().map(|s| count(&s.source)).sum()
}

fn complaints(imported: &Imported) -> String {
    imported.diagnostics.iter().map(|d| format!("\n  {:?} {:?} {}", d.severity, d.at, d.message)).collect()
}

/// Files and triangle counts of the README's table.
fn table(shared: &Path) -> Vec<(String, usize)> {
    let readme = std::fs::read_to_string(shared.join("README.md")).expect("README of the corpus");
    let row = |line: &str| {
        let mut cells = line.strip_prefix("| gltf/")?.split(" | ");
        Some((format!("gltf/{}", cells.next()?.trim()), cells.next()?.trim().parse().ok()?))
    };
    readme.lines().filter_map(row).collect()
}

#[test]
fn real_files_import_with_the_triangle_counts_of_the_table() {
    let Some(shared) = folder("") else { return };
    let mut checked = 0;
    for (file, expected) in table(&shared) {
        let started = Instant::now();
        let imported = open(&shared.join(&file), Limits::default());
        let time = started.elapsed();
        assert!(!imported.diagnostics.has_errors(), "{file}: {}", complaints(&imported));
        let desc = &imported.desc;
        println!(
            "{file}: {} triangles, {} shapes, {} meshes, {} materials, {} textures, {} cameras, {} lights, {time:.1?}{}",
            triangles(desc),
            desc.shapes.len(),
            desc.meshes.len(),
            desc.materials.len(),
            desc.textures.len(),
            desc.cameras.len(),
            desc.lights.len(),
            complaints(&imported)
        );
        match file.as_str() {
            // The table counts the base mesh of this one; its extension places it 125 times.
            "gltf/SimpleInstancing.glb" => assert_eq!(triangles(desc), 125 * expected),
            // The table counts all scenes, we draw the one the file opens with.
            "gltf/MultipleScenes/MultipleScenes.gltf" => assert_eq!(triangles(desc), 2),
            _ => assert_eq!(triangles(desc), expected, "{file}"),
        }
        checked += 1;
    }
    assert!(checked >= 40, "only {checked} files of the table were found");
}

#[test]
fn every_image_of_the_real_files_is_found_and_decoded() {
    let Some(shared) = folder("gltf") else { return };
    let mut images = 0;
    for file in files(&shared) {
        if !file.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            continue;
        }
        let imported = open(&file, Limits::default());
        for texture in &imported.desc.textures {
            let param = texture.node.params.get("filename").expect("an image map");
            let durer_scene::Data::Strings(names) = &param.data else { panic!("a string") };
            imported.assets.image(&names[0]).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            images += 1;
        }
    }
    assert!(images > 100, "{images}");
}

#[test]
fn damaged_files_import_or_say_where_and_why() {
    let Some(shared) = folder("malformed/gltf") else {
        return;
    };
    let (mut good, mut bad) = (0, 0);
    for file in files(&shared) {
        if !file.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            continue;
        }
        let started = Instant::now();
        let imported = open(&file, Limits::default());
        assert!(started.elapsed().as_secs_f64() < 2.0, "{} takes too long", file.display());
        println!("{}:{}", file.strip_prefix(&shared).expect("below").display(), complaints(&imported));
        for d in &imported.diagnostics {
            let Location::Path { file: named, pointer } = &d.at else { panic!("no path: {}", d.message) };
            assert!(named.ends_with(&*file.file_name().expect("name").to_string_lossy()));
            assert!(pointer.is_empty() || pointer.starts_with('/'), "{pointer}");
        }
        if imported.diagnostics.has_errors() {
            bad += 1;
            // Valid, but it needs glTF 2.1: to be refused.
            let newer = file.ends_with("asset__min_version_valid.gltf");
            let control = file.to_string_lossy().contains("valid-controls");
            assert!(newer || !control, "{}", file.display());
        } else {
            good += 1;
        }
    }
    println!("{good} imported, {bad} refused");
    assert!(bad >= 30, "only {bad} refused");
}

/// Flips bytes of valid files: importing must neither panic nor hang.
#[test]
fn mutilated_files_never_panic() {
    let Some(shared) = folder("gltf") else { return };
    let mut state = 0x1234_5678_9abc_def1u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below
    };
    let place = tempfile::tempdir().expect("temporary folder");
    for name in [
        "Box-Embedded.gltf",
        "BoxInterleaved.glb",
        "SimpleSparseAccessor/SimpleSparseAccessor.gltf",
        "SimpleSkin/SimpleSkin.gltf",
        "SimpleInstancing.glb",
        "AnimatedMorphCube.glb",
        "TextureTransformTest/TextureTransformTest.gltf",
    ] {
        let original = std::fs::read(shared.join(name)).expect("file of the corpus");
        let copy = place.path().join(Path::new(name).file_name().expect("name"));
        for _ in 0..400 {
            let mut bytes = original.clone();
            for _ in 0..1 + random(3) {
                let at = random(bytes.len());
                // Digits for digits keep the JSON readable and make the numbers wild.
                bytes[at] = if bytes[at].is_ascii_digit() { b'0' + random(10) as u8 } else { bytes[at] };
                let at = random(bytes.len());
                bytes[at] = if random(8) == 0 { random(256) as u8 } else { bytes[at] };
            }
            std::fs::write(&copy, &bytes).expect("written");
            open(&copy, Limits::default());
        }
    }
}
