//! Bodies that overlap, touch, absorb and surround the camera, against numbers known in closed form.
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use durer::{
    Options, Prepared,
    probe::{RayKind, RayTree, StopReason},
};
use durer_tests::{render, scene};

/// Everything is followed to its end.
const ALL: &str = "\"integer maxdepth\" 60 \"float mincontribution\" 0";
/// Until next to nothing is left: three surfaces in a row make trees that grow exponentially.
const MOST: &str = "\"integer maxdepth\" 10 \"float mincontribution\" 1e-4";
const WHITE_SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/// A picture of one pixel, taken from the origin along +z.
fn eye(integrator: &str, world: &str) -> Prepared {
    let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
                Sampler \"independent\" \"integer pixelsamples\" 1\n\
                Camera \"perspective\" \"float fov\" 1\n";
    scene(&format!("{head}Integrator \"whitted\" {integrator}\nWorldBegin\n{world}"), &Options::default())
}

fn seen(integrator: &str, world: &str) -> f64 {
    let (_, rgb) = eye(integrator, world).job().record([0, 0], 0);
    f64::from(rgb[0])
}

/// A slab between two depths.
fn slab(material: &str, near: f64, far: f64) -> String {
    format!(
        "Material \"dielectric\" {material}\n\
         Shape \"plane\" \"point3 point\" [0 0 {near}] \"vector3 normal\" [0 0 -1]\n\
         Shape \"plane\" \"point3 point\" [0 0 {far}] \"vector3 normal\" [0 0 1]\n"
    )
}

/// A diffuse wall that shines with radiance 1.
fn lit_wall(z: f64) -> String {
    format!(
        "Material \"principled\" \"bool unlit\" true\n\
         Shape \"plane\" \"point3 point\" [0 0 {z}] \"vector3 normal\" [0 0 -1]\n"
    )
}

fn fresnel(ratio: f64) -> f64 {
    ((ratio - 1.0) / (ratio + 1.0)).powi(2)
}

/// Weights of the refracted rays on the straight way through everything.
fn refractions(tree: &RayTree) -> Vec<f64> {
    let straight = |mut index: usize| loop {
        let node = &tree.nodes[index];
        match (node.kind, node.parent) {
            (RayKind::Reflection | RayKind::Shadow, _) => return false,
            (_, Some(parent)) => index = parent as usize,
            (_, None) => return true,
        }
    };
    let through = (0..tree.nodes.len()).filter(|&i| tree.nodes[i].kind == RayKind::Refraction && straight(i));
    through.map(|i| f64::from(tree.nodes[i].weight.max())).collect()
}

const GLASS: &str = "\"float eta\" 1.5 \"integer priority\" 2";
const WATER: &str = "\"float eta\" 1.333 \"integer priority\" 1";

/// The wall of a beaker from z = 1 to 2, and water from `from` on to a wall that shines.
fn beaker(from: f64) -> String {
    slab(GLASS, 1.0, 2.0) + &slab(WATER, from, 50.0) + &lit_wall(10.0)
}

#[test]
fn water_in_a_glass_is_the_same_however_deep_it_reaches_into_the_wall_i18() {
    let (into_glass, into_water) = (1.0 - fresnel(1.5), 1.0 - fresnel(1.333 / 1.5));
    assert!((into_glass * into_water - 0.956_664).abs() < 1e-6);
    let reference = seen(MOST, &beaker(1.5));
    // It overlaps by different amounts, all of it, or touches exactly.
    for from in [1.000_1, 1.25, 1.9, 1.999_9, 2.0] {
        let prepared = eye(MOST, &beaker(from));
        let (tree, rgb) = prepared.job().record([0, 0], 0);
        let weights = refractions(&tree);
        assert_eq!(weights.len(), 2, "from {from}: {weights:?}");
        assert!((weights[0] - into_glass).abs() < 1e-6 && (weights[1] - into_water).abs() < 1e-6);
        assert!((weights[0] * weights[1] - 0.956_664).abs() < 1e-6, "from {from}");
        assert_eq!(f64::from(rgb[0]), reference, "from {from}");
        assert!(render(&prepared).imbalances.is_empty(), "from {from}");
    }
    let inset = eye(MOST, &beaker(2.1));
    let (tree, rgb) = inset.job().record([0, 0], 0);
    let product: f64 = refractions(&tree).iter().product();
    assert!((product - 0.902_824).abs() < 1e-6, "{product}");
    assert!((f64::from(rgb[0]) - reference).abs() > 1e-3, "{} {reference}", rgb[0]);
}

