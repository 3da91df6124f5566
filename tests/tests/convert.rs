//! `durer convert`: what was converted renders as the original does, and what a format has no words for is named.
use std::{
    fs,
    path::{Path, PathBuf},
};

use durer::{
    Options, Studio, ToWrite,
    export::{Content, Files},
    prepare,
};
use durer_tests::{bits, render, shared};

fn small() -> Options {
    Options { width: Some(40), height: Some(30), samples: Some(4), threads: Some(2), ..Options::default() }
}

fn opened(scene: &str, options: &Options) -> (Studio, durer::Prepared) {
    Studio::open(durer::open(scene), options)
        .unwrap_or_else(|imported| panic!("{scene}: {:?}", imported.diagnostics))
}

fn to_write<'a>(studio: &'a Studio, prepared: &'a durer::Prepared) -> ToWrite<'a> {
    let (desc, assets) = (&studio.imported.desc, &studio.imported.assets);
    ToWrite { desc, assets, options: &studio.options, camera: 0, prepared }
}

/// Writes a scene as .pbrt into a folder of its own; its path.
fn as_pbrt(scene: &str, options: &Options, folder: &Path) -> PathBuf {
    let (studio, prepared) = opened(scene, options);
    let written = to_write(&studio, &prepared)
        .pbrt(Files::All, "converted-files", &[])
        .unwrap_or_else(|why| panic!("{scene}: {why:?}"));
    fs::create_dir_all(folder.join("converted-files")).expect("made");
    for file in &written.beside {
        match &file.content {
            Content::Bytes(bytes) => fs::write(folder.join(&file.path), bytes).expect("written"),
            Content::Copy(from) => drop(fs::copy(from, folder.join(&file.path)).expect("copied")),
        }
    }
    let file = folder.join("converted.pbrt");
    fs::write(&file, written.text).expect("written");
    file
}

fn film(scene: &str, options: &Options) -> Vec<[u32; 3]> {
    let mut imported = durer::open(scene);
    let prepared =
        prepare(&mut imported, options).unwrap_or_else(|| panic!("{scene}: {:?}", imported.diagnostics));
    bits(&render(&prepared))
}

/// What a scene shows, and what became of it as .pbrt.
fn both(scene: &str) -> [Vec<[u32; 3]>; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let file = as_pbrt(scene, &small(), folder.path());
    let own = Options { threads: Some(2), ..Options::default() };
    let (here, there) = (film(scene, &small()), film(file.to_str().expect("text"), &own));
    assert_eq!(here.len(), there.len(), "{scene}");
    [here, there]
}

/// Pixels whose bits differ.
fn differing(scene: &str) -> usize {
    let [here, there] = both(scene);
    here.iter().zip(&there).filter(|(a, b)| a != b).count()
}

#[test]
fn every_builtin_scene_is_the_same_picture_as_pbrt() {
    for builtin in durer::builtin::SCENES {
        let desc = durer::open(builtin.name).desc;
        if desc.shapes.iter().any(|shape| shape.world_from_object.keys().len() > 2) {
            // Keys are written in single precision.
            let [here, there] = both(builtin.name);
            let (apart, ratio) = apart(&here, &there);
            assert!(apart < 0.01 && (ratio - 1.0).abs() < 0.002, "{}: {apart} {ratio}", builtin.name);
        } else {
            assert_eq!(differing(builtin.name), 0, "{}", builtin.name);
        }
    }
}

#[test]
fn scenes_of_every_format_are_the_same_picture_as_pbrt() {
    let Some(folder) = shared("scenes_of_every_format_are_the_same_picture_as_pbrt") else { return };
    for name in [
        "gltf/AlphaBlendModeTest.glb",
        "gltf/CesiumMan.glb",
        "gltf/ClearcoatWicker.glb",
        "gltf/LightsPunctualLamp/LightsPunctualLamp.gltf",
        "gltf/SimpleInstancing.glb",
        "gltf/TextureTransformMultiTest.glb",
        "gltf/VertexColorTest.glb",
        "obj/cornell_box/cornell_box.obj",
        "obj/spot/spot_triangulated.obj",
        "obj/suzanne.obj",
        "ply/trimesh/fuze.ply",
        "stl/teapot.stl",
        "pbrt/veach-mis/scene-v4.pbrt",
        "pbrt/cornell-box/scene-v4.pbrt",
    ] {
        let scene = folder.join("assets").join(name);
        if !scene.exists() {
            panic!("{name} is not among the assets");
        }
        assert_eq!(differing(scene.to_str().expect("text")), 0, "{name}");
    }
}

