//! Wavefront OBJ: what is made of statements, and what is said about wrong ones.
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use durer_core::math::{Point2, Point3};
use durer_scene::Severity;
use mesh_scene::{assert_silent, import, material, mesh, said, triangles};

fn obj(text: &str) -> durer_io::import::Imported {
    import(&[("model.obj", text.as_bytes())])
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn corners_that_agree_share_a_vertex() {
    let text = format!("{SQUARE}vt 0 0\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\nf -4/1/-1 3/1/1 4/2/1\n");
    let scene = obj(&text);
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[3], Point3::new(0.0, 1.0, 0.0));
    assert_eq!(mesh.uvs[1], Point2::new(1.0, 0.0));
    assert_eq!(mesh.normals.len(), 4);
    assert_eq!(scene.desc.shapes[0].name, "model");
}

#[test]
fn the_same_position_with_two_texture_coordinates_is_two_vertices() {
    let scene = obj(&format!("{SQUARE}vt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n"));
    assert_eq!(mesh(&scene, 0).positions.len(), 5);
}

#[test]
fn negative_indices_count_back_from_where_they_stand() {
    let scene = obj(&format!("{SQUARE}f -4 -3 -2\nv 5 5 5\nf -5 -3 -2\n"));
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    let corner = |t: usize, c: usize| mesh.positions[mesh.indices[t][c] as usize];
    assert_eq!(corner(1, 0), Point3::new(0.0, 0.0, 0.0));
    assert_eq!(corner(1, 2), Point3::new(0.0, 1.0, 0.0));
}

#[test]
fn faces_may_name_vertices_that_come_later() {
    let scene = obj(&format!("f 1 2 3\n{SQUARE}"));
    assert_silent(&scene);
    assert_eq!(triangles(&scene), 1);
}

#[test]
fn objects_groups_and_materials_make_shapes_in_order() {
    let text =
        format!("{SQUARE}o A\ng left\nf 1 2 3\ng right wing\nf 1 3 4\ng left\nf 2 3 4\no B\nf 1 2 4\n");
    let scene = obj(&text);
    let names: Vec<_> = scene.desc.shapes.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["A/left", "A/right wing", "B"]);
    assert_eq!(mesh(&scene, 0).indices.len(), 2);
}

#[test]
fn line_ends_of_every_kind_comments_and_continued_lines_are_read() {
    let text =
        "\u{feff}# C:\\models\\\r\nv 0 0 0\r\n  v 1 0 0 # right\r\nv 1 \\\r\n 1 0\r\n\r\nf 1 2\\\r\n 3 # end";
    let scene = obj(text);
    assert_silent(&scene);
    assert_eq!(mesh(&scene, 0).positions[2], Point3::new(1.0, 1.0, 0.0));
}

#[test]
fn smoothing_groups_get_normals_weighted_by_angle_and_stay_apart() {
    // A roof: two rectangles that meet at right angles in the edge x = 0, and a third one of another group.
    let text = "v 0 1 0\nv 0 1 1\nv -1 0 1\nv -1 0 0\nv 1 0 0\nv 1 0 1\n\
                s 1\nf 1 4 3 2\nf 1 2 6 5\ns 2\nf 1 5 4\ns off\nf 2 3 6\n";
    let scene = obj(text);
    assert_silent(&scene);
    let smooth = mesh(&scene, 1);
    let flat = mesh(&scene, 0);
    assert!(flat.normals.is_empty());
    assert_eq!(flat.indices.len(), 1);
    let up = (0..smooth.positions.len()).filter(|&i| smooth.positions[i] == Point3::new(0.0, 1.0, 0.0));
    let normals: Vec<_> = up.map(|i| smooth.normals[i]).collect();
    assert_eq!(normals.len(), 2);
    assert!((normals[0].y - 1.0).abs() < 1e-6 && normals[0].x.abs() < 1e-6, "{normals:?}");
    assert!((normals[1].z + 1.0).abs() < 1e-6, "{normals:?}");
}

