//! Pictures out, and in again.
use durer_io::image::{
    ExrPicture, ExrValue, NamedChannel, PictureFormat, read, read_exr_channels, write_exr, write_png,
    writer_for,
};
use durer_scene::{ImageData, Limits};
use std::path::Path;

fn channel(name: &str, values: &[f32]) -> NamedChannel {
    NamedChannel { name: name.to_owned(), values: values.to_vec() }
}

#[test]
fn png_bytes_survive_a_round_trip_and_are_marked_srgb() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join("out.png");
    let pixels: Vec<u8> = (0..3 * 7 * 5).map(|i| (i * 37) as u8).collect();
    write_png(&path, 7, 5, &pixels).expect("written");
    // A second picture replaces the first.
    write_png(&path, 7, 5, &pixels).expect("written again");
    let bytes = std::fs::read(&path).expect("there");
    assert!(bytes.windows(4).any(|w| w == b"sRGB"));
    let image = read(&bytes, "out.png", Limits::default()).expect("readable");
    assert_eq!((image.width, image.height, image.channels), (7, 5, 3));
    assert_eq!(image.data, ImageData::U8(pixels));
    assert_eq!(std::fs::read_dir(folder.path()).expect("folder").count(), 1, "no temporary file stays");
}

#[test]
fn exr_channels_keep_their_exact_bits() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join("out.exr");
    let odd = [0.0, -0.0, 1e-45, f32::MAX, f32::INFINITY, f32::from_bits(0x7fc0_1234)];
    let many: Vec<f32> = (0..300 * 40).map(|i| f32::from_bits(i * 0x0001_3579)).collect();
    for (width, height, values) in [(3, 2, &odd[..]), (300, 40, &many[..])] {
        let picture = ExrPicture {
            width,
            height,
            channels: ["R", "depth.Z", "G", "normal.X", "depth.length"].map(|n| channel(n, values)).into(),
            attributes: vec![
                ("durer".to_owned(), ExrValue::Text("0.1.0 \u{e9}".to_owned())),
                ("spp".to_owned(), ExrValue::Integer(64)),
                ("wallSeconds".to_owned(), ExrValue::Number(1.5)),
                ("worldFromCamera".to_owned(), ExrValue::Matrix([0.5; 16])),
            ],
        };
        write_exr(&path, &picture).expect("written");
        let bytes = std::fs::read(&path).expect("there");
        write_exr(&path, &picture).expect("written again");
        assert!(bytes == std::fs::read(&path).expect("there"), "the same picture gives the same bytes");
        let (w, h, channels) = read_exr_channels(&bytes, "out.exr", Limits::default()).expect("readable");
        assert_eq!((w, h), (width, height));
        let names: Vec<&str> = channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["G", "R", "depth.Z", "depth.length", "normal.X"]);
        let bits = |v: &[f32]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(channels.iter().all(|c| bits(&c.values) == bits(values)));
        for word in ["durer", "0.1.0 \u{e9}", "wallSeconds", "worldFromCamera", "m44f"] {
            assert!(bytes.windows(word.len()).any(|w| w == word.as_bytes()), "{word}");
        }
    }
}

#[test]
fn an_exr_is_read_as_interleaved_rgba() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join("out.exr");
    let channels =
        vec![channel("B", &[3.0]), channel("A", &[4.0]), channel("G", &[2.0]), channel("R", &[1.0])];
    write_exr(&path, &ExrPicture { width: 1, height: 1, channels, attributes: vec![] }).expect("written");
    let image = read(&std::fs::read(&path).expect("there"), "out.exr", Limits::default()).expect("readable");
    assert_eq!(image.channels, 4);
    assert_eq!(image.data, ImageData::F32(vec![1.0, 2.0, 3.0, 4.0]));
}

#[test]
fn impossible_pictures_are_refused() {
    let path = Path::new("/nowhere/out.exr");
    let refused = |channels: Vec<NamedChannel>, attributes| {
        write_exr(path, &ExrPicture { width: 1, height: 1, channels, attributes })
            .expect_err("refused")
            .reason
    };
    assert!(refused(vec![channel("R", &[1.0, 2.0])], vec![]).contains("2 values"));
    assert!(refused(vec![channel("R", &[1.0]), channel("R", &[1.0])], vec![]).contains("two channels"));
    assert!(refused(vec![channel("", &[1.0])], vec![]).contains("cannot be a name"));
    let reserved = vec![("compression".to_owned(), ExrValue::Integer(1))];
    assert!(!refused(vec![channel("R", &[1.0])], reserved).contains("No such file"));
    assert!(write_png(Path::new("x.png"), 2, 2, &[0; 3]).expect_err("refused").reason.contains("need 12"));
}

#[test]
fn unwritable_places_are_named_with_the_reason() {
    let error = write_png(Path::new("/nowhere/at/all/out.png"), 1, 1, &[0; 3]).expect_err("no such folder");
    assert!(error.to_string().starts_with("/nowhere/at/all/out.png: "), "{error}");
    assert!(error.reason.contains("No such file"), "{error}");
}

#[test]
fn the_suffix_chooses_the_format_in_any_case() {
    let format = |p: &str| writer_for(Path::new(p)).map(|w| w.format);
    assert_eq!(format("a/out.PNG"), Ok(PictureFormat::Png));
    assert_eq!(format("out.v2.Exr"), Ok(PictureFormat::Exr));
    for bad in ["out.tiff", "out", "png"] {
        let error = format(bad).expect_err("unknown").to_string();
        assert!(error.starts_with(bad) && error.contains(".png") && error.contains(".exr"), "{error}");
    }
}
