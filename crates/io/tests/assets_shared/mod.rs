//! Where the corpus of real files is: `$DURER_SHARED/assets` or `../shared/assets` beside the workspace.
use std::{
    io::Write,
    path::{Path, PathBuf},
};

/// The folder `name` of the corpus; says so loudly and gives `None` if it is not there.
pub(crate) fn folder(name: &str) -> Option<PathBuf> {
    let shared = std::env::var_os("DURER_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    let folder = shared.join("assets").join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    // Past the capture of test output: a test that did not run must be seen.
    let line = format!("SKIPPED: {} is not there; set DURER_SHARED to run this test\n", folder.display());
    std::io::stderr().write_all(line.as_bytes()).expect("stderr");
    None
}

#[allow(dead_code, reason = "each test target uses some of it")]
/// All files below `folder`, sorted.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("readable folder") {
        let path = entry.expect("readable entry").path();
        if path.is_dir() { found.extend(files(&path)) } else { found.push(path) }
    }
    found.sort();
    found
}
