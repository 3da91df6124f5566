//! Radiance HDR, Windows bitmaps, Targa and portable float maps in: real files and files written by hand.
mod assets_shared;

use std::path::Path;

use assets_shared::{files, folder};
use durer_io::image::{ExrPicture, NamedChannel, read, write_exr};
use durer_scene::{AssetError, Image, ImageData, Limits};

fn load(path: &Path) -> Result<Image, AssetError> {
    let bytes = std::fs::read(path).expect("file of the corpus");
    read(&bytes, &path.file_name().expect("name").to_string_lossy(), Limits::default())
}

fn floats(image: &Image) -> &[f32] {
    match &image.data {
        ImageData::F32(v) => v,
        other => panic!("expected floats, not {other:?}"),
    }
}

fn bytes(image: &Image) -> &[u8] {
    match &image.data {
        ImageData::U8(v) => v,
        other => panic!("expected bytes, not {other:?}"),
    }
}

fn radiance(header: &str, pixels: &[u8]) -> Result<Image, AssetError> {
    let mut file = header.as_bytes().to_vec();
    file.extend(pixels);
    read(&file, "a.hdr", Limits::default())
}

#[test]
fn plain_and_run_length_radiance_pixels_are_read_alike() {
    // (mantissa / 256) 2^(exponent - 128); (128, 64, 32) with exponent 129 is (1, 0.5, 0.25).
    let pixel = [128, 64, 32, 129];
    let expected: Vec<f32> = [1.0, 0.5, 0.25].repeat(8);
    let header = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    let plain = radiance(header, &pixel.repeat(8));
    let old = radiance(header, &[128, 64, 32, 129, 1, 1, 1, 7]);
    let new = radiance(header, &[2, 2, 0, 8, 136, 128, 136, 64, 136, 32, 136, 129]);
    let other_signature = radiance(&header.replace("RADIANCE", "RGBE"), &pixel.repeat(8));
    for image in [plain, old, new, other_signature] {
        let image = image.expect("a sound file");
        assert_eq!((image.width, image.height, image.channels), (8, 1, 3));
        assert_eq!(floats(&image), expected);
    }
}

#[test]
fn damaged_radiance_files_are_refused_with_a_reason() {
    let header = |format: &str, size: &str| format!("#?RADIANCE\nFORMAT=32-bit_rle_{format}\n\n{size}\n");
    for (header, word) in [
        (header("rgbe", "-Y 1 +X 8"), "damaged Radiance HDR file: the file ends too early"),
        (header("xyze", "-Y 1 +X 1"), "does not read"),
        (header("rgbe", "+X 1 -Y 1"), "sideways"),
        (header("rgbe", "-Y 60000 +X 4000"), "cannot be stored"),
        (header("rgbe", "-Y 90000 +X 90000"), "at most 268435456 in all"),
        (header("rgbe", "-Y 0 +X 0"), "0 x 0 pixels"),
        ("#?RADIANCE\n".to_owned(), "damaged Radiance"),
    ] {
        let said = radiance(&header, &[1, 2, 3, 4]).expect_err(&header).to_string();
        assert!(said.starts_with("a.hdr: ") && said.contains(word), "{header}: {said}");
    }
}

#[test]
fn radiance_files_of_the_corpus_have_the_brightness_they_are_known_for() {
    let Some(env) = folder("env") else { return };
    // As the list of the corpus says.
    for (name, brightest) in
        [("venice_sunset_1k.hdr", 9.7), ("studio_small_03_1k.hdr", 3568.0), ("noon_grass_1k.hdr", 64256.0)]
    {
        let image = load(&env.join(name)).unwrap_or_else(|e| panic!("{e}"));
        let most = floats(&image).iter().fold(0.0f32, |a, b| a.max(*b));
        assert_eq!((image.width, image.height, image.channels), (1024, 512, 3), "{name}");
        assert!((most / brightest - 1.0).abs() < 0.01, "{name}: {most}");
    }
    for path in files(&folder("images/hdr").expect("beside the other")) {
        let image = load(&path).unwrap_or_else(|e| panic!("{e}"));
        let v = floats(&image);
        assert!(v.iter().all(|x| x.is_finite()) && v.iter().any(|x| *x != v[0]), "{}", path.display());
    }
}

#[test]
fn bitmaps_with_and_without_run_lengths_show_the_same_picture() {
    let Some(folder) = folder("images/bmp") else { return };
    let image = |name: &str| load(&folder.join(name)).unwrap_or_else(|e| panic!("{e}"));
    let (packed, plain) = (image("pal8rle.bmp"), image("rgb24.bmp"));
    assert_eq!((packed.width, packed.height, packed.channels), (127, 64, 3));
    assert_eq!((plain.width, plain.height, plain.channels), (127, 64, 3));
    // The palette has 252 colours: six levels of red and blue, seven of green.
    let differences = bytes(&packed).iter().zip(bytes(&plain)).map(|(a, b)| u32::from(a.abs_diff(*b)));
    let mean = f64::from(differences.sum::<u32>()) / bytes(&plain).len() as f64;
    assert!(mean < 20.0, "{mean}");
}

#[test]
fn targa_files_are_read_by_name_or_by_their_last_bytes() {
    let Some(folder) = folder("images/tga") else { return };
    for path in files(&folder) {
        let image = load(&path).unwrap_or_else(|e| panic!("{e}"));
        let v = bytes(&image);
        assert!(v.iter().any(|x| *x != v[0]), "{}", path.display());
        let mut file = std::fs::read(&path).expect("file of the corpus");
        file.extend(b"\0\0\0\0\0\0\0\0TRUEVISION-XFILE.\0");
        assert_eq!(read(&file, "no suffix", Limits::default()).as_ref(), Ok(&image));
    }
}

