//! Whatever the input, reading ends and does not panic.
use proptest::prelude::*;

use super::read::{complaints, open_files, read};

const WORDS: &[&str] = &[
    "Identity",
    "Translate",
    "Scale",
    "Rotate",
    "LookAt",
    "CoordinateSystem",
    "CoordSysTransform",
    "Transform",
    "ConcatTransform",
    "ReverseOrientation",
    "Camera",
    "Film",
    "Sampler",
    "PixelFilter",
    "Integrator",
    "WorldBegin",
    "AttributeBegin",
    "AttributeEnd",
    "TransformBegin",
    "TransformEnd",
    "Material",
    "MakeNamedMaterial",
    "NamedMaterial",
    "Texture",
    "LightSource",
    "Shape",
    "AreaLightSource",
    "ColorSpace",
    "Option",
    "Accelerator",
    "MakeNamedMedium",
    "MediumInterface",
    "Include",
    "Import",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "ActiveTransform",
    "TransformTimes",
    "Attribute",
    "WorldEnd",
    "StartTime",
    "EndTime",
    "All",
    "shape",
    "Shpae",
    "\"rgb\"",
    "\"sobol\"",
    "\"stratified\"",
    "\"camera\"",
    "\"world\"",
    "\"shape\"",
    "\"material\"",
    "\"\"",
    "\"a\"",
    "\"float x\"",
    "\"integer xresolution\"",
    "\"integer pixelsamples\"",
    "\"string type\"",
    "\"string name\"",
    "\"point3 P\"",
    "\"rgb c\"",
    "\"spectrum s\"",
    "\"bool b\"",
    "\"texture t\"",
    "\"flaot y\"",
    "\"float\"",
    "\"open",
    "\"es\\\"c\"",
    "\"bad\\q\"",
    "[",
    "]",
    "[ 1 2 3 ]",
    "[ \"a\" \"b\" ]",
    "[1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]",
    "0",
    "1",
    "-1",
    "1.5",
    "1e39",
    "1e-39",
    "1e308",
    ".5",
    "-2.",
    "1 2 3",
    "90 0 0 1",
    "true",
    "false",
    "nan",
    "inf",
    "# comment\n",
    "\n",
    "\r\n",
    "\t",
    "ü",
    "\u{0}",
    "\\",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn random_bytes_end(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let (_folder, imported) = open_files(&[("a.pbrt", &bytes)]);
        complaints(&imported);
    }

    #[test]
    fn random_text_ends(text in ".{0,200}") {
        complaints(&read(&text));
    }

    #[test]
    fn random_tokens_end(words in proptest::collection::vec(proptest::sample::select(WORDS), 0..120), glue in 0..2usize) {
        let text = words.join(if glue == 0 { " " } else { "\n" });
        complaints(&read(&text));
        complaints(&read(&format!("WorldBegin {text}")));
    }
}

#[test]
fn much_of_the_same_ends_soon() {
    let start = std::time::Instant::now();
    for word in WORDS {
        let text = format!("WorldBegin {}", format!("{word} ").repeat(100_000));
        complaints(&read(&text));
    }
    for pair in [
        "AttributeBegin ObjectEnd ",
        "ObjectBegin \"a\" ",
        "Film \"gbuffer\" \"float iso\" 1 ",
        "Texture \"t\" \"color\" \"x\" ",
        "Attribute \"shape\" \"float x\" 1 AttributeBegin ",
        "Camera \"p\" ",
        "Shape \"s\" [ ",
        "NamedMaterial \"a\" Shape \"b\" ",
    ] {
        complaints(&read(&format!("WorldBegin {}", pair.repeat(50_000))));
    }
    let spent = start.elapsed();
    assert!(spent.as_secs() < 60, "{spent:?}");
}
