//! What ray trees say of each ray is so: weights are what their factors give, places lie where they should, random numbers
//! lead to the ray.
use durer::{
    Distribution, Options, Prepared, builtin,
    integrator::Sampling,
    math::{Point2, Point3, Vector3},
    model::{camera::Lens, texture::Looked},
    probe::{ChosenBy, Clock, Detail, RayKind, RayTree, StopReason, TreeNode},
    sampling::{Dim, Sampler},
    spectrum::{Basis, Spectrum},
};
use durer_tests::{prepared, scene};

fn built_in(name: &str, options: &Options) -> Prepared {
    let options = Options { width: Some(48), ..options.clone() };
    prepared(builtin::find(name).expect("built in").import(), &options)
}

fn distributed() -> Options {
    let distribution = Distribution {
        shadow_rays: Some(2),
        gloss_rays: Some(3),
        sampling: Some(Sampling::Nested),
        ..Distribution::default()
    };
    Options {
        integrator: Some("distributed".to_owned()),
        samples: Some(1),
        max_depth: Some(2),
        distribution,
        ..Options::default()
    }
}

fn paths() -> Options {
    Options {
        integrator: Some("path".to_owned()),
        samples: Some(1),
        max_depth: Some(8),
        ..Options::default()
    }
}

/// Trees of pixels all over the picture.
fn trees(scene: &Prepared, count: u32) -> Vec<RayTree> {
    let (w, h) = (scene.scene.view.width, scene.scene.view.height);
    let pixel = |i: u32| [(i * 37) % w, (i * 17) % h];
    (0..count).map(|i| scene.job().record(pixel(i), i % scene.settings.samples).0).collect()
}

fn parent<'t>(tree: &'t RayTree, node: &TreeNode) -> Option<&'t TreeNode> {
    node.parent.map(|p| &tree.nodes[p as usize])
}

fn equal(a: Spectrum, b: Spectrum) -> bool {
    let (a, b) = (Basis::Rgb.to_rgb(a), Basis::Rgb.to_rgb(b));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-4 * a.abs().max(b.abs()) + 1e-20)
}

#[test]
fn weights_are_what_their_factors_give() {
    let (mut lights, mut lobes, mut sharp, mut weighed) = (0, 0, 0, 0);
    let rough = "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 27\nLookAt 0 2 -4  0 0 0  0 1 0\n\
        Camera \"perspective\" \"float fov\" 30\nWorldBegin\n\
        Material \"principled\" \"rgb basecolor\" [.8 .3 .2] \"float roughness\" .4 \"float metallic\" .5\n\
        Shape \"plane\" \"vector3 normal\" [0 1 0]\nAreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"bool twosided\" true\n\
        Shape \"polygon\" \"point3 P\" [-1 2 1  1 2 1  1 2 3  -1 2 3]\n";
    let scenes = [
        ("whitted", built_in("whitted", &Options::default())),
        ("cook", built_in("cook", &distributed())),
        ("penumbra", built_in("penumbra", &distributed())),
        ("beaker", built_in("beaker", &distributed())),
        ("rough", scene(rough, &distributed())),
        ("rough, paths", scene(rough, &paths())),
        ("cornell, paths", built_in("cornell", &paths())),
        ("beaker, paths", built_in("beaker", &paths())),
    ];
    for (name, scene) in &scenes {
        for tree in trees(scene, 120) {
            for node in &tree.nodes {
                let Some(chosen) = &node.chosen else {
                    assert!(
                        matches!(node.kind, RayKind::Eye | RayKind::Passing)
                            || node.stop == Some(StopReason::TirNoRefraction)
                    );
                    continue;
                };
                let share = chosen.mis.filter(|_| chosen.by == ChosenBy::Light).unwrap_or(1.0);
                let factor =
                    chosen.cos.unwrap_or(1.0) * share / (chosen.rays as f32 * chosen.chance * chosen.kept);
                match (chosen.by, chosen.f) {
                    (ChosenBy::Light, Some(f)) => {
                        assert!(equal(f * factor, node.weight), "{name}: {chosen:?} {:?}", node.weight);
                        lights += 1;
                    }
                    (ChosenBy::Lobe, Some(f)) => {
                        let pdf = chosen.pdf.expect("drawn with a density");
                        assert!(pdf > 0.0 && equal(f * (factor / pdf), node.weight), "{name}: {chosen:?}");
                        lobes += 1;
                    }
                    // Draws that are lost have a bound only.
                    (ChosenBy::Lobe, None) => assert_eq!(node.stop, Some(StopReason::BelowHorizon)),
                    (by, f) => {
                        assert_eq!((by, f), (ChosenBy::Sharp, None));
                        sharp += 1;
                    }
                }
                if let (Some(mis), Some(pdf), Some(other)) = (chosen.mis, chosen.pdf, chosen.other_pdf) {
                    assert!((0.0..=1.0).contains(&mis));
                    weighed += u32::from(mis > 0.0 && mis < 1.0 && pdf > 0.0 && other > 0.0);
                }
            }
        }
    }
    assert!(lights > 500 && lobes > 500 && sharp > 100 && weighed > 50, "{lights} {lobes} {sharp} {weighed}");
}

