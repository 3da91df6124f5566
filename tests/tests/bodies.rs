//! Transparent bodies in places and shapes that break renderers: nested, open, mirrored, moving, opaque as ink.
use durer::{Options, Prepared, builtin, probe::RayKind};
use durer_tests::{render, scene};

const WHITE_SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const ALL: &str = "\"integer maxdepth\" 200 \"float mincontribution\" 1e-5";

/// A picture of 16 x 16 pixels, taken from the origin along +z, 40 degrees high.
fn picture(integrator: &str, world: &str) -> Prepared {
    let head = "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n\
                Sampler \"independent\" \"integer pixelsamples\" 2\n\
                Camera \"perspective\" \"float fov\" 40 \"float shutteropen\" 0 \"float shutterclose\" 1\n";
    scene(
        &format!("{head}Integrator \"whitted\" {integrator}\nWorldBegin\n{WHITE_SKY}{world}"),
        &Options::default(),
    )
}

/// Nothing is lost: everything disappears in a uniform sky (I19), and no ray is where it should not be.
fn disappears(world: &str) {
    let rendered = render(&picture(ALL, world));
    assert!(rendered.imbalances.is_empty(), "{world}: {:?}", rendered.imbalances);
    for pixel in rendered.film.pixels() {
        let value = pixel.mean()[1];
        assert!((value - 1.0).abs() < 4e-3, "{world}: {value}");
    }
    assert!(rendered.rays > 16 * 16 * 2 * 2, "{world}: nothing is in the picture");
}

const OCTAHEDRON: &str = "Shape \"trianglemesh\" \"point3 P\" [1 0 0  0 1 0  0 0 1  -1 0 0  0 -1 0  0 0 -1]\n\
     \"integer indices\" [0 1 2  1 3 2  3 4 2  4 0 2  1 0 5  3 1 5  4 3 5  0 4 5]\n";

#[test]
fn outside_of_snells_window_the_floor_is_mirrored_and_nothing_is_lost_i3() {
    let text = builtin::find("snell").map(|s| s.text).unwrap_or_default();
    let clear = text.replace("\"rgb absorption\" [0.16 0.04 0.02]", "");
    assert_ne!(clear, text);
    let options = Options { width: Some(101), height: Some(101), samples: Some(1), ..Options::default() };
    let prepared = scene(&clear, &options);
    // The edge of the window lies 1.1339 / 1.7321 of the way from the middle to the side: 83 of 100.
    for (pixel, is_mirrored) in
        [([50, 50], false), ([50, 81], false), ([50, 85], true), ([99, 50], true), ([3, 2], true)]
    {
        let (tree, _) = prepared.job().record(pixel, 0);
        let mirrored = tree.nodes.iter().find(|n| n.kind == RayKind::Reflection && n.parent == Some(0));
        let weight = mirrored.map_or(0.0, |n| n.weight.max());
        assert_eq!(weight == 1.0, is_mirrored, "{pixel:?}: {weight}");
        if let (true, Some(node)) = (is_mirrored, mirrored) {
            assert_eq!(node.result, tree.nodes[0].result, "all that comes is what the floor sends");
        }
    }
}

#[test]
fn nested_and_equal_bodies_are_known_to_the_camera() {
    let ball = |radius: f64, rest: &str, sigma: f64| {
        format!(
            "Material \"dielectric\" \"float eta\" 1 {rest} \"rgb absorption\" [{sigma} {sigma} {sigma}]\n\
             Shape \"sphere\" \"float radius\" {radius}\n"
        )
    };
    for (inner, outer) in [("\"integer priority\" 2", "\"integer priority\" 1"), ("", "")] {
        let prepared = picture(ALL, &(ball(2.0, inner, 0.25) + &ball(3.0, outer, 0.5)));
        assert_eq!(prepared.scene.start.iter().count(), 2);
        let rendered = render(&prepared);
        assert!(rendered.imbalances.is_empty(), "{:?}", rendered.imbalances);
        // Two metres of the inner one and one of the outer one.
        let value = rendered.film.pixels()[100].mean()[0];
        assert!((value - 0.367_879).abs() < 1e-6, "{value}");
    }
    // More than fit.
    let many: String =
        (1..=12).map(|r| ball(f64::from(r), &format!("\"integer priority\" {r}"), 0.01)).collect();
    let prepared = picture(ALL, &many);
    assert_eq!(prepared.scene.start.iter().count(), 8);
    assert!(!render(&prepared).imbalances.is_empty());
    let many: String = (1..=12)
        .map(|r| ball(2.0 - 0.1 * f64::from(r), &format!("\"integer priority\" {r}"), 0.01 * f64::from(r)))
        .collect();
    let rendered = render(&picture(ALL, &format!("Translate 0 0 5\n{many}")));
    assert!(rendered.imbalances.too_deep > 0);
    assert!(rendered.film.pixels().iter().all(|p| p.mean()[0].is_finite()));
}

