//! pbrt scenes. A file that includes itself is called `fuzzed.pbrt`; `a.ply` and `a.pfm` lie beside it.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer_fuzz::scene("fuzzed.pbrt", data));