/// The mean of the absolute differences of two pictures, as a share of the mean of the first, and their means' ratio.
fn apart(a: &[[u32; 3]], b: &[[u32; 3]]) -> (f64, f64) {
    let number = |v: &u32| f64::from(f32::from_bits(*v)).min(4.0);
    let (a, b): (Vec<f64>, Vec<f64>) =
        (a.iter().flatten().map(number).collect(), b.iter().flatten().map(number).collect());
    let sum: f64 = a.iter().sum();
    let differences: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum();
    (differences / sum, b.iter().sum::<f64>() / sum)
}

/// Writes a scene as .glb; the picture of it, and what it warned of. The Khronos reader of another project must read it, too.
fn as_glb(scene: &str, options: &Options) -> (Vec<[u32; 3]>, Vec<String>) {
    let (studio, prepared) = opened(scene, options);
    let glb = to_write(&studio, &prepared).glb().unwrap_or_else(|why| panic!("{scene}: {why}"));
    let read = gltf::Gltf::from_slice_without_validation(&glb.bytes);
    let read = read.unwrap_or_else(|e| panic!("{scene}: {e}"));
    assert!(read.document.nodes().len() > 0, "{scene}");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("converted.glb");
    fs::write(&file, &glb.bytes).expect("written");
    let integrator = studio.imported.desc.integrator.as_ref().map(|node| node.kind.clone());
    (film(file.to_str().expect("text"), &Options { integrator, ..options.clone() }), glb.warnings)
}

/// What glTF has words for comes back; rounding of texture coordinates and of placements is all that may differ.
#[test]
fn models_of_gltf_are_the_same_picture_as_glb() {
    let Some(folder) = shared("models_of_gltf_are_the_same_picture_as_glb") else { return };
    for name in [
        "AlphaBlendModeTest.glb",
        "AnisotropyStrengthTest.glb",
        "AttenuationTest.glb",
        "CesiumMan.glb",
        "ClearCoatTest.glb",
        "EmissiveStrengthTest.glb",
        "Fox.glb",
        "IridescenceSuzanne.glb",
        "LightsPunctualLamp/LightsPunctualLamp.gltf",
        "MultiUVTest.glb",
        "SimpleInstancing.glb",
        "SpecularTest.glb",
        "TextureSettingsTest.glb",
        "TextureTransformMultiTest.glb",
        "TransmissionRoughnessTest.glb",
        "UnlitTest.glb",
        "VertexColorTest.glb",
    ] {
        let scene = folder.join("assets/gltf").join(name);
        let scene = scene.to_str().expect("text");
        let (there, warnings) = as_glb(scene, &small());
        let (apart, ratio) = apart(&film(scene, &small()), &there);
        eprintln!("{name}: {apart:.5} {ratio:.5} {warnings:?}");
        assert!(apart < 0.01 && (ratio - 1.0).abs() < 0.005, "{name}: {apart} {ratio} {warnings:?}");
    }
}

#[test]
fn meshes_of_other_formats_are_the_same_picture_as_glb() {
    let Some(folder) = shared("meshes_of_other_formats_are_the_same_picture_as_glb") else { return };
    for name in ["obj/suzanne.obj", "obj/spot/spot_triangulated.obj", "stl/teapot.stl"] {
        let scene = folder.join("assets").join(name);
        let scene = scene.to_str().expect("text");
        let (there, warnings) = as_glb(scene, &small());
        let (apart, ratio) = apart(&film(scene, &small()), &there);
        eprintln!("{name}: {apart:.5} {ratio:.5} {warnings:?}");
        assert!(apart < 0.03 && (ratio - 1.0).abs() < 0.01, "{name}: {apart} {ratio} {warnings:?}");
    }
}

/// A room in pbrt's left-handed world: the picture is not mirrored, colours, spots and glass are what they were.
const ROOM: &str = r#"
LookAt 0.5 1.5 -5  0 0.8 0  0 1 0
Camera "perspective" "float fov" 45
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "point" "point3 from" [ 2 3 -2 ] "rgb I" [ 9 8 7 ] "float scale" 2
AttributeBegin
  Translate -2 3 -2
  LightSource "spot" "rgb I" [ 0 6 20 ] "point3 from" [ 0 0 0 ] "point3 to" [ 0.8 -2.5 2 ] "float coneangle" 25
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "trianglemesh" "point3 P" [ -4 0 -4  4 0 -4  4 0 4  -4 0 4 ] "integer indices" [ 0 2 1 0 3 2 ]
AttributeBegin
  Translate -1.2 0.7 0
  Material "conductor" "rgb reflectance" [ 0.9 0.6 0.3 ] "float roughness" 0.2
  Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
  Translate 1.1 0 0.3
  Rotate 25 0 1 0
  Material "diffuse" "rgb reflectance" [ 0.1 0.6 0.2 ]
  Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0.5 1.6 0 ]
