//! Image files in: the PngSuite, JPEG and OpenEXR conformance files, and damaged ones.
mod assets_shared;

use assets_shared::{files, folder};
use base64::{Engine, engine::general_purpose::STANDARD};
use durer_io::image::read;
use durer_scene::{AssetError, Image, ImageData, Limits};
use std::path::Path;

fn load(path: &Path) -> Result<Image, AssetError> {
    let bytes = std::fs::read(path).expect("file of the corpus");
    let name = path.file_name().expect("name").to_string_lossy().into_owned();
    let image = read(&bytes, &name, Limits::default())?;
    let values = match &image.data {
        ImageData::U8(v) => v.len(),
        ImageData::U16(v) => v.len(),
        ImageData::F32(v) => v.len(),
    };
    assert_eq!(values as u64, u64::from(image.width) * u64::from(image.height) * u64::from(image.channels));
    Ok(image)
}

/// Channels and bits that a PngSuite name such as `basn3p04` promises.
fn promised(name: &str) -> Option<(u32, bool)> {
    let tail = name.strip_suffix(".png")?.get(name.len() - 8..)?;
    let channels = match tail.get(..2)? {
        "0g" => 1,
        "2c" | "3p" => 3,
        "4a" => 2,
        "6a" => 4,
        _ => return None,
    };
    Some((channels, tail.ends_with("16")))
}

#[test]
fn every_png_of_the_suite_has_the_promised_channels_and_depth() {
    let Some(folder) = folder("images/png/pngsuite") else {
        return;
    };
    let all = files(&folder);
    for path in &all {
        let name = path.file_name().expect("name").to_string_lossy().into_owned();
        let image = load(path).unwrap_or_else(|e| panic!("{e}"));
        let (channels, deep) = promised(&name).unwrap_or_else(|| panic!("{name}: no promise"));
        assert_eq!(matches!(image.data, ImageData::U16(_)), deep, "{name}");
        let transparent = name.contains("_tb") || name.contains("_tm3") || name.contains("_tp1");
        assert_eq!(image.channels, channels + u32::from(transparent), "{name}");
        let size = name.split_once("_s").and_then(|(_, n)| n.get(..2)?.parse().ok()).unwrap_or(32);
        assert!((image.width, image.height) == (size, size) || !name.contains("_s"), "{name}");
    }
    assert!(all.len() > 100);
}

#[test]
fn interlaced_pngs_equal_their_plain_twins() {
    let Some(folder) = folder("images/png/pngsuite") else {
        return;
    };
    for (a, b) in [
        ("primary_basi0g01", "primary_basn0g01"),
        ("primary_basi2c08", "primary_basn2c08"),
        ("primary_basi3p04", "primary_basn3p04"),
        ("16bit_basi2c16", "16bit_basn2c16"),
        ("primary_s35i3p04", "primary_s35n3p04"),
    ] {
        let image = |name: &str| load(&folder.join(format!("{name}.png"))).expect("valid");
        assert_eq!(image(a), image(b), "{a} {b}");
    }
}

#[test]
fn jpegs_of_all_codings_are_read() {
    let Some(folder) = folder("images/jpg") else {
        return;
    };
    for path in files(&folder) {
        let image = load(&path).unwrap_or_else(|e| panic!("{e}"));
        println!("{}: {} x {} x {}", path.display(), image.width, image.height, image.channels);
        assert!(image.width > 1 && image.channels == 3);
        let ImageData::U8(v) = &image.data else { panic!("8 bits") };
        assert!(v.iter().any(|&x| x != v[0]), "{}: one colour only", path.display());
    }
}

#[test]
fn conforming_exrs_are_read_or_refused_by_name() {
    let Some(folder) = folder("images/exr") else {
        return;
    };
    for path in files(&folder) {
        match load(&path) {
            Ok(i) => println!("{}: {} x {} x {}", path.display(), i.width, i.height, i.channels),
            Err(AssetError::Unsupported { reason, .. }) => {
                println!("{}: {reason}", path.display());
                let subsampled = path.ends_with("Rec709_YC.exr") || path.ends_with("comp_b44.exr");
                assert!(subsampled && reason.contains("subsampled"), "{reason}");
            }
            Err(e) => panic!("{e}"),
        }
    }
    let image = load(&folder.join("BrightRingsNanInf.exr")).expect("valid");
    let ImageData::F32(v) = &image.data else { panic!("floats") };
    assert!(v.iter().any(|x| x.is_nan()) && v.iter().any(|x| x.is_infinite()));
}

