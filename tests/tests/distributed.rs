//! Distributed ray tracing against closed forms (validation.md F1 to F11; whitted-cook.md C1, C2): each effect alone, all
//! together in both ways of sampling, each one frozen.
use durer::{
    Distribution, Gather, Options, Prepared, Rendered,
    compile::{Aperture, LensOptions},
    integrator::Sampling,
    math::Interval,
    probe::{Counters, RayKind},
};
use durer_tests::{bits, render, scene};

fn distributed(samples: u32, distribution: Distribution) -> Options {
    Options {
        integrator: Some("distributed".to_owned()),
        samples: Some(samples),
        distribution,
        ..Options::default()
    }
}

fn values(rendered: &Rendered) -> Vec<f64> {
    rendered.film.pixels().iter().map(|p| f64::from(p.mean()[1])).collect()
}

/// A scene with a light has no other light than its own.
const DARK: &str = "LightSource \"ambient\" \"rgb L\" [0 0 0]\n";

/// The point `at`, seen from `eye`, in all of a picture of one pixel.
fn spot(eye: [f64; 3], at: [f64; 3], world: &str, options: &Options) -> f64 {
    let [[ex, ey, ez], [ax, ay, az]] = [eye, at];
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
         LookAt {ex} {ey} {ez}  {ax} {ay} {az}  0.1 0.2 0.9\nCamera \"perspective\" \"float fov\" 0.0001\n\
         WorldBegin\n{DARK}{world}"
    );
    values(&render(&scene(&text, options)))[0]
}

/// A square light of the edge 0.02 or a disk of the radius 0.01, 3 above the floor, and 1 above it a half-plane whose edge
/// runs above the line x = 0: the penumbra reaches from -0.005 to 0.005.
fn penumbra_light(shape: &str) -> String {
    format!(
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 0 3 0 Rotate 90 1 0 0 {shape} AttributeEnd\n"
    )
}

const WHITE_FLOOR: &str = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape \"plane\"\n";
const HALF_PLANE: &str = "Shape \"polygon\" \"point3 P\" [0 1 -40  0 1 40  -40 1 40  -40 1 -40]\n";
const SQUARE: &str = "Shape \"polygon\" \"point3 P\" [-.01 -.01 0  .01 -.01 0  .01 .01 0  -.01 .01 0]";
const DISK: &str = "Shape \"disk\" \"float radius\" 0.01";

#[test]
fn shadow_rays_alone_give_the_penumbra_f2() {
    let expected = [[0.625, 0.75, 0.875], [0.657_481, 0.804_499, 0.927_853]];
    for (shape, expected) in [SQUARE, DISK].into_iter().zip(expected) {
        for (t, fraction) in [0.25, 0.5, 0.75].into_iter().zip(expected) {
            for (samples, shadow) in [(4096, 1), (64, 64)] {
                let x = t * 0.005;
                let rays = Distribution {
                    shadow_rays: Some(shadow),
                    sampling: Some(Sampling::Nested),
                    ..Distribution::default()
                };
                let light = penumbra_light(shape);
                let seen = |world: String| {
                    spot([x + 0.5, 0.4, 2.0], [x, 0.0, 0.0], &world, &distributed(samples, rays))
                };
                let open = seen(format!("{WHITE_FLOOR}{light}"));
                let share = seen(format!("{WHITE_FLOOR}{light}{HALF_PLANE}")) / open;
                assert!((share - fraction).abs() < 5e-3, "{shape} {t} {shadow}: {share} {fraction}");
            }
        }
    }
}

