//! Scenes of Mitsuba from text, and what is said of them.
#![allow(dead_code, reason = "each test target uses some of it")]
use durer_io::import::{Imported, Reading, open};
use durer_scene::{Data, Severity};

/// A scene of version 3 with this in it.
pub(crate) fn scene(inside: &str) -> Imported {
    text(&format!("<scene version=\"3.0.0\">\n{inside}\n</scene>"), Reading::default())
}

pub(crate) fn text(text: &str, reading: Reading) -> Imported {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, text).expect("written");
    std::fs::write(
        folder.path().join("triangle.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
    )
    .expect("written");
    std::fs::write(
        folder.path().join("loop.xml"),
        "<scene version='3.0.0'><include filename='loop.xml'/></scene>",
    )
    .expect("written");
    std::fs::write(folder.path().join("a.spd"), "# nm value\n400 0.25\n700 0.5\n").expect("written");
    open(&path, reading)
}

/// Line, column, message and hint of each complaint of this kind.
pub(crate) fn told(imported: &Imported, severity: Severity) -> Vec<String> {
    let of = imported.diagnostics.iter().filter(|d| d.severity == severity);
    of.map(|d| {
        let place = match &d.at {
            durer_scene::Location::Span(span) => {
                let (line, column) = imported.sources.line_column(span.source, span.start);
                format!("{line}:{column}: ")
            }
            _ => String::new(),
        };
        let hint = d.hint.as_ref().map(|h| format!(" ({h})")).unwrap_or_default();
        format!("{place}{}{hint}", d.message)
    })
    .collect()
}

pub(crate) fn errors(inside: &str) -> Vec<String> {
    told(&scene(inside), Severity::Error)
}

/// Numbers of a parameter of the last material that is no `sides`.
pub(crate) fn material(imported: &Imported, name: &str) -> Vec<f32> {
    let of = imported.desc.materials.iter().rev().find(|m| m.node.kind != "sides").expect("a material");
    match of.node.params.get(name).map(|p| &p.data) {
        Some(Data::Floats(v)) => v.clone(),
        other => panic!("{name}: {other:?} of {:?}", of.node),
    }
}
