//! Wavefront OBJ files and their materials: what follows the first zero byte is the library `fuzzed.mtl`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let cut = data.iter().position(|&byte| byte == 0).unwrap_or(data.len());
    let (model, library) = data.split_at(cut);
    durer_fuzz::put("fuzzed.mtl", library.get(1..).unwrap_or_default());
    durer_fuzz::scene("fuzzed.obj", model);
});
