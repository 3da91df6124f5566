//! Ptex: what files of formulas hold, seen on surfaces.
use std::path::Path;

use durer::{
    FileAssets, Options,
    math::Point2,
    model::{
        ShadeCx,
        texture::{Footprint, TextureAt},
    },
    scene::{Assets, Limits},
    spectrum::Basis,
};
use durer_testkit::ptex::{Face, File, Packed, Stored};
use durer_tests::{prepared, render};

const ALONE: [Option<(u32, u8)>; 4] = [None; 4];

fn face(log2: [u8; 2], beside: [Option<(u32, u8)>; 4], packed: Packed) -> Face {
    Face { log2, beside, packed }
}
fn file(stored: Stored, channels: u16, faces: Vec<Face>) -> File {
    File { is_triangles: false, stored, channels, faces, is_edited: false }
}

fn assets(folder: &Path) -> FileAssets {
    FileAssets::new(folder.to_owned(), Limits::default())
}

/// The texture of a file under an encoding, as materials ask it.
struct Asked(durer::Prepared);

impl Asked {
    fn of(bytes: &[u8], words: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("x.ptx"), bytes).expect("a file");
        let text = format!(
            "WorldBegin\nTexture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"x.ptx\" {words}\n\
             Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\""
        );
        let scene = folder.path().join("scene.pbrt");
        std::fs::write(&scene, text).expect("a file");
        Self(prepared(durer::open(&scene.to_string_lossy()), &Options::default()))
    }

    fn at(&self, face: u32, uv: [f32; 2], step: f32) -> [f32; 3] {
        let textures = &self.0.scene.textures;
        let cx = ShadeCx { basis: Basis::Rgb, textures, log: None };
        let footprint = Footprint { duvdx: [step, 0.0], duvdy: [0.0, step], ..Footprint::POINT };
        let uv = Point2::from(uv);
        let at = TextureAt {
            uv,
            second_uv: uv,
            face,
            p: Default::default(),
            n: [0.0, 0.0, 1.0].into(),
            vertex_color: [1.0; 4],
            footprint,
        };
        textures[0].color(&cx, &at).rgb
    }
}

fn near(a: [f32; 3], b: [f32; 3], within: f32) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= within)
}

/// Whatever way texels are packed and stored they come back, in their order.
#[test]
fn all_ways_to_store_texels_are_read() {
    let value = |face: usize, x: usize, y: usize, c: usize| {
        [0.125, 0.25, 0.5, 0.75][(face + 3 * x + 5 * y + 7 * c + x * y) % 4]
    };
    for stored in [Stored::U8, Stored::U16, Stored::Half, Stored::Float] {
        for channels in 1..=4u16 {
            let ways = [
                Packed::Plain,
                Packed::Differences,
                Packed::Constant,
                Packed::Tiles([1, 2]),
                Packed::Tiles([0, 0]),
            ];
            let faces = ways.map(|packed| face([3, 2], ALONE, packed)).to_vec();
            let bytes = file(stored, channels, faces).bytes(value);
            let asked = Asked::of(&bytes, "\"string encoding\" \"linear\"");
            for number in 0..5 {
                for (x, y) in (0..4).flat_map(|y| (0..8).map(move |x| (x, y))) {
                    let [tx, ty] = if number == 2 { [0, 0] } else { [x, y] };
                    let uv = [(x as f32 + 0.5) / 8.0, (y as f32 + 0.5) / 4.0];
                    let gray = channels < 3;
                    let expected = [0, 1, 2].map(|c| value(number, tx, ty, if gray { 0 } else { c }));
                    let found = asked.at(number as u32, uv, 0.0);
                    assert!(near(found, expected, 2e-3), "{stored:?} {channels} {number} {x} {y} {found:?}");
                }
            }
        }
    }
}

/// Four faces of different orientation that tile a square: a function that is linear over all of it stays so across edges
/// and around the corner in the middle.
#[test]
fn lookups_are_seamless_across_edges_however_faces_are_turned() {
    for turns in [[0, 1, 2, 3], [2, 3, 0, 1], [0, 0, 0, 0], [3, 0, 2, 2], [1, 2, 1, 3]] {
        check_seams(turns);
    }
}

