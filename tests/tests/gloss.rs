//! Rays about blurred directions: with shadow rays they find all light once (multiple importance sampling), they keep the
//! energy of the lobes, know the bodies they are in, and differ from pixel to pixel and bounce to bounce (C8).
use durer::{
    Contribution, Distribution, Options, PathRay, Prepared, SampleCx, Value,
    integrator::Sampling,
    math::Point2,
    probe::RayKind,
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_tests::{render, scene};

fn nested(samples: u32, shadow_rays: u32, gloss_rays: u32) -> Options {
    Options {
        integrator: Some("distributed".to_owned()),
        samples: Some(samples),
        min_contribution: Some(0.0),
        distribution: Distribution {
            shadow_rays: Some(shadow_rays),
            gloss_rays: Some(gloss_rays),
            sampling: Some(Sampling::Nested),
            ..Distribution::default()
        },
        ..Options::default()
    }
}

/// A picture of one pixel: the origin, seen from `eye`, in a scene with no light but its own.
fn seen(eye: [f64; 3], world: &str, options: &Options) -> f64 {
    let [x, y, z] = eye;
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nLookAt {x} {y} {z}  0 0 0  0.1 0.2 0.9\n\
         Camera \"perspective\" \"float fov\" 0.0001\nWorldBegin\nLightSource \"ambient\" \"rgb L\" [0 0 0]\n{world}"
    );
    f64::from(render(&scene(&text, options)).film.pixels()[0].mean()[1])
}

const LAMP: &str = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true \
    Material \"diffuse\" \"rgb reflectance\" [0 0 0]";
/// Shines as much, but is no light: rays that meet it by chance find it, and no others.
const UNLIT: &str = "Material \"principled\" \"bool unlit\" true";
const SHAPES: [&str; 2] = [
    "Shape \"polygon\" \"point3 P\" [.3 {y} -.5  1.3 {y} -.5  1.3 {y} .5  .3 {y} .5]",
    "Translate .9 {y} 0 Shape \"sphere\" \"float radius\" .4",
];

/// The shape as a light or as something that shines, in a block of its own; at the height `y`.
fn shining(how: &str, shape: &str, y: f64) -> String {
    format!("AttributeBegin {how} {} AttributeEnd\n", shape.replace("{y}", &y.to_string()))
}

#[test]
fn light_found_by_shadow_rays_and_by_gloss_rays_counts_once() {
    let from = [-0.8, 1.0, 0.1];
    let metal = |r: f64| {
        format!(
            "Material \"principled\" \"rgb basecolor\" [1 1 1] \"float metallic\" 1 \"float roughness\" {r} Shape \"plane\"\n"
        )
    };
    let glass = |r: f64| {
        format!(
            "Material \"dielectric\" \"bool remaproughness\" false \"float roughness\" {r} Shape \"plane\"\n"
        )
    };
    let mut surfaces: Vec<(String, f64)> = [0.05, 0.2, 0.4, 0.7, 1.0].map(|r| (metal(r), 1.0)).into();
    surfaces.extend([0.05, 0.3, 0.8].map(|r| (glass(r), -1.0)));
    for shape in SHAPES {
        for (surface, y) in &surfaces {
            let found = seen(from, &(surface.clone() + &shining(UNLIT, shape, *y)), &nested(16384, 1, 1));
            assert!(found > 0.01, "{surface}: {found}");
            for (shadow, gloss) in [(1, 1), (1, 4), (4, 1), (4, 4), (0, 1)] {
                let options = nested(16384, shadow, gloss);
                let got = seen(from, &(surface.clone() + &shining(LAMP, shape, *y)), &options);
                let allowed = 0.02 * found + 0.001;
                assert!((got - found).abs() < allowed, "{shadow} {gloss} {surface} {shape}: {got} {found}");
            }
        }
    }
}

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

