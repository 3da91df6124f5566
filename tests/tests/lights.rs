//! Area lights and moving lights in the whole renderer, against closed forms (validation.md E9, E10, E12, F1, F2).
use std::f64::consts::PI;

use durer::{Options, Rendered, Show, builtin, glam::DVec3};
use durer_tests::{bits, import, prepared, render, scene};

/// A picture of one pixel, all of which is the point `at`, seen from `eye` by direct light; all samples weigh exactly 1.
fn spot(eye: [f64; 3], at: [f64; 3], world: &str) -> String {
    let [ex, ey, ez] = eye;
    let [ax, ay, az] = at;
    format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt {ex} {ey} {ez}  {ax} {ay} {az}  0.1 0.9 0.3\nCamera \"perspective\" \"float fov\" 0.0001\n\
         Integrator \"whitted\"\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\n{world}"
    )
}

fn radiance(text: &str, samples: u32) -> f64 {
    let options = Options { samples: Some(samples), ..Options::default() };
    render(&scene(text, &options)).film.pixels()[0].mean()[1].into()
}

const FLOOR: &str = "Shape \"plane\"\n";

/// Irradiance of the floor y = 0 at `(x, z)`: white matte surfaces reflect it divided by pi.
fn irradiance(x: f64, z: f64, lights: &str, samples: u32) -> f64 {
    PI * radiance(&spot([x + 1.5, 1.1, z + 6.0], [x, 0.0, z], &format!("{FLOOR}{lights}")), samples)
}

/// Something that shines downwards from `height`.
fn ceiling(height: f64, shape: &str) -> String {
    format!(
        "AttributeBegin AreaLightSource \"diffuse\" Translate 0 {height} 0 Rotate 90 1 0 0 {shape} AttributeEnd\n"
    )
}

fn square(edge: f64) -> String {
    let h = 0.5 * edge;
    format!("Shape \"polygon\" \"point3 P\" [-{h} -{h} 0  {h} -{h} 0  {h} {h} 0  -{h} {h} 0]")
}

#[test]
fn a_disk_light_gives_e9_and_a_square_light_e10() {
    let disk = irradiance(0.0, 0.0, &ceiling(2.0, "Shape \"disk\""), 4096);
    assert!((disk - 0.628_319).abs() < 5e-5, "E9: {disk}");
    let quad = "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \
                \"point3 P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0]";
    let patch = "Shape \"bilinearmesh\" \"point3 P\" [-.5 -.5 0  .5 -.5 0  -.5 .5 0  .5 .5 0]";
    for shape in [&square(1.0), quad, patch] {
        let e = irradiance(0.0, 0.0, &ceiling(1.0, shape), 1024);
        assert!((e - 0.752_275).abs() < 5e-5, "E10: {e} {shape}");
    }
}

#[test]
fn a_point_light_and_a_spot_on_its_axis_give_e12() {
    let point = "LightSource \"point\" \"point3 from\" [0 2 0] \"rgb I\" [3 3 3]\n";
    // cos = 2 / sqrt(5), d² = 5.
    let e = irradiance(1.0, 0.0, point, 1);
    assert!((e / (3.0 * 2.0 / 5f64.powf(1.5)) - 1.0).abs() < 1e-5, "{e}");
    let spot = "LightSource \"spot\" \"point3 from\" [0 2 0] \"point3 to\" [0 0 0] \"float power\" 5 \
                \"float coneangle\" 40 \"float conedeltaangle\" 15\n";
    let (inner, outer) = (25f64.to_radians().cos(), 40f64.to_radians().cos());
    let intensity = 5.0 / (2.0 * PI * ((1.0 - inner) + 0.5 * (inner - outer)));
    let e = irradiance(0.0, 0.0, spot, 1);
    assert!((e / (intensity / 4.0) - 1.0).abs() < 1e-5, "{e}");
    // The integral over the floor of what arrives is the power: rings of equal width, E 2 pi x dx.
    let rings = 60;
    let reach = 2.0 * 40f64.to_radians().tan();
    let arriving: f64 = (0..rings)
        .map(|i| {
            let x = (f64::from(i) + 0.5) / f64::from(rings) * reach;
            irradiance(x, 0.0, spot, 1) * 2.0 * PI * x * reach / f64::from(rings)
        })
        .sum();
    assert!((arriving / 5.0 - 1.0).abs() < 2e-3, "{arriving}");
}

