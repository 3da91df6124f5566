//! STL files, text and binary.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::scene("fuzzed.stl", data));
