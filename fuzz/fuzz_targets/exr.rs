//! OpenEXR pictures, as textures and as layers with names.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::picture("fuzzed.exr", data);
    drop(durer_io::image::read_exr_channels(data, "fuzzed.exr", Default::default()));
});