/// A blocker at y = 1 whose straight edge runs along z at `x = 0`.
const HALF_PLANE: &str = "Shape \"polygon\" \"point3 P\" [-40 1 -40  0 1 -40  0 1 40  -40 1 40]\n";

#[test]
fn the_penumbra_of_an_edge_has_the_width_f1() {
    // D = 1, a = 2, b = 1: D b / a = 0.5, half to either side.
    let light = ceiling(3.0, &square(1.0));
    let blocked = format!("{light}{HALF_PLANE}");
    assert_eq!(irradiance(-0.2505, 0.0, &blocked, 1024), 0.0);
    assert!(irradiance(-0.2465, 0.0, &blocked, 1024) > 0.0);
    let open = |x| irradiance(x, 0.0, &light, 1024);
    assert!(irradiance(0.2465, 0.0, &blocked, 1024) < open(0.2465));
    assert_eq!(irradiance(0.2505, 0.0, &blocked, 1024), open(0.2505));
}

#[test]
fn the_umbra_of_a_strip_vanishes_below_a_third_of_the_lights_width() {
    let strip = |w: f64| {
        let h = 0.5 * w;
        let p = format!("[-{h} 1 -40  {h} 1 -40  {h} 1 40  -{h} 1 40]");
        format!("{}Shape \"polygon\" \"point3 P\" {p}\n", ceiling(3.0, &square(1.0)))
    };
    // W (1 + b / a) - D b / a: 1 for W = 1, none for W = 0.2.
    let wide = strip(1.0);
    assert_eq!(irradiance(0.4995, 0.0, &wide, 1024), 0.0);
    assert!(irradiance(0.5035, 0.0, &wide, 1024) > 0.0);
    assert!(irradiance(0.0, 0.0, &strip(0.2), 1024) > 0.0);
    assert_eq!(irradiance(0.0, 0.0, &strip(0.35), 1024), 0.0);
}

#[test]
fn across_the_penumbra_square_and_disk_lights_fade_as_f2_says() {
    // So small that nothing but visibility changes across the penumbra: half its width is 0.005.
    let lights = [ceiling(3.0, &square(0.02)), ceiling(3.0, "Shape \"disk\" \"float radius\" 0.01")];
    let expected = [[0.625, 0.75, 0.875], [0.657_481, 0.804_499, 0.927_853]];
    for (light, expected) in lights.iter().zip(expected) {
        for (t, fraction) in [0.25, 0.5, 0.75].into_iter().zip(expected) {
            for sign in [1.0, -1.0] {
                let x = sign * t * 0.005;
                let fraction = if sign > 0.0 { fraction } else { 1.0 - fraction };
                let visible = irradiance(x, 0.0, &format!("{light}{HALF_PLANE}"), 4096)
                    / irradiance(x, 0.0, light, 4096);
                // The edge cuts some 200 of the 4096 cells of the net, each right to half a cell at random: 3 sigma.
                assert!((visible - fraction).abs() < 5e-3, "t {t} {sign}: {visible} {fraction}");
            }
        }
    }
}

#[test]
fn eyes_and_mirrors_see_the_radiance_of_a_light() {
    let lamp = "AreaLightSource \"diffuse\" \"rgb L\" [2 3.25 4] \"float scale\" 2 Shape \"sphere\"\n";
    let seen = |world: &str| radiance(&spot([0.0, 0.0, -5.0], [0.0, 0.0, 0.0], world), 4);
    assert_eq!(seen(lamp), 6.5);
    let mirror = "AttributeBegin Material \"mirror\" \"rgb reflectance\" [1 1 1] \
                  Shape \"disk\" \"float radius\" 9 AttributeEnd\n";
    let behind = format!("{mirror}AttributeBegin Translate 0 0 -20 {lamp} AttributeEnd\n");
    assert_eq!(seen(&behind), 6.5);
    // The inside does not shine, unless it is asked to, or turned out.
    let disk = |more: &str| format!("AreaLightSource \"diffuse\" {more} Shape \"disk\"\n");
    assert_eq!(seen(&disk("")), 0.0);
    assert_eq!(seen(&disk("\"bool twosided\" true")), 1.0);
    assert_eq!(seen(&disk("ReverseOrientation")), 1.0);
    assert_eq!(seen(&disk("Scale -1 1 1")), 0.0);
}

