//! Scenes saved with their files: they work wherever they are unpacked.
use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use durer::{Gather, Options, prepare};
use serde_json::json;
use tempfile::TempDir;

use crate::client::{Client, get, serve, small, token};

/// Names and contents of an archive.
fn unpacked(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let archive = rawzip::ZipArchive::from_slice(bytes).expect("an archive");
    let mut entries = archive.entries();
    let mut files = Vec::new();
    while let Some(header) = entries.next_entry().expect("an entry") {
        let name = header.file_path().try_normalize().expect("a path that leads nowhere else");
        let name = name.as_ref().to_owned();
        let entry = archive.get_entry(header.wayfinder()).expect("its place");
        let mut content = Vec::new();
        let inflated = flate2::bufread::DeflateDecoder::new(entry.data());
        // Length and checksum are looked at.
        entry.verifying_reader(inflated).read_to_end(&mut content).expect("its bytes");
        files.push((name, content));
    }
    files
}

/// What a live page saves, unpacked in a folder of its own: that, the scene file in it, and the names of all.
struct Saved {
    folder: TempDir,
    scene: PathBuf,
    names: Vec<String>,
}

fn saved(live: &durer_view::Live, page: &Client, format: &str, stem: &str) -> Saved {
    let path = format!("/save?token={}&session={}&format={format}", token(live), page.session());
    let (code, head, bytes) = get(live, &path);
    assert_eq!(code, 200, "{head}\n{}", String::from_utf8_lossy(&bytes));
    let lower = head.to_lowercase();
    let expected = format!("attachment; filename=\"{stem}.zip\"").to_lowercase();
    assert!(lower.contains("content-type: application/zip") && lower.contains(&expected), "{head}");
    let folder = tempfile::tempdir().expect("a folder");
    let files = unpacked(&bytes);
    for (name, content) in &files {
        let file = folder.path().join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        assert!(!file.exists(), "{name} twice");
        fs::write(file, content).expect("written");
    }
    let scene = folder.path().join(format!("{stem}.pbrt"));
    Saved { folder, scene, names: files.into_iter().map(|(name, _)| name).collect() }
}

/// The bits of all pixels.
fn film(scene: &Path, options: &Options) -> Vec<[u32; 3]> {
    let mut imported = durer::open(scene.to_str().expect("text"));
    let Some(prepared) = prepare(&mut imported, options) else {
        panic!("{}: {:?}", scene.display(), imported.diagnostics)
    };
    let film = prepared.job().render(Gather::Rays, &(), &AtomicBool::new(false)).film;
    let bits = |p: durer::film::Pixel| p.mean().map(f32::to_bits);
    film.pixels().into_iter().map(bits).collect()
}

/// Saves a scene, reads it elsewhere, and insists that the film has the same bits.
fn comes_back(scene: &Path, format: &str) -> Saved {
    let live = serve(scene.to_str().expect("text"), small());
    let mut page = Client::new(&live);
    page.finished();
    let stem = scene.file_stem().and_then(|s| s.to_str()).expect("a name");
    let saved = saved(&live, &page, format, stem);
    let options = Options { threads: Some(2), ..Options::default() };
    let (there, here) = (film(&saved.scene, &options), film(scene, &small()));
    assert!(here.iter().any(|p| *p != here[0]), "{stem}: an empty picture");
    let differing = here.iter().zip(&there).filter(|(a, b)| a != b).count();
    assert_eq!((there.len(), differing), (here.len(), 0), "{stem}: pixels that differ");
    saved
}

