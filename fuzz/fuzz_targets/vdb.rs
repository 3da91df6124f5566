//! Voxels of OpenVDB, and the smoke that they become.
#![no_main]

const SCENE: &str = r#"WorldBegin
MakeNamedMedium "smoke" "string type" "nanovdb" "string filename" "fuzzed.vdb"
AttributeBegin
MediumInterface "smoke" ""
Shape "sphere"
AttributeEnd
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::volume("fuzzed.vdb", data);
    durer_fuzz::scene("vdb.pbrt", SCENE.as_bytes());
});