#[test]
fn damaged_images_give_an_error_or_an_image_but_no_panic() {
    for name in ["malformed/images", "malformed/exr"] {
        let Some(folder) = folder(name) else { return };
        let started = std::time::Instant::now();
        let (mut good, mut bad) = (0, 0);
        for path in files(&folder) {
            let before = std::time::Instant::now();
            match load(&path) {
                Ok(image) => {
                    good += 1;
                    println!("read {}: {} x {}", path.display(), image.width, image.height);
                }
                Err(_) => bad += 1,
            }
            assert!(before.elapsed().as_secs() < 20, "{} takes too long", path.display());
        }
        println!("{name}: {good} read, {bad} refused in {:?}", started.elapsed());
        assert!(bad > good);
    }
}

#[test]
fn corrupt_pngs_are_refused() {
    let Some(folder) = folder("malformed/images") else {
        return;
    };
    for path in files(&folder).iter().filter(|p| p.extension().is_some_and(|e| e == "png")) {
        let error = load(path).expect_err("a damaged file");
        assert!(matches!(error, AssetError::Format { .. }), "{error}");
    }
}

/// Flips bytes and cuts ends of valid files: decoders of hostile data must not panic.
#[test]
fn mutilated_images_never_panic() {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below
    };
    let limits = Limits { image_pixels: 1 << 20, ..Limits::default() };
    for name in ["images/png", "images/jpg", "images/exr", "images/hdr", "images/bmp", "images/tga"] {
        let Some(folder) = folder(name) else { return };
        for path in files(&folder) {
            let original = std::fs::read(&path).expect("file of the corpus");
            for _ in 0..if original.len() < 20_000 { 60 } else { 6 } {
                let mut bytes = original.clone();
                let reach = if random(2) == 0 { bytes.len() } else { bytes.len().min(600) };
                for _ in 0..1 + random(4) {
                    bytes[random(reach)] = random(256) as u8;
                }
                if random(4) == 0 {
                    bytes.truncate(random(original.len()));
                }
                let name = if name.ends_with("tga") { "mutilated.tga" } else { "mutilated" };
                let _ = read(&bytes, name, limits);
            }
        }
    }
}

/// 2 x 2 pixels without loss, made by ffmpeg's libwebp.
const WEBP: &str =
    "UklGRjwAAABXRUJQVlA4TC8AAAAvAUAAEB8gEEiS2B91DSEBQfX/L4EAwYj/SwIBwroHvwJvWayCkgABUJSRiP4HAwA=";

#[test]
fn webp_files_are_read() {
    let bytes = STANDARD.decode(WEBP).expect("base64");
    let image = read(&bytes, "a.webp", Limits::default()).expect("a sound picture");
    assert_eq!((image.width, image.height, image.channels), (2, 2, 4));
    let pixels = [255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255, 10, 20, 30, 20];
    assert_eq!(image.data, ImageData::U8(pixels.to_vec()));
    for place in 0..bytes.len() {
        // An error or another picture, but no panic.
        let _ = read(&bytes[..place], "a.webp", Limits::default());
        for bit in 0..8 {
            let mut bytes = bytes.clone();
            bytes[place] ^= 1 << bit;
            let _ = read(&bytes, "a.webp", Limits { image_pixels: 1 << 16, ..Limits::default() });
        }
    }
}