#[test]
fn a_targa_picture_is_turned_upright() {
    // Uncompressed true colour, 1 x 2, 24 bits, blue first; descriptor bit 5 says that rows come from the top.
    let file = |descriptor: u8| {
        let mut file = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 24, descriptor];
        file.extend([1, 2, 3, 4, 5, 6]);
        let image = read(&file, "A.TGA", Limits::default()).expect("a sound file");
        bytes(&image).to_vec()
    };
    assert_eq!((file(0x20), file(0)), (vec![3, 2, 1, 6, 5, 4], vec![6, 5, 4, 3, 2, 1]));
}

#[test]
fn every_good_picture_of_the_corpus_opens_or_is_refused_in_words() {
    let Some(folder) = folder("images") else { return };
    let mut refused = Vec::new();
    let pictures = files(&folder).into_iter().filter(|p| p.extension().is_some_and(|e| e != "LICENSE"));
    for path in pictures {
        match load(&path) {
            Ok(image) => assert!(image.width > 0 && image.height > 0),
            Err(error) => {
                println!("{}: {error}", path.display());
                refused.push(path.file_name().expect("name").to_string_lossy().into_owned());
            }
        }
    }
    assert_eq!(refused, ["Rec709_YC.exr", "comp_b44.exr"], "only pictures with subsampled chroma");
}

#[test]
fn exr_luminance_and_chroma_become_red_green_and_blue() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("chroma.exr");
    let [r, g, b] = [2.0f32, 0.5, 0.25];
    let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let channel = |name: &str, value: f32| NamedChannel { name: name.to_owned(), values: vec![value; 2] };
    let channels = vec![channel("RY", (r - y) / y), channel("Y", y), channel("BY", (b - y) / y)];
    write_exr(&path, &ExrPicture { width: 2, height: 1, channels, attributes: Vec::new() }).expect("written");
    let image = load(&path).expect("a sound file");
    assert_eq!(image.channels, 3);
    for (got, expected) in floats(&image).iter().zip([r, g, b, r, g, b]) {
        assert!((got - expected).abs() < 1e-6, "{got} {expected}");
    }
}

#[test]
fn exr_layers_and_channel_orders_do_not_matter() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases: [(&[&str], &[f32]); 4] = [
        (&["B", "G", "R", "A", "Z"], &[3.0, 2.0, 1.0, 4.0]),
        (&["diffuse.B", "diffuse.G", "diffuse.R", "depth"], &[3.0, 2.0, 1.0]),
        (&["r", "g", "b"], &[1.0, 2.0, 3.0]),
        (&["height"], &[1.0]),
    ];
    for (i, (names, expected)) in cases.into_iter().enumerate() {
        let path = folder.path().join(format!("{i}.exr"));
        let numbered = names.iter().zip(1u8..);
        let channels = numbered
            .map(|(name, value)| NamedChannel { name: (*name).to_owned(), values: vec![value.into()] })
            .collect();
        write_exr(&path, &ExrPicture { width: 1, height: 1, channels, attributes: Vec::new() })
            .expect("written");
        assert_eq!(floats(&load(&path).expect("a sound file")), expected, "{names:?}");
    }
}

/// The headers of an OpenEXR file with so many parts of one channel of floats, and nothing after them.
fn exr_headers(parts: u32, [width, height]: [i32; 2]) -> Vec<u8> {
    let text = |t: &str| [t.as_bytes(), b"\0"].concat();
    let attribute = |name: &str, kind: &str, data: &[u8]| {
        [text(name), text(kind), (data.len() as u32).to_le_bytes().to_vec(), data.to_vec()].concat()
    };
    let numbers = |n: &[i32]| n.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let window = numbers(&[0, 0, width - 1, height - 1]);
    let channels = [text("Y"), numbers(&[2, 0, 1, 1]), vec![0]].concat();
    let one = 1.0f32.to_le_bytes();
    let header = |part: u32| {
        [
            attribute("channels", "chlist", &channels),
            attribute("compression", "compression", &[3]),
            attribute("dataWindow", "box2i", &window),
            attribute("displayWindow", "box2i", &window),
            attribute("lineOrder", "lineOrder", &[0]),
            attribute("pixelAspectRatio", "float", &one),
            attribute("screenWindowCenter", "v2f", &[0; 8]),
            attribute("screenWindowWidth", "float", &one),
            attribute("name", "string", part.to_string().as_bytes()),
            attribute("type", "string", b"scanlineimage"),
            attribute("chunkCount", "int", &numbers(&[(height + 15) / 16])),
            vec![0],
        ]
        .concat()
    };
    let headers = (0..parts).flat_map(header);
    [0x76, 0x2f, 0x31, 0x01, 2, 0x10, 0, 0].into_iter().chain(headers).chain([0]).collect()
}

#[test]
fn many_harmless_parts_are_not_harmless_together() {
    let said = |parts| {
        let file = exr_headers(parts, [2000, 1000]);
        read(&file, "a.exr", Limits::default()).expect_err("no pixels").to_string()
    };
    assert!(said(1).contains("the file ends before its list of blocks does"), "{}", said(1));
    assert!(said(100).contains("100 parts cannot be stored"), "{}", said(100));
}