/// Each face covers a quarter of the square, turned so often.
fn check_seams(turns: [usize; 4]) {
    let origin = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]];
    // From face coordinates to the square.
    let place = |face: usize, [u, v]: [f32; 2]| {
        let [x, y] = (0..turns[face]).fold([u, v], |[u, v], _| [1.0 - v, u]);
        [0, 1].map(|i| origin[face][i] + [x, y][i])
    };
    // The edge whose middle lies at a place of a face.
    let edge_at = |face: usize, p: [f32; 2]| {
        let middles = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]].map(|uv| place(face, uv));
        middles.iter().position(|m| (m[0] - p[0]).abs() + (m[1] - p[1]).abs() < 1e-3)
    };
    let beside = |face: usize| {
        [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]].map(|uv| {
            let p = place(face, uv);
            let found = (0..4).filter(|other| *other != face).find_map(|o| Some((o, edge_at(o, p)?)));
            found.map(|(other, edge)| (other as u32, edge as u8))
        })
    };
    let linear = |[x, y]: [f32; 2]| 0.1 + 0.2 * x + 0.15 * y;
    let faces = (0..4).map(|number| face([3, 3], beside(number), Packed::Plain)).collect();
    let bytes = file(Stored::Float, 1, faces)
        .bytes(|f, x, y, _| linear(place(f, [(x as f32 + 0.5) / 8.0, (y as f32 + 0.5) / 8.0])));
    let asked = Asked::of(&bytes, "\"string encoding\" \"linear\"");
    let mut crossed = 0;
    for number in 0..4 {
        for i in 0..=32 * 32 {
            let uv = [(i % 33) as f32 / 32.0, (i / 33) as f32 / 32.0];
            let p = place(number, uv);
            // The square's own rim has nothing beyond it.
            if p.iter().any(|c| !(0.07..=1.93).contains(c)) {
                continue;
            }
            crossed += u32::from(p.iter().any(|c| (c - 1.0).abs() < 0.06));
            let found = asked.at(number as u32, uv, 0.0)[0];
            let expected = linear(p);
            assert!((found - expected).abs() < 1e-5, "{turns:?} {number} {uv:?}: {found} {expected}");
        }
    }
    assert!(crossed > 100);
}

/// Twice as many texels beside an edge: those of the smaller copy go on.
#[test]
fn beyond_an_edge_lie_texels_of_the_same_size() {
    let faces = vec![
        face([2, 2], [None, Some((1, 3)), None, None], Packed::Plain),
        face([3, 3], [None, None, None, Some((0, 1))], Packed::Plain),
    ];
    // The place along u over both.
    let bytes = file(Stored::Float, 1, faces)
        .bytes(|f, x, _, _| f as f32 + (x as f32 + 0.5) / if f == 0 { 4.0 } else { 8.0 });
    let asked = Asked::of(&bytes, "\"string encoding\" \"linear\"");
    for u in [0.9, 0.95, 1.0] {
        assert!((asked.at(0, [u, 0.4], 0.0)[0] - u).abs() < 1e-5, "{u}");
    }
}

#[test]
fn footprints_average_and_whole_faces_become_their_mean() {
    let value = |x: usize, y: usize| if (x + y).is_multiple_of(2) { 0.75 } else { 0.25 };
    let bytes =
        file(Stored::Float, 1, vec![face([4, 3], ALONE, Packed::Plain)]).bytes(|_, x, y, _| value(x, y));
    let asked = Asked::of(&bytes, "\"string encoding\" \"linear\"");
    assert!(near(asked.at(0, [0.5 / 16.0, 0.5 / 8.0], 0.0), [0.75; 3], 1e-6));
    for step in [0.25, 1.0, 9.0] {
        assert!(near(asked.at(0, [0.3, 0.6], step), [0.5; 3], 1e-6), "{step}");
    }
}