#[test]
fn pictures_within_a_scene_come_back_bit_for_bit() {
    let shared = std::env::var_os("DURER_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    let folder = shared.join("assets/gltf");
    if !folder.is_dir() {
        eprintln!("SKIPPED: {} is not there; set DURER_SHARED to run this test", folder.display());
        return;
    }
    for (name, pictures) in [
        ("AnisotropyStrengthTest", 1),
        ("AttenuationTest", 3),
        ("CesiumMan", 1),
        ("ClearCoatTest", 6),
        ("EmissiveStrengthTest", 1),
        ("Fox", 1),
        ("InterpolationTest", 1),
        ("IridescenceSuzanne", 1),
        ("MultiUVTest", 2),
        ("NegativeScaleTest", 2),
        ("TextureCoordinateTest", 1),
        ("TextureSettingsTest", 3),
        ("TransmissionRoughnessTest", 5),
    ] {
        let saved = comes_back(&folder.join(format!("{name}.glb")), "pbrt");
        let found = saved.names.iter().filter(|n| n.ends_with(".png") || n.ends_with(".jpg")).count();
        assert!((1..=pictures).contains(&found), "{name}: {:?}", saved.names);
    }
}

#[test]
fn pictures_in_addresses_come_back_with_their_changes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("leaf.gltf");
    fs::write(&file, include_str!("scenes/leaf-with-picture.gltf")).expect("written");
    let saved = comes_back(&file, "pbrt");
    assert_eq!(saved.names, ["leaf.pbrt", "leaf-files/image-0.png"]);

    let live = serve(file.to_str().expect("text"), small());
    let mut page = Client::new(&live);
    page.say(&json!({ "type": "set", "form": "film", "param": "width", "value": 31 }));
    page.frame_when(|h| h["film"] == json!([31, 36]) && h["done"] == true);
    let changed = self::saved(&live, &page, "pbrt", "leaf");
    assert_eq!(film(&changed.scene, &Options::default()).len(), 31 * 36);
}

/// A picture of four pixels.
fn picture(red: u8) -> Vec<u8> {
    let pixels = [red, 10, 20, 200, 220, red, 30, red, 250, 90, 80, 70];
    durer::image::encode_png(2, 2, &pixels, durer::image::Packing::Quick).expect("a picture")
}

#[test]
fn all_files_of_a_scene_go_along_and_no_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("textures/more")).expect("made");
    fs::write(at("textures/wood 1.png"), picture(255)).expect("written");
    fs::write(at("textures/more/Wood 1.PNG"), picture(0)).expect("written");
    fs::write(at("green.spd"), "400 0.1\n550 0.9\n700 0.2\n").expect("written");
    fs::write(at("secret.txt"), "not of the scene").expect("written");
    fs::write(at("inner.pbrt"), "Material \"diffuse\" \"texture reflectance\" \"b\"\nShape \"sphere\"\n")
        .expect("written");
    let text = "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n\
                Film \"rgb\" \"string filename\" \"secret.txt\"\nWorldBegin\nLightSource \"infinite\"\n\
                Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"textures/wood 1.png\"\n\
                Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"textures/x/../more/Wood 1.PNG\"\n\
                Include \"inner.pbrt\"\nTranslate 1 1 0\nMaterial \"diffuse\" \"texture reflectance\" \"a\"\n\
                Shape \"sphere\" \"string name\" \"secret.txt\"\nTranslate -2 0 0\n\
                Material \"diffuse\" \"spectrum reflectance\" \"green.spd\"\nShape \"sphere\"\n";
    fs::write(at("room.pbrt"), text).expect("written");
    fs::create_dir_all(at("textures/x")).expect("made");
    let saved = comes_back(&at("room.pbrt"), "zip");
    let mut names = saved.names.clone();
    names.sort();
    let expected = ["room-files/Wood-1-2.PNG", "room-files/green.spd", "room-files/wood-1.png", "room.pbrt"];
    assert_eq!(names, expected);
    let text = fs::read_to_string(saved.folder.path().join("room.pbrt")).expect("text");
    assert!(!text.contains("belongs there"), "{text}");

    // Alone it stays beside what it needs.
    let live = serve(at("room.pbrt").to_str().expect("text"), small());
    let page = Client::new(&live);
    let path = format!("/save?token={}&session={}&format=pbrt", token(&live), page.session());
    let (code, _, text) = get(&live, &path);
    let text = String::from_utf8(text).expect("text");
    assert!(
        code == 200 && text.contains("\"textures/wood 1.png\"") && text.contains("belongs there"),
        "{text}"
    );
}
