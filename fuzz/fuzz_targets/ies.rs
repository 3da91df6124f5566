//! Luminaires of their makers.
#![no_main]

const SCENE: &str = r#"WorldBegin
LightSource "ies" "string filename" "fuzzed.ies"
Shape "sphere"
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.ies", data);
    durer_fuzz::scene("ies.pbrt", SCENE.as_bytes());
});
