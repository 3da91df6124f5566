//! The folder a scene may read from.
use durer_io::FileAssets;
use durer_scene::{AssetError, Assets, Limits};
use std::{fs, sync::Arc};

fn scene() -> (tempfile::TempDir, FileAssets) {
    let root = tempfile::tempdir().expect("temporary folder");
    fs::create_dir_all(root.path().join("scene/textures")).expect("folder");
    fs::write(root.path().join("secret.txt"), "secret").expect("file");
    fs::write(root.path().join("scene/textures/a b.txt"), "inside").expect("file");
    let assets = FileAssets::new(root.path().join("scene"), Limits::default());
    (root, assets)
}

#[test]
fn files_below_the_folder_are_read_with_either_slash() {
    let (_root, assets) = scene();
    for path in
        ["textures/a b.txt", "textures\\a b.txt", "./textures//a b.txt", "textures/../textures/a b.txt"]
    {
        assert_eq!(&*assets.bytes(path).expect(path), b"inside");
    }
}

#[test]
fn paths_that_leave_the_folder_are_refused() {
    let (root, assets) = scene();
    let absolute = root.path().join("secret.txt").display().to_string();
    for path in
        ["../secret.txt", "textures/../../secret.txt", "..\\secret.txt", "/etc/passwd", "C:\\x", &absolute]
    {
        assert_eq!(assets.bytes(path), Err(AssetError::Outside { path: path.to_owned() }));
    }
}

#[cfg(unix)]
#[test]
fn symbolic_links_do_not_lead_out() {
    let (root, assets) = scene();
    std::os::unix::fs::symlink(root.path().join("secret.txt"), root.path().join("scene/link")).expect("link");
    std::os::unix::fs::symlink("textures/a b.txt", root.path().join("scene/fine")).expect("link");
    assert!(matches!(assets.bytes("link"), Err(AssetError::Outside { .. })));
    assert_eq!(&*assets.bytes("fine").expect("inside"), b"inside");
}

#[test]
fn missing_files_are_named_as_written() {
    let (_root, assets) = scene();
    let error = assets.bytes("textures\\No Such.png").expect_err("missing");
    assert_eq!(error.to_string(), "textures\\No Such.png: file not found");
    assert!(matches!(assets.bytes("textures"), Err(AssetError::Io { .. })));
}

#[test]
fn the_length_is_checked_before_reading() {
    let (root, _) = scene();
    let limits = Limits { file_bytes: 5, ..Limits::default() };
    let assets = FileAssets::new(root.path().join("scene"), limits);
    assert!(matches!(assets.bytes("textures/a b.txt"), Err(AssetError::Limits { .. })));
}

#[test]
fn images_are_decoded_once_and_embedded_ones_come_first() {
    let (root, mut assets) = scene();
    let path = root.path().join("scene/textures/dot.png");
    durer_io::image::write_png(&path, 1, 1, &[1, 2, 3]).expect("written");
    let first = assets.image("textures/dot.png").expect("readable");
    assert!(Arc::ptr_eq(&first, &assets.image("textures/dot.png").expect("readable")));
    let bytes = fs::read(&path).expect("there");
    assets.insert("image:0", bytes);
    assert_eq!(assets.image("image:0").expect("embedded"), first);
    assert_eq!(assets.image("image:1").expect_err("missing").to_string(), "image:1: file not found");
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packer.write_all(bytes).expect("memory");
    packer.finish().expect("memory")
}

#[test]
fn gzip_is_unpacked_whatever_the_file_is_called() {
    let (root, mut assets) = scene();
    let twice = [packed(b"one "), packed(b"two")].concat();
    fs::write(root.path().join("scene/a.txt"), &twice).expect("file");
    assert_eq!(&*assets.bytes("a.txt").expect("readable"), b"one two");
    assets.insert("embedded", twice);
    assert_eq!(&*assets.bytes("embedded").expect("readable"), b"one two");
    fs::write(root.path().join("scene/cut.gz"), &packed(&[7; 1000])[..15]).expect("file");
    let error = assets.bytes("cut.gz").expect_err("damaged").to_string();
    assert!(error.starts_with("cut.gz: the gzip file was cut off or is damaged: "), "{error}");
}

/// 64 MB of zeros are 64 kB of gzip.
#[test]
fn what_unpacks_to_more_than_the_limit_is_refused() {
    let (root, _) = scene();
    fs::write(root.path().join("scene/bomb.gz"), packed(&vec![0; 64 << 20])).expect("file");
    let limits = Limits { file_bytes: 1 << 20, ..Limits::default() };
    let assets = FileAssets::new(root.path().join("scene"), limits);
    let error = assets.bytes("bomb.gz").expect_err("too long");
    assert_eq!(error.to_string(), "bomb.gz: unpacks to more than 1048576 bytes (a damaged or hostile file)");
}

