//! Mitsuba's volumes on a grid.
#![no_main]

const SCENE: &str = r#"<scene version="3.0.0">
    <shape type="sphere">
        <medium type="heterogeneous" name="interior">
            <volume type="gridvolume" name="sigma_t"><string name="filename" value="fuzzed.vol"/></volume>
            <volume type="gridvolume" name="albedo"><string name="filename" value="fuzzed.vol"/></volume>
        </medium>
    </shape>
</scene>
"#;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    durer_fuzz::put("fuzzed.vol", data);
    durer_fuzz::scene("vol.xml", SCENE.as_bytes());
});
