//! E13 in whole scenes: by whatever one light is chosen, the mean is the same; the tree has the least noise.
use std::fmt::Write;

use durer::{
    LightSampler, Lit, Options, Prepared,
    math::{Normal3, Point3},
    model::light::{Light, LightCx},
    sampling::{Dim, Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_tests::scene;

const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.0 };
const BY: [LightSampler; 3] = [LightSampler::Uniform, LightSampler::Power, LightSampler::Tree];
const SAMPLES: u32 = 1 << 15;

/// A street with `n` times `n` lamps of different strength 3 m above it, one of them a sphere, and `more`.
fn street(n: u32, more: &str) -> Prepared {
    let mut text = String::from("Camera \"perspective\"\nWorldBegin\n");
    text.push_str(
        "Shape \"trianglemesh\" \"point3 P\" [-90 -90 0 90 -90 0 0 90 0] \"integer indices\" [0 1 2]\n",
    );
    for i in 0..n * n {
        let (x, y) =
            (f64::from(i % n) * 4.0 - 2.0 * f64::from(n), f64::from(i / n) * 4.0 - 2.0 * f64::from(n));
        let l = 1.0 + f64::from(i * 7919 % 97) / 24.0;
        let lamp = if i % 17 == 3 {
            "Shape \"sphere\" \"float radius\" 0.2"
        } else {
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0  0 .5 0  .5 .5 0  .5 0 0] \"integer indices\" [0 1 2 0 2 3]"
        };
        let _ = writeln!(
            text,
            "AttributeBegin Translate {x} {y} 3 AreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {l}] {lamp} AttributeEnd"
        );
    }
    scene(&(text + more), &Options::default())
}

/// What a sample of a light gives to a plane that faces up.
fn irradiance(light: &dyn Light, lit: &Lit, sampler: &Sampler) -> f64 {
    let n = lit.n.expect("a plane");
    light.sample(&CX, lit.p, sampler).map_or(0.0, |s| f64::from(s.weight.mean() * n.dot(s.wi).max(0.0)))
}

/// Mean and variance of one sample of one light.
fn moments(prepared: &Prepared, by: LightSampler, lit: &Lit) -> (f64, f64) {
    let scene = &prepared.scene;
    let sums = (0..SAMPLES).fold([0.0; 2], |sums, i| {
        let sampler = Sampler::new(SamplerKind::Independent, 9, [0, 0], i, SAMPLES);
        let e = scene.choose_light(by, lit, || sampler.d1(Dim::LightChoice)).map_or(0.0, |chosen| {
            let again = scene.light_chance(by, lit, chosen.light);
            assert!((again / chosen.chance - 1.0).abs() < 1e-5, "{again} {}", chosen.chance);
            irradiance(&*scene.lights[chosen.light], lit, &sampler) / f64::from(chosen.chance)
        });
        [sums[0] + e, sums[1] + e * e]
    });
    let mean = sums[0] / f64::from(SAMPLES);
    (mean, sums[1] / f64::from(SAMPLES) - mean * mean)
}

fn places() -> [Lit; 3] {
    [[0.3, 0.4, 0.0], [5.0, -7.0, 1.0], [30.0, 2.0, 0.0]].map(|p| {
        let p = Point3::from(p);
        Lit { p, n: Some(Normal3::new(0.0, 0.0, 1.0)), time: 0.0 }
    })
}

const SKY: &str = "LightSource \"gradientsky\" \"rgb zenith\" [.1 .1 .1] \"rgb horizon\" [.1 .1 .1] \"rgb ground\" [.1 .1 .1] \"vector3 up\" [0 0 1]\n\
     LightSource \"distant\" \"rgb L\" [.2 .2 .2] \"point3 from\" [0 0 1] \"point3 to\" [1 0 0]\n\
     LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n\
     LightSource \"point\" \"string falloff\" \"none\" \"rgb I\" [.1 .1 .1] \"point3 from\" [0 0 9]\n";

#[test]
fn every_choice_has_the_same_mean_and_the_tree_the_least_noise() {
    for more in ["", SKY] {
        let prepared = street(20, more);
        for lit in places() {
            let lights = &prepared.scene.lights;
            let one = |light: &dyn Light| {
                let of = |i| irradiance(light, &lit, &Sampler::new(SamplerKind::Sobol, 1, [0, 0], i, 256));
                (0..256).map(of).sum::<f64>() / 256.0
            };
            let expected: f64 = lights.iter().map(|light| one(&**light)).sum();
            let found = BY.map(|by| moments(&prepared, by, &lit));
            for ((mean, variance), by) in found.into_iter().zip(BY) {
                let sigma = (variance / f64::from(SAMPLES)).sqrt();
                assert!(
                    (mean - expected).abs() < 4.0 * sigma + 1e-3 * expected,
                    "{by:?} at {:?}: {mean}, expected {expected}, sigma {sigma}",
                    lit.p
                );
            }
            let [uniform, power, tree] = found.map(|(_, variance)| variance / expected.powi(2));
            println!("{:?}: relative variance uniform {uniform:.1}, power {power:.1}, tree {tree:.2}", lit.p);
            assert!(tree < 0.25 * uniform.min(power), "{:?}: {uniform} {power} {tree}", lit.p);
        }
    }
}

#[test]
fn chances_are_those_of_all_lights_together() {
    let prepared = street(6, SKY);
    let scene = &prepared.scene;
    for (lit, by) in places().into_iter().flat_map(|lit| BY.map(|by| (lit, by))) {
        let chances: Vec<f32> = (0..scene.lights.len()).map(|i| scene.light_chance(by, &lit, i)).collect();
        let sum: f32 = chances.iter().sum();
        assert!((sum - 1.0).abs() < 1e-5, "{by:?}: {sum}");
        let mut counts = vec![0.0; chances.len()];
        for i in 0..4096 {
            let chosen = scene.choose_light(by, &lit, || i as f32 / 4096.0).expect("lit");
            counts[chosen.light] += 1.0 / 4096.0;
        }
        for (count, chance) in counts.iter().zip(&chances) {
            assert!((count - chance).abs() < 1.01 / 4096.0, "{by:?}: {count} {chance}");
        }
    }
    // The sun below the ground gives nothing to what faces up.
    let below = scene.light_names.iter().position(|name| name == "distant 2").expect("the sun from below");
    assert_eq!(scene.light_chance(LightSampler::Tree, &places()[0], below), 0.0);
}

/// Ten thousand lamps cost what the depth of their tree costs.
#[test]
fn ten_thousand_lamps_are_no_pain() {
    let start = std::time::Instant::now();
    let prepared = street(100, "");
    let built = start.elapsed();
    let [lit, ..] = places();
    let start = std::time::Instant::now();
    let (mean, variance) = moments(&prepared, LightSampler::Tree, &lit);
    let each = start.elapsed() / SAMPLES;
    println!(
        "10000 lamps: read and built in {built:?}; choice, its chance and a sample {each:?}; variance {}",
        variance / mean / mean
    );
    assert!(variance < 30.0 * mean * mean, "{mean} {variance}");
}
