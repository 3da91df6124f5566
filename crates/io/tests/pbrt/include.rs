//! Scenes of several files.
use durer_core::glam::DVec3;

use super::read::{complaints, open_files, read};

#[test]
fn included_files_continue_the_text() {
    let (_folder, imported) = open_files(&[
        ("a.pbrt", b"WorldBegin Include \"sub/b.pbrt\" Shape \"a\""),
        ("sub/b.pbrt", b"Translate 1 0 0 Include \"c.pbrt\" Include \"sub/c.pbrt\""),
        ("sub/c.pbrt", b"Shape \"c\""),
    ]);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    assert_eq!(imported.desc.shapes.len(), 3);
    assert_eq!(imported.desc.name, "a");
    assert_eq!(imported.desc.shapes[2].world_from_object.at(0.0).translation, DVec3::X);
}

#[test]
fn imported_files_do_not_change_the_state() {
    let (_folder, imported) = open_files(&[
        ("a.pbrt", b"WorldBegin AttributeBegin Import \"b.pbrt\" Shape \"a\" NamedMaterial \"m\" AttributeEnd"),
        ("b.pbrt", b"MakeNamedMaterial \"m\" \"string type\" \"mirror\" Translate 1 0 0 AttributeBegin\nAttributeEnd AttributeEnd"),
    ]);
    assert_eq!(complaints(&imported), ["2:14 error: AttributeEnd without AttributeBegin | AttributeEnd"]);
    assert_eq!(imported.desc.shapes[0].world_from_object.at(0.0).translation, DVec3::ZERO);
}

#[test]
fn errors_name_the_included_file() {
    let (folder, imported) = open_files(&[
        ("a.pbrt", b"WorldBegin\nInclude \"b.pbrt\"\nShpae"),
        ("b.pbrt", b"Shape \"s\" \"float r\" [ 1\n"),
    ]);
    assert_eq!(
        complaints(&imported),
        [
            "1:21 error: this [ is not closed | [",
            "3:1 error: unknown directive \"Shpae\" | Shpae | did you mean \"Shape\"?"
        ]
    );
    let first = imported.diagnostics.iter().next().map(|d| d.at.clone());
    let Some(durer_scene::Location::Span(at)) = first else { panic!("a span") };
    assert_eq!(imported.sources.name(at.source), folder.path().join("b.pbrt").display().to_string());
}

#[test]
fn loops_and_missing_files_are_reported() {
    let (_folder, imported) = open_files(&[
        ("a.pbrt", b"Include \"b.pbrt\"\nWorldBegin\nInclude \"gone.pbrt\""),
        ("b.pbrt", b"Include \"a.pbrt\"\nInclude \"../x.pbrt\" Include"),
    ]);
    let found = complaints(&imported);
    assert_eq!(found[0], "1:9 error: a.pbrt: the file includes itself, perhaps through others | \"a.pbrt\"");
    assert!(found[1].starts_with("2:9 error: ../x.pbrt: "), "{found:?}");
    assert_eq!(found[2], "2:21 error: Include needs a file name in quotes | Include");
    assert!(
        found[3].starts_with("3:9 error: gone.pbrt: file not found | \"gone.pbrt\" | looked in "),
        "{found:?}"
    );
    assert_eq!(found.len(), 4);
    assert_eq!(
        complaints(&read("Include \"a.pbrt\" WorldBegin")),
        ["1:9 error: this text is no file, so it cannot include one | \"a.pbrt\""]
    );
}

#[test]
fn the_scenes_folder_is_not_left() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("secret"), "Shape \"s\"").expect("a file");
    std::fs::create_dir(folder.path().join("scene")).expect("a folder");
    let absolute = folder.path().join("secret").display().to_string().replace('\\', "/");
    let path = folder.path().join("scene/a.pbrt");
    std::fs::write(&path, format!("WorldBegin\nInclude \"../secret\"\nInclude \"{absolute}\""))
        .expect("a file");
    let imported = durer_io::import::open(&path, durer_scene::Limits::default());
    assert_eq!(
        complaints(&imported),
        ["../secret", &absolute].map(String::from).iter().zip(2..).map(|(path, line)| format!(
            "{line}:9 error: {path}: leads out of the scene's folder (for safety only files below it are read) | \
             \"{path}\" | copy the file into the scene's folder"
        )).collect::<Vec<_>>()
    );
}

#[test]
fn an_include_bomb_ends() {
    let ten = |name: &str| format!("Include \"{name}\"\n").repeat(10);
    let names: Vec<String> = (0..9).map(|i| format!("f{i}.pbrt")).collect();
    let texts: Vec<String> =
        (0..9).map(|i| if i == 8 { "#".to_owned() } else { ten(&format!("f{}.pbrt", i + 1)) }).collect();
    let files: Vec<(&str, &[u8])> =
        names.iter().zip(&texts).map(|(n, t)| (n.as_str(), t.as_bytes())).collect();
    let (_folder, imported) = open_files(&files);
    let found = complaints(&imported);
    assert!(found[0].contains("more than 65536 files are included"), "{found:?}");
    assert!(found.len() < 60);
}

