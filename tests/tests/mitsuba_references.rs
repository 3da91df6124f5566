//! Mitsuba's own test scenes against Mitsuba's own pictures, by the test that Mitsuba makes (its `test_renders.py`).
//!
//! Each picture comes with the variance of a sample in each pixel. Of `n` samples, in CIE XYZ,
//! `z = |ours - reference| sqrt(n / max(variance, 1e-4))` is normal where both agree; its two-sided probability must exceed
//! `1 - (1 - 0.01)^(1 / pixels)` (Sidak) for 99.75 % of all numbers.
//!
//! `DURER_SLOW=1` compares all scenes, with as many samples as Mitsuba takes.
use std::path::{Path, PathBuf};

use durer::{Options, image, prepare, spectrum::Carried};
use durer_tests::shared;

/// Samples of all pixels together, as Mitsuba has it; `DURER_SAMPLES` says otherwise.
const BUDGET: u32 = 2_000_000;
/// For those that are always compared.
const SMALL_BUDGET: u32 = 200_000;

/// Linear Rec. 709 to CIE XYZ.
const XYZ: [[f64; 3]; 3] =
    [[0.412_453, 0.357_580, 0.180_423], [0.212_671, 0.715_160, 0.072_169], [0.019_334, 0.119_193, 0.950_227]];

/// The share of all numbers that agree where the pictures do.
const AGREEING: f64 = 0.9975;
/// Those that are compared.
const SCENES: &[&str] = &[
    "bsdf_spheres/test_arealight_path",
    "bsdf_spheres/test_constant_path",
    "bsdf_spheres/test_envmap_path",
    "bsdf_spheres/test_normalmap_identity_roughconductor_path",
    "bsdf_spheres/test_pointlight_path",
    "bsdf_spheres/test_roughdielectric_path",
    "bsdf_spheres/test_roughplastic_linear_path",
    "bsdf_spheres/test_roughplastic_nonlinear_path",
    "bsdf_spheres/test_textured_diffuse_path",
    "bsdf_spheres/test_textured_roughconductor_path",
    "bsdf_spheres/test_texturedprincipled1_path",
    "bsdf_spheres/test_texturedprincipled2_path",
    "bsdf_spheres/test_texturedprincipledthin_path",
    "floating_sphere/test_directional_direct",
    "instancing/test_instancing_path",
    "mesh_attributes/test_mesh_attributes_1_face_direct",
    "mesh_attributes/test_mesh_attributes_3_face_direct",
    "mesh_attributes/test_mesh_attributes_3_vertex_direct",
    "participating_media/test_hetero_sigmat_albedo_volpath",
    "participating_media/test_hetero_sigmat_volpath",
    "participating_media/test_hetero_spectral_sigmat_no_scattering_volpath",
    "participating_media/test_hetero_spectral_sigmat_volpathmis",
    "participating_media/test_homo_area_light_volpath",
    "participating_media/test_homo_dielectric_envmap_volpath",
    "participating_media/test_homo_emitter_inside_medium_volpath",
    "participating_media/test_homo_null_envmap_volpath",
    "participating_media/test_homo_obj_inside_medium_volpath",
    "participating_media/test_homo_roughdielectric_spot_volpath",
    "participating_media/test_homo_spectral_sigmat_volpathmis",
    "participating_media/test_surf_area_light_volpath",
    "spot_light/test_spot_direct",
];

struct Picture {
    size: [u32; 2],
    pixels: Vec<[f64; 3]>,
}

fn xyz(rgb: [f64; 3]) -> [f64; 3] {
    XYZ.map(|row| row.iter().zip(rgb).map(|(w, v)| w * v).sum())
}

fn read(path: &Path) -> Picture {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{name}: {e}"));
    let picture = image::read(&bytes, &name, Default::default()).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    let durer::scene::ImageData::F32(data) = &picture.data else { panic!("{name}: not in floats") };
    let pixels = data.chunks(picture.channels as usize).map(|p| [p[0], p[1], p[2]].map(f64::from)).collect();
    Picture { size: [picture.width, picture.height], pixels }
}

/// The share of numbers that agree, and how much brighter ours is.
struct Comparison {
    agreeing: f64,
    brighter: f64,
}

/// The share of a normal distribution beyond `z` on both sides.
fn probability(z: f64) -> f64 {
    libm::erfc(z / std::f64::consts::SQRT_2)
}

fn compare(ours: &[[f64; 3]], reference: &Picture, variance: &Picture, samples: u32) -> Comparison {
    let pixels = ours.len() as f64;
    let alpha = 1.0 - (1.0f64 - 0.01).powf(1.0 / pixels);
    let (mut agreeing, mut light) = (0usize, [0.0; 2]);
    for ((ours, reference), variance) in ours.iter().zip(&reference.pixels).zip(&variance.pixels) {
        let (ours, reference, variance) = (xyz(*ours), xyz(*reference), xyz(*variance));
        for c in 0..3 {
            let sigma = (variance[c].max(1e-4) / f64::from(samples)).sqrt();
            agreeing += usize::from(probability((ours[c] - reference[c]).abs() / sigma) > alpha);
        }
        light = [light[0] + ours[1], light[1] + reference[1]];
    }
    Comparison { agreeing: agreeing as f64 / (3.0 * pixels), brighter: light[0] / light[1] - 1.0 }
}

