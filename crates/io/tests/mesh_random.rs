//! Whatever the bytes, reading a mesh ends, does not panic, and leaves meshes that hold together.
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use mesh_scene::import;
use proptest::prelude::*;

const OBJ: &[u8] =
    b"mtllib a.mtl\no A\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .1 0\nvt 0 0\nvn 0 0 1\n\
    usemtl m\ns 1\ng b c\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3 \\\n -4 -5\nf 1//1 2//1 3//1 4//1\nl 1 2\n# end\n";
const MTL: &[u8] = b"newmtl m\nKd 1 0 0\nKs .5 .5 .5\nNs 10\nd 0.5\nillum 7\nNi 1.5\nmap_Kd -s 1 1 -o 0 -mm 0 1 -bm 1 x.png\n";
const PLY: &[u8] =
    b"ply\nformat ascii 1.0\ncomment TextureFile x\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
    property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
    0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n4 0 1 2 3 0\n3 0 1 2 6 0 0 1 0 1 1\n";
const PACKED: &[u8] = b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n\0\0\0\0\0\0\0\0\0\0\0\0\x03\0\0\0";
const STL: &[u8] =
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
    endfacet\nendsolid a\n";

/// Bytes put in place of others, cut out, or doubled.
fn damaged(mut bytes: Vec<u8>, changes: &[(usize, u8, u8)]) -> Vec<u8> {
    for &(at, how, value) in changes {
        let at = at % bytes.len().max(1);
        match how {
            0 => bytes.truncate(at),
            1 => drop(bytes.splice(at..(at + value as usize).min(bytes.len()), [])),
            2 => bytes.extend_from_within(at..),
            3 => bytes.insert(at, b"0123456789-+.eE/\\\n\r \t#\0\xff"[value as usize % 24]),
            _ if at < bytes.len() => bytes[at] = value,
            _ => {}
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]
    #[test]
    fn damaged_files_end_in_meshes_or_complaints(
        file in 0..5_usize,
        changes in prop::collection::vec((any::<usize>(), 0..8_u8, any::<u8>()), 1..8),
    ) {
        let (name, bytes) = [("a.obj", OBJ), ("a.obj", OBJ), ("a.ply", PLY), ("a.ply", PACKED), ("a.stl", STL)][file];
        let (main, mtl) = match file {
            1 => (bytes.to_vec(), damaged(MTL.to_vec(), &changes)),
            _ => (damaged(bytes.to_vec(), &changes), MTL.to_vec()),
        };
        let scene = import(&[(name, &main), ("a.mtl", &mtl)]);
        for mesh in &scene.desc.meshes {
            prop_assert_eq!(mesh.validate(), Ok(()));
        }
        if scene.diagnostics.has_errors() {
            prop_assert!(scene.desc.shapes.is_empty());
        }
        for said in &scene.diagnostics {
            if let durer_scene::Location::Span(span) = &said.at {
                prop_assert!(span.start <= span.end && span.end as usize <= scene.sources.text(span.source).len());
            }
        }
    }
}