#[test]
fn priorities_and_not_the_order_in_the_file_decide_i18() {
    let forth = slab(GLASS, 1.0, 2.0) + &slab(WATER, 1.5, 50.0) + &lit_wall(10.0);
    let back = lit_wall(10.0) + &slab(WATER, 1.5, 50.0) + &slab(GLASS, 1.0, 2.0);
    assert_eq!(seen(MOST, &forth), seen(MOST, &back));
    let swapped = slab("\"float eta\" 1.5 \"integer priority\" 0", 1.0, 2.0) + &slab(WATER, 1.5, 50.0);
    let (tree, _) = eye(MOST, &(swapped + &lit_wall(10.0))).job().record([0, 0], 0);
    let surfaces: Vec<f32> = tree.nodes.iter().filter_map(|n| n.hit.map(|h| h.p.z)).collect();
    let passed =
        tree.nodes.iter().position(|n| n.kind == RayKind::Passing).expect("the glass ends in the water");
    assert!(surfaces.contains(&1.5), "the water's surface bends: {surfaces:?}");
    assert!((tree.nodes[passed].o.z - 2.0).abs() < 1e-4);
}

#[test]
fn through_a_gap_of_air_no_light_leaves_the_water_beyond_the_critical_angle_i18() {
    // From within the water towards the wall of the glass.
    let critical = (1.0f64 / 1.333).asin().to_degrees();
    assert!((critical - 48.6066).abs() < 1e-4);
    for (gap, angle, leaves) in
        [(0.1, 48.55, true), (0.1, 48.66, false), (0.0, 48.66, true), (-0.5, 60.0, true)]
    {
        let (s, c) = (f64::sin(f64::to_radians(angle)), f64::cos(f64::to_radians(angle)));
        let head = format!(
            "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\n\
             LookAt 0 0 0 {s} 0 {c} 0 1 0\nCamera \"perspective\" \"float fov\" 1\nIntegrator \"whitted\" {MOST}\n"
        );
        let water = slab(WATER, -50.0, 1.0 - gap);
        let prepared = scene(
            &format!("{head}WorldBegin\n{WHITE_SKY}{water}{}", slab(GLASS, 1.0, 2.0)),
            &Options::default(),
        );
        let (tree, _) = prepared.job().record([0, 0], 0);
        assert_eq!(prepared.scene.start.iter().count(), 1, "the camera is in the water");
        let first = tree.nodes.iter().find(|n| n.parent == Some(0) && n.kind == RayKind::Refraction);
        let got_out = if gap < 0.0 {
            // The water's own surface lies in the glass: the wall is met first.
            tree.nodes.iter().any(|n| n.kind == RayKind::Passing)
        } else {
            first.is_some_and(|n| n.stop != Some(StopReason::TirNoRefraction))
        };
        assert_eq!(got_out, leaves, "gap {gap}, {angle} degrees");
    }
}

#[test]
fn any_dielectric_disappears_in_a_uniform_sky_i19() {
    let ball = |x: f64, r: f64, material: &str| {
        format!(
            "AttributeBegin\nTranslate {x} 0.2 5\nMaterial \"dielectric\" {material}\n\
             Shape \"sphere\" \"float radius\" {r}\nAttributeEnd\n"
        )
    };
    let world = ball(0.0, 1.0, GLASS)
        + &ball(0.7, 0.9, WATER)
        + &ball(-0.6, 0.8, "\"float eta\" 2.4 \"integer priority\" 3")
        + &ball(-1.9, 0.5, "\"float eta\" 0.7");
    let head = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n\
        Sampler \"independent\" \"integer pixelsamples\" 1\nCamera \"perspective\" \"float fov\" 30\n";
    let text = format!(
        "{head}Integrator \"whitted\" \"integer maxdepth\" 1000 \"float mincontribution\" 1e-5\nWorldBegin\n{WHITE_SKY}{world}"
    );
    let rendered = render(&scene(&text, &Options::default()));
    assert!(rendered.imbalances.is_empty(), "{:?}", rendered.imbalances);
    for pixel in rendered.film.pixels() {
        let value = pixel.mean()[0];
        assert!((value - 1.0).abs() < 3e-3, "{value}: no more is missing than was cut");
    }
    assert!(rendered.rays > 12 * 8 * 4, "the balls are in the picture");
}

