//! Packed files: the unpacking, of several members too.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::scene("fuzzed.obj.gz", data));
