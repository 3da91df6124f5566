//! Measured materials, from file to picture: files are made here of materials that durer has, and look like those.
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use std::path::Path;

use durer::{Imported, Options, scene::Severity, spectrum::Carried};
use durer_testkit::{
    DVec3,
    measured::{self, Brushed, Grid, Known, azimuths, fields, file},
    random::Random,
};
use durer_tests::{prepared, render};

/// What the metal reflects in red, green and blue.
const METAL: [f64; 3] = [0.9, 0.6, 0.3];

/// Metal of facets of these widths.
fn metal(facets: Brushed) -> Vec<u8> {
    let value = |o: DVec3, i: DVec3, c: f64| METAL[c as usize] * facets.value(o, i);
    let is_round = facets.0 == facets.1;
    let grid = Grid {
        azimuths: if is_round { vec![0.0] } else { azimuths(7, 4.0) },
        elevations: 16,
        normals: [64, if is_round { 33 } else { 65 }],
        colours: 33,
        wavelengths: Vec::new(),
    };
    file(&fields(Known { normals: &|m| facets.normals(m), value: &value }, &grid))
}

/// A matte body whose share of light rises with wavelength.
fn matte() -> Vec<u8> {
    let known = Known {
        normals: &|m| Brushed(0.5, 0.5).normals(m),
        value: &|_, _, nm| (nm - 360.0) / 600.0 / std::f64::consts::PI,
    };
    let wavelengths = (0..25).map(|i| 360.0 + 20.0 * f64::from(i)).collect();
    let grid = Grid { azimuths: vec![0.0], elevations: 10, normals: [64, 33], colours: 33, wavelengths };
    file(&fields(known, &grid))
}

/// The scene of a text in a folder.
fn opened(folder: &Path, name: &str, text: &str) -> Imported {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    durer::open(&path.display().to_string())
}

fn colours(imported: Imported, options: &Options) -> Vec<[f32; 3]> {
    let prepared = prepared(imported, options);
    render(&prepared).film.pixels().iter().map(|pixel| pixel.mean()).collect()
}

/// A ball and a floor of a material, in light from above and from around.
fn ball(integrator: &str, material: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\nLookAt 0 2 -5  0 0.6 0  0 1 0\n\
         Camera \"perspective\" \"float fov\" 35\nIntegrator \"{integrator}\"\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [0.3 0.4 0.5]\n\
         LightSource \"point\" \"rgb I\" [20 18 16] \"point3 from\" [2 4 -3]\n{material}\n\
         AttributeBegin Translate 0 1 0 Shape \"sphere\" \"float radius\" 1 AttributeEnd\n\
         Shape \"bilinearmesh\" \"point3 P\" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]\n"
    )
}

/// Mean difference of two pictures by what they are.
fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    let pairs = || a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    assert!(a.len() == b.len() && pairs().all(|(a, b)| a.is_finite() && b.is_finite()));
    pairs().map(|(a, b)| (a - b).abs()).sum::<f64>() / pairs().map(|(_, b)| b).sum::<f64>()
}

fn many(samples: u32) -> Options {
    Options { samples: Some(samples), ..Options::default() }
}

#[test]
fn metal_that_was_measured_looks_like_the_metal() {
    let folder = tempfile::tempdir().expect("a folder");
    for (alpha, is_close) in [((0.35, 0.35), 0.01), ((0.5, 0.25), 0.02)] {
        std::fs::write(folder.path().join("metal.bsdf"), metal(Brushed(alpha.0, alpha.1))).expect("written");
        let own = format!(
            "Material \"mirror\" \"rgb reflectance\" {METAL:?} \"float uroughness\" {} \"float vroughness\" {} \
             \"bool remaproughness\" false",
            alpha.0, alpha.1
        )
        .replace(',', "");
        let read = "Material \"measured\" \"string filename\" \"metal.bsdf\"";
        let picture = |material: &str| {
            let text = ball("path", material);
            colours(opened(folder.path(), "ball.pbrt", &text), &many(256))
        };
        let off = difference(&picture(read), &picture(&own));
        assert!(off < is_close, "{alpha:?}: {off}");
    }
}

#[test]
fn wavelengths_are_those_that_rays_carry_and_colours_else() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("matte.bsdf"), matte()).expect("written");
    let own = "Material \"diffuse\" \"spectrum reflectance\" [360 0 840 0.8]";
    let read = "Material \"measured\" \"string filename\" \"matte.bsdf\"";
    for carried in [Carried::Rgb, Carried::Wavelengths] {
        let options = Options { carried: Some(carried), ..many(256) };
        let picture =
            |material: &str| colours(opened(folder.path(), "ball.pbrt", &ball("path", material)), &options);
        let off = difference(&picture(read), &picture(own));
        assert!(off < 0.012, "{carried:?}: {off}");
    }
}

#[test]
fn every_integrator_shows_it_about_as_bright() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("matte.bsdf"), matte()).expect("written");
    let mean = |integrator: &str| {
        let text = ball(integrator, "Material \"measured\" \"string filename\" \"matte.bsdf\"");
        let all = colours(opened(folder.path(), "ball.pbrt", &text), &many(64));
        assert!(all.iter().flatten().all(|v| v.is_finite()), "{integrator}");
        all.iter().flatten().sum::<f32>() / (3 * all.len()) as f32
    };
    let path = mean("path");
    for (integrator, within) in [("volpath", 0.02), ("bdpt", 0.03), ("distributed", 0.1), ("whitted", 0.3)] {
        let found = mean(integrator);
        assert!((found - path).abs() < within * path, "{integrator}: {found}, path {path}");
    }
}