#[test]
fn rough_mirrors_lose_what_the_furnace_says_e3() {
    for (alpha, expected) in [(0.1f64, 0.988304), (0.25, 0.915812), (0.5, 0.687849), (1.0, 0.306853)] {
        let metal = format!(
            "{SKY}Material \"principled\" \"rgb basecolor\" [1 1 1] \"float metallic\" 1 \"float roughness\" {} Shape \"plane\"\n",
            alpha.sqrt()
        );
        let got = seen([0.0, 1.0, 0.0], &metal, &nested(4096, 1, 1));
        assert!((got - expected).abs() < 3e-3, "alpha {alpha}: {got}");
    }
    // The lobe of 1984 is turned back where it would enter the surface: nothing is lost.
    for exponent in [0, 4, 64, 20000] {
        let gloss = format!(
            "{SKY}Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb reflection\" [.9 .9 .9] \"float gloss\" {exponent} Shape \"plane\"\n"
        );
        let got = seen([1.0, 0.2, 0.0], &gloss, &nested(64, 1, 1));
        assert!((got - 0.9).abs() < 1e-5, "exponent {exponent}: {got}");
        let both = gloss
            .replace("[.9 .9 .9]", "[.3 .3 .3] \"rgb transmission\" [.6 .6 .6] \"float translucency\" 9");
        let got = seen([1.0, 0.2, 0.0], &both, &nested(64, 1, 2));
        assert!((got - 0.9).abs() < 1e-5, "exponent {exponent}: {got}");
    }
}

/// The mean of a picture of something about the origin, and how many rays left bodies that they were not in.
fn portrait(world: &str, options: &Options) -> (f64, bool) {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\nLookAt 0 0 -4  0 0 0  0 1 0\n\
         Camera \"perspective\" \"float fov\" 20\nWorldBegin\n{world}"
    );
    let rendered = render(&scene(&text, options));
    let pixels = rendered.film.pixels();
    let mean = pixels.iter().map(|p| f64::from(p.mean()[1])).sum::<f64>() / pixels.len() as f64;
    (mean, rendered.imbalances.is_empty())
}

fn ball(radius: f64, material: &str) -> String {
    format!(
        "Material \"dielectric\" \"bool remaproughness\" false {material} Shape \"sphere\" \"float radius\" {radius}\n"
    )
}

#[test]
fn frosted_glass_in_a_white_sky_never_gains_and_loses_little_i19() {
    // At 0.3 three samplers agree on 0.7915.
    for (roughness, least) in [(0.0, 0.9999), (0.01, 0.995), (0.1, 0.96), (0.3, 0.788), (1.0, 0.3)] {
        let world = format!("{SKY}{}", ball(1.0, &format!("\"float roughness\" {roughness}")));
        let (mean, is_balanced) = portrait(&world, &Options { max_depth: Some(40), ..nested(4, 1, 1) });
        assert!(is_balanced && mean < 1.002 && mean > least, "{roughness}: {mean}");
    }
}

#[test]
fn frosted_bodies_absorb_and_overlap_like_smooth_ones_i18_i20() {
    // Each with a place for what is said of its roughness.
    let alone = ball(1.0, "\"rgb absorption\" [.5 .5 .5] {r}");
    let two = |outer: u32, inner: u32| {
        let glass = ball(1.0, &format!("\"integer priority\" {outer} \"rgb absorption\" [.2 .2 .2] {{r}}"));
        let water = format!("\"integer priority\" {inner} \"float eta\" 1.333 \"rgb absorption\" [.3 .3 .3]");
        format!("{glass}Translate .5 0 0\n{}", ball(0.9, &water))
    };
    let bodies = [("absorbing", alone), ("glass over water", two(2, 1)), ("water over glass", two(1, 2))];
    for (what, world) in bodies {
        let taken = |roughness: &str| {
            let options = Options { max_depth: Some(12), ..nested(4, 1, 1) };
            portrait(&format!("{SKY}{}", world.replace("{r}", roughness)), &options)
        };
        let (smooth, nearly, rough) =
            (taken(""), taken("\"float roughness\" 0.004"), taken("\"float roughness\" 0.4"));
        assert!(smooth.1 && nearly.1 && rough.1, "{what}: no ray leaves what it has not entered");
        assert!((nearly.0 / smooth.0 - 1.0).abs() < 0.01, "{what}: {nearly:?} {smooth:?}");
        assert!(rough.0 < 0.99 * smooth.0, "{what}: the way through is another: {rough:?} {smooth:?}");
        assert!(smooth.0 < 0.95, "{what}: something is absorbed: {smooth:?}");
    }
}

