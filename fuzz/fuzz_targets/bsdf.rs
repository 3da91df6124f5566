//! Measured materials.
#![no_main]

const SCENE: &str = r#"WorldBegin
Material "measured" "string filename" "fuzzed.bsdf"
Shape "sphere"
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.bsdf", data);
    durer_fuzz::scene("bsdf.pbrt", SCENE.as_bytes());
});
