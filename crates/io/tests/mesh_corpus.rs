//! Meshes of other projects: every good file opens with as many triangles as it holds, every bad one is told why.
#[path = "assets_shared/mod.rs"]
mod assets_shared;
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use durer_scene::Severity;
use mesh_scene::{read, said, triangles};

/// Triangles, counted by another program (n - 2 for a face of n corners), less those without area.
const TRIANGLES: &[(&str, usize)] = &[
    ("obj/cow.obj", 5804),
    ("obj/fandisk.obj", 12946),
    ("obj/stanford-bunny.obj", 69451),
    ("obj/suzanne.obj", 968),
    ("obj/teapot.obj", 6320),
    ("obj/assimp/box.obj", 12),
    ("obj/assimp/box_mat_with_spaces.obj", 12),
    ("obj/assimp/box_without_lineending.obj", 12),
    ("obj/assimp/concave_polygon.obj", 64),
    ("obj/assimp/cube_mtllib_after_g.obj", 12),
    ("obj/assimp/cube_usemtl.obj", 12),
    ("obj/assimp/cube_with_vertexcolors.obj", 12),
    ("obj/assimp/multiple_spaces.obj", 1),
    ("obj/assimp/space_in_material_name.obj", 64),
    ("obj/assimp/spider.obj", 1312),
    ("obj/assimp/testmixed.obj", 12),
    ("obj/cornell_box/cornell_box.obj", 32),
    ("obj/obj2gltf/box-complex-material/box-complex-material.obj", 12),
    ("obj/obj2gltf/box-complex-material-alpha/box-complex-material-alpha.obj", 12),
    ("obj/obj2gltf/box-groups/box-groups.obj", 36),
    ("obj/obj2gltf/box-mixed-attributes/box-mixed-attributes.obj", 12),
    ("obj/obj2gltf/box-mtllib/box-mtllib.obj", 12),
    ("obj/obj2gltf/box-mtllib-spaces/box mtllib.obj", 12),
    ("obj/obj2gltf/box-negative-indices/box-negative-indices.obj", 12),
    ("obj/obj2gltf/box-objects-groups-materials/box-objects-groups-materials.obj", 36),
    ("obj/obj2gltf/box-subdirectories/box-textured.obj", 12),
    ("obj/obj2gltf/box-texture-options/box-texture-options.obj", 12),
    ("obj/obj2gltf/box-textured/box-textured.obj", 12),
    ("obj/obj2gltf/box-transparent/box-transparent.obj", 12),
    ("obj/obj2gltf/box-windows-paths/box-windows-paths.obj", 12),
    ("obj/obj2gltf/concave/concave.obj", 16),
    ("obj/spot/spot_control_mesh.obj", 372),
    ("obj/spot/spot_quadrangulated.obj", 5856),
    ("obj/spot/spot_triangulated.obj", 5856),
    ("obj/trimesh/cubevt.obj", 12),
    ("obj/trimesh/fuze.obj", 1000),
    ("obj/trimesh/groups.obj", 2308),
    ("obj/trimesh/negative_indices.obj", 12),
    ("obj/trimesh/quadknot.obj", 2880),
    ("obj/trimesh/tube.obj", 120),
    ("obj/trimesh/wallhole.obj", 66),
    ("ply/dragon_vrip.ply.gz", 871414),
    ("ply/sponza_dabrovic.ply", 66445),
    ("ply/assimp/Wuson.ply", 3732),
    ("ply/assimp/cube.ply", 12),
    ("ply/assimp/cube_binary.ply", 12),
    ("ply/assimp/cube_binary_header_with_RN_newline.ply", 12),
    ("ply/assimp/cube_uv.ply", 12),
    ("ply/assimp/float-color.ply", 1),
    ("ply/trimesh/fuze.ply", 1000),
    ("ply/trimesh/fuze_ascii.ply", 1000),
    ("ply/trimesh/metadata.ply", 2),
    ("ply/trimesh/multi.ply", 2),
    ("ply/trimesh/plane_tri.ply", 2),
    ("stl/Spider_ascii.stl", 1368),
    ("stl/Spider_binary.stl", 1368),
    ("stl/featuretype.STL", 3476),
    ("stl/multibody.stl", 32),
    ("stl/sphereWithHole.stl", 285),
    ("stl/teapot.stl", 894),
    ("stl/triangle.stl", 1),
    ("stl/triangle_with_two_solids.stl", 2),
];

/// A face of 936 corners that winds around a square 234 times: any number of triangles will do.
const ODD: &str = "obj/assimp/box_longline.obj";

/// Files with a statement that is none.
const REFUSED: &[(&str, &str)] =
    &[("obj/assimp/number_formats.obj", "\"3.1+e2\" is not a number (the first of 6 such errors)")];