#[test]
fn mitsubas_measured_material_is_black_from_behind_unless_it_has_two_sides() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("paint.bsdf"), measured::paint()).expect("written");
    let picture = |bsdf: &str, turn: u32| {
        let text = format!(
            "<scene version='3.0.0'><integrator type='path'/><sensor type='perspective'><film type='hdrfilm'>\
             <integer name='width' value='4'/><integer name='height' value='4'/></film>\
             <transform name='to_world'><lookat origin='0,0,3' target='0,0,0' up='0,1,0'/></transform>\
             <float name='fov' value='10'/></sensor><emitter type='constant'/>\
             <shape type='rectangle'><transform name='to_world'><rotate y='1' angle='{turn}'/></transform>{bsdf}\
             </shape></scene>"
        );
        let all = colours(opened(folder.path(), "scene.xml", &text), &many(256));
        all.iter().flatten().sum::<f32>() / (3 * all.len()) as f32
    };
    let plain = "<bsdf type='measured'><string name='filename' value='paint.bsdf'/></bsdf>";
    let both = format!("<bsdf type='twosided'>{plain}</bsdf>");
    let seen = [picture(plain, 0), picture(plain, 180), picture(&both, 0), picture(&both, 180)];
    assert_eq!(seen[1], 0.0, "{seen:?}");
    for value in [seen[0], seen[2], seen[3]] {
        // So coarse a file is not very matte.
        assert!((value - 0.5).abs() < 0.08, "{seen:?}");
    }
}

#[test]
fn what_is_wrong_with_a_file_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let sound = measured::brushed_paint();
    let said = |bytes: &[u8]| {
        std::fs::write(folder.path().join("a.bsdf"), bytes).expect("written");
        let text = "WorldBegin\nMaterial \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n";
        let mut imported = opened(folder.path(), "a.pbrt", text);
        let built = durer::prepare(&mut imported, &Options::default()).is_some();
        let errors = imported.diagnostics.iter().filter(|d| d.severity == Severity::Error);
        let errors: Vec<String> = errors.map(|d| d.message.clone()).collect();
        assert_eq!(built, errors.is_empty(), "{errors:?}");
        errors.join("; ")
    };
    assert_eq!(said(&sound), "");
    for end in (0..sound.len()).step_by(if sound.len() > 4000 { 131 } else { 7 }) {
        assert!(said(&sound[..end]).starts_with("a.bsdf: "), "{end}: {}", said(&sound[..end]));
    }
    assert!(said(b"PK\x03\x04").contains("not a tensor file"));
    let with = |at: usize, byte: u8| {
        let mut bytes = sound.clone();
        bytes[at] = byte;
        said(&bytes)
    };
    assert!(with(12, 2).contains("version 2.0"));
    assert!(with(17, 9).contains("expected at most 1000"));
    // The first field is "description": its axes, its type, its place.
    assert!(with(32, 200).contains("axes"), "{}", with(32, 200));
    assert!(with(33, 77).contains("unknown type (77)"), "{}", with(33, 77));
    assert!(with(41, 77).contains("does not lie in the file"), "{}", with(41, 77));
    let missing = opened(
        folder.path(),
        "b.pbrt",
        "WorldBegin\nMaterial \"measured\" \"string filenam\" \"a.bsdf\"\nShape \"sphere\"\n",
    );
    let mut missing = missing;
    assert!(durer::prepare(&mut missing, &Options::default()).is_none());
    assert!(
        format!("{:?}", missing.diagnostics).contains("did you mean \\\"filename\\\""),
        "{:?}",
        missing.diagnostics
    );
}

#[test]
fn damaged_files_end_with_a_picture_or_a_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut random = Random::new(52);
    let text = "Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2\nLookAt 0 0 -3 0 0 0 0 1 0\n\
                Camera \"perspective\" Integrator \"path\" WorldBegin LightSource \"infinite\"\n\
                Material \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\"\n";
    let (mut refused, mut seen) = (0, 0);
    for sound in [measured::paint(), measured::brushed_paint()] {
        for round in 0..400 {
            let mut bytes = sound.clone();
            // Most of the damage to what is told of the fields, where it does most.
            let end = if round % 2 == 0 { 400 } else { bytes.len() };
            for _ in 0..=round % 3 {
                let at = (random.unit() * end as f64) as usize;
                bytes[at] = (random.unit() * 256.0) as u8;
            }
            std::fs::write(folder.path().join("a.bsdf"), bytes).expect("written");
            let mut imported = opened(folder.path(), "a.pbrt", text);
            match durer::prepare(&mut imported, &many(2)) {
                Some(prepared) => {
                    render(&prepared);
                    seen += 1;
                }
                None => {
                    assert!(imported.diagnostics.iter().any(|d| d.message.starts_with("a.bsdf: ")));
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 100 && seen > 100, "{refused} {seen}");
}

/// What fuzzing begins with is what the formulas say.
#[test]
fn seeds_of_fuzzing_are_files_that_are_read() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/seeds/bsdf");
    for (name, bytes) in [("paint.bsdf", measured::paint()), ("brushed.bsdf", measured::brushed_paint())] {
        if std::env::var_os("DURER_BLESS").is_some() {
            std::fs::create_dir_all(&seeds).expect("a folder");
            std::fs::write(seeds.join(name), &bytes).expect("written");
        }
        assert!(
            std::fs::read(seeds.join(name)).expect("a seed") == bytes,
            "DURER_BLESS=1 writes {name} anew"
        );
    }
}
