//! WebP pictures.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::picture("fuzzed.webp", data));
