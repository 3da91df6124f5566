//! glTF as JSON, with its buffers and images as data in it.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::scene("fuzzed.gltf", data));
