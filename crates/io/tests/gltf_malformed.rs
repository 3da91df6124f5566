//! The Khronos validator's damaged files: what is structurally wrong is refused at the place that is wrong.
mod assets_shared;

use assets_shared::folder;
use durer_io::import::open;
use durer_scene::{Limits, Location, Severity};

/// Codes of the validator after which a file cannot be trusted, whether or not a scene uses what is wrong. The others
/// are about meaning and style: a picture can be drawn.
const STRUCTURAL: &[&str] = &[
    "ACCESSOR_TOO_LONG",
    "ARRAY_TYPE_MISMATCH",
    "BUFFER_BYTE_LENGTH_MISMATCH",
    "BUFFER_VIEW_TOO_LONG",
    "GLB_CHUNK_LENGTH_UNALIGNED",
    "GLB_DUPLICATE_CHUNK",
    "GLB_EMPTY_CHUNK",
    "GLB_INVALID_MAGIC",
    "GLB_UNEXPECTED_BIN_CHUNK",
    "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
    "GLB_UNEXPECTED_END_OF_HEADER",
    "GLB_UNEXPECTED_FIRST_CHUNK",
    "INVALID_JSON",
    "NODE_LOOP",
    "NODE_PARENT_OVERRIDE",
    "TYPE_MISMATCH",
    "UNKNOWN_ASSET_MAJOR_VERSION",
    "UNRESOLVED_REFERENCE",
];

/// Errors with their places, and whether there are any.
fn errors(file: &std::path::Path) -> Vec<(String, String)> {
    let imported = open(file, Limits::default());
    let error = |d: &durer_scene::Diagnostic| match &d.at {
        Location::Path { pointer, .. } => (pointer.clone(), d.message.clone()),
        other => panic!("{}: a complaint at {other:?}: {}", file.display(), d.message),
    };
    imported.diagnostics.iter().filter(|d| d.severity == Severity::Error).map(error).collect()
}

#[test]
fn structural_damage_is_refused_where_it_is() {
    let Some(shared) = folder("malformed/gltf/khronos") else { return };
    let table = std::fs::read_to_string(shared.join("EXPECTED.tsv")).expect("the table");
    let (mut refused, mut accepted, mut wrong) = (0, Vec::new(), Vec::new());
    for line in table.lines().skip(1) {
        let (name, codes) = line.split_once('\t').expect("two columns");
        let errors = errors(&shared.join(name));
        let structural: Vec<&str> = codes.split(',').filter(|c| STRUCTURAL.contains(c)).collect();
        println!("{name}: {codes}: {errors:?}");
        // What is wrong with the container or with JSON itself has no place in the tree.
        let whole = structural.iter().any(|c| c.starts_with("GLB_") || *c == "INVALID_JSON")
            || name == "json/invalid_object.gltf";
        let as_expected = match (structural.is_empty(), errors.first()) {
            (true, _) => true,
            (false, None) => false,
            (false, Some((pointer, _))) => whole == pointer.is_empty(),
        };
        wrong.extend((!as_expected).then(|| format!("{name}: {structural:?}: {errors:?}")));
        refused += usize::from(!structural.is_empty() && !errors.is_empty());
        accepted.extend(errors.is_empty().then_some(name));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    println!("{refused} refused for their structure; drawn: {accepted:#?}");
    assert!(refused >= 40, "only {refused} refused");
}

#[test]
fn complaints_name_the_place_of_the_damage() {
    let Some(shared) = folder("malformed/gltf/khronos") else { return };
    let mut wrong = Vec::new();
    for (file, pointer, text) in [
        ("accessor/alignment.gltf", "/accessors/", "do not fit /bufferViews/"),
        (
            "animation/unresolved_channel_target.gltf",
            "/animations/0/channels/0/target/node",
            "there are none",
        ),
        ("buffer/invalid_object.gltf", "/buffers/0", "expected an object, found an array"),
        ("buffer_view/unresolved_buffer.gltf", "/bufferViews/0/buffer", "only 1 buffer"),
        ("material/unresolved_normal.gltf", "/materials/0/normalTexture/index", "there are none"),
        ("mesh/empty_object.gltf", "/meshes/1/primitives", "expected an array, found an object"),
        ("mesh/unresolved_positions.gltf", "/meshes/0/primitives/0/attributes/POSITION", "there are none"),
        ("node/node_loop_scene.gltf", "/nodes/5/children/0", "a node has one parent"),
        (
            "root/extensions_non_objects.gltf",
            "/extensions/KHR_invalid1",
            "expected an object, found a number",
        ),
        ("root/invalid_array_elements.gltf", "/materials/0", "expected an object, found a string"),
        ("scene/unresolved_default_scene.gltf", "/scene", "scenes"),
        ("skin/unresolved_joint.gltf", "/skins/0/joints/0", "there are none"),
        ("texture/unresolved_source.gltf", "/textures/0/source", "there are none"),
    ] {
        let errors = errors(&shared.join(file));
        let found = errors.iter().any(|(p, m)| p.starts_with(pointer) && m.contains(text));
        wrong.extend((!found).then(|| format!("{file}: {errors:?}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn valid_controls_are_read() {
    let Some(shared) = folder("malformed/gltf/khronos-valid-controls") else { return };
    let mut read = 0;
    for file in assets_shared::files(&shared) {
        if file.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            let errors = errors(&file);
            assert!(errors.is_empty(), "{}: {errors:?}", file.display());
            read += 1;
        }
    }
    assert!(read >= 38, "{read}");
}