/// Triangles that point the other way are stored in the other half; each has its own value.
#[test]
fn triangles_have_texels_that_are_triangles() {
    let mut of = file(Stored::Float, 1, vec![face([2, 2], ALONE, Packed::Plain)]);
    of.is_triangles = true;
    let asked = Asked::of(&of.bytes(|_, x, y, _| (4 * y + x) as f32), "\"string encoding\" \"linear\"");
    let at = |u: f32, v: f32| asked.at(0, [u / 4.0, v / 4.0], 0.0)[0];
    // Of column i and row j: the lower one, then the upper one.
    assert_eq!((at(0.3, 0.3), at(0.7, 0.7)), (0.0, 15.0));
    assert_eq!((at(1.2, 2.3), at(1.8, 0.9)), (9.0, 11.0));
    assert_eq!((at(3.4, 0.3), at(0.1, 3.2)), (3.0, 12.0));
    // The mean of the sixteen.
    assert!((asked.at(0, [0.2, 0.2], 4.0)[0] - 7.5).abs() < 1e-5);
}

#[test]
fn encodings_and_scale_are_pbrts() {
    let bytes = file(Stored::U8, 3, vec![face([0, 0], ALONE, Packed::Constant)])
        .bytes(|_, _, _, c| [0.2, 0.6, 1.0][c]);
    let gamma = [0.2f64, 0.6, 1.0].map(|v| v.powf(2.2) as f32);
    assert!(near(Asked::of(&bytes, "").at(0, [0.5; 2], 0.0), gamma, 1e-5));
    let srgb = Asked::of(&bytes, "\"string encoding\" \"sRGB\" \"float scale\" 0.5").at(0, [0.5; 2], 0.0);
    assert!(near(srgb, [0.0331, 0.3186 * 0.5, 0.5], 2e-2) && (srgb[1] - 0.1593).abs() < 1e-3, "{srgb:?}");
    assert_eq!(Asked::of(&bytes, "").at(1, [0.5; 2], 0.0), [0.0; 3], "there is no such face");
}

/// Meshes in all the ways that pbrt has: each face has its own colour.
#[test]
fn shapes_tell_which_face_is_met() {
    let folder = tempfile::tempdir().expect("a folder");
    let faces = (0..4).map(|_| face([1, 1], ALONE, Packed::Plain)).collect();
    // Green grows with u, blue with v.
    let bytes = file(Stored::Float, 3, faces)
        .bytes(|f, x, y, c| [0.2 * (f + 1) as f32, 0.25 + 0.5 * x as f32, 0.25 + 0.5 * y as f32][c]);
    std::fs::write(folder.path().join("x.ptx"), bytes).expect("a file");
    let ply = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uchar int vertex_indices\nproperty int face_indices\nend_header\n\
        -1 -1 0\n0 -1 0\n1 -1 0\n-1 1 0\n0 1 0\n1 1 0\n4 0 1 4 3 3\n4 1 2 5 4 1\n";
    std::fs::write(folder.path().join("quads.ply"), ply).expect("a file");
    let patches = "Shape \"bilinearmesh\" \"integer faceIndices\" [3 1] \"integer indices\" [0 1 3 4 1 2 4 5] \
        \"point3 P\" [-1 -1 0 0 -1 0 1 -1 0 -1 1 0 0 1 0 1 1 0]";
    let triangles = "Shape \"trianglemesh\" \"integer faceIndices\" [3 3 1 1] \
        \"integer indices\" [0 1 2 0 2 3 4 5 6 4 6 7] \"point2 uv\" [0 0 1 0 1 1 0 1 0 0 1 0 1 1 0 1] \
        \"point3 P\" [-1 -1 0 0 -1 0 0 1 0 -1 1 0 0 -1 0 1 -1 0 1 1 0 0 1 0]";
    let shapes = [patches, triangles, "Shape \"plymesh\" \"string filename\" \"quads.ply\""];
    let moved = "AttributeBegin Scale 0.5 0.5 0.5 Scale 2 2 2\n";
    for shape in shapes {
        let text = format!(
            "LookAt 0 0 -5 0 0 0 0 1 0\nCamera \"orthographic\"\nIntegrator \"cast\" \"string show\" \"albedo\"\n\
             Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nOption \"bool disablepixeljitter\" true\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\nWorldBegin\n\
             Texture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"x.ptx\" \"string encoding\" \"linear\"\n\
             Material \"diffuse\" \"texture reflectance\" \"t\"\n{moved}{shape}\nAttributeEnd"
        );
        let scene = folder.path().join("scene.pbrt");
        std::fs::write(&scene, text).expect("a file");
        let seen = render(&prepared(durer::open(&scene.to_string_lossy()), &Options::default()));
        let pixels = seen.film.pixels();
        let reds = [8 * 4 + 1, 8 * 4 + 6].map(|pixel| (pixels[pixel].mean()[0] * 5.0).round());
        assert_eq!(reds, [4.0, 2.0], "{shape}");
        let rows: Vec<f32> = (0..8).map(|y| pixels[8 * y + 1].mean()[2]).collect();
        assert!(rows[0] > 0.74 && rows[7] < 0.26 && rows.is_sorted_by(|a, b| a >= b), "{shape}: {rows:?}");
    }
}