#[test]
fn frosted_surfaces_between_equal_indices_show_lights_as_they_are() {
    let through = |eta: f64, roughness: f64, shadow: u32| {
        let sheet = format!(
            "Material \"dielectric\" \"float eta\" {eta} \"bool remaproughness\" false \
             \"float roughness\" {roughness} Shape \"plane\"\n"
        );
        let lamp = "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true Translate -.5 -1 0 \
                    Rotate 90 1 0 0 Shape \"disk\" \"float radius\" .2 AttributeEnd\n";
        seen([0.5, 1.0, 0.0], &format!("{sheet}{lamp}"), &nested(256, shadow, 1))
    };
    for roughness in [0.1, 0.5, 1.0] {
        for shadow in [0, 1, 4] {
            let got = through(1.0, roughness, shadow);
            assert!((got - 1.0).abs() < 1e-4, "{roughness} {shadow}: {got}");
            // Nearly equal ones blur nearly nothing, and lose what single scattering does.
            let [near, alone] = [shadow, 0].map(|shadow| through(1.001, roughness, shadow));
            assert!((near - alone).abs() < 0.01 && near > 0.9, "{roughness} {shadow}: {near} {alone}");
        }
    }
}

/// Two facing walls of gloss, one seen in the other, under a sky of two colours.
const CORRIDOR: &str = "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 PixelFilter \"box\"\n\
    LookAt 0 1 0  1 1 1  0 1 0\nCamera \"perspective\" \"float fov\" 10\n\
    Integrator \"distributed\" \"integer maxdepth\" 2 \"float mincontribution\" 0\nWorldBegin\n\
    LightSource \"gradientsky\" \"rgb zenith\" [1 1 1] \"rgb horizon\" [.5 .5 .5] \"rgb ground\" [0 0 0]\n\
    Material \"classic\" \"rgb diffuse\" [0 0 0] \"rgb reflection\" [1 1 1] \"float gloss\" 20\n\
    Shape \"polygon\" \"point3 P\" [-90 -90 3  5 -90 3  5 90 3  -90 90 3]\n\
    Shape \"polygon\" \"point3 P\" [-90 -90 -1  90 -90 -1  90 90 -1  -90 90 -1]\n";

/// The picture by `samples` of each pixel, whose numbers are those of the pixel that `source` names.
fn picture(prepared: &Prepared, samples: u32, seed: u64, source: impl Fn([u32; 2]) -> [u32; 2]) -> Vec<f64> {
    let cx = SampleCx { scene: &prepared.scene, basis: Basis::Rgb };
    let mut out = Contribution::default();
    let pixels = (0..64u32).flat_map(|y| (0..64u32).map(move |x| [x, y]));
    let mean = pixels.map(|pixel| {
        let film = Point2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
        let ray = prepared.scene.view.ray(film, Point2::new(0.5, 0.5), 0.0);
        let one = |sample| {
            let sampler = Sampler::new(SamplerKind::Sobol, seed, source(pixel), sample, samples);
            prepared.integrator.sample(&cx, &PathRay::eye(ray, sampler), &mut out);
            match out.value {
                Value::Radiance(radiance) => f64::from(Basis::Rgb.to_rgb(radiance)[1]),
                Value::Data(_) => f64::NAN,
            }
        };
        (0..samples).map(one).sum::<f64>() / f64::from(samples)
    });
    mean.collect()
}

/// Correlation of a picture with itself shifted by so many pixels.
fn autocorrelation(picture: &[f64], [dx, dy]: [usize; 2]) -> f64 {
    let at = |x: usize, y: usize| picture[y * 64 + x];
    let (mut product, mut square) = (0.0, 0.0);
    for y in 0..64 - dy {
        for x in 0..64 - dx {
            product += at(x, y) * at(x + dx, y + dy);
            square += 0.5 * (at(x, y).powi(2) + at(x + dx, y + dy).powi(2));
        }
    }
    product / square
}