#[test]
fn a_ball_hit_near_its_edge_lacks_what_was_cut_i19() {
    // Cut after eight hits from inside: R + (1 - R)^2 (1 + R + ... + R^7) = 1 - (1 - R) R^8.
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
         Sampler \"independent\" \"integer pixelsamples\" 1\n\
         Camera \"orthographic\" \"float screenwindow\" [-1e-4 1e-4 -1e-4 1e-4]\n\
         Integrator \"whitted\" \"integer maxdepth\" 9 \"float mincontribution\" 0\n\
         WorldBegin\n{WHITE_SKY}Translate 0.99 0 5\nMaterial \"dielectric\" \"float eta\" 1.5\nShape \"sphere\"\n"
    );
    let (_, rgb) = scene(&text, &Options::default()).job().record([0, 0], 0);
    assert!((rgb[0] - 0.998_929).abs() < 1e-5, "{}", rgb[0]);
}

#[test]
fn light_fades_exponentially_on_its_way_through_a_body_i20() {
    // Index 1: nothing but absorption.
    let grey = "\"float eta\" 1 \"rgb absorption\" [0.5 0.5 0.5]";
    for priority in ["", "\"integer priority\" 1"] {
        let value = seen(ALL, &(slab(&format!("{grey} {priority}"), 2.0, 3.0) + &lit_wall(10.0)));
        assert!((value - 0.606_531).abs() < 1e-6, "{value}");
        // Mirrored inside: a clear one of index 1.5 has ways of length 1, 3, 5... in it.
        let glass = format!("\"float eta\" 1.5 \"rgb absorption\" [0.5 0.5 0.5] {priority}");
        let value = seen(ALL, &(WHITE_SKY.to_owned() + &slab(&glass, 2.0, 3.0)));
        let (r, t) = (0.04f64, 0.606_530_66f64);
        let through = (1.0 - r).powi(2) * t / (1.0 - r * r * t * t);
        let back = r + (1.0 - r).powi(2) * r * t * t / (1.0 - r * r * t * t);
        assert!((value - through - back).abs() < 1e-5, "{value} {}", through + back);
    }
}

#[test]
fn a_ball_absorbs_along_its_chord_i20() {
    for (impact, eta) in [(0.0f64, 1.5f64), (0.5, 1.5), (0.8, 1.333), (0.9, 1.0)] {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\n\
             Camera \"orthographic\" \"float screenwindow\" [-1e-4 1e-4 -1e-4 1e-4]\n\
             Integrator \"whitted\" {ALL}\nWorldBegin\n{WHITE_SKY}Translate {impact} 0 5\n\
             Material \"dielectric\" \"float eta\" {eta} \"rgb absorption\" [0.5 0.5 0.5]\nShape \"sphere\"\n"
        );
        let (tree, _) = scene(&text, &Options::default()).job().record([0, 0], 0);
        let refracted = refractions(&tree);
        let chord = 2.0 * (1.0 - (impact / eta).powi(2)).sqrt();
        let f = durer_testkit::interface::fresnel_mean((1.0 - impact * impact).sqrt(), eta);
        let expected = (1.0 - f) * (-0.5 * chord).exp();
        assert!((refracted[1] - expected).abs() < 2e-6, "impact {impact}: {} {expected}", refracted[1]);
    }
}

/// Where a straight line is among three balls: the body of the highest priority that contains the place.
fn winner(balls: &[(f64, f64, i32)], z: f64) -> Option<i32> {
    let around = balls.iter().filter(|(centre, radius, _)| (z - centre).abs() < *radius);
    around.map(|&(_, _, priority)| priority).max()
}

#[test]
fn the_body_of_highest_priority_fills_every_place() {
    let mut random = durer_testkit::random::Random::new(11);
    for round in 0..60 {
        let mut priorities = [1, 2, 3];
        let swap = (random.between(0.0, 3.0) as usize).min(2);
        priorities.swap(0, swap);
        priorities.swap(1, 2 - usize::from(round % 2 == 0));
        let balls = priorities.map(|p| (random.between(4.0, 6.0), random.between(0.5, 1.9), p));
        // Indices of 1: lines stay straight. Each absorbs differently; the light tells how long it was where.
        let sigma = |priority: i32| 0.25 * f64::from(priority);
        let mut world = WHITE_SKY.to_owned();
        for (centre, radius, priority) in balls {
            let s = sigma(priority);
            world += &format!(
                "AttributeBegin\nTranslate 0 0 {centre}\nMaterial \"dielectric\" \"float eta\" 1 \
                 \"integer priority\" {priority} \"rgb absorption\" [{s} {s} {s}]\n\
                 Shape \"sphere\" \"float radius\" {radius}\nAttributeEnd\n"
            );
        }
        let mut ends: Vec<f64> = balls.iter().flat_map(|(c, r, _)| [c - r, c + r]).collect();
        ends.sort_by(f64::total_cmp);
        let depth: f64 = ends
            .windows(2)
            .filter_map(|w| winner(&balls, 0.5 * (w[0] + w[1])).map(|p| sigma(p) * (w[1] - w[0])))
            .sum();
        let prepared = eye(ALL, &world);
        let (_, rgb) = prepared.job().record([0, 0], 0);
        assert!(
            (f64::from(rgb[0]) - (-depth).exp()).abs() < 3e-7,
            "{balls:?}: {} {}",
            rgb[0],
            (-depth).exp()
        );
        assert!(render(&prepared).imbalances.is_empty(), "{balls:?}");
    }
}

