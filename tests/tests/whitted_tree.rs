//! The ray trees of Whitted's recursion against counts and radiances known in closed form.
use durer::{
    Options, Prepared,
    probe::{RayKind, RayTree, StopReason},
};
use durer_tests::scene;

/// One pixel looking along +z from the origin.
fn eye(integrator: &str, world: &str) -> Prepared {
    let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
                Sampler \"independent\" \"integer pixelsamples\" 1\n\
                Camera \"perspective\" \"float fov\" 1\n";
    scene(&format!("{head}Integrator \"whitted\" {integrator}\nWorldBegin\n{world}"), &Options::default())
}

fn tree(prepared: &Prepared) -> (RayTree, f32) {
    let (tree, rgb) = prepared.job().record([0, 0], 0);
    assert_eq!(rgb[0], rgb[2], "these scenes are grey");
    (tree, rgb[0])
}

fn traced(tree: &RayTree, kind: RayKind) -> usize {
    let untraced = |stop: Option<StopReason>| stop.is_some_and(StopReason::is_untraced);
    tree.nodes.iter().filter(|n| n.kind == kind && !untraced(n.stop)).count()
}

/// Light of radiance 1 arriving from the half space +z (or -z), nothing from the other.
fn half_sky(sign: f32) -> String {
    format!(
        "LightSource \"gradientsky\" \"rgb zenith\" [1 1 1] \"rgb horizon\" [1 1 1] \"rgb ground\" [0 0 0] \
         \"vector3 up\" [0 0 {sign}]\n"
    )
}

/// A plate of glass (n = 1.5, so R = 0.04 at normal incidence) between z = 2 and z = 3.
const PLATE: &str = "Material \"dielectric\" \"float eta\" 1.5\n\
    Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n\
    Shape \"plane\" \"point3 point\" [0 0 3] \"vector3 normal\" [0 0 1]\n";

#[test]
fn glass_plate_transmits_each_order_as_computed_by_hand_i10() {
    for (double_bounces, expected) in [(0, 0.9216), (1, 0.923_074_56), (2, 0.923_076_9)] {
        let depth = 2 + 2 * double_bounces;
        let world = half_sky(1.0) + PLATE;
        let plate = eye(&format!("\"integer maxdepth\" {depth} \"float mincontribution\" 0"), &world);
        let (_, radiance) = tree(&plate);
        assert!(
            (radiance - expected).abs() < 1e-5,
            "{double_bounces} double bounces: {radiance} != {expected}"
        );
    }
}

#[test]
fn glass_plate_reflects_the_rest_i10() {
    let plate = eye("\"integer maxdepth\" 40 \"float mincontribution\" 0", &(half_sky(-1.0) + PLATE));
    let (_, radiance) = tree(&plate);
    assert!((radiance - 0.076_923_1).abs() < 1e-6, "{radiance}");
}

#[test]
fn a_recursion_limit_cuts_the_plate_where_it_says() {
    let (tree, radiance) =
        tree(&eye("\"integer maxdepth\" 1 \"float mincontribution\" 0", &(half_sky(1.0) + PLATE)));
    assert_eq!(radiance, 0.0, "the light needs two refractions");
    assert!(tree.nodes.iter().all(|n| n.depth <= 2));
    assert!(tree.nodes.iter().any(|n| n.stop == Some(StopReason::DepthLimit)));
}

#[test]
fn facing_mirrors_stop_by_contribution_where_the_power_falls_below_the_cut_i16() {
    for (k, cut, bounces) in [(0.5f64, 1.0 / 256.0, 8), (0.9, 0.01, 44)] {
        let world = format!(
            "LightSource \"infinite\" \"rgb L\" [1 1 1]\n\
             Material \"mirror\" \"rgb reflectance\" [{k} {k} {k}]\n\
             Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 0 -1]\n\
             Shape \"plane\" \"point3 point\" [0 0 -1] \"vector3 normal\" [0 0 1]\n"
        );
        let (tree, _) =
            tree(&eye(&format!("\"integer maxdepth\" 1000 \"float mincontribution\" {cut}"), &world));
        let last = tree.nodes.last().expect("a tree");
        assert_eq!((last.depth, last.stop), (bounces, Some(StopReason::ContributionBelowCutoff)), "k = {k}");
        for node in &tree.nodes {
            let expected = k.powi(node.depth as i32);
            let weight = f64::from(node.throughput.max());
            assert!((weight / expected - 1.0).abs() < 1e-5, "image {}: {weight} != {expected}", node.depth);
        }
    }
}