#[test]
fn bytes_that_are_no_text_are_located() {
    let text = b"WorldBegin\n# caf\xe9 \"\nShape \"b\\\"\xfcste # \xe9\"\nShpae \"s\" # \xe9\n";
    let (_folder, imported) = open_files(&[("a.pbrt", text)]);
    assert_eq!(
        complaints(&imported),
        [
            "3:11 error: this is not valid UTF-8 | \u{fffd} | save the file as UTF-8",
            "4:1 error: unknown directive \"Shpae\" | Shpae | did you mean \"Shape\"?"
        ]
    );
    let (_folder, imported) =
        open_files(&[("a.pbrt", b"WorldBegin # M\xfcller \xff\xfe\r\nShape \"s\"#\xe9")]);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    assert_eq!(imported.desc.shapes.len(), 1);
    for (bytes, word) in [
        (b"\x1f\x8b\x08\x00\x01".as_slice(), "gzip"),
        (b"\x1f\x8b\x07\x00\x01", "gzip"),
        (b"\xff\xfeW\0o\0", "UTF-16"),
        (b"PK\0\xff\xff", "binary"),
    ] {
        let (_folder, imported) = open_files(&[("a.pbrt", bytes)]);
        let found = complaints(&imported);
        assert!(found.len() == 1 && found[0].contains(word), "{found:?}");
    }
    let missing = durer_io::import::open("no/such.PBRT".as_ref(), durer_scene::Limits::default());
    assert_eq!(complaints(&missing), ["- error: no/such.PBRT: file not found | "]);
}

#[test]
fn large_files_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.pbrt");
    std::fs::write(&path, "WorldBegin ###########").expect("a file");
    let limits = durer_scene::Limits { file_bytes: 20, ..Default::default() };
    let found = complaints(&durer_io::import::open(&path, limits));
    assert!(found.len() == 1 && found[0].contains("larger than 20 bytes"), "{found:?}");
}

#[test]
fn packed_files_are_unpacked() {
    // "WorldBegin\nShape \"s\"\n", by gzip -n.
    const PACKED: &[u8] = b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x0b\xcf\x2f\xca\x49\x71\x4a\x4d\xcf\xcc\xe3\x0a\xce\x48\x2c\x48\x55\x50\x2a\x56\xe2\x02\x00\x04\x01\xa7\x6f\x15\x00\x00\x00";
    let (_folder, imported) = open_files(&[("a.pbrt.gz", PACKED)]);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    assert_eq!((imported.desc.shapes.len(), imported.desc.name.as_str()), (1, "a"));
    let (_folder, imported) =
        open_files(&[("a.pbrt", b"WorldBegin Include \"b.pbrt.gz\""), ("b.pbrt.gz", PACKED)]);
    assert_eq!(complaints(&imported), ["1:1 error: a second WorldBegin | WorldBegin"]);
}

#[test]
fn texts_may_be_empty_and_end_anywhere() {
    for text in ["", "\n", "\u{feff}", "# only a comment", "\t \r"] {
        let found = complaints(&read(text));
        assert!(found.len() == 1 && found[0].contains("the scene has no WorldBegin"), "{found:?}");
    }
    let (_folder, imported) = open_files(&[
        ("a.pbrt", b"WorldBegin\rInclude \"empty.pbrt\" Shape \"s\" \"float a\" 1"),
        ("empty.pbrt", b""),
    ]);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    assert_eq!(imported.desc.shapes.len(), 1);
}

/// Whether there is such a file or not is nobody's business.
#[test]
fn paths_that_climb_out_are_refused_before_they_are_looked_for() {
    for path in ["../a.pbrt", "../no such file", "sub/../../no such file", "/no such file"] {
        let (_folder, imported) =
            open_files(&[("a.pbrt", format!("WorldBegin Include \"{path}\"").as_bytes())]);
        let all = complaints(&imported);
        assert!(all.len() == 1 && all[0].contains("leads out of the scene's folder"), "{path}: {all:?}");
    }
    let (_folder, imported) = open_files(&[
        ("a.pbrt", b"WorldBegin Include \"sub/b.pbrt\""),
        ("sub/b.pbrt", b"Include \"../c.pbrt\" Include \"x/../../c.pbrt\""),
        ("sub/x/d.pbrt", b""),
        ("c.pbrt", b"Shape \"c\""),
    ]);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    assert_eq!(imported.desc.shapes.len(), 2);
}