#[test]
fn local_radiance_is_its_parts_and_throughput_the_product_of_weights() {
    for tree in trees(&built_in("cook", &distributed()), 60)
        .iter()
        .chain(&trees(&built_in("cornell", &distributed()), 60))
    {
        for node in &tree.nodes {
            let above = parent(tree, node).map_or(Spectrum::ONE, |p| p.throughput);
            assert_eq!(node.throughput, above * node.weight);
            let Some(shading) = &node.shading else { continue };
            let parts = shading.emission + shading.ambient + shading.blurred_sky;
            assert!(equal(parts, node.local), "{parts:?} {:?}", node.local);
        }
    }
}

#[test]
fn hits_lie_in_their_triangles() {
    let mut triangles = 0;
    for name in ["glass-plate", "cornell", "mirrors"] {
        for tree in trees(&built_in(name, &Options::default()), 80) {
            for hit in tree.nodes.iter().filter_map(|n| n.hit) {
                assert_eq!(hit.triangle.is_some(), hit.barycentric().is_some());
                let (Some(corners), Some(b)) = (hit.triangle, hit.barycentric()) else { continue };
                assert!(
                    b.iter().all(|b| (-1e-6..=1.0 + 1e-6).contains(b))
                        && (b.iter().sum::<f32>() - 1.0).abs() < 1e-6
                );
                let p = (0..3).fold(Vector3::ZERO, |sum, i| sum + (corners[i] - Point3::ZERO) * b[i]);
                assert!((p - (hit.p - Point3::ZERO)).length() < 1e-4, "{p:?} {:?}", hit.p);
                let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
                assert!(hit.n_g.dot(n).abs() > 0.9999);
                assert!((0.0..=1.0).contains(&hit.cos));
                triangles += 1;
            }
        }
    }
    assert!(triangles > 100, "{triangles}");
}

#[test]
fn random_numbers_lead_to_the_eye_ray() {
    let (mut lenses, mut moments) = (0, 0);
    for name in ["whitted", "bokeh", "shutter", "cook"] {
        let scene = built_in(name, &Options { samples: Some(16), ..Options::default() });
        for tree in trees(&scene, 40) {
            let (eye, first) = (tree.eye.expect("an eye"), &tree.nodes[0]);
            let number = |dim: Dim| first.random.iter().find(|r| r.dim == dim);
            let place = number(Dim::Pixel).expect("a place").numbers();
            assert_eq!(place.len(), 2);
            assert!(place.iter().all(|u| (0.0..1.0).contains(u)));
            let lens = number(Dim::Lens).map_or(Lens::CENTRE, |r| Point2::new(r.u[0], r.u[1]));
            let ray = scene.scene.view.ray(Point2::new(eye.film[0], eye.film[1]), lens, eye.time);
            assert_eq!((ray.o, ray.d, ray.time), (first.o, first.d, first.path.ray.time), "{name}");
            assert_eq!(eye.lens, number(Dim::Lens).map(|_| scene.scene.view.camera.lens().at(lens)));
            lenses += u32::from(eye.lens.is_some());
            moments += u32::from(number(Dim::Time).is_some_and(|r| r.numbers().len() == 1));
        }
    }
    assert!(lenses >= 40 && moments >= 40, "{lenses} {moments}");
}

