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