#[test]
fn blobs_of_the_same_water_are_one_and_leave_no_surface_between_them() {
    let world =
        WHITE_SKY.to_owned() + &slab(WATER, 1.0, 2.5) + &slab(WATER, 2.0, 4.0) + &slab(WATER, 4.0, 5.0);
    let (tree, _) = eye(MOST, &world).job().record([0, 0], 0);
    assert_eq!(refractions(&tree).len(), 2, "in at 1 and out at 5");
    assert_eq!(seen(MOST, &world), seen(MOST, &(WHITE_SKY.to_owned() + &slab(WATER, 1.0, 5.0))));
}

#[test]
fn the_camera_knows_the_bodies_that_it_is_in() {
    let sigma = "\"rgb absorption\" [0.5 0.5 0.5]";
    let ball = |radius: f64, rest: &str| {
        format!(
            "Material \"dielectric\" \"float eta\" 1 {sigma} {rest}\nShape \"sphere\" \"float radius\" {radius}\n"
        )
    };
    for priority in ["", "\"integer priority\" 1"] {
        let prepared = eye(ALL, &(WHITE_SKY.to_owned() + &ball(2.0, priority)));
        let (_, rgb) = prepared.job().record([0, 0], 0);
        assert!((rgb[0] - 0.367_879).abs() < 1e-6, "two metres: {}", rgb[0]);
        assert!(render(&prepared).imbalances.is_empty());
        // In a hollow of it, turned inside out, it is not in it.
        let hollow = format!("ReverseOrientation\n{}", ball(1.0, priority));
        let prepared = eye(ALL, &(WHITE_SKY.to_owned() + &ball(2.0, priority) + &hollow));
        let (_, rgb) = prepared.job().record([0, 0], 0);
        assert!((rgb[0] - 0.606_531).abs() < 1e-6, "one metre: {}", rgb[0]);
        assert_eq!(prepared.scene.start.iter().count(), 0);
        assert!(render(&prepared).imbalances.is_empty());
    }
}

#[test]
fn surfaces_that_are_inside_out_are_named() {
    for (turn, priority) in
        [("", ""), ("ReverseOrientation\n", ""), ("ReverseOrientation\n", "\"integer priority\" 1")]
    {
        let world = format!(
            "{WHITE_SKY}Translate 0 0 5\nMaterial \"dielectric\" {priority}\n{turn}\
             Shape \"sphere\" \"string name\" \"ball\"\n"
        );
        let prepared = eye(ALL, &world);
        let found = render(&prepared).imbalances;
        assert_eq!(found.is_empty(), turn.is_empty(), "{found:?}");
        if let Some((object, count)) = found.objects.iter().next() {
            assert_eq!(prepared.scene.object(durer::Id::new(*object)).name, "ball");
            assert!(*count > 0);
        }
    }
}

/// What of a lamp straight above arrives at a floor below these sheets of glass, which are a metre thick.
fn lit(shadows: &str, from: [f64; 2], material: &str, sheets: u32) -> f64 {
    let mut world = format!(
        "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [{} {} 0] \"point3 to\" [0 0 0]\n\
         Material \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape \"plane\" \"point3 point\" [0 -1 0]\n{material}\n",
        from[0], from[1]
    );
    for sheet in 0..sheets {
        let y = 1 + 2 * sheet;
        world += &format!(
            "Shape \"plane\" \"point3 point\" [0 {y} 0] \"vector3 normal\" [0 -1 0]\n\
             Shape \"plane\" \"point3 point\" [0 {} 0] \"vector3 normal\" [0 1 0]\n",
            y + 1
        );
    }
    let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
        Sampler \"independent\" \"integer pixelsamples\" 1\n\
        LookAt 0 0 0  0 -1 0.001  0 0 1\nCamera \"perspective\" \"float fov\" 1\n";
    let text = format!("{head}Integrator \"whitted\" \"string shadows\" \"{shadows}\"\nWorldBegin\n{world}");
    let prepared = scene(&text, &Options::default());
    let (tree, rgb) = prepared.job().record([0, 0], 0);
    let light = tree.nodes.iter().find_map(|n| n.light).expect("a lamp");
    assert_eq!(light.visible, rgb[0] > 0.0);
    assert_eq!(light.passed * light.unoccluded, tree.nodes[1].local, "the tree says what arrives");
    let cos = from[1] / from[0].hypot(from[1]);
    f64::from(rgb[0]) * std::f64::consts::PI / cos
}