#[test]
fn lens_points_alone_blur_a_dot_to_an_even_disc_f4() {
    // A dot that shines by itself at depth 2, a lens of radius 0.2 focused at 4 m; 64 pixels show 0.1 to each side at 1 m.
    let (n, radius) = (64u32, 0.0125);
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" {n} \"integer yresolution\" {n} PixelFilter \"box\"\n\
         Sampler \"stratified\" Camera \"perspective\" \"float fov\" {fov} \"float lensradius\" 0.2 \"float focaldistance\" 4\n\
         WorldBegin\n{DARK}Material \"principled\" \"bool unlit\" true Shape \"disk\" \"float height\" 2 \"float radius\" {radius}\n",
        fov = 2.0 * 0.1f64.atan().to_degrees(),
    );
    let middle = |i: usize| i as f64 + 0.5 - f64::from(n) / 2.0;
    let all = values(&render(&scene(&text, &distributed(144, Distribution::default()))));
    let place = |i: usize| middle(i % n as usize).hypot(middle(i / n as usize));
    let sum: f64 = all.iter().sum();
    let square: f64 = all.iter().enumerate().map(|(i, v)| v * place(i).powi(2)).sum::<f64>() / sum;
    // Diameter A |z - z_f| / z on the plane in focus, where a pixel is 0.1 4 / 32; the dot is 2 pixels in radius.
    let blur: f64 = 0.4 * (4.0 - 2.0) / 2.0 / 2.0 / (0.1 * 4.0 / 32.0);
    let expected = blur * blur / 2.0 + 2.0 + 1.0 / 6.0;
    assert!((square / expected - 1.0).abs() < 0.03, "{square} {expected}");
    assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.03, "{sum}");
    assert!(all.iter().enumerate().all(|(i, v)| place(i) < blur + 2.8 || *v == 0.0), "dark outside");
}

#[test]
fn moments_alone_make_a_trapezoid_f6() {
    for (w, v) in [(8.0f64, 24.0), (20.0, 10.0)] {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 2 PixelFilter \"box\"\n\
             Sampler \"stratified\" Camera \"orthographic\" \"float screenwindow\" [0 64 0 2]\nWorldBegin\n{DARK}\
             Material \"principled\" \"bool unlit\" true\n\
             TransformKeys \"float times\" [0 1] \"point3 translate\" [10 0 0  {to} 0 0]\n\
             Shape \"polygon\" \"point3 P\" [0 -1 1  {w} -1 1  {w} 9 1  0 9 1]\n",
            to = 10.0 + v
        );
        let all = values(&render(&scene(&text, &distributed(256, Distribution::default()))));
        let covered = |x: f64| {
            let (enters, leaves) = ((x - 10.0 - w) / v, (x - 10.0) / v);
            (leaves.clamp(0.0, 1.0) - enters.clamp(0.0, 1.0)).max(0.0)
        };
        for (x, value) in all.iter().take(64).enumerate() {
            let expected =
                (0..50).map(|i| covered(x as f64 + (f64::from(i) + 0.5) / 50.0)).sum::<f64>() / 50.0;
            assert!((value - expected).abs() < 0.03, "{w} {v}: pixel {x}: {value}, expected {expected}");
        }
        assert!((all.iter().sum::<f64>() / 2.0 - w).abs() < 0.1, "{w} {v}");
    }
}

/// Something that ends in a straight edge, `psi` degrees beside the point above (or below) the origin, at height `y`.
fn edge(psi: f64, y: f64, what: &str) -> String {
    let x = y.abs() * psi.to_radians().tan();
    format!(
        "AttributeBegin {what} Shape \"polygon\" \"point3 P\" [{x} {y} -60  {x} {y} 60  -60 {y} 60  -60 {y} -60] AttributeEnd\n"
    )
}

/// What shines with radiance 1: found by rays about the mirror direction only, or by shadow rays too.
const SHINING: [&str; 2] = [
    "Material \"principled\" \"bool unlit\" true",
    "AreaLightSource \"diffuse\" \"bool twosided\" true Material \"diffuse\" \"rgb reflectance\" [0 0 0]",
];
/// Angle between main direction and edge, and the share of the lobe of exponent 32 before the edge.
const ACROSS: [(f64, f64); 3] = [(2.0, 0.578_880), (5.0, 0.690_703), (20.0, 0.977_839)];

#[test]
fn gloss_rays_alone_blur_a_straight_edge_f9() {
    let mirror = "Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb reflection\" [1 1 1] \"float gloss\" 32 Shape \"plane\"\n";
    for (psi, expected) in ACROSS {
        for shining in SHINING {
            for (samples, rays) in [(4096, 1), (256, 16)] {
                let gloss = Distribution {
                    gloss_rays: Some(rays),
                    sampling: Some(Sampling::Nested),
                    ..Distribution::default()
                };
                let world = format!("{mirror}{}", edge(psi, 1.0, shining));
                let got = spot([0.0, 0.5, 0.0], [0.0; 3], &world, &distributed(samples, gloss));
                assert!((got - expected).abs() < 0.01, "{psi} {rays} {shining}: {got} {expected}");
            }
        }
    }
}

