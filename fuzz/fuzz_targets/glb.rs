//! glTF in its container.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::scene("fuzzed.glb", data));
