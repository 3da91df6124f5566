//! What is said about damaged pictures: our own sentences, for people who paint.
mod assets_shared;

use assets_shared::{files, folder};
use durer_io::image::read;
use durer_scene::{AssetError, Limits};

/// Traces of libraries, of Rust and of debugging in texts for people.
const FOREIGN: [&str; 20] = [
    "{ ",
    "ChunkType",
    "Some(",
    "Err(",
    "invalid:",
    "Invalid",
    "IoError",
    "while decoding",
    "Format error",
    "fill whole buffer",
    "expected 0x",
    "soft limit",
    "not supported:",
    "Error",
    "error ",
    "Reason",
    "chunk",
    "`",
    "The ",
    "  ",
];

/// Complains about a message that did not come from us or cannot be continued.
fn check(error: &AssetError, name: &str) {
    let said = error.to_string();
    let reason = said.strip_prefix(name).and_then(|s| s.strip_prefix(": "));
    let reason = reason.unwrap_or_else(|| panic!("begins with the file: {said}"));
    let found = FOREIGN.iter().find(|f| reason.contains(**f));
    assert!(found.is_none(), "{found:?}: {said}");
    assert!(!reason.ends_with(['.', '\n', ' ']) && !reason.contains(".;"), "more may follow: {said}");
    assert!(reason.chars().count() < 160, "one line: {said}");
    assert_eq!(reason.matches("damaged").count().max(1), 1, "said once: {said}");
}

fn said(bytes: &[u8], name: &str) -> String {
    let error = read(bytes, name, Limits::default()).expect_err(name);
    check(&error, name);
    error.to_string()
}

#[test]
fn every_picture_of_the_corpus_is_refused_in_our_own_words() {
    let mut refused = 0;
    for name in ["images", "malformed/images", "malformed/exr"] {
        let Some(folder) = folder(name) else { return };
        for path in files(&folder) {
            let bytes = std::fs::read(&path).expect("file of the corpus");
            let name = path.file_name().expect("name").to_string_lossy().into_owned();
            if let Err(error) = read(&bytes, &name, Limits::default()) {
                println!("{error}");
                check(&error, &name);
                refused += 1;
            }
        }
    }
    assert!(refused > 150, "{refused}");
}

#[test]
fn whatever_breaks_in_a_picture_is_told_in_our_own_words() {
    let mut state = 7u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below
    };
    let limits = Limits { image_pixels: 1 << 20, ..Limits::default() };
    let mut refused = 0;
    for kind in ["png", "jpg", "exr", "hdr", "bmp", "tga"] {
        let Some(folder) = folder(&format!("images/{kind}")) else { return };
        for path in files(&folder) {
            let original = std::fs::read(&path).expect("file of the corpus");
            if original.len() > 200_000 {
                continue;
            }
            for _ in 0..24 {
                let mut bytes = original.clone();
                let reach = bytes.len().min([40, 600, usize::MAX][random(3)]);
                for _ in 0..1 + random(3) {
                    bytes[random(reach)] = random(256) as u8;
                }
                bytes.truncate(if random(3) == 0 { random(original.len()) } else { original.len() });
                let name = format!("mutilated.{kind}");
                if let Err(error) = read(&bytes, &name, limits) {
                    check(&error, &name);
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

#[test]
fn a_suffix_that_the_first_bytes_belie_is_told() {
    for (name, format) in [("a.PNG", "PNG"), ("a.jpeg", "JPEG"), ("a.exr", "OpenEXR"), ("a.bmp", "BMP")] {
        let said = said(b"<!DOCTYPE html>", name);
        let begin =
            format!("{name}: the name says {format}, but it does not begin like one; damaged on the way");
        assert!(said.starts_with(&begin), "{said}");
        assert_eq!(self::said(b"", name), format!("{name}: the file is empty"));
    }
}

/// The files of the corpus that a newcomer asked about.
#[test]
fn broken_pictures_are_told_with_numbers_and_what_to_do() {
    let again = "; copy or export the picture again";
    let Some(folder) = folder("malformed/images") else { return };
    for (file, reason) in [
        ("xcsn0g01.png", format!("damaged PNG: a checksum does not match{again}")),
        ("xdtn0g01.png", format!("damaged PNG: it holds no pixels{again}")),
        (
            "xc9n2c08.png",
            format!("damaged PNG: its header says colour type 9, expected 0, 2, 3, 4 or 6{again}"),
        ),
        (
            "xd9n2c08.png",
            format!("damaged PNG: its header says 99 bits per channel, expected 1, 2, 4, 8 or 16{again}"),
        ),
        ("flip-zero-height.tga", format!("its header says 103 x 0 pixels, which is no picture{again}")),
        (
            "Bad_height.bmp",
            "6 x 2147483647 pixels; durer reads at most 268435456 in all (damaged header?)".to_owned(),
        ),
        (
            "Bad_shortfile.bmp",
            "damaged Windows bitmap (BMP): the file ends too early; copy it again".to_owned(),
        ),
    ] {
        let bytes = std::fs::read(folder.join(file)).expect("file of the corpus");
        assert_eq!(said(&bytes, file), format!("{file}: {reason}"));
    }
}

#[test]
fn bitmaps_that_are_too_wide_or_negative_are_told_with_their_size() {
    let file = |width: i32, height: i32, bits: u16| {
        let mut file = b"BM".to_vec();
        file.extend([0u8; 8]);
        file.extend(54u32.to_le_bytes());
        file.extend(40u32.to_le_bytes());
        file.extend(width.to_le_bytes());
        file.extend(height.to_le_bytes());
        file.extend([1, 0]);
        file.extend(bits.to_le_bytes());
        file.extend([0; 24]);
        file
    };
    let header = |width, height, bits| said(&file(width, height, bits), "a.bmp");
    assert!(header(70_000, 2, 24).contains("70000 x 2 pixels, at most 65535 along an edge"));
    assert!(header(-3, 2, 24).contains("its header says -3 x 2 pixels"));
    assert!(header(0, i32::MIN, 24).contains("0 x 2147483648 pixels"));
    assert!(header(4, 4, 7).contains("7 bits per pixel"));
    assert!(header(4, -4, 24).contains("ends too early"));
    let mut strange = file(4, 4, 24);
    strange[14] = 99;
    let unread =
        "a.bmp: a Windows bitmap (BMP) of a rare kind, which durer does not read; export it as EXR or PNG";
    assert_eq!(said(&strange, "a.bmp"), unread);
}

/// A palette is a row of 3 bytes per colour, 256 colours at most; the `png` crate panics at others.
#[test]
fn a_palette_that_is_no_row_of_colours_is_damage() {
    let indexed = |palette: usize| {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, 1, 1);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(vec![255; palette]);
        let mut writer = encoder.write_header().expect("header");
        writer.write_image_data(&[0]).expect("one pixel");
        drop(writer);
        file
    };
    read(&indexed(768), "a.png", Limits::default()).expect("256 colours");
    let whole =
        "a.png: damaged PNG: its palette is no row of whole colours; copy or export the picture again";
    assert_eq!(said(&indexed(719), "a.png"), whole);
    said(&indexed(771), "a.png");
}