#[test]
fn lights_keep_to_their_block_and_to_the_shapes_in_it() {
    let text = "WorldBegin\nAttributeBegin\nAreaLightSource \"diffuse\"\nShape \"sphere\"\nShape \"disk\"\nAttributeEnd\n\
                Shape \"sphere\"\nObjectBegin \"lamp\"\nAreaLightSource \"diffuse\"\nShape \"disk\"\nObjectEnd\n\
                ObjectInstance \"lamp\"\nScale 2 3 4 ObjectInstance \"lamp\"\n";
    let scene = prepared(import(text), &Options::default()).scene;
    let lights: Vec<_> = scene.objects.iter().map(|o| o.light).collect();
    assert_eq!(lights, [Some(0), Some(1), None, Some(2), Some(3)]);
    let mut infinite = import("WorldBegin\nAreaLightSource \"diffuse\"\nShape \"plane\"\n");
    assert!(durer::prepare(&mut infinite, &Options::default()).is_none());
    assert!(infinite.diagnostics.iter().any(|d| d.message.contains("a shape without end")));
}

/// Pictures with and without shadows.
fn with_and_without_shadows(world: &str) -> [Rendered; 2] {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nLookAt 0 5 -9  0 0 0  0 1 0\n\
         Camera \"perspective\" \"float fov\" 60\nWorldBegin\nMaterial \"diffuse\"\n{FLOOR}{world}"
    );
    ["whitted", "cast"].map(|integrator| {
        let options = Options {
            samples: Some(8),
            integrator: Some(integrator.to_owned()),
            show: (integrator == "cast").then_some(Show::Shading),
            ..Options::default()
        };
        render(&scene(&text, &options))
    })
}

#[test]
fn no_light_stands_in_its_own_way() {
    let octahedron = "Shape \"trianglemesh\" \"point3 P\" [1 0 0  0 1 0  0 0 1  -1 0 0  0 -1 0  0 0 -1] \
         \"integer indices\" [0 1 2  1 3 2  3 4 2  4 0 2  1 0 5  3 1 5  4 3 5  0 4 5]";
    let quad = format!("Rotate 70 1 0 0 {}", square(1.5));
    let shapes = [
        "Shape \"sphere\"",
        "Scale 0.5 1 1.6 Shape \"sphere\"",
        "Rotate 90 1 0 0 Shape \"disk\"",
        octahedron,
        "Scale -0.3 2 1 Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [1 0 0  0 1 0  0 0 1  -1 0 0  0 -1 0  0 0 -1] \
         \"integer indices\" [0 1 2  1 3 2  3 4 2  4 0 2  1 0 5  3 1 5  4 3 5  0 4 5]",
        &quad,
        "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]",
    ];
    for shape in shapes {
        // Far from the origin, small and large, touching the floor, moving, repeated.
        for place in [
            "Translate 0.3 1.7 0.2",
            "Translate 0.3 1.01 0.2 Scale 0.01 0.01 0.01",
            "Translate -300 700 900 Scale 300 300 300",
            "TransformKeys \"float times\" [0 1] \"point3 translate\" [-1 2 0  1 3 0] \"float rotate\" [0 1 2 0  50 1 2 0]",
        ] {
            // The inside of what is closed is hidden by its outside.
            let is_closed = ["sphere", "trianglemesh", "loopsubdiv"].iter().any(|kind| shape.contains(kind));
            let lamp = format!("AreaLightSource \"diffuse\" \"bool twosided\" {}", !is_closed);
            let world = format!("AttributeBegin {lamp} {place} {shape} AttributeEnd\n");
            let [shadows, none] = with_and_without_shadows(&world);
            assert!(none.film.pixels().iter().any(|p| p.mean()[1] > 0.0), "{world}");
            assert_eq!(bits(&shadows), bits(&none), "{world}");
        }
    }
}

