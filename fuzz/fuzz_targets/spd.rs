//! Curves over wavelengths, as the metal of a ball.
#![no_main]

const SCENE: &str = r#"WorldBegin
LightSource "point"
Material "conductor" "spectrum eta" "fuzzed.spd" "spectrum k" "fuzzed.spd"
Shape "sphere"
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.spd", data);
    durer_fuzz::scene("spd.pbrt", SCENE.as_bytes());
});