#[test]
fn a_quadrangle_is_split_along_the_diagonal_inside() {
    // An arrowhead, concave at its second and then at its first corner.
    for (text, diagonal) in [
        ("v 0 0 0\nv 1 1 0\nv 2 0 0\nv 1 3 0\nf 1 2 3 4\n", [1, 3]),
        ("v 1 1 0\nv 2 0 0\nv 1 3 0\nv 0 0 0\nf 1 2 3 4\n", [0, 2]),
    ] {
        let scene = obj(text);
        let mesh = mesh(&scene, 0);
        assert_eq!(mesh.indices.len(), 2);
        for t in &mesh.indices {
            let corners = t.map(|i| mesh.positions[i as usize]);
            let ends = diagonal.map(|d: usize| {
                let lines: Vec<&str> = text.lines().collect();
                let numbers: Vec<f32> =
                    lines[d].split(' ').skip(1).map(|n| n.parse().expect("number")).collect();
                Point3::new(numbers[0], numbers[1], numbers[2])
            });
            assert!(ends.iter().all(|e| corners.contains(e)), "{corners:?}");
        }
    }
}

#[test]
fn concave_polygons_keep_their_area() {
    // A comb with 8 teeth of 1 by 2 on a bar of 15 by 1, in the plane z = x.
    let mut outline = vec![(0.0, 0.0), (15.0, 0.0)];
    for tooth in (0..8).rev() {
        let x = 2.0 * f64::from(tooth);
        outline.extend([(x + 1.0, 1.0), (x + 1.0, 3.0), (x, 3.0), (x, 1.0)]);
    }
    outline.retain(|p| *p != (15.0, 1.0) && *p != (0.0, 1.0));
    let vertices: String = outline.iter().map(|(x, y)| format!("v {x} {y} {x}\n")).collect();
    let face: String = (1..=outline.len()).map(|i| format!(" {i}")).collect();
    let scene = obj(&format!("{vertices}f{face}\n"));
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.indices.len(), outline.len() - 2);
    let normals = mesh.indices.iter().map(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).x * -0.5
    });
    // In the projection along x no area is lost and none is counted twice or backwards.
    let areas: Vec<f32> = normals.collect();
    assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
    assert_eq!(areas.iter().sum::<f32>(), 15.0 + 8.0 * 2.0);
}

#[test]
fn vertex_colours_are_decoded_and_shown() {
    let scene = obj("v 0 0 0 1 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 0 0 1\nf 1 2 3\n");
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.colors[0], [1.0, 0.0, 0.0, 1.0]);
    // sRGB 0.5 is 0.214 linear.
    assert!((mesh.colors[1][0] - 0.214_041).abs() < 1e-5);
    assert_eq!(material(&scene, 0).node.kind, "principled");
}

#[test]
fn wrong_statements_are_told_with_line_and_column() {
    let scene = obj("v 0 0 0\nv 1 x 0\nv 1 1\nvt\nv 1 nan 0\nf 1 2 9\nf 1 2 -7\nf 1 0 2\nf 1 2 a\n");
    let expected = [
        "2:5: \"x\" is not a number",
        "3:1: expected 3 numbers, found 2",
        "4:1: expected numbers",
        "5:1: a coordinate is nan or infinite",
        "6:7: there is no vertex 9: the file has 4",
        "7:7: -7 counts backwards, but there are fewer than 7 vertices before this",
        "8:5: there is no vertex 0",
        "9:7: expected a corner such as 1, 1/1, 1//1 or 1/1/1, found \"a\"",
    ];
    assert_eq!(said(&scene, Severity::Error), expected);
    assert!(scene.desc.shapes.is_empty());
}