#[test]
fn shadows_of_transparent_things_are_opaque_tinted_or_fresnels() {
    let clear = "Material \"dielectric\"";
    assert!((lit("opaque", [0.0, 1.0], clear, 0) - 1.0).abs() < 1e-5);
    assert_eq!(lit("opaque", [0.0, 1.0], clear, 1), 0.0);
    for sheets in 0..5 {
        assert!((lit("tinted", [0.0, 1.0], clear, sheets) - 1.0).abs() < 1e-5);
        let expected = 0.96f64.powi(2 * sheets as i32);
        assert!((lit("fresnel", [0.0, 1.0], clear, sheets) - expected).abs() < 1e-5, "{sheets} sheets");
    }
    // At 60 degrees each surface reflects 0.08919 (I5).
    let slanted = lit("fresnel", [3f64.sqrt(), 1.0], clear, 1);
    assert!((slanted - (1.0f64 - 0.089_19).powi(2)).abs() < 2e-5, "{slanted}");
    let tinted = "Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb transmission\" [.5 .5 .5]";
    assert!((lit("tinted", [0.0, 1.0], tinted, 2) - 0.0625).abs() < 1e-6);
    for priority in ["", "\"integer priority\" 3"] {
        let absorbing = format!("Material \"dielectric\" \"rgb absorption\" [.5 .5 .5] {priority}");
        assert!((lit("tinted", [0.0, 1.0], &absorbing, 2) - (-1.0f64).exp()).abs() < 1e-5);
        let slanted = lit("tinted", [1.0, 1.0], &absorbing, 1);
        assert!((slanted - (-0.5 * 2f64.sqrt()).exp()).abs() < 1e-5, "{slanted}");
    }
    assert_eq!(lit("fresnel", [0.0, 1.0], "Material \"diffuse\"", 1), 0.0);
    let thin = "Material \"principled\" \"float alpha\" 0.25 \"string alphamode\" \"blend\"";
    let passed = lit("tinted", [0.0, 1.0], thin, 1);
    assert!((passed - 0.5625).abs() < 1e-5, "two sheets of which a quarter is there: {passed}");
}

#[test]
fn overlapping_bodies_tint_shadows_by_what_is_there() {
    // Water from 1 to 4, in it glass from 2 to 3 that absorbs nothing: two metres of water are left.
    let world = |order: bool| {
        let plane = |y: u32, n: i32| {
            format!("Shape \"plane\" \"point3 point\" [0 {y} 0] \"vector3 normal\" [0 {n} 0]\n")
        };
        let body = |material: &str, from: u32, to: u32| {
            format!("Material \"dielectric\" {material}\n{}{}", plane(from, -1), plane(to, 1))
        };
        let water = body(&format!("{WATER} \"rgb absorption\" [.5 .5 .5]"), 1, 4);
        let glass = body(GLASS, 2, 3);
        let both = if order { water + &glass } else { glass + &water };
        format!(
            "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 6 0] \"string falloff\" \"none\"\n\
             Material \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape \"plane\" \"point3 point\" [0 -1 0]\n{both}"
        )
    };
    for order in [true, false] {
        let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
            Sampler \"independent\" \"integer pixelsamples\" 1\n\
            LookAt 0 0 0  0 -1 0.001  0 0 1\nCamera \"perspective\" \"float fov\" 1\n";
        let text = format!(
            "{head}Integrator \"whitted\" \"string shadows\" \"fresnel\"\nWorldBegin\n{}",
            world(order)
        );
        let (tree, _) = scene(&text, &Options::default()).job().record([0, 0], 0);
        let light = tree.nodes.iter().find_map(|n| n.light).expect("a lamp");
        let expected =
            (-1.0f64).exp() * (1.0 - fresnel(1.333)).powi(2) * (1.0 - fresnel(1.5 / 1.333)).powi(2);
        assert!((f64::from(light.passed.max()) - expected).abs() < 1e-5, "{:?} {expected}", light.passed);
    }
}
