//! Prescriptions of lenses.
#![no_main]

const SCENE: &str = r#"Camera "realistic" "string lensfile" "fuzzed.dat" "float aperturediameter" 4
WorldBegin
LightSource "point"
Shape "sphere"
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.dat", data);
    durer_fuzz::scene("lens.pbrt", SCENE.as_bytes());
});
