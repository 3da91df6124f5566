//! Small files that ask for much: what multiplies, and pictures that their headers say are huge. Each is refused with a message
//! before it takes time or memory. (What damages files do is in `malformed.rs`; what fuzzing found is beside the readers.)
use std::{
    fmt::Write,
    fs,
    time::{Duration, Instant},
};

use durer::{Imported, Options, image, prepare, scene::Limits};
use durer_tests::import;

/// The program itself has 10 s; what is not optimised, on a machine that does other things, takes longer. What multiplies takes
/// for ever.
const PATIENCE: Duration = Duration::from_secs(60);

/// All that is said, one to a line.
fn said(imported: &Imported) -> String {
    imported.diagnostics.iter().fold(String::new(), |all, d| all + &d.message + "\n")
}

/// What is said of a scene in Mitsuba's language.
fn mitsuba(inside: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.xml");
    fs::write(&file, format!("<scene version=\"3.0.0\">\n{inside}</scene>\n")).expect("a file");
    let mut imported = durer::open(&file.to_string_lossy());
    prepare(&mut imported, &Options::default());
    said(&imported)
}

/// Refused in time, with these words.
fn refused(what: &str, words: &str, read: impl FnOnce() -> String) {
    let start = Instant::now();
    let said = read();
    assert!(said.contains(words), "{what}: {said}");
    assert!(start.elapsed() < PATIENCE, "{what} took {:?}", start.elapsed());
}

/// Each of forty things is made of the one before it, twice.
fn doubled(first: &str, next: impl Fn(usize) -> String) -> String {
    (1..40).fold(first.to_owned(), |mut text, i| {
        writeln!(text, "{}", next(i)).expect("text");
        text
    })
}

#[test]
fn groups_in_groups_do_not_multiply_without_end() {
    let instance = |i: usize| format!("<shape type=\"instance\"><ref id=\"g{i}\"/></shape>");
    let group = |i: usize| {
        let inner = instance(i - 1).repeat(2);
        format!("<shape type=\"shapegroup\" id=\"g{i}\">{inner}</shape>")
    };
    let first = "<shape type=\"shapegroup\" id=\"g0\"><shape type=\"sphere\"/></shape>\n";
    let text = doubled(first, group) + &instance(39);
    refused("groups", "more than 1048576 objects", || mitsuba(&text));
}

#[test]
fn materials_in_materials_do_not_multiply_without_end() {
    let blend = |i: usize| {
        let inner = format!("<ref id=\"m{}\"/>", i - 1).repeat(2);
        format!("<bsdf type=\"blendbsdf\" id=\"m{i}\"><float name=\"weight\" value=\"0.5\"/>{inner}</bsdf>")
    };
    let text = doubled("<bsdf type=\"diffuse\" id=\"m0\"/>\n", blend);
    let text = text + "<shape type=\"sphere\"><ref id=\"m39\"/></shape>";
    refused("materials", "more than 1048576 objects", || mitsuba(&text));
}

#[test]
fn textures_in_textures_do_not_multiply_without_end() {
    let mix = |i: usize| {
        let below = i - 1;
        format!(
            "Texture \"t{i}\" \"spectrum\" \"mix\" \"texture tex1\" \"t{below}\" \"texture tex2\" \"t{below}\""
        )
    };
    let first = "WorldBegin\nTexture \"t0\" \"spectrum\" \"constant\" \"rgb value\" [0.5 0.5 0.5]\n";
    let used =
        |last: usize| format!("Material \"diffuse\" \"texture reflectance\" \"t{last}\"\nShape \"sphere\"\n");
    let prepared = |text: &str| {
        let mut imported = import(text);
        prepare(&mut imported, &Options::default());
        said(&imported)
    };
    let text = doubled(first, mix);
    refused("textures", "texture \"t12\" asks more than 4096 others", || prepared(&(text + &used(39))));
    let ten: String = (1..=10).fold(first.to_owned(), |text, i| text + &mix(i) + "\n");
    let said = prepared(&(ten + &used(10)));
    assert!(!said.contains("asks"), "{said}");
}

/// An OpenEXR header of three channels, without pixels.
fn exr(window: [i32; 4]) -> Vec<u8> {
    let mut channels = Vec::new();
    for name in [b'B', b'G', b'R'] {
        channels.extend([name, 0]);
        channels.extend([1, 0, 1, 1].map(i32::to_le_bytes).concat());
    }
    channels.push(0);
    let window = window.map(i32::to_le_bytes).concat();
    let mut file = [20_000_630u32, 2].map(u32::to_le_bytes).concat();
    for (name, kind, value) in [
        ("channels", "chlist", &channels[..]),
        ("compression", "compression", &[3]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[0]),
        ("pixelAspectRatio", "float", &1f32.to_le_bytes()),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &1f32.to_le_bytes()),
    ] {
        let head = format!("{name}\0{kind}\0");
        file.extend([head.as_bytes(), &(value.len() as u32).to_le_bytes(), value].concat());
    }
    file.push(0);
    file
}

#[test]
fn headers_of_huge_pictures_are_not_believed() {
    // The check sum of the header is right.
    let png = |edge: [u8; 8], sum: [u8; 4]| {
        [&b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"[..], &edge, &[8, 2, 0, 0, 0], &sum].concat()
    };
    let bmp = [
        &b"BM"[..],
        &[0, 0, 54].map(u32::to_le_bytes).concat(),
        &[40i32, 60_000, 60_000].map(i32::to_le_bytes).concat(),
        &[1, 0, 24, 0],
        &[0; 24],
    ];
    let tga =
        [&[0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x60, 0xea, 0x60, 0xea, 24, 0][..], b"TRUEVISION-XFILE.\0"];
    let webp =
        [&b"RIFF\x1e\0\0\0WEBPVP8L\x0a\0\0\0\x2f"[..], &(16_382u32 | 16_382 << 14).to_le_bytes(), &[0; 5]];
    let bombs: [(&str, Vec<u8>); 9] = [
        ("a.png", png([0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60], [0x0f, 0xb0, 0xe2, 0x15])),
        ("b.png", png([0, 0, 0x27, 0x10, 0, 0, 0x27, 0x10], [0x35, 0x2c, 0xf5, 0x70])),
        (
            "a.jpg",
            b"\xff\xd8\xff\xc0\0\x11\x08\xea\x60\xea\x60\x03\x01\x22\0\x02\x11\x01\x03\x11\x01".to_vec(),
        ),
        ("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n".to_vec()),
        ("a.pfm", b"PF\n60000 60000\n-1.0\n".to_vec()),
        ("a.bmp", bmp.concat()),
        ("a.tga", tga.concat()),
        ("a.webp", webp.concat()),
        ("a.exr", exr([0, 0, 59_999, 59_999])),
    ];
    for (name, bytes) in bombs {
        let read = || match image::read(&bytes, name, Limits::default()) {
            Ok(image) => format!("{} x {}", image.width, image.height),
            Err(error) => format!("refused: {error}"),
        };
        refused(name, "refused: ", read);
    }
    let everywhere = exr([i32::MIN, i32::MIN, i32::MAX, i32::MAX]);
    assert!(image::read(&everywhere, "b.exr", Limits::default()).is_err());
}