#[test]
fn all_triangles_of_good_files_are_read() {
    let (mut found, mut wrong) = (0, Vec::new());
    for kind in ["obj", "ply", "stl"] {
        let Some(folder) = assets_shared::folder(kind) else {
            return;
        };
        let root = folder.parent().expect("a folder of folders");
        for path in assets_shared::files(&folder) {
            let name = path.strip_prefix(root).expect("below").to_string_lossy().to_lowercase();
            let suffixes = [".obj", ".ply", ".ply.gz", ".stl"];
            if !suffixes.iter().any(|s| name.ends_with(s)) {
                continue;
            }
            found += 1;
            let scene = read(&path);
            let errors = said(&scene, Severity::Error);
            if let Some((_, why)) = REFUSED.iter().find(|(n, _)| *n == name) {
                assert!(errors[0].contains(why), "{name}: {errors:?}");
                continue;
            }
            assert!(errors.is_empty(), "{name}: {errors:#?}");
            if name == ODD {
                assert!(triangles(&scene) > 12);
                continue;
            }
            let expected = TRIANGLES.iter().find(|(n, _)| n.to_lowercase() == name);
            let (_, expected) = expected.unwrap_or_else(|| panic!("{name} is in no table"));
            let read = triangles(&scene);
            if read != *expected {
                wrong.push(format!("{name}: {read}, not {expected}: {:?}", said(&scene, Severity::Warning)));
            }
            for mesh in &scene.desc.meshes {
                mesh.validate().expect(&name);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(found, TRIANGLES.len() + REFUSED.len() + 1);
}

/// What is said of a bad file: the first error, or the first warning of one that opens.
const BAD: &[(&str, &str)] = &[
    ("assimp_box_UTF16BE.obj", "this is UTF-16; save it as UTF-8"),
    ("assimp_empty.obj", "the file is empty"),
    ("assimp_malformed.obj", "23:5: there is no vertex 12: the file has 8"),
    (
        "obj2gltf/box-incomplete-attributes/box-incomplete-normals.obj",
        "32:1: 5 faces name normals that are not there; drawn without them",
    ),
    (
        "obj2gltf/box-incomplete-attributes/box-incomplete-positions.obj",
        "29:9: there is no vertex 2: the file has 1 (the first of 6 such errors)",
    ),
    (
        "obj2gltf/box-incomplete-attributes/box-incomplete-uvs.obj",
        "17:1: 6 faces name texture coordinates that are not there; drawn without them",
    ),
    (
        "obj2gltf/box-missing-mtllib/box-missing-mtllib.obj",
        "3:8: /box.mtl: leads out of the scene's folder (for safety only files below it are read); its materials are drawn in grey",
    ),
    (
        "obj2gltf/box-missing-texture/box-missing-texture.obj",
        "/cesium.png: leads out of the scene's folder (for safety only files below it are read); drawn without this image",
    ),
    ("tinyobj/invalid-face-definition.obj", "15:1: 2 faces with fewer than 3 corners are left out"),
    (
        "tinyobj/invalid-relative-vertex-index.obj",
        "1:3: -4 counts backwards, but there are fewer than 4 vertices before this",
    ),
    ("tinyobj/issue-140-zero-face-idx.obj", "16:3: there is no vertex 0"),
    (
        "tinyobj/issue-161-inconsistent-f.obj",
        "2:8: cube.mtl: file not found; its materials are drawn in grey",
    ),
    // Nothing is wrong with it: it made another reader fail.
    ("tinyobj/issue-319-002.obj", ""),
    (
        "tinyobj/missing_material_file.obj",
        "11:8: the file uses materials, but names no file that holds them (mtllib); drawn in grey",
    ),
    ("tinyobj/test-nan.obj", "12:1: a coordinate is nan or infinite (the first of 2 such errors)"),
    ("trimesh/notenoughindices.obj", "9:1: 1 face with fewer than 3 corners is left out"),
    ("trimesh/obj_empty.obj", "the file holds no faces: there is nothing to see"),
    ("trimesh/obj_wireframe.obj", "12:1: 12 lines and points (l, p) are left out: only faces are drawn"),
    (
        "trimesh/obj_with_no_face_in_chunk.obj",
        "8:8: the file uses materials, but names no file that holds them (mtllib); drawn in grey",
    ),
    (
        "crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
        "7:10: the header holds bytes that are no text: the file is damaged",
    ),
    ("empty.ply", "the file holds no vertices and no faces: there is nothing to see"),
    ("ply_empty_ascii.ply", "the file holds no vertices and no faces: there is nothing to see"),
    ("ply_empty_header.ply", "the file holds no vertices and no faces: there is nothing to see"),
    ("points_emptyascii.ply", "the file holds 12 points but no faces: there is nothing to see"),
    ("empty.stl", "the file holds no triangles: there is nothing to see"),
    // Triangles that do not touch: nothing is wrong with it.
    ("soup.stl", ""),
    ("stl_empty_ascii.stl", "the file holds no triangles: there is nothing to see"),
];

#[test]
fn bad_files_are_told_why() {
    let mut found = 0;
    for kind in ["obj", "ply", "stl"] {
        let Some(folder) = assets_shared::folder(&format!("malformed/{kind}")) else {
            return;
        };
        for path in assets_shared::files(&folder) {
            let name = path.strip_prefix(&folder).expect("below").to_string_lossy().into_owned();
            if name.ends_with(".mtl") {
                continue;
            }
            found += 1;
            let scene = read(&path);
            let said: Vec<_> = [said(&scene, Severity::Error), said(&scene, Severity::Warning)].concat();
            let first = said.first().cloned().unwrap_or_default();
            let expected = BAD.iter().find(|(n, _)| *n == name);
            let (_, expected) = expected.unwrap_or_else(|| panic!("{name} is in no table: {first}"));
            assert!(expected.is_empty() == first.is_empty(), "{name}: {first}");
            assert!(first.ends_with(expected), "{name}: {first}");
        }
    }
    assert_eq!(found, BAD.len());
}