/// Renders a scene and compares it with its reference in colours or wavelengths.
fn compared(folder: &Path, scene: &str, carried: Carried, budget: u32) -> Comparison {
    let file = folder.join(format!("tests/scenes/{scene}.xml"));
    let (group, name) = scene.split_once('/').expect("a folder");
    let stem = name.rsplit_once('_').expect("an integrator").0;
    let mode = if carried == Carried::Rgb { "rgb" } else { "spectral" };
    let refs = folder.join(format!("tests/scenes/{group}/refs"));
    let reference = read(&refs.join(format!("{stem}_ref_{mode}.exr")));
    let variance = read(&refs.join(format!("{stem}_ref_{mode}_var.exr")));
    let [width, height] = reference.size;
    let samples = budget / (width * height);
    let options = Options {
        samples: Some(samples),
        root: Some(folder.to_owned()),
        carried: Some(carried),
        // Less noise than the variance says, of which differences stand out all the more.
        sampler: Some(durer::sampling::SamplerKind::ZSobol),
        ..Options::default()
    };
    let mut imported = durer::open_for(&file.to_string_lossy(), &options);
    let prepared = prepare(&mut imported, &options).unwrap_or_else(|| panic!("{:#?}", imported.diagnostics));
    let film = durer_tests::render(&prepared).film;
    let ours: Vec<[f64; 3]> = film.pixels().iter().map(|p| p.mean().map(f64::from)).collect();
    assert_eq!(ours.len(), reference.pixels.len(), "{scene}: of another size");
    if let Some(out) = std::env::var_os("DURER_PICTURES") {
        write(&PathBuf::from(out), &scene.replace('/', "_"), width as usize, &ours, &reference.pixels);
    }
    compare(&ours, &reference, &variance, samples)
}

/// Ours beside the reference, for those who want to look.
fn write(folder: &Path, name: &str, width: usize, ours: &[[f64; 3]], reference: &[[f64; 3]]) {
    const ZOOM: usize = 6;
    let shown = |v: f64| (v.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8;
    let height = ours.len() / width;
    let mut text = format!("P6 {} {} 255\n", 3 * width * ZOOM, height * ZOOM).into_bytes();
    for y in 0..height * ZOOM {
        for x in 0..3 * width * ZOOM {
            let (part, x, y) = (x / (width * ZOOM), x / ZOOM % width, y / ZOOM);
            let (a, b) = (ours[y * width + x], reference[y * width + x]);
            let pixel = match part {
                0 => a,
                1 => b,
                _ => [0, 1, 2].map(|c| 0.5 + 4.0 * (a[c] - b[c])),
            };
            text.extend(pixel.map(shown));
        }
    }
    std::fs::write(folder.join(format!("{name}.ppm")), text).expect("a folder that can be written");
}

fn check(test: &str, scenes: &[&str], carried: Carried, budget: u32) {
    let Some(folder) = shared(test) else { return };
    let folder = folder.join("assets/mitsuba");
    let only = std::env::var("DURER_SCENE").unwrap_or_default();
    let mut wrong = Vec::new();
    for scene in scenes.iter().filter(|scene| scene.contains(&only)) {
        let found = compared(&folder, scene, carried, budget);
        let line = format!("{scene}: {:.5} agree, {:+.2} % brighter", found.agreeing, 100.0 * found.brighter);
        println!("{line}");
        if found.agreeing < AGREEING {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn some_test_scenes_of_mitsuba_look_as_they_do_there() {
    let quick = ["floating_sphere", "3_vertex", "instancing", "spot_light"];
    let scenes: Vec<_> =
        SCENES.iter().filter(|name| quick.iter().any(|q| name.contains(q))).copied().collect();
    assert_eq!(scenes.len(), quick.len());
    check("some_test_scenes_of_mitsuba_look_as_they_do_there", &scenes, Carried::Rgb, SMALL_BUDGET);
}

#[test]
fn all_test_scenes_of_mitsuba_look_as_they_do_there() {
    if std::env::var_os("DURER_SLOW").is_none() {
        eprintln!("SKIPPED: all_test_scenes_of_mitsuba_look_as_they_do_there: set DURER_SLOW=1");
        return;
    }
    let asked = std::env::var("DURER_SAMPLES").ok().and_then(|n| n.parse().ok());
    let budget = asked.unwrap_or(BUDGET);
    check("all_test_scenes_of_mitsuba_look_as_they_do_there", SCENES, Carried::Rgb, budget);
}