#[test]
fn translucency_alone_blurs_a_straight_edge_f9() {
    let sheet = "Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb transmission\" [1 1 1] \"float eta\" 1 \
                 \"float translucency\" 32 Shape \"plane\"\n";
    for (psi, expected) in ACROSS {
        for shining in SHINING {
            let world = format!("{sheet}{}", edge(psi, -1.0, shining));
            let options = distributed(4096, Distribution::default());
            let got = spot([0.0, 0.5, 0.0], [0.0; 3], &world, &options);
            assert!((got - expected).abs() < 0.01, "{psi} {shining}: {got} {expected}");
        }
    }
}

#[test]
fn points_of_the_pixel_alone_weigh_an_edge_by_the_filter_f10() {
    // The share of a triangle filter of radius 1.5 left of an edge 0.2 right of the middle of the pixel; of the box: 0.7.
    let tent = 1.0 - (1.5f64 - 0.2).powi(2) / (2.0 * 1.5 * 1.5);
    let filters = [("\"box\"", 0.7), ("\"triangle\" \"float xradius\" 1.5 \"float yradius\" 1.5", tent)];
    for (filter, expected) in filters {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 3 \"integer yresolution\" 1\nPixelFilter {filter}\n\
             Sampler \"stratified\" Camera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -.5 .5]\nWorldBegin\n{DARK}\
             Material \"principled\" \"bool unlit\" true Shape \"polygon\" \"point3 P\" [-9 -9 1  .2 -9 1  .2 9 1  -9 9 1]\n"
        );
        let got = values(&render(&scene(&text, &distributed(1024, Distribution::default()))))[1];
        assert!((got - expected).abs() < 5e-3, "{filter}: {got} {expected}");
    }
}

/// A ball that moves and is matt, another that is a blurred mirror, on a floor that is both, under a lamp, through a lens.
const ALL_EFFECTS: &str = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8 PixelFilter \"box\"\n\
    LookAt 0 2.5 -5  0 .6 0  0 1 0\n\
    Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.25 \"float focaldistance\" 4.5\nWorldBegin\n\
    LightSource \"gradientsky\" \"rgb zenith\" [.1 .2 .5] \"rgb horizon\" [.7 .6 .5] \"rgb ground\" [.1 .1 .1]\n\
    AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate -1 3 0 Rotate 90 1 0 0\n\
    Shape \"disk\" \"float radius\" .8 AttributeEnd\n\
    Material \"classic\" \"rgb diffuse\" [.4 .4 .4] \"rgb reflection\" [.4 .4 .4] \"float gloss\" 40 Shape \"plane\"\n\
    AttributeBegin TransformKeys \"float times\" [0 1] \"point3 translate\" [-1.2 .6 0  .2 .6 .4]\n\
    Material \"diffuse\" \"rgb reflectance\" [.8 .3 .2] Shape \"sphere\" \"float radius\" .6 AttributeEnd\n\
    Translate 1 .5 -.3 Material \"principled\" \"rgb basecolor\" [.9 .8 .6] \"float metallic\" 1 \"float roughness\" .4\n\
    Shape \"sphere\" \"float radius\" .5\n";

/// Mean and variance of the mean of each pixel, over pictures of other seeds.
fn estimate(distribution: Distribution, samples: u32, min_contribution: f32) -> Vec<(f64, f64)> {
    let seeds = 8u32;
    let mut sums = vec![(0.0, 0.0); 96];
    for seed in 0..seeds {
        let options = Options {
            seed: Some(seed.into()),
            max_depth: Some(3),
            min_contribution: Some(min_contribution),
            ..distributed(samples, distribution)
        };
        let picture = values(&render(&scene(ALL_EFFECTS, &options)));
        sums.iter_mut().zip(picture).for_each(|(s, v)| *s = (s.0 + v, s.1 + v * v));
    }
    let n = f64::from(seeds);
    let moments =
        |(sum, squares): (f64, f64)| (sum / n, (squares / n - (sum / n).powi(2)).max(0.0) / (n - 1.0));
    sums.into_iter().map(moments).collect()
}

