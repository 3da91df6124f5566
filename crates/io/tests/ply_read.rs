//! PLY: every way to write it, and what is said about damaged files.
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use durer_core::math::{Point2, Point3};
use durer_io::FileAssets;
use durer_scene::{AssetError, Assets, Limits, Severity};
use mesh_scene::{assert_silent, folder, import, material, mesh, said, triangles};
use std::sync::Arc;

fn ply(bytes: &[u8]) -> durer_io::import::Imported {
    import(&[("a.ply", bytes)])
}

const HEAD: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn text(body: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\n{HEAD}{body}").into_bytes()
}

#[test]
fn text_and_both_byte_orders_agree() {
    let words: String = SQUARE.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let ascii = ply(&text(&(words + "4 0 1 2 3\n")));
    assert_silent(&ascii);
    assert_eq!(mesh(&ascii, 0).indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh(&ascii, 0).positions, SQUARE.map(Point3::from));
    assert!(mesh(&ascii, 0).normals.is_empty());
    for (order, end) in [("little", "\n"), ("big", "\n"), ("little", "\r\n")] {
        let big = order == "big";
        let head = format!("ply\nformat binary_{order}_endian 1.0\n{HEAD}").replace('\n', end);
        let mut bytes = head.into_bytes();
        let float = |v: f32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        let int = |v: i32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        bytes.extend(SQUARE.as_flattened().iter().flat_map(|v| float(*v)));
        bytes.push(4);
        bytes.extend((0..4).flat_map(int));
        let scene = ply(&bytes);
        assert_silent(&scene);
        assert_eq!(mesh(&scene, 0), mesh(&ascii, 0), "{order}");
    }
}

#[test]
fn columns_come_in_any_order_under_any_of_their_names() {
    let scene = ply(b"ply\nformat ascii 1.0\ncomment made by hand\nobj_info 1\nelement face 1\n\
        property uint8 flags\nproperty list int16 uint32 vertex_index\nelement edge 1\nproperty int a\n\
        property list uchar double b\nelement nothing 4000000000\nelement vertex 3\nproperty double z\n\
        property float32 y\nproperty short x\nproperty float t\nproperty float s\nproperty uchar red\n\
        property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float ny\nproperty float nz\n\
        property float nx\nend_header\n7 3 2 1 0\n5 2 0.5 0.5\n\
        1 2 3 0.25 0.5 255 0 188 51 0 1 0\n0 0 0 0 0 0 0 0 255 0 1 0\n0 1 0 0 0 0 0 0 255 0 1 0\n");
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.indices, [[2, 1, 0]]);
    assert_eq!(mesh.positions[0], Point3::new(3.0, 2.0, 1.0));
    assert_eq!(mesh.uvs[0], Point2::new(0.5, 0.25));
    assert_eq!(mesh.normals[0].to_array(), [0.0, 0.0, 1.0]);
    let [r, g, b, a] = mesh.colors[0];
    // sRGB 188 is 0.503 linear; alpha is linear.
    assert!(r == 1.0 && g == 0.0 && (b - 0.502_886).abs() < 1e-5 && (a - 0.2).abs() < 1e-6);
    assert_eq!(material(&scene, 0).node.kind, "principled");
}

#[test]
fn colours_in_floats_are_linear() {
    let scene = ply(b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float red\nproperty float green\nproperty float blue\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 .5 .25 2\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n");
    assert_eq!(mesh(&scene, 0).colors[0], [0.5, 0.25, 2.0, 1.0]);
}

#[test]
fn rows_may_be_broken_across_lines_or_share_one() {
    let broken = text("0 0\n0 1 0 0\n1 1\n0\n0 1 0 4 0 1\n2 3");
    let joined = text("0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3");
    for bytes in [broken, joined] {
        let scene = ply(&bytes);
        assert_silent(&scene);
        assert_eq!(triangles(&scene), 2);
    }
}

#[test]
fn strips_become_triangles_that_turn_one_way() {
    let scene = ply(
        b"ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n9 0 1 2 3 -1 2 3 4 -1\n",
    );
    assert_silent(&scene);
    assert_eq!(mesh(&scene, 0).indices, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

#[test]
fn texture_coordinates_of_faces_split_vertices() {
    let scene =
        ply(b"ply\nformat ascii 1.0\ncomment TextureFile gone.png\nelement vertex 4\nproperty float x\n\
        property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\n\
        property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\
        3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 0.5 0.5 0 1\n");
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 3, 4]]);
    assert_eq!(mesh.positions[3], mesh.positions[2]);
    assert_eq!(mesh.uvs[3], Point2::new(0.5, 0.5));
    assert!(said(&scene, Severity::Warning)[0].contains("gone.png: file not found; drawn without"));
}

fn error(bytes: &[u8]) -> String {
    let scene = ply(bytes);
    assert!(scene.desc.shapes.is_empty());
    said(&scene, Severity::Error).remove(0)
}

