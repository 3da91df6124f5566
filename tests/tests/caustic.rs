//! Caustics: their place and their energy in closed form, and what they cost paths.
use durer::{Options, Prepared, builtin, math::Point2, math::Point3};
use durer_tests::{prepared, render, scene};

fn means(scene: &Prepared) -> Vec<f64> {
    render(scene).film.pixels().iter().map(|p| p.mean()[1].into()).collect()
}

fn caustic(integrator: &str, width: u32, samples: u32) -> Prepared {
    let options = Options {
        integrator: Some(integrator.to_owned()),
        width: Some(width),
        samples: Some(samples),
        ..Options::default()
    };
    prepared(builtin::find("caustic").expect("built in").import(), &options)
}

/// A ball of index 1.5 and radius R focuses what comes from afar `n R / 2 (n - 1) = 1.5 R` behind its middle.
#[test]
fn the_lens_of_the_caustic_scene_gathers_the_light_where_its_focus_is() {
    let scene = caustic("light", 320, 24);
    let (lamp, middle) = (Point3::new(-3.6, 4.8, 0.6), Point3::new(-0.55, 0.7, 0.15));
    let d = (middle - lamp).normalize();
    let focus = middle + d * (1.5 * 0.5837);
    assert!(focus.y.abs() < 2e-3, "it lies on the table: {focus:?}");
    let view = &scene.scene.view;
    let place = |p: Point3| {
        let p = Point3::from_f64(p.to_f64() - view.world_from_render);
        view.sees(p, Point2::new(0.5, 0.5), 0.0).expect("in front of the camera").film
    };
    let expected = place(focus);
    // The middle of what is more than half as bright as the brightest block of 3 x 3 pixels near the ball's shadow.
    let pixels = means(&scene);
    let block =
        |x: usize, y: usize| (0..9).map(|i| pixels[(y + i / 3 - 1) * 320 + x + i % 3 - 1]).sum::<f64>();
    let near = |x: usize, y: usize| (x as f32 - expected.x).hypot(y as f32 - expected.y) < 25.0;
    let places = || (1..199).flat_map(|y| (1..319).map(move |x| (x, y))).filter(|&(x, y)| near(x, y));
    let most = places().map(|(x, y)| block(x, y)).fold(0.0, f64::max);
    let (mut sum, mut at) = (0.0, [0.0; 2]);
    for (x, y) in places().filter(|&(x, y)| block(x, y) > 0.5 * most) {
        sum += block(x, y);
        at = [at[0] + x as f64 * block(x, y), at[1] + y as f64 * block(x, y)];
    }
    let found = at.map(|v| v / sum + 0.5);
    let off = (found[0] - f64::from(expected.x)).hypot(found[1] - f64::from(expected.y));
    assert!(off < 4.0, "{found:?}, expected {expected:?}");
    // Without the ball the table there has E / pi times its colour.
    let distance = f64::from((focus - lamp).length());
    let irradiance = 29000.0 * std::f64::consts::PI * (0.03 / distance).powi(2) * f64::from(-d.y);
    assert!(most / 9.0 > 10.0 * 0.56 * irradiance / std::f64::consts::PI, "{most}");
}

/// Fresnel's equations for unpolarised light that enters a medium of index `n` at an angle.
fn fresnel(cos: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    0.5 * (s * s + p * p)
}

/// Of parallel light that a ball intercepts `integral (1 - F)² 2 sin cos` goes straight through, on a screen below.
#[test]
fn as_much_light_goes_through_a_ball_as_fresnel_lets_pass() {
    let world = "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1]\n\
        AttributeBegin Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" AttributeEnd\n\
        Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]\n\
        Shape \"bilinearmesh\" \"point3 P\" [-8 -1.1 -8  -8 -1.1 8  8 -1.1 -8  8 -1.1 8]";
    let flux = |integrator: &str, depth: u32| {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 48\nPixelFilter \"box\"\n\
             LookAt 0 -3 0  0 0 0  0 0 1\nCamera \"orthographic\" \"float screenwindow\" [-6 6 -6 6]\n\
             Integrator \"{integrator}\" \"integer maxdepth\" {depth} \"integer roulettedepth\" 50\nWorldBegin\n{world}"
        );
        let pixels = means(&scene(&text, &Options { samples: Some(256), ..Options::default() }));
        std::f64::consts::PI * pixels.iter().sum::<f64>() * 144.0 / pixels.len() as f64
    };
    let n = 4096;
    let angles = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
    // d(sin²) = 2 sin cos dtheta
    let share =
        angles.map(|sin2| (1.0 - fresnel((1.0 - sin2).sqrt(), 1.5)).powi(2)).sum::<f64>() / f64::from(n);
    let expected = std::f64::consts::PI * share;
    for integrator in ["light", "bdpt"] {
        // In and out, and spread by the screen; what is mirrored outside needs one bounce less.
        let found = flux(integrator, 3) - flux(integrator, 2);
        assert!((found / expected - 1.0).abs() < 0.015, "{integrator}: {found} W, expected {expected}");
        // What goes by.
        let beside = flux(integrator, 1);
        let free = 144.0 - std::f64::consts::PI;
        assert!((beside / free - 1.0).abs() < 4e-3, "{integrator}: {beside} W, expected {free}");
    }
}