#[test]
fn samplers_give_the_recorded_numbers_again() {
    let mut found = 0;
    for tree in trees(&built_in("cook", &distributed()), 40) {
        for node in tree.nodes.iter().filter(|n| n.kind == RayKind::Shadow) {
            let (Some(parent), Some(light)) = (parent(&tree, node), node.light) else { continue };
            let Some(numbers) = node.random.last() else { continue };
            let dims: Vec<Dim> = node.random.iter().map(|r| r.dim).collect();
            assert_eq!(dims, [Dim::LightChoice, Dim::Light]);
            let sampler = Sampler::from_hex(&parent.path.sampler.to_hex()).expect("digits");
            assert_eq!(sampler, parent.path.sampler);
            // Shadow rays use branches from 2^16 on; two rays share the light.
            let of_light = sampler.fork((1 << 16) + light.light);
            let possible = [0, 1].map(|part| of_light.split(part, 2).d2(Dim::Light).to_array());
            let choice = [0, 1].map(|part| sampler.fork(1 << 16).split(part, 2).d1(Dim::LightChoice));
            assert!(choice.contains(&node.random[0].u[0]));
            assert!(possible.iter().any(|u| u[..] == *numbers.numbers()));
            found += 1;
        }
    }
    assert!(found > 80, "{found}");
}

#[test]
fn textures_tell_what_they_were_asked() {
    let scene = built_in("mirrors", &Options::default());
    let mut looked = 0;
    for tree in trees(&scene, 60) {
        for node in &tree.nodes {
            let Some((hit, shading)) = node.hit.zip(node.shading.as_ref()) else { continue };
            let is_floor = scene.scene.object(hit.object).name == "floor";
            assert_eq!(shading.textures.len(), usize::from(is_floor));
            for lookup in &shading.textures {
                assert_eq!(scene.scene.texture_names[lookup.texture as usize], "floor");
                assert_eq!(lookup.uv.to_array(), hit.uv);
                let Looked::Color(color) = lookup.value else { panic!("a number") };
                assert!(color.rgb == [0.10, 0.11, 0.13] || color.rgb == [0.78, 0.76, 0.70], "{color:?}");
                let lobe = shading.lobes.iter().find(|l| l.name == "diffuse").expect("a matte floor");
                assert_eq!(Basis::Rgb.to_rgb(lobe.reflectance), color.rgb);
                looked += 1;
            }
        }
    }
    assert!(looked > 20, "{looked}");
}

#[test]
fn bodies_say_what_a_ray_goes_from_and_into() {
    let scene = built_in("beaker", &Options::default());
    let mut pairs = std::collections::BTreeSet::new();
    for tree in trees(&scene, 500) {
        for node in &tree.nodes {
            let Some((shading, media)) = node.shading.as_ref().and_then(|s| Some((s, s.media?))) else {
                continue;
            };
            assert_eq!(media.before, node.path.media);
            if let Some(fresnel) = shading.fresnel {
                assert!((media.n2 / media.n1 - fresnel.eta).abs() < 1e-6);
                assert!((fresnel.reflect + fresnel.transmit - 1.0).abs() < 1e-6);
                pairs.insert([media.n1, media.n2].map(|n| (100.0 * n).round() as u32));
                // Snell: what was refracted obeys it.
                for child in tree
                    .nodes
                    .iter()
                    .filter(|c| c.parent.is_some_and(|p| std::ptr::eq(&tree.nodes[p as usize], node)))
                {
                    if child.kind == RayKind::Refraction && child.is_traced() {
                        let n = node.hit.expect("hit").n_s;
                        let sin = |d: Vector3| (1.0 - n.dot(d).powi(2)).max(0.0).sqrt();
                        assert!((media.n1 * sin(node.d) - media.n2 * sin(child.d)).abs() < 1e-4);
                    }
                }
            }
        }
    }
    assert!(pairs.len() >= 4, "air, glass, water and ice: {pairs:?}");
}

