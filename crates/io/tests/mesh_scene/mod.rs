//! Small files, opened, and what was made of them.
#![allow(dead_code, reason = "no test file needs all of it")]
use std::{fs, path::Path};

use durer_io::import::{Imported, open};
use durer_scene::{Data, Limits, Location, Mesh, NamedNode, Severity, ShapeSource};

/// A folder with files in it.
pub(crate) fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let root = tempfile::tempdir().expect("temporary folder");
    for (name, content) in files {
        let path = root.path().join(name);
        fs::create_dir_all(path.parent().expect("below the folder")).expect("folder");
        fs::write(path, content).expect("file");
    }
    root
}

/// Opens a file.
pub(crate) fn read(path: &Path) -> Imported {
    open(path, Limits::default())
}

/// Opens the first of some files.
pub(crate) fn import(files: &[(&str, &[u8])]) -> Imported {
    let root = folder(files);
    let (name, _) = files.first().expect("a file");
    read(&root.path().join(name))
}

/// The mesh of a shape.
pub(crate) fn mesh(imported: &Imported, shape: usize) -> &Mesh {
    match &imported.desc.shapes[shape].source {
        ShapeSource::Mesh(id) => &imported.desc.meshes[id.index()],
        other => panic!("{other:?} is no mesh"),
    }
}

/// The material of a shape.
pub(crate) fn material(imported: &Imported, shape: usize) -> &NamedNode {
    let id = imported.desc.shapes[shape].material.expect("a material");
    &imported.desc.materials[id.index()]
}

/// Triangles of all shapes.
pub(crate) fn triangles(imported: &Imported) -> usize {
    (0..imported.desc.shapes.len()).map(|i| mesh(imported, i).indices.len()).sum()
}

/// All complaints of a severity, as `line:column: message`.
pub(crate) fn said(imported: &Imported, severity: Severity) -> Vec<String> {
    let all = imported.diagnostics.iter().filter(|d| d.severity == severity);
    all.map(|d| match &d.at {
        Location::Span(span) => {
            let (line, column) = imported.sources.line_column(span.source, span.start);
            format!("{line}:{column}: {}", d.message)
        }
        _ => d.message.clone(),
    })
    .collect()
}

/// Fails if anything was said.
pub(crate) fn assert_silent(imported: &Imported) {
    assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
}

/// The numbers of a material's parameter.
pub(crate) fn floats(node: &NamedNode, name: &str) -> Vec<f32> {
    match node.node.params.get(name).map(|p| &p.data) {
        Some(Data::Floats(values)) => values.clone(),
        other => panic!("{name} is {other:?}"),
    }
}