/// What an error costs: the mean square of the relative error in the pixels of the caustics, times the rays of a pixel, which
/// does not depend on the samples where there is no blur. Medians say what most pixels are like: docs/bidirectional.md.
#[test]
fn an_error_of_a_caustic_costs_particles_fewer_rays() {
    if std::env::var_os("DURER_SLOW").is_none() {
        eprintln!("SKIPPED: an_error_of_a_caustic_costs_particles_fewer_rays: set DURER_SLOW=1");
        return;
    }
    let width = 96;
    let reference = means(&caustic("bdpt", width, 512));
    let particles = means(&caustic("light", width, 512));
    let mut straight = caustic("light", width, 128);
    let node = durer::scene::Node::new("light", durer::scene::Params::new().int("maxdepth", 1));
    straight.integrator = durer::compile::integrator(&node, &mut Default::default()).expect("sound");
    let straight = means(&straight);
    let is_matte = |i: usize| (particles[i] / reference[i] - 1.0).abs() < 0.1;
    let counts = |i: &usize| particles[*i] > 2.0 * straight[*i] + 0.05 && is_matte(*i);
    let caustics: Vec<usize> = (0..reference.len()).filter(counts).collect();
    eprintln!("{} pixels of caustics on the table", caustics.len());
    let mut costs = Vec::new();
    // Discs of 3 pixels are 10 cm wide in so small a picture, wider than the caustics.
    for (integrator, samples, radius) in [
        ("path", 1024, None),
        ("light", 64, None),
        ("bdpt", 64, None),
        ("sppm", 64, None),
        ("sppm", 64, Some(0.05)),
        ("sppm", 256, Some(0.05)),
    ] {
        let mut scene = caustic(integrator, width, samples);
        if let Some(radius) = radius {
            let node =
                durer::scene::Node::new(integrator, durer::scene::Params::new().float("radius", radius));
            scene.integrator = durer::compile::integrator(&node, &mut Default::default()).expect("sound");
        }
        scene.settings.seed = 7;
        let rendered = render(&scene);
        let rays = rendered.rays as f64 / reference.len() as f64;
        let found: Vec<f64> = rendered.film.pixels().iter().map(|p| p.mean()[1].into()).collect();
        let mut off: Vec<f64> = caustics.iter().map(|&i| (found[i] / reference[i] - 1.0).abs()).collect();
        let square = off.iter().map(|off| off * off).sum::<f64>() / off.len() as f64;
        off.sort_by(f64::total_cmp);
        let median = off[off.len() / 2];
        eprintln!(
            "| {integrator} {radius:?} | {samples} | {rays:.0} | {median:.3} | {:.3} | {:.0} |",
            square.sqrt(),
            square * rays
        );
        costs.push(square * rays);
    }
    let [path, light, both, blurred @ ..] = &costs[..] else { unreachable!() };
    assert!(light.max(*both) < 0.1 * path, "{costs:?}");
    // Blur costs photons much of what they gain.
    assert!(blurred.iter().all(|cost| cost < path), "{costs:?}");
}

/// How far caustics are off, and after how many samples of paths they still are: docs/benchmarks.md.
#[test]
fn paths_look_in_vain_for_what_particles_bring() {
    let slow = std::env::var_os("DURER_SLOW").is_some();
    let (width, many, times) = if slow { (64, 1024, 100) } else { (48, 256, 10) };
    let reference = means(&caustic("bdpt", width, many));
    // Where particles bring more by glass and brass than straight from the lamp, and nearly all: not where something sharp is
    // seen that may mirror the lamp itself.
    let of_depth = |depth: i32| {
        let mut scene = caustic("light", width, many);
        let node = durer::scene::Node::new("light", durer::scene::Params::new().int("maxdepth", depth));
        scene.integrator = durer::compile::integrator(&node, &mut Default::default()).expect("sound");
        means(&scene)
    };
    let (all, straight) = (of_depth(8), of_depth(1));
    let is_matte = |i: usize| (all[i] / reference[i] - 1.0).abs() < 0.15;
    let counts = |i: &usize| all[*i] > 2.0 * straight[*i] + 0.05 && is_matte(*i);
    let caustics: Vec<usize> = (0..reference.len()).filter(counts).collect();
    assert!(caustics.len() > 10, "{}", caustics.len());
    let median = |integrator: &str, samples: u32| {
        let start = std::time::Instant::now();
        let mut scene = caustic(integrator, width, samples);
        scene.settings.seed = 7;
        let found = means(&scene);
        let mut off: Vec<f64> = caustics.iter().map(|&i| (found[i] / reference[i] - 1.0).abs()).collect();
        off.sort_by(f64::total_cmp);
        let (median, count) = (off[off.len() / 2], off.len());
        eprintln!(
            "{integrator} {samples} spp: off by {median:.3} in half of {count} pixels, {:?}",
            start.elapsed()
        );
        median
    };
    let both = median("bdpt", 16);
    let path = median("path", 16 * times);
    assert!(path > 1.5 * both, "16 samples of bdpt: {both}, {} of path: {path}", 16 * times);
    if slow {
        for (integrator, samples) in [("bdpt", 4), ("bdpt", 64), ("light", 16), ("path", 16)] {
            median(integrator, samples);
        }
    }
}
