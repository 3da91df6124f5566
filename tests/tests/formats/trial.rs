//! One feature, tried: a small file is opened and prepared, and what was said about it is the answer.
use std::path::Path;

use base64::{Engine, prelude::BASE64_STANDARD};
use durer::{
    Options,
    scene::{Missing, Severity},
};

/// A picture of one pixel.
const PIXEL: &str =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const LAMP: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 50 0\n";
/// A biconvex lens and its stop.
const LENS: &str = "# radius thickness index aperture\n60 4 1.5 20\n-60 4 1 20\n0 50 0 10\n";

/// What became of a feature.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing was said.
    Read,
    /// It is read, in another way or in part.
    Changed(String),
    /// It is an error.
    Refused(String),
}

/// A folder for trials.
pub(crate) struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// With the files that features may ask for.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let write =
            |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("written");
        write("pixel.png", &BASE64_STANDARD.decode(PIXEL).expect("base64"));
        write("triangle.ply", TRIANGLE.as_bytes());
        write("lamp.ies", LAMP.as_bytes());
        write("lens.dat", LENS.as_bytes());
        write("paint.bsdf", &durer_testkit::measured::paint());
        write("x.ptx", &durer_testkit::ptex::pixel());
        write("curve.spd", b"400 0.5\n700 0.5\n");
        write("part.pbrt", b"# nothing\n");
        write("library.mtl", b"newmtl red\nKd 1 0 0\n");
        Self { folder }
    }

    /// Where a file of this name lies.
    pub(crate) fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    /// Opens a file of this name and content.
    pub(crate) fn try_file(&self, name: &str, content: impl AsRef<[u8]>) -> Outcome {
        let path = self.folder.path().join(name);
        std::fs::write(&path, content).expect("written");
        let outcome = opened(&path);
        std::fs::remove_file(&path).expect("removed");
        outcome
    }
}

fn opened(path: &Path) -> Outcome {
    let mut imported = durer::open(&path.display().to_string());
    let options = Options {
        threads: Some(1),
        width: Some(8),
        height: Some(8),
        nothing: Missing::Warn,
        ..Options::default()
    };
    durer::prepare(&mut imported, &options);
    let said = |severity: Severity| {
        let of = imported.diagnostics.iter().filter(|d| d.severity == severity);
        let messages: Vec<String> = of.map(|d| d.message.clone()).collect();
        let folder = path.parent().map(|p| format!("{}/", p.display())).unwrap_or_default();
        (!messages.is_empty()).then(|| messages.join("; ").replace(&folder, ""))
    };
    match (said(Severity::Error), said(Severity::Warning)) {
        (Some(message), _) => Outcome::Refused(message),
        (None, Some(message)) => Outcome::Changed(message),
        (None, None) => Outcome::Read,
    }
}

/// A line of a list: a feature and what was said about it.
pub(crate) fn remark(feature: &str, outcome: &Outcome) -> Option<String> {
    let (word, message) = match outcome {
        Outcome::Read => return None,
        Outcome::Changed(message) => ("", message),
        Outcome::Refused(message) => ("refused: ", message),
    };
    Some(format!("- `{feature}`: {word}{}\n", message.replace('|', "\\|")))
}
