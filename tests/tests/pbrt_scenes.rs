//! The pbrt scenes of others, from file to what can be rendered.
use std::path::{Path, PathBuf};

use durer::{Options, accel::Engine, prepare, scene::Severity};
use durer_tests::{bits, import, render, shared};

fn pbrt_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten().map(|e| e.path());
    let mut found: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { pbrt_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "pbrt"))
        .collect();
    found.sort();
    found
}

#[test]
fn every_shared_pbrt_scene_is_compiled() {
    let Some(folder) = shared("every_shared_pbrt_scene_is_compiled") else { return };
    let mut compiled = 0;
    for file in pbrt_files(&folder.join("assets/pbrt")) {
        // The others are parts, to be included.
        if !std::fs::read_to_string(&file).is_ok_and(|text| text.contains("WorldBegin")) {
            continue;
        }
        let mut imported = durer::open(&file.to_string_lossy());
        let prepared = prepare(
            &mut imported,
            &Options { width: Some(16), height: Some(16), engine: Engine::BruteForce, ..Options::default() },
        );
        let errors = imported.diagnostics.iter().filter(|d| d.severity == Severity::Error);
        let errors: Vec<_> = errors.map(|d| d.message.as_str()).collect();
        // Image lights are the only thing a scene may wait for.
        let waits = |e: &&str| e.contains("image environment maps are not supported yet");
        assert!(errors.iter().all(waits), "{}: {errors:?}", file.display());
        assert_eq!(prepared.is_some(), errors.is_empty());
        compiled += usize::from(prepared.is_some());
        // What is left out is said, but no shape of these scenes is.
        assert!(
            !imported.diagnostics.iter().any(|d| d.message.contains("is left out")),
            "{}",
            file.display()
        );
    }
    assert!(compiled > 10, "{compiled}");
}

/// Kinds and parameters of pbrt-v4 (pbrt.org/fileformat-v4): what we have and what we only know.
const EVERYTHING: &str = r#"
Option "bool disablepixeljitter" true
Option "integer seed" 3
ColorSpace "srgb"
Camera "perspective" "float fov" 39 "float frameaspectratio" 1 "float screenwindow" [-1 1 -1 1] "float lensradius" 0 "float focaldistance" 5 "float shutteropen" 0 "float shutterclose" 1
Film "rgb" "integer xresolution" 20 "integer yresolution" 20 "string filename" "a.exr" "float diagonal" 35 "bool savefp16" true
Sampler "zsobol" "integer pixelsamples" 4 "string randomization" "fastowen" "integer seed" 3
PixelFilter "gaussian" "float xradius" 1.5 "float yradius" 1.5 "float sigma" 0.5
Integrator "path" "integer maxdepth" 5 "string lightsampler" "bvh" "bool regularize" false
Accelerator "bvh" "integer maxnodeprims" 4 "string splitmethod" "sah"
WorldBegin
LightSource "point" "spectrum I" "stdillum-A" "float scale" 2 "float power" 3 "point3 from" [0 3 0]
LightSource "spot" "blackbody I" 3000 "point3 from" [0 3 0] "point3 to" [0 0 0] "float coneangle" 30 "float conedeltaangle" 5 "float power" 5
LightSource "distant" "rgb L" [1 1 1] "point3 from" [0 0 0] "point3 to" [0 0 1] "float illuminance" 3
LightSource "infinite" "rgb L" [1 1 1] "float scale" 1 "float illuminance" 3
Texture "f" "float" "constant" "float value" 0.5
Texture "c" "spectrum" "constant" "rgb value" [.5 .5 .5]
Texture "sc" "spectrum" "scale" "texture tex" "c" "texture scale" "f"
Texture "sf" "float" "scale" "texture tex" "f" "float scale" 2
Texture "m" "spectrum" "mix" "texture tex1" "c" "rgb tex2" [1 0 0] "texture amount" "f"
Texture "b" "float" "bilerp" "float v00" 1
Texture "ch" "spectrum" "checkerboard" "integer dimension" 2 "texture tex1" "c" "float uscale" 2 "float vscale" 2
Material "diffuse" "texture reflectance" "sc" "texture displacement" "f" "string normalmap" ""
Shape "sphere" "float radius" 1 "float zmin" -1 "float zmax" 1 "float phimax" 300 "float alpha" 0.5
Material "coateddiffuse" "spectrum reflectance" [400 .5 700 .5] "float roughness" 0.1 "float thickness" 0.01 "float eta" 1.5 "float g" 0 "rgb albedo" [0 0 0] "integer maxdepth" 10 "integer nsamples" 1 "bool remaproughness" true
Shape "disk" "texture alpha" "f"
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float uroughness" 0.1 "float vroughness" 0.1
Shape "cylinder" "float radius" 1
Material "dielectric" "spectrum eta" "glass-BK7" "float roughness" 0
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 1 0 0 1 0 0 1] "vector3 S" [1 0 0 1 0 0 1 0 0] "point2 uv" [0 0 1 0 0 1] "integer indices" [0 1 2] "integer faceIndices" [0]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [1 1 1]
MediumInterface "fog" ""
AttributeBegin AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true "float power" 4 "float scale" 1 Shape "disk" AttributeEnd
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] "normal N" [0 0 1 0 0 1 0 0 1 0 0 1] "point2 uv" [0 0 1 0 0 1 1 1]
Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "integer levels" 1 "string scheme" "loop"
"#;