#[test]
fn a_light_flush_with_the_ceiling_shines() {
    let light = ceiling(2.0, &square(1.0));
    let flush = format!("{light}Shape \"polygon\" \"point3 P\" [-3 2 -3  3 2 -3  3 2 3  -3 2 3]\n");
    for x in [0.0, 0.7, 2.9] {
        assert_eq!(irradiance(x, 0.1, &flush, 64), irradiance(x, 0.1, &light, 64), "{x}");
    }
}

#[test]
fn a_moving_light_is_where_it_is_at_each_moment() {
    // From x = -1 to 1 in the time that the shutter is open, at height 1: the mean of E = I / (1 + x²)^1.5 is I / sqrt 2.
    let moved = |light: &str| {
        let keys = "TransformKeys \"float times\" [0 1] \"point3 translate\" [-1 1 0  1 1 0]";
        irradiance(0.0, 0.0, &format!("AttributeBegin {keys} {light} AttributeEnd\n"), 1024)
    };
    let expected = 0.5f64.sqrt();
    let point = moved("LightSource \"point\" \"rgb I\" [1 1 1]");
    assert!((point - expected).abs() < 2e-4, "{point}");
    // A sphere whose intensity, pi r² L, is 1.
    let l = 1.0 / (PI * 0.04);
    let sphere = moved(&format!(
        "AreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {l}] Shape \"sphere\" \"float radius\" 0.2"
    ));
    assert!((sphere - expected).abs() < 2e-3, "{sphere}");
    // A spot that turns away from the floor lights it half of the time.
    let turning = "TransformKeys \"float times\" [0 1] \"float rotate\" [0 1 0 0  90 1 0 0]";
    let cone = "\"float coneangle\" 45 \"float conedeltaangle\" 0 \"point3 to\" [0 -1 0]";
    let spot = format!("AttributeBegin Translate 0 2 0 {turning} LightSource \"spot\" {cone} AttributeEnd\n");
    let e = irradiance(0.0, 0.0, &spot, 1024);
    assert!((e - 0.125).abs() < 2e-3, "{e}");
    let sun =
        format!("AttributeBegin {turning} LightSource \"distant\" \"point3 to\" [0 -1 0] AttributeEnd\n");
    // The mean of the cosine over a quarter turn.
    let e = irradiance(0.0, 0.0, &sun, 1024);
    assert!((e - 2.0 / PI).abs() < 1e-3, "{e}");
}

#[test]
fn highlights_are_for_lights_that_mirrors_cannot_show() {
    let seen = |material: &str, light: &str| {
        let world = format!(
            "AttributeBegin Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb specular\" [1 1 1] \
             \"float exponent\" 4 {material} {FLOOR} AttributeEnd {light}"
        );
        radiance(&spot([0.0, 2.0, -2.0], [0.0, 0.0, 0.0], &world), 16)
    };
    let (lamp, point) = (
        ceiling(3.0, "Shape \"disk\" \"float radius\" 0.3"),
        "LightSource \"point\" \"point3 from\" [0 3 0]",
    );
    let mirror = "\"rgb reflection\" [.5 .5 .5]";
    assert!(seen("", &lamp) > 0.0 && seen("", point) > 0.0 && seen(mirror, point) > 0.0);
    assert_eq!(seen(mirror, &lamp), 0.0);
}

/// A built-in scene, small, and its mean radiance in the pixel at fractions of width and height.
fn pictured(name: &str, width: u32, samples: u32) -> impl Fn(f64, f64) -> [f64; 3] {
    let imported = builtin::find(name).expect("a built-in scene").import();
    let (w, h) = (imported.desc.film.width.expect("a width"), imported.desc.film.height.expect("a height"));
    let height = (width * h).div_ceil(w);
    let options =
        Options { width: Some(width), height: Some(height), samples: Some(samples), ..Options::default() };
    let pixels = render(&prepared(imported, &options)).film.pixels();
    move |x, y| {
        let (x, y) = ((x * f64::from(width)) as usize, (y * f64::from(height)) as usize);
        pixels[y * width as usize + x].mean().map(f64::from)
    }
}