#[test]
fn a_full_tree_has_two_to_the_depth_plus_one_less_one_rays_i17() {
    // Radial rays in concentric shells meet something in both directions at every depth.
    let mut world = String::from(
        "LightSource \"point\" \"rgb I\" [1 1 1] \"string falloff\" \"none\"\n\
         Material \"classic\" \"rgb diffuse\" [.5 .5 .5] \"rgb reflection\" [.5 .5 .5] \
         \"rgb transmission\" [.5 .5 .5] \"float eta\" 1\n",
    );
    for shell in 1..=10 {
        world += &format!("Shape \"sphere\" \"float radius\" {shell}\n");
    }
    for (depth, rays) in [(3, 15), (5, 63), (8, 511)] {
        let (tree, _) =
            tree(&eye(&format!("\"integer maxdepth\" {depth} \"float mincontribution\" 0"), &world));
        let bounces = traced(&tree, RayKind::Reflection) + traced(&tree, RayKind::Refraction);
        assert_eq!(1 + bounces, rays, "depth {depth}");
        let lit = tree.nodes.iter().filter(|n| n.hit.is_some_and(|h| !h.from_outside)).count();
        assert!(lit > 0);
        assert_eq!(
            traced(&tree, RayKind::Shadow),
            lit,
            "one shadow ray per light on the viewer's side and hit"
        );
    }
}

#[test]
fn a_corner_cube_sends_light_back_where_it_came_from_i15() {
    let head = "Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 9\n\
                Sampler \"independent\" \"integer pixelsamples\" 1\n\
                LookAt 3 2.5 3.5  0.4 0.5 0.6  0 1 0\nCamera \"perspective\" \"float fov\" 8\n\
                Integrator \"whitted\"\nWorldBegin\nMaterial \"mirror\" \"rgb reflectance\" [1 1 1]\n";
    let faces = "Shape \"polygon\" \"point3 P\" [0 0 0 9 0 0 9 9 0 0 9 0]\n\
                 Shape \"polygon\" \"point3 P\" [0 0 0 0 9 0 0 9 9 0 0 9]\n\
                 Shape \"polygon\" \"point3 P\" [0 0 0 0 0 9 9 0 9 9 0 0]\n";
    let cube = scene(&format!("{head}{faces}"), &Options::default());
    let mut returned = 0;
    for y in 0..9 {
        for x in 0..9 {
            let (tree, _) = cube.job().record([x, y], 0);
            let first = &tree.nodes[0];
            if let Some(last) = tree.nodes.iter().find(|n| n.depth == 3) {
                assert!((last.d + first.d).length() < 1e-5, "{:?} is not opposite to {:?}", last.d, first.d);
                assert_eq!(last.stop, Some(StopReason::MissedScene));
                returned += 1;
            }
        }
    }
    assert!(returned > 60, "only {returned} rays met all three mirrors");
}