/// Whatever is cut off or changed: a message or a picture of bounded size, within reason.
#[test]
fn damaged_files_are_refused_or_read_without_harm() {
    let folder = tempfile::tempdir().expect("a folder");
    let faces = vec![
        face([2, 3], [Some((1, 2)), None, Some((7, 1)), None], Packed::Tiles([1, 1])),
        face([3, 3], [None, None, Some((0, 0)), None], Packed::Differences),
        face([0, 4], ALONE, Packed::Plain),
    ];
    let whole = file(Stored::U16, 3, faces).bytes(|f, x, y, c| ((f + x * y + c) % 5) as f32 / 5.0);
    let said = |bytes: &[u8]| {
        std::fs::write(folder.path().join("x.ptx"), bytes).expect("a file");
        assets(folder.path()).ptex("x.ptx").map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(said(&whole), Ok(()));
    for length in 0..whole.len() {
        assert!(said(&whole[..length]).is_err(), "{length}");
    }
    for at in 0..whole.len() {
        for change in [0xff, 0x80, 0x01] {
            let mut bytes = whole.clone();
            bytes[at] ^= change;
            let _ = said(&bytes);
        }
    }
    let with = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        said(&bytes).expect_err("damaged")
    };
    assert!(with(0, 1).contains("it does not begin with \"Ptex\""));
    assert!(with(4, 2).contains("version 2 of Ptex is not known"));
    assert!(with(20, 9).contains("it has 9 channels"));
    assert!(with(24, u32::MAX).contains("4294967295 faces cannot be stored in"));
    assert!(with(32, u32::MAX).contains("the file ends before the list of faces is whole"));
    // A short file of a face that takes 256 MiB.
    let bomb = file(Stored::Float, 4, vec![face([12, 12], ALONE, Packed::Plain)]).bytes(|_, _, _, _| 0.0);
    assert!(said(&bomb).expect_err("a bomb").contains("a damaged or hostile file"));
}

#[test]
fn edits_are_passed_over_with_a_warning_and_missing_files_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let edited = File { is_edited: true, ..file(Stored::U8, 1, vec![face([0, 0], ALONE, Packed::Constant)]) };
    std::fs::write(folder.path().join("x.ptx"), edited.bytes(|_, _, _, _| 1.0)).expect("a file");
    let told = |name: &str| {
        let text = format!(
            "WorldBegin\nTexture \"t\" \"float\" \"ptex\" \"string filename\" \"{name}\"\nShape \"sphere\"\n"
        );
        let scene = folder.path().join("scene.pbrt");
        std::fs::write(&scene, text).expect("a file");
        let mut imported = durer::open(&scene.to_string_lossy());
        durer::prepare(&mut imported, &Options::default());
        imported.diagnostics.iter().map(|d| d.message.clone() + "\n").collect::<String>()
    };
    assert!(told("x.ptx").contains("what was edited later in this file is passed over"), "{}", told("x.ptx"));
    assert!(told("y.ptx").contains("y.ptx: file not found"), "{}", told("y.ptx"));
}