/// 22 x 17 pixels (20 + 10 x, 8 + 14 y, 60 or, right of x = 10, 200), packed as ETC1S by Basis Universal 1.16.4.
const ETC1S: &str = "q0tUWCAyMLsNChoKAAAAAAEAAAAWAAAAEQAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAACwAAACUAAAAJAAAALgAAAAAAAAA5gAAAAAAAACeAQAAAAAAABQAAAAAAAAAAAAAAAAAAAAsAAAAAAAAAAIAKACjAQIAAwMAAAAAAAAAAAAAAAA/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDEuMTYAAB4AEQBXAAAAMwAAADQAAAAAAAAAAAAAAAAAAAAUAAAAAAAAAAAAAAAHwBQAAAAAQBBkg0CAKAACAADCsAk/ljcFoyDA5AABAAZhAHhSC/llBBGAKQAAAACCMGwYvO0ca08qHBt5ob2kD8GHdKG9pA/DQrpoH+nCWMoWnfG+MB6IB+YEEMAwCADA5+jIUCkI6ICEOKq1mIiPAFSp/g9sXkOz7gRJgGd8S4CxOfzd3VVVmZkBwUQAAAAAAADyX40AMAEAAAAAAIAgBbwNFABgEEgecTNkgxSChTiDA8AEgAAAAAAAQiAAxHk5l/Xv0/EN0eW9+S2meMp11xc=";
/// 16 x 16 pixels (240 - 8 x, 30 + 6 y, 120, 255 - 12 x), packed as UASTC and by Zstandard.
const UASTC: &str = "q0tUWCAyMLsNChoKAAAAAAEAAAAQAAAAEAAAAAAAAAAAAAAAAQAAAAEAAAACAAAAaAAAACwAAACUAAAAJAAAAAAAAAAAAAAAAAAAAAAAAAC4AAAAAAAAAI0AAAAAAAAAAAEAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAAAAAAAAAAAAAAAB/AwAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDEuMTYAACi1L/1gAAAdBADEBQBQiUpNkblHETJUdpi63P5dkrnfEgCJam6TubcTUIlqvpO5OxIJT00ZuhhQCU9dGroYAAlvbhu6GFAJb74buslMTSG7XSK7yWxuI7vJbL4juxCxu12yELO7ELO7FSiQ4wIPEFAhuR0QlrdBQAxEIZT5Yd8Az0IzGGUG9HhzVxvwlw==";

fn eight_bits(text: &str, name: &str) -> (u32, u32, usize, Vec<u8>) {
    let bytes = STANDARD.decode(text).expect("base64");
    let image = read(&bytes, name, Limits::default()).expect("a sound picture");
    let ImageData::U8(pixels) = image.data else { panic!("eight bits a channel") };
    (image.width, image.height, image.channels as usize, pixels)
}

#[test]
fn pictures_packed_for_graphics_cards_are_read() {
    let (width, height, channels, pixels) = eight_bits(ETC1S, "a.ktx2");
    assert_eq!((width, height, channels), (22, 17, 3));
    let at = |x: usize, y: usize| &pixels[3 * (x + 22 * y)..][..3];
    // What the encoder's own transcoder gives.
    assert_eq!(at(0, 0), [16, 7, 40]);
    assert_eq!(at(21, 0), [214, 16, 181]);
    assert_eq!(at(5, 9), [69, 135, 52]);
    assert_eq!(at(21, 16), [224, 233, 200]);
    assert_eq!(at(11, 3), [152, 62, 128]);
    assert_eq!(pixels.iter().map(|v| u32::from(*v)).sum::<u32>(), 139630);
    let (width, height, channels, pixels) = eight_bits(UASTC, "a.ktx2");
    assert_eq!((width, height, channels), (16, 16, 4));
    for (i, pixel) in (0..).zip(pixels.chunks(4)) {
        let (x, y) = (i % 16, i / 16);
        let expected = [240 - 8 * x, 30 + 6 * y, 120, 255 - 12 * x];
        let off = pixel.iter().zip(expected).map(|(a, b)| (i32::from(*a) - b).abs()).max();
        assert!(off <= Some(4), "{x} {y}: {pixel:?} {expected:?}");
    }
}

#[test]
fn damaged_packed_pictures_are_refused_or_other_pictures() {
    let limits = Limits { image_pixels: 1 << 16, ..Limits::default() };
    for text in [ETC1S, UASTC] {
        let bytes = STANDARD.decode(text).expect("base64");
        for place in 0..bytes.len() {
            assert!(read(&bytes[..place], "a.ktx2", limits).is_err(), "{place}");
            for bit in 0..8 {
                let mut bytes = bytes.clone();
                bytes[place] ^= 1 << bit;
                let _ = read(&bytes, "a.ktx2", limits);
            }
        }
    }
    // Found by fuzzing: a level whose end is beyond all numbers; and what levels share.
    for (text, length) in [(UASTC, 88), (ETC1S, 72)] {
        let mut bytes = STANDARD.decode(text).expect("base64");
        bytes[length..length + 8].fill(0xff);
        let error = read(&bytes, "a.ktx2", limits).expect_err("damaged").to_string();
        assert!(error.contains("damaged KTX 2 file"), "{error}");
    }
    let mut bytes = STANDARD.decode(ETC1S).expect("base64");
    bytes[36] = 6;
    let error = read(&bytes, "a.ktx2", Limits::default()).expect_err("a cube").to_string();
    assert!(error.contains("more than one picture"), "{error}");
}