fn nested(shadow: u32, gloss: u32, time: u32, lens: u32) -> Distribution {
    Distribution {
        shadow_rays: Some(shadow),
        lights: None,
        gloss_rays: Some(gloss),
        time_samples: Some(time),
        lens_samples: Some(lens),
        aa_samples: None,
        sampling: Some(Sampling::Nested),
    }
}

#[test]
fn nested_and_shared_samples_have_the_same_mean_c2() {
    let shared = estimate(Distribution::default(), 96, 0.0);
    // A branch is given up by its share before it was divided among several rays.
    for (how, least) in [(nested(1, 1, 2, 2), 0.0), (nested(3, 2, 2, 2), 0.0), (nested(2, 4, 1, 3), 0.002)] {
        let nested = estimate(how, 12, least);
        let pairs = || shared.iter().zip(&nested);
        let z = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0) / (a.1 + b.1).sqrt().max(1e-6);
        // Student's t with some ten degrees of freedom, of 96 pixels.
        let worst = pairs().map(z).fold(0.0, |m: f64, z| m.max(z.abs()));
        assert!(worst < 7.0, "{how:?}: {worst}");
        let (off, variance) = pairs().fold((0.0, 0.0), |(off, v), (a, b)| (off + a.0 - b.0, v + a.1 + b.1));
        assert!(off.abs() < 4.0 * variance.sqrt(), "{how:?}: {off} of {}", variance.sqrt());
        let mean = shared.iter().map(|p| p.0).sum::<f64>();
        assert!(variance.sqrt() < 0.01 * mean, "the test has power: {} of {mean}", variance.sqrt());
    }
}

/// Two facing planes of gloss, with a lamp beside: every ray meets one, every hit sends shadow and gloss rays.
const BETWEEN_PLANES: &str = "Film \"rgb\" \"integer xresolution\" 6 \"integer yresolution\" 4\n\
    LookAt 0 1 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 10 \"float lensradius\" 0.01 \"float focaldistance\" 1\n\
    WorldBegin\nAttributeBegin AreaLightSource \"diffuse\" Translate 50 1 0 Shape \"sphere\" \"float radius\" .5 AttributeEnd\n\
    Material \"classic\" \"rgb diffuse\" [.3 .3 .3] \"rgb reflection\" [.02 .02 .02] \"float gloss\" 5000\n\
    Shape \"plane\" Shape \"plane\" \"point3 point\" [0 2 0] \"vector3 normal\" [0 -1 0]\n";

fn counted(text: &str, options: &Options) -> Counters {
    let prepared: Prepared = scene(text, options);
    prepared.job().render(Gather::Counters, &(), &Default::default()).counters.expect("asked for")
}

#[test]
fn rays_of_nested_effects_multiply_and_shared_ones_do_not_c2() {
    let count = |distribution, least| {
        let options =
            Options { max_depth: Some(2), min_contribution: Some(least), ..distributed(16, distribution) };
        let counters = counted(BETWEEN_PLANES, &options);
        assert_eq!(counters.rays(RayKind::Reflection), 0);
        [RayKind::Eye, RayKind::GlossyReflection, RayKind::Shadow].map(|kind| counters.rays(kind))
    };
    let eye = 6 * 4 * 16;
    assert_eq!(count(Distribution::default(), 0.0), [eye, eye * 2, eye * 3], "one ray each");
    let shared = Distribution { sampling: Some(Sampling::Shared), ..nested(3, 5, 4, 2) };
    assert_eq!(count(shared, 0.0), [eye, eye * 2, eye * 3], "16 samples serve all");
    let more = Distribution { lens_samples: Some(20), ..shared };
    assert_eq!(count(more, 0.0), [24 * 20, 24 * 40, 24 * 60], "as many as the largest number");
    for (s, g, t, l) in [(1, 1, 4, 2), (3, 1, 1, 1), (1, 3, 1, 1), (2, 3, 2, 3)] {
        let [places, s64, g64] = [eye * u64::from(t * l), s.into(), g.into()];
        let hits = places * (1 + g64 + g64 * g64);
        assert_eq!(count(nested(s, g, t, l), 0.0), [places, hits - places, hits * s64], "{s} {g} {t} {l}");
    }
    // 0.02 passes the cut, 0.0004 does not; whether five rays share it or one.
    assert_eq!(count(nested(1, 1, 1, 1), 0.01)[1], eye);
    assert_eq!(count(nested(1, 5, 1, 1), 0.01)[1], eye * 5);
    // Frozen effects send no rays but shadow rays to the middle and sharp ones.
    let counters =
        counted(BETWEEN_PLANES, &Options { max_depth: Some(2), ..distributed(16, nested(0, 0, 0, 0)) });
    assert_eq!((counters.rays(RayKind::Eye), counters.rays(RayKind::GlossyReflection)), (eye, 0));
    assert!(counters.rays(RayKind::Reflection) >= eye && counters.rays(RayKind::Shadow) >= eye);
}

