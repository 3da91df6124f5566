//! Mitsuba's packed meshes. What does not begin as such a file does is packed: its first byte says which version it is.
#![no_main]

use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};

const SCENE: &str = r#"<scene version="3.0.0">
    <shape type="serialized"><string name="filename" value="fuzzed.serialized"/></shape>
    <shape type="serialized">
        <string name="filename" value="fuzzed.serialized"/>
        <integer name="shape_index" value="1"/>
    </shape>
</scene>
"#;

/// A file of one mesh.
fn packed(data: &[u8]) -> Vec<u8> {
    let (version, content) = data.split_first().unwrap_or((&4, &[]));
    let mut file = vec![0x1c, 0x04, 3 + version % 2, 0];
    let mut packer = ZlibEncoder::new(&mut file, Compression::none());
    packer.write_all(content).and_then(|()| packer.finish().map(drop)).expect("memory");
    file.extend([0, 0, 0, 0, 1, 0, 0, 0]);
    file
}

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    match data.starts_with(&[0x1c, 0x04]) {
        true => durer_fuzz::put("fuzzed.serialized", data),
        false => durer_fuzz::put("fuzzed.serialized", &packed(data)),
    }
    durer_fuzz::scene("serialized.xml", SCENE.as_bytes());
});