#[test]
fn errors_of_neighbouring_pixels_have_nothing_in_common_c8() {
    let corridor = scene(CORRIDOR, &Options::default());
    // The picture is smooth: its mean over blocks of pixels is as good as many samples.
    let truth = {
        let noisy = picture(&corridor, 16, 9, |pixel| pixel);
        let block = |x: usize, y: usize| {
            let near = |v: usize| v.saturating_sub(6)..(v + 7).min(64);
            let all: Vec<f64> =
                near(y).flat_map(|j| near(x).map(move |i| (i, j))).map(|(i, j)| noisy[j * 64 + i]).collect();
            all.iter().sum::<f64>() / all.len() as f64
        };
        (0..64 * 64).map(|i| block(i % 64, i / 64)).collect::<Vec<_>>()
    };
    let error = |source: fn([u32; 2]) -> [u32; 2]| {
        let estimate = picture(&corridor, 4, 1, source);
        estimate.iter().zip(&truth).map(|(a, b)| a - b).collect::<Vec<f64>>()
    };
    let (hashed, shared, tiled) = (error(|p| p), error(|_| [0, 0]), error(|[x, y]| [x % 8, y % 8]));
    let rms = |e: &[f64]| (e.iter().map(|v| v * v).sum::<f64>() / e.len() as f64).sqrt();
    assert!(rms(&hashed) > 0.005, "there is an error to look at: {}", rms(&hashed));
    // One in 64 is the spread of a correlation of 4096 pairs; a pattern of 8 pixels is a peak of the spectrum there.
    for lag in [[1, 0], [0, 1], [1, 1], [2, 0], [0, 3], [8, 0], [0, 8], [8, 8]] {
        let [independent, same] = [&hashed, &shared].map(|e| autocorrelation(e, lag));
        assert!(independent.abs() < 0.08, "{lag:?}: {independent}");
        assert!(same > 0.5, "{lag:?}: {same}");
    }
    let [at_8, at_3] = [[8, 0], [3, 0]].map(|lag| autocorrelation(&tiled, lag));
    assert!(at_8 > 0.5 && at_3.abs() < 0.3, "{at_8} {at_3}");
}

#[test]
fn one_bounce_says_nothing_of_the_next_c8() {
    let corridor = scene(CORRIDOR, &Options { samples: Some(4), ..Options::default() });
    // How far each bounce strays from the mirror direction, which reverses z, and to which side.
    let mut pairs = Vec::new();
    for i in 0..4096u32 {
        let (tree, _) = corridor.job().record([i % 64, i / 64], i % 4);
        let way: Vec<_> = tree.nodes.iter().filter(|n| n.kind != RayKind::Shadow).collect();
        if let [eye, first, second] = way[..] {
            let strays = |before: &durer::probe::TreeNode, after: &durer::probe::TreeNode| {
                let (a, b) = (before.d.to_f64(), after.d.to_f64());
                [b.x * a.x + b.y * a.y - b.z * a.z, b.y - a.y]
            };
            pairs.push((strays(eye, first), strays(first, second)));
        }
    }
    assert!(pairs.len() > 2000, "{}", pairs.len());
    let n = pairs.len() as f64;
    for i in 0..2 {
        for j in 0..2 {
            let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
            let about_mean = |values: Vec<f64>| {
                let middle = mean(&values);
                values.iter().map(|v| v - middle).collect::<Vec<f64>>()
            };
            let a = about_mean(pairs.iter().map(|p| p.0[i]).collect());
            let b = about_mean(pairs.iter().map(|p| p.1[j]).collect());
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let r = product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt();
            // Three and a half times the spread of as many unrelated pairs.
            assert!(r.abs() < 3.5 / n.sqrt(), "{i} {j}: {r}");
        }
    }
}