/// How many images of a small ball an eye between two vertical mirrors of this angle sees.
fn images(degrees: f64) -> usize {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let point = |r: f64, a: f64| (r * a.to_radians().cos(), r * a.to_radians().sin());
    let ((ex, ez), (bx, bz)) = (point(2.0, degrees * 0.42), point(1.1, degrees * 0.7));
    let mut found = 0;
    let mut inside = None;
    // All the way round in the plane of eye and ball; one image is one run of directions with the same mirrors.
    let world = format!(
        "WorldBegin\nMaterial \"mirror\" \"rgb reflectance\" [1 1 1]\n\
         Shape \"polygon\" \"point3 P\" [0 -5 0 90 -5 0 90 5 0 0 5 0]\n\
         Shape \"polygon\" \"point3 P\" [0 -5 0 {x} -5 {z} {x} 5 {z} 0 5 0]\n\
         AttributeBegin\nTranslate {bx} 0 {bz}\nMaterial \"diffuse\"\n\
         Shape \"sphere\" \"string name\" \"ball\" \"float radius\" 0.04\nAttributeEnd\n",
        x = 90.0 * cos,
        z = 90.0 * sin
    );
    // A panorama as a stack of narrow pictures: 120 directions of one picture span 6 degrees.
    for turn in 0..60 {
        let a = (turn as f64 * 6.0 + 3.0).to_radians();
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 120 \"integer yresolution\" 1\n\
             LookAt {ex} 0 {ez}  {} 0 {}  0 1 0\n\
             Camera \"perspective\" \"float fov\" 6 \"string fovaxis\" \"x\"\nIntegrator \"whitted\"\n{world}",
            ex + a.cos(),
            ez + a.sin()
        );
        let prepared = scene(&text, &Options { samples: Some(1), ..Options::default() });
        // LookAt's x axis runs against the angle: walk each picture from its right edge.
        for x in (0..120).rev() {
            let (tree, _) = prepared.job().record([x, 0], 0);
            let ball = tree.nodes.iter().find(|n| {
                n.hit.is_some_and(|h| prepared.scene.object(h.object).name == "ball")
                    && n.kind != RayKind::Shadow
            });
            let depth = ball.map(|n| n.depth);
            if depth.is_some_and(|d| d > 0) && depth != inside {
                found += 1;
            }
            inside = depth;
        }
    }
    found
}

#[test]
fn two_mirrors_at_an_angle_show_as_many_images_as_fit_in_the_circle_i15() {
    assert_eq!(images(90.0), 3);
    assert_eq!(images(60.0), 5);
}

#[test]
fn snells_window_ends_at_the_critical_angle_i3() {
    // Under water looking up: 97.18 degrees of sky for n = 4/3, a mirror outside.
    let text = "Film \"rgb\" \"integer xresolution\" 2048 \"integer yresolution\" 1\n\
        LookAt 0 -1 0  0 0 0  0 0 1\n\
        Camera \"perspective\" \"float fov\" 120 \"string fovaxis\" \"x\"\nIntegrator \"whitted\"\n\
        WorldBegin\nMaterial \"dielectric\" \"float eta\" 1.3333333333\n\
        Shape \"plane\" \"string name\" \"water\"\n";
    let prepared = scene(text, &Options { samples: Some(1), ..Options::default() });
    let (mut inside, mut outside) = (0.0f64, 90.0f64);
    for x in 0..2048 {
        let (tree, _) = prepared.job().record([x, 0], 0);
        let d = tree.nodes[0].d.to_f64();
        let angle = d.y.acos().to_degrees();
        if traced(&tree, RayKind::Refraction) > 0 {
            inside = inside.max(angle);
        } else {
            outside = outside.min(angle);
        }
    }
    let critical = (0.75f64).asin().to_degrees();
    assert!(inside < critical && critical < outside, "{inside} {critical} {outside}");
    assert!(outside - inside < 0.1, "the edge is sharp: {inside} to {outside}");
}

#[test]
fn the_zenith_seen_from_under_water_loses_what_is_mirrored_i4() {
    let water = "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"dielectric\" \"float eta\" 1.3333333333\n\
                 Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 0 1]\n\
                 Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
                 Shape \"plane\" \"point3 point\" [0 0 -1] \"vector3 normal\" [0 0 1]\n";
    let (_, radiance) = tree(&eye("", water));
    assert!((radiance - 0.979_592).abs() < 1e-5, "{radiance}");
}