#[test]
fn the_shadows_of_the_scene_penumbra_are_complements_of_its_lights() {
    let at = pictured("penumbra", 240, 16);
    let [yellow, cyan, magenta] = [at(0.383, 0.694), at(0.625, 0.778), at(0.5, 0.805)];
    for (seen, hidden) in [(yellow, 2), (cyan, 0), (magenta, 1)] {
        assert!((0..3).all(|c| c == hidden || seen[c] > 1.5 * seen[hidden]), "{hidden} in {seen:?}");
    }
    // Where two are hidden the third is left alone.
    for (seen, left) in [(at(0.453, 0.708), 0), (at(0.544, 0.717), 2)] {
        assert!((0..3).all(|c| c == left || seen[left] > 2.0 * seen[c]), "{left} in {seen:?}");
    }
    // The lights, seen, have their radiance.
    for (x, expected) in [(0.317, [400.0, 42.0, 22.0]), (0.5, [6.0, 58.0, 9.0]), (0.7, [2.4, 6.0, 31.0])] {
        let seen = at(x, if x < 0.4 { 0.068 } else { 0.045 });
        assert!((0..3).all(|c| (seen[c] / expected[c] - 1.0).abs() < 1e-5), "{seen:?}");
    }
}

/// Lambert's formula (1760): irradiance from a polygon of radiance 1 all above the horizon of `n` at `p`.
fn lambert(corners: &[DVec3], p: DVec3, n: DVec3) -> f64 {
    let rays: Vec<DVec3> = corners.iter().map(|c| (*c - p).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (rays[i], rays[(i + 1) % rays.len()]);
        a.angle_between(b) * a.cross(b).normalize().dot(n)
    };
    (0.5 * (0..rays.len()).map(edge).sum::<f64>()).abs()
}

#[test]
fn the_cornell_box_is_lit_as_lamberts_formula_says() {
    let at = pictured("cornell", 96, 64);
    // A point of the room in the picture: camera at 278 273 -800, x to the left, film 25 mm, focal length 35 mm.
    let pixel = |p: DVec3| {
        let depth = (p.z + 800.0) * 2.0 * 12.5 / 35.0;
        at(0.5 - (p.x - 278.0) / depth, 0.5 - (p.y - 273.0) / depth)
    };
    let lamp = [(343.0, 227.0), (343.0, 332.0), (213.0, 332.0), (213.0, 227.0)];
    let lamp = lamp.map(|(x, z)| DVec3::new(x, 548.8, z));
    let seen = pixel(DVec3::new(278.0, 548.8, 280.0));
    // Its own surface reflects 0.78 of the ambient term.
    let sent = |c: usize| [17.0, 12.0, 4.0][c] + 0.78 * [0.16, 0.125, 0.06][c];
    assert!((0..3).all(|c| (seen[c] / sent(c) - 1.0).abs() < 1e-5), "{seen:?}");
    let white = [0.725, 0.71, 0.68];
    let green = [0.14, 0.45, 0.091];
    let places = [
        (DVec3::new(278.0, 450.0, 559.2), -DVec3::Z, white),
        (DVec3::new(450.0, 0.0, 80.0), DVec3::Y, white),
        (DVec3::new(0.0, 300.0, 300.0), DVec3::X, green),
    ];
    for (p, n, albedo) in places {
        let (e, seen) = (lambert(&lamp, p, n), pixel(p));
        for c in 0..3 {
            let expected = albedo[c] * ([0.16, 0.125, 0.06][c] + [17.0, 12.0, 4.0][c] * e / PI);
            // A pixel is some 6 mm wide; light fades by less than 1 % across it.
            assert!((seen[c] / expected - 1.0).abs() < 0.02, "{p} {c}: {} {expected}", seen[c]);
        }
    }
    // In the shadow of the tall block only the ambient term is left.
    let shadow = pixel(DVec3::new(551.0, 60.0, 420.0));
    assert!((shadow[0] / (0.63 * 0.16) - 1.0).abs() < 0.02, "{shadow:?}");
}
