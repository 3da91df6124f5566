//! Animated glTF files at moments and while the shutter is open, against another reader in double precision, against
//! closed forms, and what is said of animations that cannot be played.
mod assets_shared;
mod gltf_document;
mod gltf_oracle;

use std::path::Path;

use assets_shared::folder;
use durer_core::{glam::DVec3, math::Interval};
use durer_io::import::{Imported, Moment, Play, Reading, open};
use durer_scene::{SceneDesc, ShapeSource};
use gltf_oracle::Oracle;

/// Files with animations, and how many of them.
const FILES: [(&str, usize); 9] = [
    ("SimpleSkin/SimpleSkin.gltf", 1),
    ("SimpleMorph/SimpleMorph.gltf", 1),
    ("AnimatedTriangle/AnimatedTriangle.gltf", 1),
    ("AnimatedMorphCube.glb", 1),
    ("AnimatedMorphCube-Quantized/AnimatedMorphCube.gltf", 1),
    ("RiggedSimple.glb", 1),
    ("CesiumMan.glb", 1),
    ("Fox.glb", 3),
    ("InterpolationTest.glb", 9),
];

fn played(path: &Path, animation: usize, shutter: Interval) -> Imported {
    let play = Play::Named(animation.to_string());
    let moment = Moment { time: shutter.min, shutter };
    let imported = open(path, Reading { play, moment, ..Reading::default() });
    assert!(!imported.diagnostics.has_errors(), "{:#?}", imported.diagnostics);
    imported
}

/// The corners of all triangles in the world at a moment that the description knows.
fn corners(desc: &SceneDesc, time: f32) -> Vec<DVec3> {
    let mut all = Vec::new();
    for shape in &desc.shapes {
        let ShapeSource::Mesh(id) = &shape.source else { panic!("a mesh") };
        let (mesh, m) = (&desc.meshes[id.index()], shape.world_from_object.at(time.into()));
        for triangle in &mesh.indices {
            let points = mesh.corners(triangle.map(|i| i as usize), time);
            all.extend(points.map(|p| m.transform_point3(p.to_f64())));
        }
    }
    all
}

/// The largest distance between two lists of points, and between the points of the second and those of a third.
fn apart(a: &[DVec3], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (*a - DVec3::from(*b)).length()).fold(0.0, f64::max)
}

fn size(points: &[[f64; 3]]) -> f64 {
    points.iter().map(|p| DVec3::from(*p).length()).fold(0.0, f64::max)
}

/// For each animation of the corpus.
fn each(check: impl Fn(&Path, &Oracle, usize)) {
    let Some(folder) = folder("gltf") else { return };
    for (name, animations) in FILES {
        let path = folder.join(name);
        let oracle = Oracle::read(&path);
        assert_eq!(oracle.animations(), animations, "{name}");
        (0..animations).for_each(|animation| check(&path, &oracle, animation));
    }
}

#[test]
fn every_vertex_is_where_the_keys_put_it_at_any_moment() {
    each(|path, oracle, animation| {
        let (first, last) = oracle.span(animation);
        // Also before the first and after the last key, where it is held.
        for i in -1..=8 {
            let time = (first + (last - first) * f64::from(i) / 7.3) as f32;
            let found = corners(&played(path, animation, Interval::point(time)).desc, time);
            let expected = oracle.corners(animation, time.into());
            let (far, size) = (apart(&found, &expected), size(&expected));
            assert!(far <= 1e-5 * size, "{} {animation} at {time}: {far} of {size}", path.display());
        }
    });
}

#[test]
fn while_the_shutter_is_open_things_stray_from_their_way_by_a_250th_at_most() {
    each(|path, oracle, animation| {
        let (first, last) = oracle.span(animation);
        let length = (last - first).min(0.7);
        for start in [first, first + (last - first - length) * 0.6] {
            let shutter = Interval::new(start as f32, (start + length) as f32);
            let desc = played(path, animation, shutter).desc;
            let times: Vec<f32> = (0..=24).map(|i| shutter.at(i as f32 / 24.0)).collect();
            let ways: Vec<_> = times.iter().map(|t| oracle.corners(animation, (*t).into())).collect();
            let way = ways.iter().map(|w| {
                let from: Vec<DVec3> = ways[0].iter().map(|p| DVec3::from(*p)).collect();
                apart(&from, w)
            });
            let (way, size) = (way.fold(0.0, f64::max), size(&ways[0]));
            for (time, expected) in times.iter().zip(&ways) {
                let far = apart(&corners(&desc, *time), expected);
                let name = path.display();
                assert!(far <= way / 250.0 + 1e-5 * size, "{name} {animation} at {time}: {far} of {way}");
            }
        }
    });
}
