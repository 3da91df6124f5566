//! Pictures of faces.
#![no_main]

const SCENE: &str = r#"WorldBegin
Texture "fuzzed" "spectrum" "ptex" "string filename" "fuzzed.ptx"
Material "diffuse" "texture reflectance" "fuzzed"
Shape "sphere"
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.ptx", data);
    durer_fuzz::scene("ptex.pbrt", SCENE.as_bytes());
});
