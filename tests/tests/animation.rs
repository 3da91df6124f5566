//! Animated files as pictures: slices of time add up to the blurred picture, and frames have the same bits alone and in
//! sequence.
use std::path::Path;

use durer::{
    Imported, Options, Prepared, Sequence, Show, import::Play, math::Interval, open_for, prepare,
    scene::ShapeSource,
};
use durer_tests::{bits, render, shared};

fn options(play: &str, time: f32) -> Options {
    Options {
        play: Play::Named(play.to_owned()),
        time,
        width: Some(48),
        height: Some(48),
        samples: Some(4),
        integrator: Some("cast".to_owned()),
        show: Some(Show::Shading),
        ..Options::default()
    }
}

fn taken(file: &Path, options: &Options) -> Prepared {
    let mut imported = open_for(&file.to_string_lossy(), options);
    prepare(&mut imported, options).unwrap_or_else(|| panic!("{:#?}", imported.diagnostics))
}

fn values(prepared: &Prepared) -> Vec<f64> {
    render(prepared).film.pixels().iter().map(|p| f64::from(p.mean()[0])).collect()
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn slices_of_a_skinned_and_of_a_morphed_mesh_add_up_to_the_blurred_picture_f8() {
    let Some(shared) = shared("slices of animated meshes") else { return };
    // Without textures, whose filters depend on the number of samples.
    for (name, start, length) in [("RiggedSimple.glb", 0.5, 0.8), ("AnimatedMorphCube.glb", 1.0, 1.0)] {
        const SLICES: u32 = 32;
        let file = shared.join("assets/gltf").join(name);
        let of = |time: f32, shutter: Interval, samples: u32, seed: u64| {
            let base = options("0", time);
            let show = Some(Show::Albedo);
            values(&taken(
                &file,
                &Options { shutter: Some(shutter), samples: Some(samples), seed: Some(seed), show, ..base },
            ))
        };
        let sliced = |from: f32, length: f32| {
            let mut mean = vec![0.0; 48 * 48];
            for i in 0..SLICES {
                let time = from + length * (i as f32 + 0.5) / SLICES as f32;
                let slice = of(time, Interval::point(0.0), 4, i.into());
                mean.iter_mut().zip(slice).for_each(|(m, v)| *m += v / f64::from(SLICES));
            }
            mean
        };
        let blurred = of(start, Interval::new(0.0, length), 128, 99);
        let (off, other) =
            (rms(&blurred, &sliced(start, length)), rms(&blurred, &sliced(start, length * 0.2)));
        assert!(off < 0.008, "{name}: {off}");
        assert!(other > 5.0 * off, "{name}: {other} of another motion, {off}");
    }
}

/// The pictures of a sequence, and those of its frames alone.
fn compared(file: &Path, options: &Options, times: &[f32]) {
    let imported = open_for(&file.to_string_lossy(), &Options { time: times[0], ..options.clone() });
    let first = Options { time: times[0], ..options.clone() };
    let mut sequence = Sequence::new(imported, first);
    for &time in times {
        let frame = sequence.at(time).unwrap_or_else(|| panic!("{:#?}", sequence.imported.diagnostics));
        let alone = taken(file, &Options { time, ..options.clone() });
        assert!(bits(&render(&frame)) == bits(&render(&alone)), "{} at {time}", file.display());
    }
}

#[test]
fn frames_have_the_same_bits_alone_and_in_sequence_r1() {
    let Some(shared) = shared("frames of animated files") else { return };
    let folder = shared.join("assets/gltf");
    let blur = |play: &str| Options { shutter: Some(Interval::new(0.0, 0.04)), ..options(play, 0.0) };
    let times = [0.1, 0.14, 0.9, 0.2];
    for (name, options) in [
        ("CesiumMan.glb", options("0", 0.0)),
        ("CesiumMan.glb", blur("0")),
        ("Fox.glb", Options { integrator: Some("path".to_owned()), show: None, ..blur("Run") }),
        ("AnimatedMorphCube.glb", options("0", 0.0)),
        ("InterpolationTest.glb", options("all", 0.0)),
        ("InterpolationTest.glb", blur("all")),
        ("AnimatedTriangle/AnimatedTriangle.gltf", blur("0")),
    ] {
        compared(&folder.join(name), &options, &times);
    }
}

#[test]
fn frames_of_a_pbrt_file_have_the_same_bits_alone_and_in_sequence_r1() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("move.pbrt");
    let text = "LookAt 0 1 -6  0 0 0  0 1 0\n\
        ActiveTransform EndTime Translate 1 0.5 0 ActiveTransform All\n\
        Camera \"perspective\" \"float fov\" 40\nWorldBegin\n\
        LightSource \"distant\" \"point3 from\" [1 2 -3]\n\
        Shape \"sphere\"\n\
        AttributeBegin ActiveTransform EndTime Translate 0 1 0 ActiveTransform All\n\
        Translate 1.5 0 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n";
    std::fs::write(&file, text).expect("written");
    let base =
        Options { show: None, integrator: Some("path".into()), play: Play::First, ..options("0", 0.0) };
    compared(&file, &base, &[0.0, 0.25, 0.9]);
    compared(&file, &Options { shutter: Some(Interval::new(0.0, 0.2)), ..base }, &[0.25, 0.75]);
}

#[test]
fn what_rests_is_made_once() {
    let Some(shared) = shared("meshes kept between frames") else { return };
    let file = shared.join("assets/gltf/InterpolationTest.glb");
    let mut options = options("all", 0.1);
    let mut imported: Imported = open_for(&file.to_string_lossy(), &options);
    let meshes = imported.desc.meshes.clone();
    options.time = 0.6;
    imported.turn_to(options.moment());
    let same = meshes.iter().zip(&imported.desc.meshes).filter(|(a, b)| std::sync::Arc::ptr_eq(a, b)).count();
    assert!(same == meshes.len() && !meshes.is_empty(), "{same} of {}", meshes.len());
    let moved = imported.desc.shapes.iter().filter(|s| matches!(s.source, ShapeSource::Mesh(_))).count();
    assert!(imported.desc.apart.len() == 9 && moved > 9, "{:?} of {moved}", imported.desc.apart);
}