#[test]
fn frozen_effects_are_the_picture_without_them_f11() {
    let with = |text: &str, options: Options| render(&scene(text, &options));
    let plain = |distribution| distributed(9, distribution);
    let usual = Distribution::default();
    let all = with(ALL_EFFECTS, plain(usual));
    let off = |a: &Rendered, b: &Rendered| {
        values(a).iter().zip(values(b)).map(|(a, b)| (a - b).abs()).sum::<f64>() / 96.0
    };
    let same = |what: &str, frozen: &Rendered, other: &Rendered| {
        assert!(bits(frozen) == bits(other), "{what}: {}", off(frozen, other));
        assert!(off(frozen, &all) > 5e-3, "{what} does something: {}", off(frozen, &all));
    };
    // A pinhole.
    let pinhole = LensOptions { aperture: Some(Aperture::Radius(0.0)), ..LensOptions::default() };
    let frozen = with(ALL_EFFECTS, plain(Distribution { lens_samples: Some(0), ..usual }));
    // Directions are rounded on other ways.
    let rounding = off(&frozen, &with(ALL_EFFECTS, Options { lens: pinhole, ..plain(usual) }));
    assert!(rounding < 1e-6 && off(&frozen, &all) > 5e-3, "{rounding} {}", off(&frozen, &all));
    // A still at half time.
    let still = Options { time: 0.5, shutter: Some(Interval::point(0.0)), ..plain(usual) };
    let frozen = with(ALL_EFFECTS, plain(Distribution { time_samples: Some(0), ..usual }));
    same("time", &frozen, &with(ALL_EFFECTS, still));
    // Everything sharp: Whitted's picture, with one shadow ray to each light.
    let sharp = Distribution { gloss_rays: Some(0), ..usual };
    let whitted = Options { integrator: Some("whitted".to_owned()), ..plain(usual) };
    same("gloss", &with(ALL_EFFECTS, plain(sharp)), &with(ALL_EFFECTS, whitted));
    // A mirror, if nothing but the exponent says otherwise.
    let floor = ALL_EFFECTS.replace("\"float roughness\" .4", "\"float roughness\" 0");
    let mirror = floor.replace("\"float gloss\" 40", "");
    same("mirror", &with(&floor, plain(sharp)), &with(&mirror, plain(usual)));
}

#[test]
fn a_frozen_light_throws_hard_shadows_from_its_middle_f11() {
    let frozen = Distribution { shadow_rays: Some(0), ..Distribution::default() };
    for shape in [SQUARE, DISK] {
        let light = penumbra_light(shape);
        // Anywhere in the penumbra the light's middle is seen or not.
        for t in [-0.9, -0.5, -0.02, 0.02, 0.5, 0.9] {
            let x = t * 0.005;
            let seen =
                |world: String| spot([x + 0.5, 0.4, 2.0], [x, 0.0, 0.0], &world, &distributed(64, frozen));
            let open = seen(format!("{WHITE_FLOOR}{light}"));
            let share = seen(format!("{WHITE_FLOOR}{light}{HALF_PLANE}")) / open;
            assert_eq!(share, if t > 0.0 { 1.0 } else { 0.0 }, "{shape} {t}");
        }
    }
}
