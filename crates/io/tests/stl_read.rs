//! STL: text and bytes, told apart by content.
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use durer_scene::Severity;
use mesh_scene::{assert_silent, import, mesh, said, triangles};

fn stl(bytes: &[u8]) -> durer_io::import::Imported {
    import(&[("part.stl", bytes)])
}

fn facet(x: f32) -> String {
    format!(
        "facet normal 0 0 1\nouter loop\nvertex {x} 0 0\nvertex {x} 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    )
}

fn binary(head: &[u8], count: u32, triangles: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend([0xff, 0x7f]);
    }
    bytes
}

const TWO: [[f32; 9]; 2] = [[0., 0., 0., 1., 0., 0., 1., 1., 0.], [0., 0., 0., 1., 1., 0., 0., 1., 0.]];

#[test]
fn several_bodies_are_several_shapes_with_their_names() {
    let text = format!(
        "solid left part\n{}endsolid left part\nSOLID\n{}{}EndSolid",
        facet(1.0),
        facet(2.0),
        facet(3.0)
    );
    let scene = stl(text.as_bytes());
    assert_silent(&scene);
    let names: Vec<_> = scene.desc.shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["left part", "part"]);
    assert_eq!(mesh(&scene, 1).indices, [[0, 1, 2], [3, 4, 2]]);
    assert!(mesh(&scene, 1).normals.is_empty());
}

#[test]
fn binary_files_may_begin_with_solid() {
    for head in [&b"solid part"[..], b"made by hand", b"\0"] {
        let scene = stl(&binary(head, 2, &TWO));
        assert_silent(&scene);
        assert_eq!(mesh(&scene, 0).indices, [[0, 1, 2], [0, 2, 3]]);
    }
}

#[test]
fn wrong_counts_are_told() {
    let error = |bytes: &[u8]| said(&stl(bytes), Severity::Error).remove(0);
    assert!(
        error(&binary(b"x", 4_000_000_000, &TWO))
            .ends_with("the file was cut off: 2 of 4000000000 triangles are there")
    );
    assert!(error(&binary(b"solid", 3, &TWO)).ends_with("the file was cut off: 2 of 3 triangles are there"));
    assert!(error(b"PK").ends_with("this is no STL file: 2 bytes are too few for a binary one"));
    let scene = stl(&binary(b"x", 1, &TWO));
    assert!(said(&scene, Severity::Warning)[0].ends_with("50 bytes behind the last triangle are ignored"));
    assert_eq!(triangles(&scene), 1);
    let mut nan = TWO;
    nan[1][4] = f32::NAN;
    assert!(error(&binary(b"x", 2, &nan)).ends_with("triangle 1: a coordinate is nan or infinite"));
}

#[test]
fn wrong_text_is_told_with_its_place() {
    let good = facet(1.0);
    for (text, expected) in [
        (good.replace("vertex 1 0 0", "vertex 1 o 0"), "4:10: expected a number, found \"o\""),
        (good.replace("vertex 1 0 0\n", ""), "6:1: expected \"vertex\", found \"endloop\""),
        (good.replace("endloop", "vertex 1 2 3\nendloop"), "7:1: expected \"endloop\", found \"vertex\""),
        (
            good.replace("facet normal", "face normal"),
            "2:1: expected \"facet\" or \"endsolid\", found \"face\"",
        ),
        (good.replace("vertex 1 0 0", "vertex inf 0 0"), "4:1: a coordinate is nan or infinite"),
        (
            "facet normal 0 0 1 outer loop vertex 1 2".to_owned(),
            "2:40: the file ends within a facet: expected a number",
        ),
    ] {
        let scene = stl(format!("solid a\n{text}").as_bytes());
        assert_eq!(said(&scene, Severity::Error), [expected]);
    }
    let cut = stl(format!("solid a\n{good}").as_bytes());
    assert!(said(&cut, Severity::Warning)[0].contains("\"endsolid\" is missing"));
}

#[test]
fn large_texts_are_read_in_pieces_without_seams() {
    let count = 30_000;
    let mut text = String::from("solid facet normal\n");
    (0..count).for_each(|i| text += &facet(1.0 + i as f32));
    assert!(text.len() > 2 << 20);
    let scene = stl((text + "endsolid\n").as_bytes());
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!((mesh.indices.len(), mesh.positions.len()), (count, 2 * count + 1));
    let first = |t: &[u32; 3]| mesh.positions[t[0] as usize].x;
    assert!(mesh.indices.iter().enumerate().all(|(i, t)| first(t) == 1.0 + i as f32));
}

#[test]
fn texts_may_have_any_line_ends_or_none_and_a_byte_order_mark() {
    let text = format!(
        "solid big part\n{}{}endsolid big part\nsolid\n{}endsolid\n",
        facet(1.0),
        facet(2.0),
        facet(3.0)
    );
    let marked = format!("\u{feff}{text}");
    for text in [text.replace('\n', "\r"), text.replace('\n', " "), text.replace('\n', "\r\n"), marked] {
        let scene = stl(text.as_bytes());
        assert_silent(&scene);
        let names: Vec<_> = scene.desc.shapes.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["big part", "part"], "{text:?}");
        assert_eq!((mesh(&scene, 0).indices.len(), triangles(&scene)), (2, 3));
    }
    let wide: Vec<u8> = "\u{feff}solid a\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(said(&stl(&wide), Severity::Error)[0].ends_with("this is UTF-16; save it as UTF-8"));
}