#[test]
fn every_word_of_pbrt_is_known() {
    let mut imported = import(EVERYTHING);
    let prepared = prepare(&mut imported, &Options::default());
    let said = |severity: Severity| -> Vec<String> {
        let of = imported.diagnostics.iter().filter(|d| d.severity == severity);
        of.map(|d| d.message.clone()).collect()
    };
    assert_eq!(said(Severity::Error), Vec::<String>::new());
    assert!(prepared.is_some());
    // Nothing that is left out goes unsaid, and nothing is said twice.
    let mut warnings = said(Severity::Warning);
    assert!(warnings.iter().any(|w| w.contains("the medium \"fog\"")), "{warnings:?}");
    let all = warnings.len();
    warnings.sort();
    warnings.dedup();
    assert_eq!(warnings.len(), all, "{warnings:?}");
}

/// What a film and a sampler say reaches the picture, unless options say otherwise.
#[test]
fn crops_seeds_and_exposures_of_files_are_followed() {
    let of = |film: &str, sampler: &str, options: &Options| {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 {film}\n\
             Sampler \"zsobol\" \"integer pixelsamples\" 2 {sampler}\nCamera \"perspective\"\nWorldBegin\n\
             LightSource \"gradientsky\" Translate 0 0 3 Shape \"sphere\""
        );
        let prepared = prepare(&mut import(&text), options).expect("sound");
        let all: Vec<u32> = bits(&render(&prepared)).into_iter().flatten().collect();
        (prepared.window(), all)
    };
    let usual = Options::default();
    let (whole, plain) = of("", "", &usual);
    assert_eq!((whole.x0, whole.x1, whole.y0, whole.y1), (0, 8, 0, 6));
    let (part, _) = of("\"float cropwindow\" [0.25 0.5 0 0.5]", "", &usual);
    assert_eq!((part.x0, part.x1, part.y0, part.y1), (2, 4, 0, 3));
    let bounds = "\"integer pixelbounds\" [1 5 2 6]";
    let (part, _) = of(bounds, "", &usual);
    assert_eq!((part.x0, part.x1, part.y0, part.y1), (1, 5, 2, 6));
    assert_eq!(of(bounds, "", &Options { crop: Some(whole), ..usual.clone() }).0, whole);
    let seed = "\"integer seed\" 7";
    let seeded = of("", seed, &usual).1;
    assert_ne!(seeded, plain);
    assert_eq!(seeded, of("", "", &Options { seed: Some(7), ..usual.clone() }).1);
    assert_eq!(plain, of("", seed, &Options { seed: Some(0), ..usual.clone() }).1);
    let twice = of("\"float exposuretime\" 2", "", &usual).1;
    let doubled: Vec<u32> = plain.iter().map(|bits| (2.0 * f32::from_bits(*bits)).to_bits()).collect();
    assert_eq!(twice, doubled);
}