#[test]
fn meshes_instances_mirror_images_and_motion_are_bodies_too_i19() {
    let glass = "Material \"dielectric\" \"float eta\" 1.5 \"integer priority\" 2\n";
    let water = "Material \"dielectric\" \"float eta\" 1.333 \"integer priority\" 2\n";
    let place = |x: f64, what: &str| {
        format!("AttributeBegin\nTranslate {x} 0.1 5\nRotate 20 1 2 3\n{what}AttributeEnd\n")
    };
    for mirror in ["", "Scale -1 1 1\n", "Scale -1 1.2 0.7\n"] {
        disappears(&place(0.0, &format!("{glass}{mirror}{OCTAHEDRON}")));
        let instance = format!("ObjectBegin \"o\"\n{glass}{OCTAHEDRON}ObjectEnd\n");
        disappears(&(instance.clone() + &place(0.0, &format!("{mirror}ObjectInstance \"o\"\n"))));
        // Two that overlap, of equal priority.
        let other = place(0.6, &format!("{water}{mirror}Shape \"sphere\"\n"));
        disappears(&(instance + &place(0.0, &format!("{mirror}ObjectInstance \"o\"\n")) + &other));
    }
    let moving = "ActiveTransform EndTime\nTranslate 0.4 0.3 0\nActiveTransform All\n";
    let ball = format!("AttributeBegin\n{moving}Translate 0 0 5\n{glass}Shape \"sphere\"\nAttributeEnd\n");
    disappears(&ball);
    disappears(&(ball + &place(0.6, &format!("{water}{OCTAHEDRON}"))));
}

#[test]
fn a_ball_cut_in_half_is_named_and_does_no_harm() {
    for priority in ["", "\"integer priority\" 1"] {
        let world = format!(
            "Translate 0 0 5\nRotate 60 1 0.2 0\nMaterial \"dielectric\" {priority}\n\
             Shape \"sphere\" \"float zmin\" 0 \"string name\" \"bowl\"\n"
        );
        let prepared = picture(ALL, &world);
        let rendered = render(&prepared);
        assert!(!rendered.imbalances.is_empty());
        assert!(rendered.film.pixels().iter().all(|p| (p.mean()[0] - 1.0).abs() < 4e-3));
    }
}

#[test]
fn fog_in_a_ball_dims_by_its_chord_wherever_it_is_crossed_i20() {
    let world = "Translate 0.2 -0.1 5\nMaterial \"dielectric\" \"float eta\" 1 \"rgb absorption\" [0.7 0.07 1e38]\n\
                 Shape \"sphere\" \"float radius\" 1.4\n";
    let prepared = picture(ALL, world);
    let job = prepared.job();
    let mut crossed = 0;
    for pixel in (0..16).flat_map(|y| (0..16).map(move |x| [x, y])) {
        let (tree, rgb) = job.record(pixel, 0);
        let d = tree.nodes[0].d;
        let (d, c) = ([d.x, d.y, d.z].map(f64::from), [0.2f64, -0.1, 5.0]);
        let along: f64 = d.iter().zip(c).map(|(d, c)| d * c).sum();
        let squared = 1.4f64.powi(2) - (c.iter().map(|c| c * c).sum::<f64>() - along * along);
        let chord = 2.0 * squared.max(0.0).sqrt();
        // A line two millionths of a metre beside: its chord differs by more the nearer the edge it is.
        let tolerance = 1e-6 + 0.7 * 2.0 * 2.8e-6 / chord.max(1e-3);
        for (value, sigma) in rgb.into_iter().zip([0.7, 0.07]) {
            let expected = (-sigma * chord).exp();
            assert!(
                (f64::from(value) - expected).abs() < tolerance,
                "{pixel:?}: {value} {expected}, chord {chord}"
            );
        }
        crossed += u32::from(chord > 0.0);
        assert_eq!(rgb[2], if chord > 0.0 { 0.0 } else { 1.0 }, "as black as ink, and no NaN");
    }
    assert!((20..200).contains(&crossed), "{crossed}");
}

#[test]
fn light_in_a_body_seen_through_its_frosted_surface_is_absorbed_on_its_way_there() {
    let seen = |sigma: f64| {
        let world = format!(
            "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 0 5]\n\
             Material \"dielectric\" \"float roughness\" 0.5 \"rgb absorption\" [{sigma} {sigma} {sigma}]\n\
             Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n"
        );
        let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
                    Sampler \"independent\" \"integer pixelsamples\" 1\nCamera \"perspective\" \"float fov\" 0.01\n";
        let text = format!("{head}Integrator \"whitted\"\nWorldBegin\n{world}");
        f64::from(scene(&text, &Options::default()).job().record([0, 0], 0).1[0])
    };
    let share = seen(0.5) / seen(0.0);
    assert!((share - (-1.5f64).exp()).abs() < 1e-5, "three metres: {share}");
}

#[test]
fn nothing_comes_out_of_an_endless_absorbing_body() {
    let water = "Material \"dielectric\" \"float eta\" 1.333 \"rgb absorption\" [0.1 0 0.1]\n\
                 Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n";
    let (_, rgb) = picture(ALL, water).job().record([8, 8], 0);
    let mirrored = (0.333f32 / 2.333).powi(2);
    assert!((rgb[0] - mirrored).abs() < 1e-5, "only what is mirrored: {}", rgb[0]);
    assert!((rgb[1] - 1.0).abs() < 1e-5, "all of what is not absorbed: {}", rgb[1]);
}
