//! Files that are not what their names say.
mod mesh_scene;

use durer_io::import::Imported;
use durer_scene::Severity;
use mesh_scene::{folder, import, read, said};

fn error(scene: &Imported) -> String {
    let mut all = said(scene, Severity::Error);
    assert_eq!(all.len(), 1, "{all:?}");
    all.remove(0)
}

#[test]
fn empty_files_are_called_so_in_all_formats() {
    for name in ["a.gltf", "a.glb", "a.pbrt", "a.obj", "a.ply", "a.stl", "a.obj.gz", "a.blend"] {
        assert_eq!(error(&import(&[(name, b"")])), "the file is empty", "{name}");
    }
}

#[test]
fn folders_are_called_so_whatever_their_suffix() {
    let root = folder(&[("scene.glb/a.obj", b"")]);
    assert_eq!(error(&read(&root.path().join("scene.glb"))), "is a folder; name a scene file in it");
}

#[test]
fn known_formats_under_wrong_names_are_told() {
    let cases: [(&str, &[u8], &str); 5] = [
        ("a.obj", b"glTF\x02\0\0\0", "this is a GLB file: name it .glb"),
        ("a.gltf", b"BLENDER-v300RENDH", "this is a Blender file: export it as glTF from Blender"),
        ("a.blend", b"BLENDER-v300RENDH", "this is a Blender file: export it as glTF from Blender"),
        ("a.stl", b"ply\nformat ascii 1.0\n", "this is a PLY file: name it .ply"),
        ("a.obj.gz", b"v 0 0 0\n", "named .gz, but not gzip"),
    ];
    for (name, bytes, expected) in cases {
        let said = error(&import(&[(name, bytes)]));
        assert!(said.ends_with(expected), "{name}: {said}");
    }
}

#[test]
fn files_of_an_older_pbrt_are_told_first() {
    let old = "Shape \"sphere\"\nMaterial \"plastic\" \"rgb Kd\" [1 1 1]\n".repeat(9);
    let scene = import(&[("a.pbrt", format!("WorldBegin\n{old}").as_bytes())]);
    let errors = said(&scene, Severity::Error);
    assert_eq!(errors[0], "this looks like a pbrt-v2 or pbrt-v3 file; durer reads pbrt-v4");
    assert_eq!((errors.len(), errors[3].as_str()), (4, "16 more errors like these"));
}

#[test]
fn images_that_are_not_there_are_told_at_their_line_of_the_mtl_file() {
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    let mtl = b"newmtl m\nKd 1 0\nmap_Kd Wodo.png\n";
    let scene = import(&[("a.obj", obj), ("a.mtl", mtl), ("wood.png", b"")]);
    let warnings = said(&scene, Severity::Warning);
    assert_eq!(warnings[0], "2:1: expected 1 or 3 numbers, found 2: the first is used for all");
    assert_eq!(warnings[1], "3:8: Wodo.png: file not found; drawn without this image");
    let hints: Vec<&str> = scene.diagnostics.iter().filter_map(|d| d.hint.as_deref()).collect();
    assert!(hints.len() == 1 && hints[0].ends_with("did you mean \"wood.png\"?"), "{hints:?}");
}