/// On these the decoder of Basis Universal panics, as fuzzing found.
const PANICS: [&str; 2] = [
    "q0tUWCAyMLsNChoKAAAAAAEAAAAQAAAAEAAAAAAAAAAAAAAAAQAAAAEAAAACAAAAaAAAACwAAACUAAAAIwAAAAAAAAAAAAAAAAAAAAAAAAC4AAAAAAAAAI0AAAAAAAAAAAEAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAAAAAAAAAAAAAAAB/AwAAAAAAAAAABwD//x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDEuMX4AACi1L/1gAAAdBADEBQBQiQAAAAAAfwMAAAAA/wADAwAAAAAAAAAAAAAAAD8AAAAAAAAAAAD/////HwAAAEtUWHeOlouajf+9nnNpcyBVbml2ZXJzYWwgMC4xNgAAHgARAFcAAgAoAKYBAgADAwAAAAAAAAAALgAAABQAAAAAAAAAAAAAAAfAzzMYZQb0eHNXGwuX",
    "q0tUWCAyMLsNChoKAAAAAAEAAAAWBgAAEQAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAACwAAACUAAAAJAAAALgAAAAAAAAA5gAAAAAAAACeAQAAAAAAABQAAAAAAAAAAAAAAAAAAAAsAAAAAAAAAAIAKACjAQIAAwMAAAAAAAAAAAAAAAA/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDAuMTYAAB4AEQBXAAAAMwAAADQAAAAAAAAAAAAAgAAAAAAUAAAAAAAAAAAAAAAHwBQAAAAAQBBkg0CAKAACAADCsAk/ljcFoyDA5AABAAZhAHhSC/llBBGAKQAAAACCMGwYvO0ca08qHBt5ob2kD8GHdKG9pA/DQrpoH+nCWMoWnfG+MB6IB+YEEMAwCADA5+jIUCkI6ICEOKq1mIiPAFSp/g9sXkOz7gRJgGd8S4CxOfzd3VVVmZkBwUQAAAAAAADyX41AMAEAAAAAgAAgBbwNFABgEEgecTNkgxSChTiDA8AEgAAAAAAAQiAAxHml/////////wAOIy2meMp11xc=",
];

#[test]
fn a_decoder_that_panics_ends_with_a_message() {
    for text in PANICS {
        let bytes = STANDARD.decode(text).expect("base64");
        let error = read(&bytes, "a.ktx2", Limits::default()).expect_err("damaged").to_string();
        assert!(error.contains("damaged KTX 2 file"), "{error}");
    }
}

#[test]
fn other_formats_are_refused_by_name() {
    let cases: [(&[u8], &str, &str); 4] = [
        (b"GIF89a\0\0\0", "a.gif", "GIF"),
        (b"\xabKTX 11\xbb\r\n\x1a\n", "a.ktx", "KTX"),
        (b"DDS \0\0", "a.dds", "DDS"),
        (b"hello", "a.txt", "not an image of a known format"),
    ];
    for (bytes, name, word) in cases {
        let error = read(bytes, name, Limits::default()).expect_err("unsupported");
        let text = error.to_string();
        assert!(matches!(error, AssetError::Unsupported { .. }), "{text}");
        assert!(text.starts_with(name) && text.contains(word) && text.contains("OpenEXR"), "{text}");
    }
}

#[test]
fn image_limits_hold_before_decoding() {
    let Some(folder) = folder("images/png/pngsuite") else {
        return;
    };
    let bytes = std::fs::read(folder.join("primary_basn2c08.png")).expect("file of the corpus");
    let limits = |image_pixels| Limits { image_pixels, ..Limits::default() };
    assert!(read(&bytes, "a", limits(32 * 32)).is_ok());
    assert!(matches!(read(&bytes, "a", limits(32 * 32 - 1)), Err(AssetError::Limits { .. })));
}
