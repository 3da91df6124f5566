//! Ray trees of rays among what floats: they are the pixel (D1), each part can be traced again (D2), and weights are what
//! their factors give (D3).
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use durer::{
    Options, Prepared, builtin,
    probe::{ChosenBy, RayKind},
    spectrum::{Basis, Spectrum},
};
use durer_tests::{prepared, scene};

/// Glass with milk in it, in a cloud, before lamps.
const SMOKE: &str = "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nIntegrator \"volpath\" \"integer maxdepth\" 12\n\
    LookAt 0 0.5 -6  0 0.4 0  0 1 0\nCamera \"perspective\" \"float fov\" 32\nWorldBegin\n\
    LightSource \"point\" \"point3 from\" [3 4 -4] \"rgb I\" [30 30 30]\n\
    AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 7 4] Translate -2 2 1 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n\
    MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.01 0.1 0.3] \"rgb sigma_s\" [3 4 6]\n\
    AttributeBegin Translate -1.5 -1 -1.5 Scale 3 2 3\n\
    MakeNamedMedium \"cloud\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2\n\
    \"float density\" [0.3 1 0.2 0.8 0.5 0.1 0.9 0.4] \"rgb sigma_s\" [0.5 0.7 0.9] \"rgb sigma_a\" [0.1 0.1 0.1] \"rgb Le\" [0.2 0.1 0.1]\n\
    AttributeEnd\n\
    AttributeBegin MediumInterface \"cloud\" \"\" Material \"interface\" Shape \"sphere\" \"float radius\" 2.2 AttributeEnd\n\
    AttributeBegin MediumInterface \"milk\" \"cloud\" Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n\
    Material \"diffuse\" Translate 0 -1.2 0 Shape \"plane\"\n";

fn smoke(integrator: &str) -> Prepared {
    let text = SMOKE.replace("volpath", integrator);
    scene(&text, &Options { samples: Some(4), ..Options::default() })
}

fn scenes() -> [(&'static str, Prepared); 3] {
    let options = |samples| Options { width: Some(48), samples: Some(samples), ..Options::default() };
    let fog = prepared(builtin::find("fog").expect("built in").import(), &options(2));
    [("fog", fog), ("smoke", smoke("volpath")), ("both ends", smoke("bdpt"))]
}

fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(f32::to_bits)
}

fn equal(a: Spectrum, b: Spectrum) -> bool {
    let (a, b) = (Basis::Rgb.to_rgb(a), Basis::Rgb.to_rgb(b));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-4 * a.abs().max(b.abs()) + 1e-20)
}

#[test]
fn pixels_are_their_trees_and_each_ray_can_be_traced_again_d1_d2() {
    for (name, scene) in scenes().into_iter().chain([("particles", smoke("light"))]) {
        let (mut particles, mut replayed) = (0, 0);
        let view = &scene.scene.view;
        for i in 0..150u32 {
            let (pixel, sample) =
                ([(i * 37) % view.width, (i * 17) % view.height], i % scene.settings.samples);
            let (tree, rgb) = scene.job().record(pixel, sample);
            assert_eq!(bits(scene.job().value(pixel, sample)), bits(rgb), "{name} {pixel:?}");
            assert_eq!(bits(Basis::Rgb.to_rgb(tree.fold())), bits(rgb), "{name} {pixel:?}");
            let mut sum = [0.0f64; 3];
            for node in &tree.nodes {
                let own = Basis::Rgb.to_rgb(node.contribution());
                sum.iter_mut().zip(own).for_each(|(sum, c)| *sum += f64::from(c));
                particles += usize::from(node.particle().is_some());
            }
            for (sum, v) in sum.iter().zip(rgb.map(f64::from)) {
                assert!((sum - v).abs() <= 1e-5 * v.max(1.0), "{name} {pixel:?}: {sum} is not {v}");
            }
            let children = tree.children();
            for (index, node) in tree.nodes.iter().enumerate() {
                let Some(again) = scene.job().replay(&tree, index as u32) else { continue };
                assert_eq!(again.nodes[0].result, node.result, "{name} {pixel:?}, ray {index}");
                assert_eq!(again.nodes[0].floating, node.floating, "{name} {pixel:?}, ray {index}");
                assert_eq!(again.children()[0].len(), children[index].len());
                replayed += 1;
            }
        }
        assert!(particles > 25 && replayed > 500, "{name}: {particles} {replayed}");
    }
}

#[test]
fn weights_of_particles_are_what_their_factors_give_d3() {
    for (name, scene) in scenes() {
        let (mut lights, mut scattered, mut passing, mut joined, mut sent) = (0, 0, 0, 0, 0);
        let view = &scene.scene.view;
        for i in 0..300u32 {
            let pixel = [(i * 37) % view.width, (i * 17) % view.height];
            let (tree, _) = scene.job().record(pixel, i % scene.settings.samples);
            for node in &tree.nodes {
                let above = node.parent.map(|parent| &tree.nodes[parent as usize]);
                let Some(particle) = above.and_then(|above| above.particle()) else {
                    passing += usize::from(node.kind == RayKind::Passing);
                    continue;
                };
                assert_eq!(node.o, particle.p, "rays begin where the particle is");
                let above = above.expect("it met the particle");
                let floating = above.floating.expect("among what floats");
                let chosen = node.chosen.expect("drawn");
                let cos = above.d.normalize().dot(node.d.normalize());
                let phase = durer::model::medium::HenyeyGreenstein::new(particle.g).density(cos);
                let mis = chosen.mis.unwrap_or(1.0);
                match chosen.by {
                    // What particles from lights bring is part of other rays.
                    ChosenBy::Phase if node.kind == RayKind::Photon => {
                        assert!(
                            node.weight.is_black() && (chosen.pdf.expect("drawn") / phase - 1.0).abs() < 1e-3
                        );
                        sent += 1;
                    }
                    ChosenBy::Joined => {
                        assert!(node.kind == RayKind::Connection);
                        let f = chosen.f.expect("known");
                        assert!(equal(floating.weight * phase, f), "{name}: {chosen:?} {floating:?}");
                        assert!((0.0..=1.0).contains(&mis), "{name}: {mis}");
                        joined += 1;
                    }
                    ChosenBy::Light => {
                        let expected = floating.weight * (phase * mis / chosen.chance);
                        assert!(equal(expected, node.weight), "{name}: {chosen:?} {:?}", node.weight);
                        lights += 1;
                    }
                    ChosenBy::Phase => {
                        assert!(
                            node.kind == RayKind::Scattered
                                && (chosen.pdf.expect("drawn") / phase - 1.0).abs() < 1e-3
                        );
                        let f = chosen.f.expect("known");
                        assert!(
                            equal(f * (1.0 / (chosen.pdf.expect("drawn") * chosen.kept)), node.weight),
                            "{chosen:?}"
                        );
                        scattered += 1;
                    }
                    by => panic!("{by:?} at a particle"),
                }
            }
        }
        assert!(lights > 100 && scattered > 100, "{name}: {lights} {scattered}");
        assert!(name != "both ends" || joined > 100 && sent > 30, "{name}: {joined} {sent}");
        assert!(passing > 0 || name == "fog", "{passing}");
    }
}
