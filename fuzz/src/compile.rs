//! Descriptions that are small enough are compiled: kinds, parameters, textures, trees.
use durer::{
    Imported, Options, prepare,
    scene::{Missing, SceneDesc},
};

/// Most shapes, triangles, lights and textures: more of them are no other code, and take long.
const MOST: usize = 2_000;

/// Prepares a small picture of what was read, if it is small.
pub(crate) fn small(imported: &mut Imported) {
    let options = Options {
        width: Some(8),
        height: Some(8),
        threads: Some(1),
        missing: Missing::Warn,
        nothing: Missing::Warn,
        ..Options::default()
    };
    if is_small(&imported.desc) {
        drop(prepare(imported, &options));
    }
}

fn is_small(desc: &SceneDesc) -> bool {
    let triangles: usize = desc.meshes.iter().map(|mesh| mesh.indices.len()).sum();
    [desc.shapes.len(), triangles, desc.lights.len(), desc.textures.len()].iter().all(|&n| n <= MOST)
}
