//! What is fuzzed, and what each target begins with.

/// A target of `fuzz/`.
#[derive(Debug)]
pub(super) struct Target {
    /// Its file in `fuzz/fuzz_targets/`.
    pub(super) name: &'static str,
    /// Files of these suffixes are what it begins with.
    pub(super) suffixes: &'static [&'static str],
    /// Longest file that is tried, in bytes.
    pub(super) longest: u64,
    /// Whether the files hold words that are worth putting into others.
    pub(super) is_wordy: bool,
}

const fn text(name: &'static str, suffixes: &'static [&'static str]) -> Target {
    Target { name, suffixes, longest: 16 << 10, is_wordy: true }
}

const fn binary(name: &'static str, suffixes: &'static [&'static str]) -> Target {
    Target { name, suffixes, longest: 64 << 10, is_wordy: false }
}

/// All targets.
pub(super) const TARGETS: &[Target] = &[
    text("pbrt", &["pbrt"]),
    text("mitsuba", &["xml"]),
    text("gltf", &["gltf"]),
    Target { is_wordy: true, ..binary("glb", &["glb"]) },
    text("obj", &["obj"]),
    text("ply", &["ply"]),
    text("stl", &["stl"]),
    binary("serialized", &["serialized"]),
    binary("meshopt", &[]),
    binary("draco", &[]),
    binary("vdb", &["vdb"]),
    binary("vol", &["vol"]),
    binary("bsdf", &["bsdf"]),
    binary("ptex", &["ptx"]),
    binary("gzip", &["gz"]),
    text("spd", &["spd", "csv"]),
    text("ies", &["ies"]),
    text("lens", &["dat"]),
    binary("png", &["png"]),
    binary("jpeg", &["jpg", "jpeg"]),
    Target { is_wordy: true, ..binary("exr", &["exr"]) },
    binary("hdr", &["hdr"]),
    binary("pfm", &["pfm"]),
    binary("bmp", &["bmp"]),
    binary("tga", &["tga"]),
    binary("webp", &["webp"]),
    binary("ktx2", &["ktx2"]),
];

#[cfg(test)]
mod tests {
    use std::{collections::BTreeSet, fs};

    use super::*;

    #[test]
    fn all_targets_are_known() {
        let folder = crate::root().expect("the workspace").join("fuzz/fuzz_targets");
        let files = fs::read_dir(folder).expect("the targets").flatten();
        let there: BTreeSet<String> =
            files.filter_map(|f| Some(f.path().file_stem()?.to_string_lossy().into_owned())).collect();
        let known: BTreeSet<String> = TARGETS.iter().map(|target| target.name.to_owned()).collect();
        assert_eq!(there, known);
    }
}