#[test]
fn boxes_on_the_way_are_told_in_order() {
    let instances = "ObjectBegin \"balls\"\nShape \"sphere\" \"float radius\" .4\nTranslate .5 .5 .3\nShape \"sphere\" \"float radius\" .3\n\
        Shape \"trianglemesh\" \"point3 P\" [-1 -1 1 1 -1 1 0 1 1] \"integer indices\" [0 1 2]\nObjectEnd\n\
        AttributeBegin\nTranslate -1 0 6\nRotate 30 0 1 0\nObjectInstance \"balls\"\nAttributeEnd\n\
        AttributeBegin\nTranslate 1 0 7\nScale 1 2 1\nObjectInstance \"balls\"\nAttributeEnd\n";
    let head = "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 27\nSampler \"independent\" \"integer pixelsamples\" 1\n\
        Camera \"perspective\" \"float fov\" 30\nWorldBegin\n";
    let scenes = [
        built_in("glass-plate", &Options::default()),
        built_in("shutter", &Options::default()),
        scene(&format!("{head}{instances}"), &Options::default()),
    ];
    for (number, scene) in scenes.iter().enumerate() {
        let mut hits = 0;
        for i in 0..120u32 {
            let pixel = [(i * 37) % 48, (i * 11) % 27];
            let detail = Detail { walks: 5, ..Detail::default() };
            let (tree, rgb) = scene.job().record_in(pixel, 0, detail);
            assert_eq!(rgb, scene.job().value(pixel, 0));
            for (id, node) in tree.nodes.iter().enumerate() {
                assert_eq!(node.walk.is_empty(), id >= 5 || node.node_tests == 0, "scene {number}");
                assert!(node.walk.first().is_none_or(|test| test.depth == 0));
                if let (Some(hit), true) = (node.hit, id < 5) {
                    // What was hit lies in boxes that were met, at every depth down to its own; planes lie in none.
                    let holds = |test: &&durer::probe::BoxTest| {
                        let [min, max] = test.bounds.map(Point3::to_array);
                        let p = hit.p.to_array();
                        (0..3).all(|a| p[a] >= min[a] - 1e-3 && p[a] <= max[a] + 1e-3)
                    };
                    let around: Vec<_> = node.walk.iter().filter(holds).collect();
                    if !around.is_empty() {
                        assert!(
                            around.iter().any(|test| test.hit),
                            "scene {number}, pixel {pixel:?}, ray {id}"
                        );
                        hits += 1;
                    }
                }
            }
        }
        assert!(hits > 10, "scene {number}: {hits}");
    }
}

#[test]
fn tests_are_counted_by_type() {
    let balls = trees(&built_in("whitted", &Options::default()), 40);
    let glass = trees(&built_in("glass-plate", &Options::default()), 40);
    let sum = |trees: &[RayTree], of: fn(&TreeNode) -> u32| {
        trees.iter().flat_map(|t| &t.nodes).map(of).sum::<u32>()
    };
    for trees in [&balls, &glass] {
        assert!(trees.iter().flat_map(|t| &t.nodes).all(|n| n.triangle_tests <= n.primitive_tests));
    }
    assert!(sum(&balls, |n| n.triangle_tests) < sum(&balls, |n| n.primitive_tests), "there are balls");
    assert!(sum(&glass, |n| n.triangle_tests) > 0);
}

#[test]
fn time_is_measured_only_if_wanted_and_holds_that_of_the_children() {
    let scene = built_in("whitted", &Options::default());
    let (plain, _) = scene.job().record([24, 14], 0);
    assert!(plain.nodes.iter().all(|n| n.ns.is_none()));
    let (timed, _) = scene.job().record_in([24, 14], 0, Detail { clock: Clock::On, ..Detail::default() });
    for (node, children) in timed.nodes.iter().zip(timed.children()) {
        let own = node.ns.expect("measured");
        let of_children: u64 = children.iter().filter_map(|&c| timed.nodes[c as usize].ns).sum();
        assert!(own >= of_children);
    }
}