/// Zeros get a thousand times smaller: no scene does.
#[test]
fn what_is_packed_too_well_is_refused_before_the_limit() {
    let (root, assets) = scene();
    let folder = root.path().join("scene");
    fs::write(folder.join("small.gz"), packed(&vec![0; 64 << 20])).expect("file");
    assert_eq!(assets.bytes("small.gz").expect("readable").len(), 64 << 20);
    fs::write(folder.join("bomb.gz"), packed(&vec![0; 96 << 20])).expect("file");
    let said = "bomb.gz: unpacks to more than 67108864 bytes (a damaged or hostile file)";
    assert_eq!(assets.bytes("bomb.gz").expect_err("too long").to_string(), said);
    let limits = Limits { unpacked_bytes: 5, ..Limits::default() };
    fs::write(folder.join("long.gz"), packed(b"123456")).expect("file");
    let error = FileAssets::new(folder, limits).bytes("long.gz").expect_err("too long").to_string();
    assert!(error.starts_with("long.gz: unpacks to more than 5 bytes"), "{error}");
}

#[test]
fn scene_files_open_in_any_letter_case_and_packed() {
    let (root, _) = scene();
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (name, bytes) in [("A.OBJ", obj.to_vec()), ("B.Obj.GZ", packed(obj)), ("c.obj", packed(obj))] {
        let path = root.path().join("scene").join(name);
        fs::write(&path, bytes).expect("file");
        let scene = durer_io::import::open(&path, Limits::default());
        assert!(scene.diagnostics.is_empty(), "{name}: {:?}", scene.diagnostics);
        assert_eq!(scene.desc.name.to_lowercase(), name[..1].to_lowercase());
        assert_eq!(scene.desc.shapes.len(), 1);
    }
    let other = durer_io::import::open(&root.path().join("a.fbx"), Limits::default());
    let said = other.diagnostics.iter().next().expect("an error");
    assert!(said.message.ends_with("a.fbx: not a scene format durer reads"));
    assert!(said.hint.as_deref().is_some_and(|h| h.contains(".obj, .ply, .stl")), "{said:?}");
}

#[test]
fn missing_files_are_told_with_the_folder_and_the_nearest_name() {
    let root = tempfile::tempdir().expect("temporary folder");
    fs::create_dir(root.path().join("textures")).expect("folder");
    fs::write(root.path().join("textures/Logo.jpg"), "").expect("file");
    let assets = FileAssets::new(root.path().to_owned(), Limits::default());
    let advice = |path: &str| assets.advice(&assets.bytes(path).expect_err("missing")).expect("advice");
    let folder = root.path().join("textures");
    assert_eq!(
        advice("textures/logo.png"),
        format!("looked in {}/; did you mean \"Logo.jpg\"?", folder.display())
    );
    assert_eq!(advice("textures/wood.png"), format!("looked in {}/", folder.display()));
    assert!(advice("tex/logo.png").ends_with("/tex/, which is not there"));
    assert_eq!(
        advice("../logo.png"),
        "copy the file into the scene's folder, or name a folder with --root that holds both"
    );
}

/// Opening a pipe to which nobody writes would wait for ever.
#[cfg(unix)]
#[test]
fn pipes_and_devices_are_not_opened() {
    let (root, assets) = scene();
    let folder = root.path().join("scene");
    for name in ["p.obj", "p.ply", "p.stl", "p.gltf", "p.pbrt", "p.png"] {
        let made = std::process::Command::new("mkfifo").arg(folder.join(name)).status().expect("mkfifo");
        assert!(made.success());
        if name != "p.png" {
            let scene = durer_io::import::open(&folder.join(name), Limits::default());
            let said = scene.diagnostics.iter().next().expect("an error");
            assert!(said.message.ends_with("not a file"), "{name}: {said:?}");
        }
    }
    assert_eq!(assets.image("p.png").expect_err("a pipe").to_string(), "p.png: not a file");
    fs::write(folder.join("a.pbrt"), "Include \"p.pbrt\"\n").expect("file");
    let scene = durer_io::import::open(&folder.join("a.pbrt"), Limits::default());
    assert!(scene.diagnostics.iter().any(|d| d.message.ends_with("p.pbrt: not a file")));
}