#[test]
fn in_a_hollow_ball_refractions_nest_within_096_of_its_radius_w7() {
    let ball = |impact: f64, hollow: bool| {
        let inner = "ReverseOrientation\nShape \"sphere\" \"string name\" \"inner\" \"float radius\" 0.96\n";
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\n\
             Camera \"orthographic\" \"float screenwindow\" [-1e-4 1e-4 -1e-4 1e-4]\n\
             Integrator \"whitted\" \"integer maxdepth\" 8 \"float mincontribution\" 0.001\nWorldBegin\n\
             LightSource \"infinite\" \"rgb L\" [1 1 1]\nTranslate {impact} 0 5\nMaterial \"dielectric\"\n\
             Shape \"sphere\" \"string name\" \"outer\"\n{}",
            if hollow { inner } else { "" }
        );
        let prepared = scene(&text, &Options::default());
        let (tree, _) = prepared.job().record([0, 0], 0);
        // Refracted at every hit: which surface, and from which side it was met.
        let mut way = Vec::new();
        let mut at = Some(0);
        while let Some(index) = at {
            let node = &tree.nodes[index];
            way.extend(node.hit.map(|h| (prepared.scene.object(h.object).name.clone(), h.from_outside)));
            at = (0..tree.nodes.len()).find(|&i| {
                tree.nodes[i].parent == Some(index as u32)
                    && tree.nodes[i].kind == RayKind::Refraction
                    && tree.nodes[i].stop != Some(StopReason::TirNoRefraction)
            });
        }
        way
    };
    let hit = |name: &str, from_outside: bool| (name.to_owned(), from_outside);
    let solid = [hit("outer", true), hit("outer", false)];
    // The inner surface is turned: its outside is the glass's inside.
    let nested = [hit("outer", true), hit("inner", false), hit("inner", true), hit("outer", false)];
    for impact in [0.0, 0.5, 0.9, 0.955] {
        assert_eq!(ball(impact, true), nested, "at {impact}");
        assert_eq!(ball(impact, false), solid, "at {impact}");
    }
    // Beyond it the inner surface reflects totally: n sin = 0.97 there.
    assert_eq!(ball(0.97, true), nested[..2], "the way ends at the inner surface");
}

#[test]
fn mirrored_and_refracted_rays_fade_linearly_with_their_length_w8() {
    // A mirror at 2 that takes half, and behind the eye a wall at -3 that shines with 1: the mirrored ray is 5 m long.
    let world = "Material \"mirror\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
        Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n\
        Material \"principled\" \"bool unlit\" true\n\
        Shape \"plane\" \"point3 point\" [0 0 -3] \"vector3 normal\" [0 0 1]\n";
    for (rule, expected) in [
        ("", 0.5),
        ("\"float attenuationdistance\" 20", 0.375),
        ("\"float attenuationdistance\" 10", 0.25),
        ("\"float attenuationdistance\" 5", 0.0),
        ("\"float attenuationdistance\" 2", 0.0),
    ] {
        let (_, radiance) = tree(&eye(rule, world));
        assert!((radiance - expected).abs() < 1e-6, "{rule}: {radiance}");
    }
    // Two refracted rays of 1 m and 5 m, weight 0.8 each, constant coefficients: 0.64 (1 - 1/10) (1 - 5/10) = 0.288.
    let world = "Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb transmission\" [.8 .8 .8] \"float eta\" 1.3\n\
        Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n\
        Shape \"plane\" \"point3 point\" [0 0 3] \"vector3 normal\" [0 0 1]\n\
        Material \"principled\" \"bool unlit\" true\n\
        Shape \"plane\" \"point3 point\" [0 0 8] \"vector3 normal\" [0 0 -1]\n";
    let (_, radiance) = tree(&eye("\"float attenuationdistance\" 10", world));
    assert!((radiance - 0.288).abs() < 1e-6, "{radiance}");
    // What leaves the scene keeps all.
    let sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"mirror\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
        Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n";
    let (_, radiance) = tree(&eye("\"float attenuationdistance\" 1", sky));
    assert!((radiance - 0.5).abs() < 1e-6, "{radiance}");
}