AttributeEnd
"#;

#[test]
fn a_room_of_pbrt_is_nearly_the_same_picture_as_glb() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.pbrt");
    fs::write(&file, ROOM).expect("written");
    let options = Options { samples: Some(64), max_depth: Some(4), ..small() };
    let scene = file.to_str().expect("text");
    let (there, warnings) = as_glb(scene, &options);
    let (apart, ratio) = apart(&film(scene, &options), &there);
    eprintln!("room: {apart:.5} {ratio:.5} {warnings:?}");
    // Noise of other random numbers, the rim of the spot, Schlick's rise of the metal.
    assert!(apart < 0.05 && (ratio - 1.0).abs() < 0.02, "{apart} {ratio} {warnings:?}");
    assert!(warnings.iter().any(|w| w.contains("curved")), "{warnings:?}");
}

#[test]
fn every_builtin_scene_can_be_written_as_glb() {
    for builtin in durer::builtin::SCENES {
        // Area lights are light of materials there, which paths see.
        let options = Options { integrator: Some("path".to_owned()), ..small() };
        let (there, warnings) = as_glb(builtin.name, &options);
        // What is left to light these two is so small that few paths meet it.
        let is_dim = ["caustic", "prism"].contains(&builtin.name);
        assert!(
            is_dim || there.iter().any(|p| *p != there[0]),
            "{}: an empty picture; {warnings:?}",
            builtin.name
        );
    }
}

#[test]
fn glass_keeps_how_it_disperses_as_glb() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("glass.pbrt");
    for (glass, eta, dispersion) in [
        ("\"dielectric\" \"spectrum eta\" \"glass-SF11\"", 1.7847, 20.0 / 25.68),
        ("\"dielectric\" \"float cauchy\" [1.5046 0.0042]", 1.5168, 0.3112),
        ("\"classic\" \"rgb transmission\" [1 1 1] \"float eta\" 1.6 \"float dispersion\" 0.5", 1.6, 0.5),
        (
            "\"principled\" \"float transmission\" 1 \"float thickness\" 1 \"float eta\" 1.6 \"float dispersion\" 2",
            1.6,
            2.0,
        ),
    ] {
        fs::write(&file, format!("WorldBegin Material {glass} Shape \"sphere\"")).expect("written");
        let (studio, prepared) = opened(file.to_str().expect("text"), &small());
        let glb = to_write(&studio, &prepared).glb().expect("written");
        let length = u32::from_le_bytes(glb.bytes[12..16].try_into().expect("four"));
        let document: serde_json::Value =
            serde_json::from_slice(&glb.bytes[20..20 + length as usize]).expect("a document");
        let said = |extension: &str, key: &str| {
            document["materials"][0]["extensions"][extension][key].as_f64().expect("a number")
        };
        assert!((said("KHR_materials_ior", "ior") - eta).abs() < 2e-4, "{glass}");
        let found = said("KHR_materials_dispersion", "dispersion");
        assert!((found / dispersion - 1.0).abs() < 3e-3, "{glass}: {found}");
    }
}

#[test]
fn what_gltf_has_no_words_for_is_named() {
    let (_, warnings) = as_glb("whitted", &small());
    let all = warnings.join("\n");
    for word in ["curved", "checks", "becomes glass", "becomes a mirror", "\"gradientsky\" is left out"] {
        assert!(all.contains(word), "{word}: {all}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("plane.pbrt");
    let plane = "Camera \"spherical\"\nWorldBegin\nLightSource \"infinite\"\n\
                 MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" \"mirror\"\n\
                 Material \"mix\" \"string materials\" [ \"a\" \"b\" ]\nShape \"plane\" \"string name\" \"ground\"\n";
    fs::write(&file, plane).expect("written");
    let (_, warnings) = as_glb(file.to_str().expect("text"), &small());
    let all = warnings.join("\n");
    for word in [
        "\"ground\" has no end",
        "\"spherical\" is left out",
        "\"mix\" becomes grey",
        "\"infinite\" is left out",
    ] {
        assert!(all.contains(word), "{word}: {all}");
    }
    let (_, warnings) = as_glb("cook", &small());
    assert!(warnings.iter().any(|w| w.contains("moves")), "{warnings:?}");
}
