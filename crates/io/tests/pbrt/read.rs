//! Reads texts and shows complaints as a user sees them.
use std::{fs, path::Path};

use durer_io::import::{Imported, open, pbrt::read_text};
use durer_scene::{Limits, Location, SceneDesc, Severity};

pub(crate) fn read(text: &str) -> Imported {
    let mut imported = Imported::new(".".into(), Limits::default());
    read_text("test", text, &mut imported);
    imported
}

/// The scene of a text without any complaint.
pub(crate) fn sound(text: &str) -> SceneDesc {
    let imported = read(text);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    imported.desc
}

/// `line:column severity: message | the text pointed at | hint` of each complaint.
pub(crate) fn complaints(imported: &Imported) -> Vec<String> {
    let line = |d: &durer_scene::Diagnostic| {
        let severity = match d.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        let (place, text) = match &d.at {
            Location::Span(span) => {
                let (line, column) = imported.sources.line_column(span.source, span.start);
                let text = imported.sources.text(span.source);
                let text = text.get(span.start as usize..span.end as usize).expect("a span lies in its text");
                (format!("{line}:{column}"), text.to_owned())
            }
            _ => ("-".to_owned(), String::new()),
        };
        let mut line = format!("{place} {severity}: {} | {text}", d.message);
        if let Some(hint) = &d.hint {
            line.push_str(" | ");
            line.push_str(hint);
        }
        line
    };
    imported.diagnostics.iter().map(line).collect()
}

/// Writes files into a new folder and opens the first.
pub(crate) fn open_files(files: &[(&str, &[u8])]) -> (tempfile::TempDir, Imported) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    }
    let imported = open(&folder.path().join(files[0].0), Limits::default());
    (folder, imported)
}

/// The shared assets, if this machine has them.
pub(crate) fn shared(below: &str) -> Option<std::path::PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::var_os("DURER_SHARED").map(std::path::PathBuf::from);
    let candidates = [Some("../shared"), Some("../../shared"), Some("../../../shared")];
    let all = given.into_iter().chain(candidates.into_iter().flatten().map(|c| here.join(c)));
    let found = all.map(|folder| folder.join("assets").join(below)).find(|p| p.exists());
    if found.is_none() {
        eprintln!("SKIPPED: no shared/assets/{below}; set DURER_SHARED to the folder that holds assets/");
    }
    found
}