#[test]
fn damaged_files_are_told_where() {
    let square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (body, expected) in [
        ("0 0 0\n1 0 x\n1 1 0\n0 1 0\n4 0 1 2 3\n", "11:5: expected a number, found \"x\""),
        ("0 0 0\n1 0 nan\n1 1 0\n0 1 0\n4 0 1 2 3\n", "11:5: a coordinate is nan or infinite"),
        (&format!("{square}4 0 1 2 4\n"), "14:9: a face names vertex 4, but there are 4, counted from 0"),
        (&format!("{square}4 0 1 2 -1\n"), "14:9: a face names vertex -1, but there are 4, counted from 0"),
        (&format!("{square}4 0 1 2\n"), "14:7: this face says 4 corners but lists 3"),
        (&format!("{square}-3 0 1 2\n"), "14:1: a list of -3 values"),
        (square, "7:1: the header promises 1 row of the element face, but the file ends after 0"),
    ] {
        assert_eq!(error(&text(body)), expected);
    }
    for (bytes, expected) in [
        (&b"ply\nelement vertex 1\nend_header\n"[..], "3:1: the header has no line \"format\""),
        (
            b"ply\nformat asci 1.0\n",
            "2:8: expected \"ascii\", \"binary_little_endian\" or \"binary_big_endian\", found \"asci\"",
        ),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty flaot x\n", "4:10: unknown type \"flaot\""),
        (
            b"ply\nformat ascii 1.0\nelement vertex -1\n",
            "3:16: expected \"element\", a name and a number of rows, found \"-1\"",
        ),
        (b"ply\nformat ascii 1.0\nproperty float x\n", "3:1: a property before the first element"),
        (
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
            "3:1: the vertices have no properties x, y and z",
        ),
    ] {
        assert_eq!(error(bytes), expected);
    }
    let foreign = "not a PLY file: it begins with \"plyx\", not with a line \"ply\"";
    assert!(error(b"plyx\n").ends_with(foreign));
}

/// A reader that believed these headers would ask for terabytes.
#[test]
fn promises_are_checked_against_the_bytes_there_are() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let head = format!("ply\nformat {encoding} 1.0\n{HEAD}").replace("vertex 4", "vertex 4000000000");
        let message = error(&[head.as_bytes(), &b"1 1 1\n".repeat(8)].concat());
        assert!(message.contains("the header promises 4000000000 rows of the element vertex"), "{message}");
        let mut bytes =
            format!("ply\nformat {encoding} 1.0\n{HEAD}").replace("uchar int", "uint int").into_bytes();
        bytes.extend(std::iter::repeat_n([0xf0; 4], 40).flatten());
        error(&bytes);
    }
}

#[test]
fn any_cut_of_a_binary_file_is_an_error() {
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\n{HEAD}").into_bytes();
    bytes.extend(SQUARE.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    bytes.push(4);
    bytes.extend((0..4).flat_map(i32::to_le_bytes));
    for length in 0..bytes.len() {
        error(&bytes[..length]);
    }
}

#[test]
fn assets_hold_the_same_mesh_packed_or_not_and_read_it_once() {
    use std::io::Write;
    let words: String = SQUARE.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let plain = text(&(words + "4 0 1 2 3\n"));
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packer.write_all(&plain).expect("memory");
    let packed = packer.finish().expect("memory");
    let root = folder(&[("m.ply", &plain), ("m.ply.gz", &packed), ("bad.ply", b"ply\nformat x\n")]);
    let assets = FileAssets::new(root.path().to_owned(), Limits::default());
    let mesh = assets.mesh("m.ply").expect("readable");
    assert_eq!(*mesh, *assets.mesh("m.ply.gz").expect("readable"));
    assert!(Arc::ptr_eq(&mesh, &assets.mesh("m.ply").expect("readable")));
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    let error = assets.mesh("bad.ply").expect_err("damaged").to_string();
    assert!(error.starts_with("bad.ply: line 2: expected \"ascii\""), "{error}");
    assert!(matches!(assets.mesh("gone.ply"), Err(AssetError::Missing { .. })));
}

#[test]
fn line_ends_of_old_macintosh_computers_are_read() {
    let body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    let ascii: Vec<u8> = text(body).iter().map(|&b| if b == b'\n' { b'\r' } else { b }).collect();
    let mut binary = format!("ply\nformat binary_little_endian 1.0\n{HEAD}").replace('\n', "\r").into_bytes();
    // 13 is a carriage return, which the body of a binary file may hold.
    let corners =
        [[13.0, 0.0, 0.0], [1.0, 0.0, f32::from_bits(0x0d0d_0d0d)], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    binary.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    binary.push(4);
    binary.extend((0..4_i32).flat_map(i32::to_le_bytes));
    for bytes in [&ascii, &binary] {
        let scene = ply(bytes);
        assert_silent(&scene);
        assert_eq!(triangles(&scene), 2);
    }
    assert_eq!(mesh(&ply(&binary), 0).positions, corners.map(Point3::from));
    let root = folder(&[("mac.ply", &ascii)]);
    let assets = FileAssets::new(root.path().to_owned(), Limits::default());
    assert_eq!(assets.mesh("mac.ply").expect("readable").indices.len(), 2);
}