#[test]
fn what_is_left_out_is_said_once() {
    let text = format!(
        "{SQUARE}l 1 2\nl 2 3\np 1\nf 1 2\nf 1 1 2\nf 1 2 3\nvertx 1\nvertx 2\ncurv 0 1 1 2\nf 1/5 2/5 3/5\n"
    );
    let scene = obj(&text);
    let warnings = said(&scene, Severity::Warning);
    let expected = [
        "5:1: 3 lines and points (l, p) are left out: only faces are drawn",
        "13:1: 1 line is skipped: curves and free-form surfaces are not read",
        "8:1: 1 face with fewer than 3 corners is left out",
        "14:1: 1 face names texture coordinates that are not there; drawn without them",
        "11:1: unknown word \"vertx\"; lines with it are skipped",
    ];
    assert_eq!(&warnings[..5], expected);
    assert!(warnings[5].ends_with("model.obj: 1 faces without area are left out"), "{warnings:?}");
    assert_eq!(triangles(&scene), 2);
}

#[test]
fn large_files_are_read_in_pieces_without_seams() {
    // Rows of a strip: 2 vertices and one relative quadrangle each, 3 MB in all.
    let rows = 60_000;
    let mut text = String::from("v 0 0 0\nv 0 1 0\n");
    for i in 1..=rows {
        text += &format!("v {i}.000000 0.000000 0\nv {i}.000000 1.000000 0\nf -4 -2 -1 -3\n");
    }
    assert!(text.len() > 2 << 20);
    let scene = obj(&text);
    assert_silent(&scene);
    let mesh = mesh(&scene, 0);
    assert_eq!((mesh.positions.len(), mesh.indices.len()), (2 * rows + 2, 2 * rows));
    for (i, t) in mesh.indices.iter().enumerate() {
        let x = t.map(|v| mesh.positions[v as usize].x);
        let left = (i / 2) as f32;
        assert!(x.iter().all(|x| *x == left || *x == left + 1.0), "triangle {i}: {x:?}");
    }
}

#[test]
fn what_is_read_does_not_depend_on_threads() {
    let mut text = String::new();
    for i in 0..40_000 {
        text += &format!("v {i} 0.5 {}\nvt 0.{i} 1\n", i * 7 % 13);
        if i >= 3 {
            text += &format!("g {}\ns {}\nf -1/-1 -2/-2 -3/-3\n", i / 5000, i / 7000);
        }
    }
    let root = mesh_scene::folder(&[("a.obj", text.as_bytes())]);
    let read = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| mesh_scene::read(&root.path().join("a.obj"))).desc
    };
    let (one, four) = (read(1), read(4));
    assert_eq!(one, four);
    assert!(one.meshes.len() > 4);
}

#[test]
fn other_encodings_are_named() {
    for bytes in [&b"\xff\xfev\x000\x00"[..], b"\xfe\xff\x00v"] {
        let scene = import(&[("a.obj", bytes)]);
        assert!(said(&scene, Severity::Error)[0].ends_with("a.obj: this is UTF-16; save it as UTF-8"));
    }
    let scene = import(&[("a.obj", b"\x7fXLF\x02\0\0\0")]);
    assert!(said(&scene, Severity::Error)[0].ends_with("this is a binary file, not a Wavefront OBJ"));
    let scene = import(&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\no K\xf6rper\nf 1 2 3\n")]);
    assert_eq!(scene.desc.shapes[0].name, "Körper");
}

#[test]
fn numbers_that_old_programs_could_not_write_are_none() {
    let scene = import(&[("a.obj", b"v 0 0 1.#IND # a comment\nv 1 0 0#two\n")]);
    assert_eq!(said(&scene, Severity::Error), ["1:7: \"1.#IND\" is not a number"]);
}

#[test]
fn line_ends_of_old_macintosh_computers_are_read() {
    let scene = obj(&format!("# old\n{SQUARE}f 1 2 3\nf 1 3 4\n").replace('\n', "\r"));
    assert_silent(&scene);
    assert_eq!(triangles(&scene), 2);
}

#[test]
fn indices_of_more_digits_than_a_number_has_are_out_of_range() {
    let scene = obj(&format!("{SQUARE}f 1 2 99999999999999999999999\n"));
    let errors = said(&scene, Severity::Error);
    assert_eq!(errors, ["5:7: there is no vertex 999999999999999999: the file has 4"]);
}
